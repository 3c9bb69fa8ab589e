//! From a hinted font to a neural one.

pub mod assemble;
pub mod distance;
pub mod start;
pub mod strip;
pub mod teach;
pub mod teacher;
pub mod train;
pub mod warp;

use std::ops::RangeInclusive;

use crate::error::Error;
use crate::model::Target;

/// What a conversion is asked to do.
#[derive(Debug, Clone)]
pub struct Options {
    /// The font's index in a collection file; 0 for a plain font.
    pub index: u32,
    /// The glyphs to convert, in ascending order.
    pub gids: Vec<u16>,
    /// The sizes to train on, in pixels per em.
    pub ppem: RangeInclusive<u16>,
    /// What the teacher hints for.
    pub target: Target,
    /// Seeds whatever the training draws at random.
    pub seed: u64,
    /// Threads. The result does not depend on it.
    pub jobs: usize,
}

/// What a conversion tells while it runs; called from several threads.
pub trait Progress: Sync {
    /// One glyph is ready: its training error (mae, 0..1).
    fn glyph_done(&self, gid: u16, mae: f64);
}

/// One converted glyph, for the report.
#[derive(Debug, Clone, PartialEq)]
pub struct GlyphReport {
    /// The glyph.
    pub gid: u16,
    /// Bytes of its model in the table.
    pub bytes: usize,
    /// Mean absolute error against the teacher over all sizes, 0..1.
    pub mae: f64,
    /// Share of pixels off by more than 16/255.
    pub bad16: f64,
}

/// A finished conversion.
#[derive(Debug, Clone)]
pub struct Conversion {
    /// The new font file.
    pub font: Vec<u8>,
    /// A line for each glyph, in order.
    pub glyphs: Vec<GlyphReport>,
    /// The length of the `Nfrt` table.
    pub table_bytes: usize,
}

/// Converts a font: trains a model for each glyph and writes a font that carries them instead of hints.
///
/// # Errors
///
/// `Malformed` or `Unsupported` for a font that cannot teach, `InvalidParameter` for options that make no
/// sense.
pub fn convert(input: &[u8], options: &Options, progress: &dyn Progress) -> Result<Conversion, Error> {
    let _ = (input, options, progress);
    Err(Error::Unsupported("conversion".into()))
}
