//! The models and experiments of the paper "Neural Font Rendering" (Anderson, Shamir, Fried), and our model beside
//! them on the same bitmaps.

#![forbid(unsafe_code)]

pub mod accelerator;
pub mod charts;
pub mod classes;
pub mod dataset;
mod dense;
pub mod device_check;
pub mod enlarge;
pub mod error_table;
pub mod evaluation;
pub mod experiment;
pub mod family;
mod files;
pub mod gridfit_interpolation;
mod groups;
pub mod guard;
pub mod implicit;
pub mod interpolation;
pub mod lockstep;
pub mod masked;
pub mod masked_samples;
pub mod memorisation;
pub mod network_font;
pub mod network_training;
pub mod network_variant;
pub mod output;
pub mod pictures;
pub mod pixel_error;
pub mod queue;
mod random;
pub mod report;
pub mod resize;
pub mod samples;
pub mod schedule;
pub mod settings;
pub mod statistics;
pub mod stored_network;
pub mod study;
mod tensors;
pub mod train;
pub mod truth;

/// One ground-truth bitmap of a glyph, or a model's picture of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SquareBitmap {
    /// Pixels along a side of the box, *s* in the paper.
    pub side: usize,
    /// Coverage 0–255, top row first, `side`² bytes.
    pub pixels: Vec<u8>,
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
