//! Coverage of the three subpixels of a pixel, for LCD panels.

use alloc::vec::Vec;

use crate::options::Sampling;
use crate::placement::Placement;

/// How the red, green and blue subpixels of a pixel lie on a panel, and how their coverage is filtered, for
/// [`Rasterizer::draw_lcd`](crate::Rasterizer::draw_lcd). The default is red, green, blue from left to right, and
/// [`LcdFilter::Shifted`], as in FreeType.
///
/// ```
/// use nfr::{Lcd, LcdFilter, SubpixelOrder};
/// let lcd = Lcd::new(SubpixelOrder::Bgr).with_filter(LcdFilter::Light);
/// assert_eq!((lcd.order(), lcd.filter()), (SubpixelOrder::Bgr, LcdFilter::Light));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Lcd {
    order: SubpixelOrder,
    filter: LcdFilter,
}

impl Lcd {
    /// The default filter on a panel whose subpixels lie so.
    pub fn new(order: SubpixelOrder) -> Self {
        Self { order, filter: LcdFilter::default() }
    }

    /// Sets the filter.
    #[must_use]
    pub fn with_filter(self, filter: LcdFilter) -> Self {
        Self { filter, ..self }
    }

    /// How the subpixels lie.
    pub fn order(&self) -> SubpixelOrder {
        self.order
    }

    /// The filter.
    pub fn filter(&self) -> LcdFilter {
        self.filter
    }
}

/// How the subpixels of a panel lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[non_exhaustive]
pub enum SubpixelOrder {
    /// Red, green, blue, from left to right.
    #[default]
    Rgb,
    /// Blue, green, red, from left to right.
    Bgr,
    /// Red, green, blue, from top to bottom.
    VerticalRgb,
    /// Blue, green, red, from top to bottom.
    VerticalBgr,
}

/// How much of its surroundings a subpixel shows: the more, the less colour is seen at edges, and the softer they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[non_exhaustive]
pub enum LcdFilter {
    /// A channel is the coverage of a whole pixel around the subpixel's middle: the glyph is drawn three times, moved by 21/64
    /// pixel. FreeType does so unless it is built with `FT_CONFIG_OPTION_SUBPIXEL_RENDERING`, and calls it Harmony.
    #[default]
    Shifted,
    /// A subpixel's own coverage. Edges have strong colours.
    Unfiltered,
    /// Three subpixels, weighed 85, 86, 85 of 256: FreeType's `FT_LCD_FILTER_LIGHT`.
    Light,
    /// Five subpixels, weighed 8, 77, 86, 77, 8 of 256: FreeType's `FT_LCD_FILTER_DEFAULT`.
    Fir5,
}

/// Subpixels in a pixel.
pub(crate) const SUBPIXELS: usize = 3;
/// How far FreeType moves a glyph for a subpixel beside the middle, in pixels.
const SHIFT: f32 = 21.0 / 64.0;

impl Lcd {
    /// How a subpixel is sampled where the glyph is moved for each; they are counted from the left or from the top.
    pub(crate) fn shifted(&self, subpixel: usize) -> Sampling {
        let right = SHIFT * (1 - subpixel as i32) as f32;
        let shift = if self.is_vertical() { [0.0, -right] } else { [right, 0.0] };
        Sampling { shift, ..Sampling::PIXELS }
    }

    /// How all subpixels are sampled at once, to be filtered.
    pub(crate) fn stretched(&self) -> Sampling {
        let stretch = if self.is_vertical() { [1, SUBPIXELS as i32] } else { [SUBPIXELS as i32, 1] };
        Sampling { stretch, ..Sampling::PIXELS }
    }

    /// The weights of the subpixel itself and of its neighbours on either side, in 1/256. None where the glyph is moved instead.
    pub(crate) fn weights(&self) -> Option<[u32; 3]> {
        match self.filter {
            LcdFilter::Shifted => None,
            LcdFilter::Unfiltered => Some([256, 0, 0]),
            LcdFilter::Light => Some([86, 85, 0]),
            LcdFilter::Fir5 => Some([86, 77, 8]),
        }
    }

    /// The channel that a subpixel shows.
    pub(crate) fn channel(&self, subpixel: usize) -> usize {
        match self.order {
            SubpixelOrder::Rgb | SubpixelOrder::VerticalRgb => subpixel,
            SubpixelOrder::Bgr | SubpixelOrder::VerticalBgr => SUBPIXELS - 1 - subpixel,
        }
    }

    /// Whether the subpixels lie one above the other.
    pub(crate) fn is_vertical(&self) -> bool {
        matches!(self.order, SubpixelOrder::VerticalRgb | SubpixelOrder::VerticalBgr)
    }
}

/// A rendered glyph: coverage 0–255 of red, green and blue, top row first, `placement.width` pixels a row.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LcdBitmap {
    /// Where the pixels lie, in whole pixels.
    pub placement: Placement,
    /// `placement.area()` pixels: red, green and blue, in this order on every panel.
    pub pixels: Vec<[u8; 3]>,
}

/// A rendered glyph in a rasterizer's own buffer: coverage 0–255 of red, green and blue, top row first, `placement.width` pixels a
/// row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct LcdBitmapRef<'a> {
    /// Where the pixels lie, in whole pixels.
    pub placement: Placement,
    /// `placement.area()` pixels: red, green and blue, in this order on every panel.
    pub pixels: &'a [[u8; 3]],
}

impl<'a> LcdBitmapRef<'a> {
    pub(crate) fn new(placement: Placement, pixels: &'a [[u8; 3]]) -> Self {
        Self { placement, pixels }
    }

    /// The rows, top row first.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &'a [[u8; 3]]> + use<'a> {
        self.pixels.chunks_exact(self.placement.width.max(1) as usize)
    }
}

impl LcdBitmap {
    /// The rows, top row first.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[[u8; 3]]> {
        LcdBitmapRef::new(self.placement, &self.pixels).rows()
    }
}

impl From<LcdBitmapRef<'_>> for LcdBitmap {
    fn from(LcdBitmapRef { placement, pixels }: LcdBitmapRef<'_>) -> Self {
        Self { placement, pixels: pixels.to_vec() }
    }
}
