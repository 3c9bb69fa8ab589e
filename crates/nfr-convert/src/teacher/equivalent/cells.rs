//! Cells of the tables that all programs of a glyph share.

use std::collections::BTreeSet;

/// A table that all programs of a glyph share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Table {
    ControlValues,
    Storage,
}

/// A cell of a table; without an index if a program computes that.
pub(super) type Cell = (Table, Option<i32>);

/// Whether a cell of one set can be one of the other.
pub(super) fn overlap(a: &BTreeSet<Cell>, b: &BTreeSet<Cell>) -> bool {
    let same = |(table, index): &Cell, (other, at): &Cell| {
        table == other && (index.is_none() || at.is_none() || index == at)
    };
    a.iter().any(|cell| b.iter().any(|other| same(cell, other)))
}
