//! Outline models: the tracks of each glyph, found in closed form; what glyphs share; and the messages of the table, whose moves
//! are chosen by bits against the error of the pixels.

mod correction;
mod distortion;
mod encode;
mod fit;
mod samples;
mod sharing;
mod stored;

pub(crate) use encode::{EncodedOutlines, encode};
pub(crate) use fit::{FittedOutline, fit};
pub(crate) use samples::OutlineSamples;
pub(crate) use stored::{FontGlyph, stored_outline};
