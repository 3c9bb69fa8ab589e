//! Neural font rendering: hinted bitmaps from small implicit models, with no bytecode interpreter.
//!
//! A converted font carries a model for each glyph in a table `Nfrt`. [`Font`] opens it, [`Rasterizer`] draws:
//!
//! ```
//! # fn draw(file: &[u8]) -> Result<nfr::Bitmap, nfr::Error> {
//! let font = nfr::Font::parse(file)?;
//! nfr::Rasterizer::new(&font).render(font.glyph_for_char('g').unwrap_or(0), 16.0)
//! # }
//! # assert!(draw(b"no font").is_err());
//! ```

#![forbid(unsafe_code)]

#[doc(hidden)]
pub mod error;
#[doc(hidden)]
pub mod model;
#[doc(hidden)]
pub mod render;
#[doc(hidden)]
pub mod table;

pub use error::Error;
pub use model::Target;
pub use render::{Bitmap, Font, Glyph, MAX_PEN, Placement, Rasterizer, Scratch, Setting};

/// What the converter shares with the renderer. No promises: anything in here may change in any release.
#[doc(hidden)]
pub mod internals {
    pub use crate::{error, model, render, table};
}

/// Runs the examples of README as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
