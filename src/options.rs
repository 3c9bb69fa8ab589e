//! At which size and where between pixels a glyph is drawn, and whether it is hinted.

use crate::constants::{MAX_OFFSET, MAX_PPEM};
use crate::error::Error;
use crate::model::sizes::{HintedSize, Scale};

/// How a glyph is drawn: its size, its subpixel offset, and whether it is hinted. A plain number is a size with no offset, hinted.
///
/// ```
/// let quarter = nfr::DrawOptions::new(16.0).with_offset([0.25, 0.0]);
/// assert_eq!(nfr::DrawOptions::from(16.0), quarter.with_offset([0.0, 0.0]));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawOptions {
    pub(crate) ppem: f32,
    pub(crate) offset: [f32; 2],
    pub(crate) hinting: bool,
    pub(crate) sampling: Sampling,
}

/// Where coverage is sampled: how subpixels are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sampling {
    /// Samples of a pixel along x and y: the bitmap's columns and rows are so many times narrower.
    pub(crate) stretch: [i32; 2],
    /// What the glyph is moved by, beside its offset, in pixels.
    pub(crate) shift: [f32; 2],
}

impl Sampling {
    /// One sample a pixel.
    pub(crate) const PIXELS: Self = Self { stretch: [1; 2], shift: [0.0; 2] };
}

impl DrawOptions {
    /// The largest size, in pixels per em.
    pub const MAX_PPEM: f32 = MAX_PPEM;
    /// The largest subpixel offset either way, in pixels.
    pub const MAX_OFFSET: f32 = MAX_OFFSET;

    /// A size in pixels per em, above 0 and at most [`Self::MAX_PPEM`]; it may be fractional. No offset, hinted.
    pub fn new(ppem: f32) -> Self {
        Self { ppem, offset: [0.0; 2], hinting: true, sampling: Sampling::PIXELS }
    }

    /// Sets the subpixel offset: how far the glyph is moved in pixels, x to the right and y up. It is what is left of a
    /// position in a line of text when whole pixels are taken off; whole pixels move the placement and change no pixel.
    /// At most [`Self::MAX_OFFSET`] either way.
    #[must_use]
    pub fn with_offset(self, offset: [f32; 2]) -> Self {
        Self { offset, ..self }
    }

    /// Chooses between the hinted glyph and its plain outline, as for text that is animated or transformed. The plain outline
    /// is drawn for glyphs without a model, too, whatever [`MissingModel`](crate::MissingModel) says.
    #[must_use]
    pub fn with_hinting(self, hinting: bool) -> Self {
        Self { hinting, ..self }
    }

    /// The size in pixels per em.
    pub fn ppem(&self) -> f32 {
        self.ppem
    }

    /// The subpixel offset in pixels, x to the right and y up.
    pub fn offset(&self) -> [f32; 2] {
        self.offset
    }

    /// Whether the glyph is hinted.
    pub fn hinting(&self) -> bool {
        self.hinting
    }

    /// How a font whose models have this scale is hinted at the size.
    pub(crate) fn size(&self, scale: Scale) -> HintedSize {
        if self.hinting { scale.at(self.ppem) } else { HintedSize::plain(self.ppem) }
    }

    /// How far the glyph is moved, in pixels.
    pub(crate) fn moved(&self) -> [f32; 2] {
        [0, 1].map(|axis| self.offset[axis] + self.sampling.shift[axis])
    }

    /// Checks the size and the offset.
    pub(crate) fn checked(self) -> Result<Self, Error> {
        check_ppem(self.ppem)?;
        match self.offset.iter().find(|offset| offset.is_nan() || offset.abs() > Self::MAX_OFFSET) {
            Some(offset) => Err(Error::InvalidOffset(*offset)),
            None => Ok(self),
        }
    }
}

impl From<f32> for DrawOptions {
    fn from(ppem: f32) -> Self {
        Self::new(ppem)
    }
}

/// Checks that a size is drawn at all.
///
/// # Errors
///
/// `InvalidSize` for one that is not above 0 and at most [`MAX_PPEM`].
pub(crate) fn check_ppem(ppem: f32) -> Result<(), Error> {
    if ppem > 0.0 && ppem <= MAX_PPEM { Ok(()) } else { Err(Error::InvalidSize(ppem)) }
}
