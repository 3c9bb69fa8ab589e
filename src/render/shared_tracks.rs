//! Tracks that glyphs share, kept after they are decoded: the next glyph often has the same.

use alloc::vec::Vec;
use core::ops::Range;

use crate::error::Damage;

/// The tracks that are kept.
const KEPT: usize = 64;

/// The moves of some shared tracks. Each has one place, which the last one that belongs there has.
#[derive(Debug, Default)]
pub(super) struct SharedTracks {
    places: Vec<Option<Kept>>,
    /// Working memory of decoding one.
    memory: Vec<u16>,
}

#[derive(Debug, Clone)]
struct Kept {
    axis: usize,
    number: usize,
    first_size: usize,
    moves: Vec<i16>,
}

impl SharedTracks {
    /// The moves of a shared track along an axis at some sizes, which `decode` gives if they are not kept: it is lent
    /// working memory.
    ///
    /// # Errors
    ///
    /// Those of `decode`.
    pub(super) fn moves(
        &mut self,
        axis: usize,
        number: usize,
        sizes: Range<usize>,
        decode: impl FnOnce(&mut Vec<u16>) -> Result<Vec<i16>, Damage>,
    ) -> Result<Vec<i16>, Damage> {
        if self.places.is_empty() {
            self.places.resize(KEPT, None);
        }
        let place = &mut self.places[(2 * number + axis) % KEPT];
        if let Some(kept) = place
            && (kept.axis, kept.number, kept.first_size) == (axis, number, sizes.start)
            && let Some(moves) = kept.moves.get(..sizes.len())
        {
            return Ok(moves.to_vec());
        }
        let moves = decode(&mut self.memory)?;
        *place = Some(Kept { axis, number, first_size: sizes.start, moves: moves.clone() });
        Ok(moves)
    }
}
