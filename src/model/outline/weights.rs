//! What hinting does to an outline, as it is stored.

use alloc::vec::Vec;
use core::ops::Range;

use super::points::OutlinePoints;
use crate::error::Damage;
use crate::model::sizes::Scale;

/// The most tracks of an axis.
pub const MAX_TRACKS: usize = 250;
/// Stands for the track of a point that no track moves.
pub const UNTOUCHED: u8 = u8::MAX;

/// A point that is not where the tracks put it at a size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Correction {
    /// The index of the size.
    pub size: u16,
    /// The point.
    pub point: u16,
    /// How far it is moved in 1/64 pixel.
    pub by: i16,
}

/// What hinting does along one axis.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct AxisHints {
    /// Whether there are tracks, or corrections at any size: the axis then follows whole sizes.
    pub is_hinted: bool,
    /// The level of each track in font units, ascending: the coordinate of its points. Equal levels may follow each other.
    pub levels: Vec<i16>,
    /// The track of each point, or [`UNTOUCHED`]. Empty if there are no tracks.
    pub track_of: Vec<u8>,
    /// Whether each track moves its own points alone, so that those between the levels of others pass it by. Empty where points
    /// follow those beside them on their contour.
    pub is_local: Vec<bool>,
    /// The index of the first size that `moves` has.
    pub first_size: usize,
    /// For each size, for each track: how far it is from its scaled level, in 1/64 pixel.
    pub moves: Vec<i16>,
    /// Corrections, ascending by size, then point.
    pub corrections: Vec<Correction>,
}

impl AxisHints {
    /// The moves of all tracks at a size.
    pub fn moves_at(&self, size: usize) -> &[i16] {
        let tracks = self.levels.len();
        let first = size.checked_sub(self.first_size).map(|at| at * tracks);
        first.and_then(|first| self.moves.get(first..first + tracks)).unwrap_or_default()
    }

    /// The corrections at a size.
    pub fn corrections_at(&self, size: usize) -> &[Correction] {
        let first = self.corrections.partition_point(|c| usize::from(c.size) < size);
        let end = self.corrections.partition_point(|c| usize::from(c.size) <= size);
        &self.corrections[first..end]
    }

    fn memory(&self) -> usize {
        2 * (self.levels.capacity() + self.moves.len())
            + self.track_of.len()
            + self.is_local.len()
            + size_of_val(&*self.corrections)
    }
}

/// A glyph's weights as they are stored.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OutlineWeights {
    /// Hints along x and y.
    pub axes: [AxisHints; 2],
    /// The hinted advance width at each size, in whole pixels less the scaled advance width, rounded. 0 at sizes before those that
    /// are decoded.
    pub advances: Vec<i8>,
}

/// A glyph's outline with its hints, ready to draw at some trained sizes.
#[derive(Debug, Clone)]
pub struct OutlineModel {
    /// Units and sizes of the font's models.
    pub scale: Scale,
    /// The sizes that are decoded, counted from the smallest.
    pub sizes: Range<usize>,
    /// The outline.
    pub points: OutlinePoints,
    /// The hints.
    pub weights: OutlineWeights,
}

impl OutlineModel {
    /// Puts an outline and its hints together.
    ///
    /// # Errors
    ///
    /// `Malformed` if they do not fit each other.
    pub fn new(
        points: OutlinePoints,
        weights: OutlineWeights,
        scale: Scale,
        sizes: Range<usize>,
    ) -> Result<Self, Damage> {
        for (axis, coordinates) in weights.axes.iter().zip(&points.coordinates) {
            let tracks = axis.levels.len();
            let fits = tracks <= MAX_TRACKS
                && axis.moves.len() == tracks * sizes.len()
                && (tracks == 0 || axis.first_size == sizes.start)
                && (axis.track_of.len() == points.len() || tracks == 0 && axis.track_of.is_empty());
            let level = |(track, at): (&u8, &i16)| {
                *track == UNTOUCHED || axis.levels.get(usize::from(*track)) == Some(at)
            };
            let inside = |c: &Correction| usize::from(c.point) < points.len();
            if !fits
                || !axis.track_of.iter().zip(coordinates).all(level)
                || !axis.corrections.iter().all(inside)
            {
                return Err(Damage::Malformed("has hints that do not fit its outline"));
            }
        }
        Ok(Self { scale, sizes, points, weights })
    }

    /// Whether the sizes that are decoded include the one with this index.
    pub fn has_size(&self, index: usize) -> bool {
        self.sizes.contains(&index)
    }

    /// Whether the sizes that are decoded include those with these indices.
    pub fn has_sizes(&self, indices: &Range<usize>) -> bool {
        self.sizes.start <= indices.start && indices.end <= self.sizes.end
    }

    /// The memory that the model takes, in bytes.
    pub fn memory(&self) -> usize {
        size_of::<Self>()
            + self.points.memory()
            + self.weights.axes.iter().map(AxisHints::memory).sum::<usize>()
            + self.weights.advances.len()
    }
}
