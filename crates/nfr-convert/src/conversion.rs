//! A conversion seen from outside: its progress and its result.

use crate::assemble::HintBytes;
use crate::compare::metrics::Sums;

/// A stage of a conversion that takes time for each glyph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// The glyphs are drawn once with their hints, to see which of them can be.
    Reading,
    /// Tracks are found for outlines.
    Fitting,
    /// Outline models are encoded.
    Encoding,
    /// Fields are trained.
    Training,
    /// Models are drawn and compared with the hinted glyphs.
    Measuring,
}

/// Callbacks of a running conversion, from several threads.
pub trait Progress: Sync {
    /// How many glyphs each stage has to work on in this run; those that a work file holds are not among them. Called again when more
    /// is known.
    fn work(&self, stages: &[(Stage, usize)]) {
        let _ = stages;
    }

    /// A stage has worked on one glyph.
    fn worked(&self, stage: Stage) {
        let _ = stage;
    }

    /// The number of glyphs that will be ready in the end: those selected, and the parts of them that need models.
    fn planned(&self, glyphs: usize) {
        let _ = glyphs;
    }

    /// One glyph is ready: its error over all sizes (mae, 0..1).
    fn glyph_done(&self, gid: u16, mae: f64);

    /// A defect of the font, and how the conversion handles it.
    fn warn(&self, message: &str) {
        let _ = message;
    }
}

/// One converted glyph, for the report.
#[derive(Debug, Clone, PartialEq)]
pub struct GlyphReport {
    /// The glyph.
    pub gid: u16,
    /// Bytes of its model in the table, or of the list of its parts.
    pub bytes: usize,
    /// Whether it is composed of others' models.
    pub composed: bool,
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
    /// One report for each glyph of the table, in ascending order: those selected, less those left out, and parts of them.
    pub glyphs: Vec<GlyphReport>,
    /// The selected glyphs that have no model, ascending: those that cannot be drawn with their hints, and those whose contours hinting changes, with
    /// [`Shape::Outline`](crate::Shape::Outline), and with [`Shape::Auto`](crate::Shape::Auto) in a build without the feature `train`.
    pub left_out: Vec<u16>,
    /// The sums over all selected glyphs that have models, and all sizes.
    pub sums: Sums,
    /// The length of the `Nfrt` table.
    pub table_bytes: usize,
    /// The hint programs of the original, which the new font does not have.
    pub hint_bytes: HintBytes,
}
