//! At which size and where between pixels a glyph is drawn.

use crate::constants::{MAX_OFFSET, MAX_PPEM};
use crate::error::Error;

/// How a glyph is drawn: its size and its subpixel offset. A plain number is a size with no offset.
///
/// ```
/// let quarter = nfr::DrawOptions::new(16.0).with_offset([0.25, 0.0]);
/// assert_eq!(nfr::DrawOptions::from(16.0), quarter.with_offset([0.0, 0.0]));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawOptions {
    pub(crate) ppem: f32,
    pub(crate) offset: [f32; 2],
}

impl DrawOptions {
    /// The largest size, in pixels per em.
    pub const MAX_PPEM: f32 = MAX_PPEM;
    /// The largest subpixel offset either way, in pixels.
    pub const MAX_OFFSET: f32 = MAX_OFFSET;

    /// A size in pixels per em, above 0 and at most [`Self::MAX_PPEM`]; it may be fractional. No offset.
    pub fn new(ppem: f32) -> Self {
        Self { ppem, offset: [0.0; 2] }
    }

    /// Sets the subpixel offset: how far the glyph is moved in pixels, x to the right and y up. It is what is left of a
    /// position in a line of text when whole pixels are taken off; whole pixels move the placement and change no pixel.
    /// At most [`Self::MAX_OFFSET`] either way.
    #[must_use]
    pub fn with_offset(self, offset: [f32; 2]) -> Self {
        Self { offset, ..self }
    }

    /// The size in pixels per em.
    pub fn ppem(&self) -> f32 {
        self.ppem
    }

    /// The subpixel offset in pixels, x to the right and y up.
    pub fn offset(&self) -> [f32; 2] {
        self.offset
    }

    /// Checks both.
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
