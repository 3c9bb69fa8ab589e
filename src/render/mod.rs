//! From a font to pixels.

mod area;
mod bytes;
mod charmap;
mod component;
mod decoder;
#[cfg(feature = "fields")]
mod draw;
mod flatten;
mod font;
mod glyf;
mod glyph;
mod lcd;
mod metrics;
mod mono;
mod outline;
mod rasterizer;
mod scratch;
mod shared_tracks;
mod stored_outline;
mod strips;
mod tables;

pub use decoder::Decoder;
pub use font::{Font, open};
pub use glyph::{Glyph, HintedOutline};
pub use metrics::LineMetrics;
pub use rasterizer::Rasterizer;
pub use scratch::Scratch;
pub use stored_outline::{components, recode_outlines};
pub use tables::head_units;
