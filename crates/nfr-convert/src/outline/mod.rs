//! Outline models: the tracks of each glyph, found in closed form; what glyphs share; and the messages of the table, whose moves
//! are chosen by bits against the error of the pixels.

mod correction;
mod distortion;
mod encode;
mod fit;
mod kept;
mod samples;
mod sharing;
mod stored;

pub(crate) use encode::{EncodedOutlines, Store, encode};
pub(crate) use fit::{FittedOutline, fit};
pub(crate) use kept::{Encoded, keep_encoded, keep_fitted, kept_encoded, kept_fitted};
pub(crate) use samples::OutlineSamples;
pub(crate) use stored::{FontGlyph, stored_outline};
