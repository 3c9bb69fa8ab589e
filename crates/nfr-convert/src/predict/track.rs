//! Tracks: coordinates that hinting moves as one.

/// Points that have the same coordinate in the unhinted outline and in every hinted one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Track {
    /// In em.
    pub(super) unhinted: f64,
    /// In pixels, at each known size.
    pub(super) hinted: Vec<f64>,
}

impl Track {
    /// The same for tracks that are equal, and for no others.
    pub(super) fn key(&self) -> Vec<u64> {
        // Adding 0 turns −0 into 0.
        std::iter::once(&self.unhinted).chain(&self.hinted).map(|v| (v + 0.0).to_bits()).collect()
    }

    /// The distance from another track at each known size, in pixels.
    pub(super) fn distance_from(&self, other: &Self) -> Vec<f64> {
        self.hinted.iter().zip(&other.hinted).map(|(a, b)| a - b).collect()
    }
}

/// The position of a track at the wanted size.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Position {
    /// In pixels.
    pub(super) at: f64,
    /// The natural logarithm of its probability.
    pub(super) log_probability: f64,
}

/// A track that many glyphs share, as the baseline and the x-height, with its position at the wanted size.
#[derive(Debug, Clone)]
pub(super) struct AlignmentZone {
    pub(super) track: Track,
    pub(super) position: Position,
}
