//! Tracks that the glyphs of a font share: a level, and a move at each size.

use alloc::vec::Vec;
use core::ops::Range;

use read_fonts::types::BigEndian;

use crate::error::Damage;

/// Where the moves of a track come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Source {
    /// They are coded with the glyph.
    #[default]
    Own,
    /// They are those of a shared track of the same level.
    Same(u16),
    /// They are coded with the glyph, and a shared track of about the same level predicts them.
    Near(u16),
    /// They are 0 at all sizes: other points are interpolated between the track's.
    Still,
}

impl Source {
    /// Whether there are moves that are coded with the glyph.
    pub(super) fn is_coded(self) -> bool {
        matches!(self, Self::Own | Self::Near(_))
    }
}

/// Gives the moves of a shared track, by its axis and its number, at some sizes. It is lent working memory.
pub type SharedMoves<'a> = dyn Fn(usize, usize, Range<usize>, &mut Vec<u16>) -> Result<Vec<i16>, Damage> + 'a;

/// The shared tracks of a font, along x and y.
#[derive(Clone, Copy)]
pub struct Shared<'a> {
    /// Their levels, ascending.
    pub levels: [&'a [BigEndian<i16>]; 2],
    /// Gives the moves of a shared track, by its axis and its number, at some sizes. It is lent working memory.
    pub moves: &'a SharedMoves<'a>,
}

impl Shared<'_> {
    /// The shared tracks of a level.
    pub(super) fn of_level(&self, axis: usize, level: i16) -> Range<usize> {
        let levels = self.levels[axis];
        levels.partition_point(|at| at.get() < level)..levels.partition_point(|at| at.get() <= level)
    }

    /// The shared tracks by the distance of their levels from one: those below, and of the same level, come before those above
    /// that are as far.
    fn by_distance(&self, axis: usize, level: i16) -> impl Iterator<Item = usize> {
        let levels = self.levels[axis];
        let mut above = levels.partition_point(|at| at.get() <= level);
        let mut below = above;
        let far =
            move |at: usize| levels.get(at).map_or(u32::MAX, |at| i32::from(at.get()).abs_diff(level.into()));
        core::iter::from_fn(move || {
            if below > 0 && far(below - 1) <= far(above) {
                below -= 1;
                return Some(below);
            }
            above += 1;
            (above <= levels.len()).then_some(above - 1)
        })
    }

    /// The place of a shared track in the order of distances from a level.
    pub(super) fn rank(&self, axis: usize, level: i16, number: usize) -> usize {
        self.by_distance(axis, level).position(|at| at == number).unwrap_or(0)
    }

    /// The shared track at a place in the order of distances from a level.
    pub(super) fn of_rank(&self, axis: usize, level: i16, rank: usize) -> Option<usize> {
        self.by_distance(axis, level).nth(rank)
    }
}
