//! Composed glyphs: accented letters and duplicate shapes, which need no model of their own.
//!
//! A glyph is composed of others if hinting does the same: at every size each of its parts must be another glyph's hinted
//! outline, moved, and the parts' coverage must add up to the glyph's.

mod components;
mod coverage;
mod decomposition;
mod duplicates;
mod matcher;

pub(crate) use decomposition::Decomposition;
