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
pub mod networks;
pub mod open;
pub mod outline;
pub mod partial;
pub mod pipeline;
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

pub use error::Error;
pub use networks::with_networks;
pub use pipeline::{Conversion, GlyphReport, Options, Progress, convert, resume};
pub use quality::Quality;
