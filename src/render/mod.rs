//! From a model to pixels.

mod area;
mod bitmap;
mod draw;
mod font;
mod glyph;
mod limits;
mod metrics;
#[cfg(feature = "networks")]
mod network;
mod options;
mod outline;
mod rasterizer;

pub use bitmap::{Bitmap, BitmapRef, Placement, union};
pub use draw::Scratch;
pub use font::{Font, head_units, open};
pub use glyph::{Decoder, Glyph};
pub use limits::{Limits, MissingModel};
pub use metrics::LineMetrics;
pub use options::DrawOptions;
pub use rasterizer::Rasterizer;
