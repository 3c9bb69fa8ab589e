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
//!
//! With the default feature `convert`, `convert` trains and writes such fonts and `compare` measures them; with `lab`,
//! `lab` has the models and experiments of the paper that the idea comes from; without default features this is the
//! renderer alone. `spec/nfrt.md` in the repository describes the table.

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
#[cfg(feature = "lab")]
pub mod lab;

pub use error::Error;
pub use model::Target;
pub use render::{Bitmap, Font, Glyph, MAX_PEN, Placement, Rasterizer, Scratch, Setting};

/// Runs the examples of README as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
