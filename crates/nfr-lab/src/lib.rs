//! The models and experiments of the paper "Neural Font Rendering" (Anderson, Shamir, Fried), and our model beside
//! them on the same bitmaps.

#![forbid(unsafe_code)]

pub mod bench;
pub mod between;
pub mod charts;
pub mod classes;
mod dense;
pub mod enlarge;
pub mod error;
pub mod family;
mod files;
pub mod implicit;
pub mod interpolation;
pub mod learn;
pub mod masked;
pub mod networks;
pub mod output;
pub mod pictures;
mod random;
pub mod report;
pub mod resize;
pub mod samples;
pub mod scale;
pub mod schedule;
pub mod single;
pub mod stored;
pub mod study;
mod tensors;
pub mod train;
pub mod truth;

/// One ground-truth bitmap of a glyph, or a model's picture of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Square {
    /// Pixels along a side of the box, *s* in the paper.
    pub side: usize,
    /// Coverage 0–255, top row first, `side`² bytes.
    pub pixels: Vec<u8>,
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
