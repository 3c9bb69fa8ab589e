//! From a hinted font to a neural one. The stages, in order: `input`, `teacher`, `training_samples`, `predict` (sizes that
//! the teacher does not draw), `compose` (glyphs made of other glyphs' models), then either `outline` (outline models, in closed
//! form) or `fit` (initial fields), `train` and `refine` (rate–distortion refinement of the integers), `writer` and `assemble`; `pipeline` runs them. Each stage's output is a
//! plain type that the next one takes.
//!
//! `train` and burn are built with the feature `train`. Without it, a conversion that would train a field is
//! [`Error::TrainingNotBuilt`].

#![forbid(unsafe_code)]

pub mod assemble;
pub mod combine;
pub mod compare;
mod compose;
mod conversion;
pub mod cost;
pub mod error;
pub mod fit;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod fixtures;
mod input;
pub mod options;
mod outline;
mod parallel;
pub mod partial;
mod path_points;
mod pipeline;
mod predict;
pub mod random;
pub mod records;
pub mod refine;
pub mod strip;
pub mod teacher;
pub mod temporary;
#[cfg(feature = "train")]
pub mod train;
pub mod training_samples;
pub mod writer;

pub use conversion::{Conversion, GlyphReport, Progress, Stage};
pub use error::Error;
pub use input::{closure, face_names, open, ppem, select, variable, web_font};
pub use options::{Hinter, Options, Quality, Shape};
pub use pipeline::{convert, resume};

/// Runs the examples of the README as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
