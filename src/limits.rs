//! What a font file may ask of the renderer, and what is drawn where it has no model.

use crate::constants::MAX_SIDE;
use crate::error::Error;

/// What drawing a glyph may take. A font file cannot ask for more; an application may lower each limit.
///
/// ```
/// let mut limits = nfr::Limits::default();
/// limits.bitmap_side = 256;
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// The longest side of a bitmap in pixels: 8192, which is also the most.
    pub bitmap_side: u32,
    /// The memory that a decoded glyph may take, in bytes: 8 MiB. While a model is decoded, up to 1 MiB more is taken
    /// for a moment.
    pub decoded_bytes: usize,
    /// The steps that drawing a glyph may take: 2²⁸, some tenths of a second. A step is about one multiplication: one
    /// for each pixel, for each row and column that a side of the outline may cross, and for each weight that a network
    /// multiplies. Text takes some thousands of steps a glyph, a glyph of 2048 pixels per em some millions.
    pub work: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { bitmap_side: MAX_SIDE, decoded_bytes: 8 << 20, work: 1 << 28 }
    }
}

impl Limits {
    /// Checks a bitmap's sides.
    pub(crate) fn check_sides(&self, width: u32, height: u32) -> Result<(), Error> {
        let limit = self.bitmap_side.min(MAX_SIDE);
        if width <= limit && height <= limit {
            return Ok(());
        }
        Err(Error::BitmapTooLarge { width, height, limit })
    }

    /// Checks the memory of a decoded glyph.
    pub(crate) fn check_decoded(&self, glyph: u32, bytes: usize) -> Result<(), Error> {
        let limit = self.decoded_bytes;
        if bytes <= limit { Ok(()) } else { Err(Error::DecodedTooLarge { glyph, bytes, limit }) }
    }
}

/// The steps that drawing a glyph may still take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Budget {
    glyph: u32,
    spent: u64,
    limit: u64,
}

impl Budget {
    pub(crate) fn new(glyph: u32, limits: &Limits) -> Self {
        Self { glyph, spent: 0, limit: limits.work }
    }

    /// For callers that draw what they have made themselves.
    #[cfg(feature = "fields")]
    pub(crate) fn unlimited() -> Self {
        Self { glyph: 0, spent: 0, limit: u64::MAX }
    }

    /// Takes steps off.
    ///
    /// # Errors
    ///
    /// `TooMuchWork` if there are not as many left.
    pub(crate) fn spend(&mut self, steps: u64) -> Result<(), Error> {
        self.spent = self.spent.saturating_add(steps);
        if self.spent <= self.limit {
            return Ok(());
        }
        Err(Error::TooMuchWork { glyph: self.glyph, work: self.spent, limit: self.limit })
    }
}

/// What is drawn for a glyph that the font has, but no model of. A damaged model is an error in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[non_exhaustive]
pub enum MissingModel {
    /// [`Error::MissingModel`], so that the application can draw the glyph by other means.
    #[default]
    Error,
    /// Nothing: an empty bitmap.
    Blank,
    /// The glyph's plain outline, without hinting.
    Outline,
}
