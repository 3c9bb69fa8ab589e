//! From a hinted font to a neural one: select, teach, train, quantise, polish, pack. Each stage is a module, and each
//! stage's output is a plain type that the next one takes.

#![forbid(unsafe_code)]

pub mod assemble;
pub mod compare;
mod compose;
pub mod cost;
mod course;
mod deform;
mod distance;
pub mod error;
pub mod open;
pub mod outline;
mod parallel;
pub mod partial;
pub mod pipeline;
mod plain;
pub mod polish;
pub mod ppem;
mod predict;
mod quality;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod samples;
pub mod select;
pub mod start;
pub mod strip;
pub mod teach;
pub mod teacher;
pub mod temporary;
pub mod train;
mod warp;
pub mod writer;

pub use error::Error;
pub use pipeline::{Conversion, GlyphReport, Options, Progress, convert, resume};
pub use quality::Quality;

/// Runs the examples of the README as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
