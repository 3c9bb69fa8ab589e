//! From a font to pixels.

mod area;
mod draw;
mod font;
mod glyph;
mod metrics;
mod outline;
mod rasterizer;

pub use draw::Scratch;
pub use font::{Font, head_units, open};
pub use glyph::{Decoder, Glyph};
pub use metrics::LineMetrics;
pub use rasterizer::Rasterizer;
