//! Tracks that glyphs share, kept after they are decoded: the next glyph often has the same.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use crate::error::Damage;

/// The tracks that are kept.
const KEPT: usize = 64;

/// The moves of some shared tracks. Each has one place, which the last one that belongs there has.
#[derive(Debug, Default)]
pub(super) struct SharedTracks {
    places: Vec<Place>,
    /// Room for so many moves for each place.
    room: usize,
    moves: Vec<i16>,
}

/// What is kept at a place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Place {
    number: u16,
    axis: u8,
    first_size: u16,
    /// How many moves there are, 0 for none.
    count: u16,
}

impl SharedTracks {
    /// The moves of a shared track along an axis at some sizes, which `decode` gives if they are not kept.
    ///
    /// # Errors
    ///
    /// Those of `decode`.
    pub(super) fn moves(
        &mut self,
        axis: usize,
        number: usize,
        sizes: Range<usize>,
        decode: impl FnOnce() -> Result<Vec<i16>, Damage>,
    ) -> Result<Vec<i16>, Damage> {
        if self.room < sizes.len() {
            self.room = sizes.len();
            self.places = vec![Place::default(); KEPT];
            self.moves = vec![0; KEPT * self.room];
        }
        let at = (2 * number + axis) % KEPT;
        let (place, moves) = (&mut self.places[at], &mut self.moves[at * self.room..][..sizes.len()]);
        let wanted = Place {
            number: number as u16,
            axis: axis as u8,
            first_size: sizes.start as u16,
            count: place.count,
        };
        if *place == wanted && usize::from(place.count) >= sizes.len() {
            return Ok(moves.to_vec());
        }
        let decoded = decode()?;
        if decoded.len() != moves.len() {
            return Ok(decoded);
        }
        moves.copy_from_slice(&decoded);
        *place = Place { count: sizes.len() as u16, ..wanted };
        Ok(decoded)
    }
}
