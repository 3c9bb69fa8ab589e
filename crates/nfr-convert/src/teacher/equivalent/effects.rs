//! What a glyph's program does to the tables that all programs of a glyph share: the control values and the storage area.

use std::collections::BTreeSet;

use read_fonts::tables::glyf::bytecode::{Opcode, decode_all};

use super::cells::Cell;
use super::follow::{Followed, Sizes, follow, only_computes};
use super::functions::Functions;

/// What a program does to the shared tables.
#[derive(Debug, Default)]
pub(super) struct Effects {
    /// The cells that the program may read before it writes them.
    pub(super) reads: BTreeSet<Cell>,
    /// Whether there are no other cells that it reads.
    pub(super) complete: bool,
    /// Whether it does no more than to write cells, so that nothing of it is seen.
    pub(super) unseen: bool,
    /// Code that writes again what the program has written, wherever it stands.
    pub(super) repeat: Vec<u8>,
    /// The cells that `repeat` writes.
    pub(super) repeated: BTreeSet<Cell>,
    /// The cells that the program may write and `repeat` does not.
    pub(super) lost: BTreeSet<Cell>,
}

impl Effects {
    /// Finds the effects of a program.
    pub(super) fn of(code: &[u8], functions: &Functions<'_>, sizes: Sizes) -> Self {
        let whole = follow(code, functions, sizes);
        if !whole.does_more {
            let (repeat, repeated) = repetition(code, &whole);
            return Self {
                repeat,
                repeated,
                reads: whole.reads,
                complete: true,
                unseen: true,
                lost: BTreeSet::new(),
            };
        }
        let end = &code[last_part(code)..];
        let last = follow(end, functions, sizes);
        // What is read at the end may be of the program's own making.
        let (repeat, repeated) = if last.does_more || !last.reads.is_empty() {
            Default::default()
        } else {
            repetition(end, &last)
        };
        let lost = whole.lasting.difference(&repeated).copied().collect();
        Self { reads: whole.reads, complete: whole.complete, unseen: false, repeat, repeated, lost }
    }
}

/// The code that stands for a program which only writes. It leaves an empty stack.
fn repetition(code: &[u8], followed: &Followed) -> (Vec<u8>, BTreeSet<Cell>) {
    if followed.writes.is_empty() {
        return Default::default();
    }
    let mut repeat = code.to_vec();
    if followed.leftover {
        repeat.push(Opcode::CLEAR as u8);
    }
    (repeat, followed.writes.clone())
}

/// Where the part of a program begins that does no more than to compute and write, and which is not in a branch.
fn last_part(code: &[u8]) -> usize {
    let (mut start, mut depth, mut restarts, mut broken) = (0, 0usize, false, false);
    for instruction in decode_all(code, 0).map_while(Result::ok) {
        if restarts {
            (start, restarts) = (instruction.pc, false);
        }
        match instruction.opcode {
            Opcode::IF => depth += 1,
            Opcode::ELSE => {}
            Opcode::EIF => {
                depth = depth.saturating_sub(1);
                restarts = depth == 0 && broken;
                broken &= !restarts;
            }
            opcode if only_computes(opcode) => {}
            _ if depth == 0 => restarts = true,
            _ => broken = true,
        }
    }
    if restarts || broken { code.len() } else { start }
}
