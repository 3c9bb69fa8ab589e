//! Neural font rendering: hinted bitmaps from small implicit models, with no bytecode interpreter.

#![forbid(unsafe_code)]

pub mod error;
pub mod model;
pub mod render;
pub mod table;

#[cfg(feature = "convert")]
pub mod cli;
#[cfg(feature = "convert")]
pub mod compare;
#[cfg(feature = "convert")]
pub mod convert;

pub use error::Error;
pub use model::Target;
pub use model::gridfit::Scratch;
pub use render::{Bitmap, Font, Glyph, Placement, Rasterizer};
