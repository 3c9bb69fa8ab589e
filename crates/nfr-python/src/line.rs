//! A line of text: glyphs one after the other, without shaping.

use nfr::{Bitmap, DrawOptions, Error, Font, Limits, Placement, Rasterizer};

use crate::error::Failure;
use crate::glyphs::of_text;

/// How a line is drawn.
#[derive(Clone, Copy)]
pub(crate) struct Style {
    pub(crate) ppem: f32,
    pub(crate) hinting: bool,
    /// Whether the pen moves by hinted advance widths, which are whole pixels at the trained sizes, or by linear ones.
    pub(crate) hinted_advances: bool,
}

impl Style {
    pub(crate) fn options(&self, offset: [f32; 2]) -> DrawOptions {
        DrawOptions::new(self.ppem).with_offset(offset).with_hinting(self.hinting)
    }
}

/// The glyphs of a text. For characters that the font lacks it is glyph 0, which shows that something is missing.
pub(crate) fn glyphs(font: &Font, text: &str) -> Vec<u32> {
    of_text(font, text).map(|(_, glyph)| glyph.unwrap_or(0)).collect()
}

/// How far the pen moves over some glyphs, in pixels.
pub(crate) fn advance(rasterizer: &mut Rasterizer, glyphs: &[u32], style: Style) -> Result<f64, Error> {
    glyphs.iter().try_fold(0.0, |pen, glyph| Ok(pen + one_advance(rasterizer, *glyph, style)?))
}

fn one_advance(rasterizer: &mut Rasterizer, glyph: u32, style: Style) -> Result<f64, Error> {
    let advance = if style.hinted_advances {
        rasterizer.hinted_advance(glyph, style.ppem)?
    } else {
        rasterizer.font().advance(glyph, style.ppem)
    };
    Ok(advance.into())
}

/// A glyph of a line: the whole pixels of its origin, and the rest.
struct Placed {
    glyph: u32,
    x: i64,
    rest: f32,
}

/// Draws a line. It has at most as many pixels as a glyph may have, whatever the font says of advance widths.
pub(crate) fn draw(
    rasterizer: &mut Rasterizer,
    glyphs: &[u32],
    style: Style,
    limits: &Limits,
) -> Result<Bitmap, Failure> {
    let side = u64::from(limits.bitmap_side.min(Limits::default().bitmap_side));
    let (mut line, mut ink, mut pen) = (Vec::new(), Box::default(), 0.0);
    for &glyph in glyphs {
        let whole = f64::floor(pen);
        let placed = Placed { glyph, x: whole as i64, rest: (pen - whole) as f32 };
        ink = Box::union(ink, rasterizer.placement(glyph, style.options([placed.rest, 0.0]))?, placed.x);
        line.push(placed);
        pen += one_advance(rasterizer, glyph, style)?;
    }
    let mut bitmap = blank(ink, side * side)?;
    for Placed { glyph, x, rest } in line {
        let drawn = rasterizer.draw(glyph, style.options([rest, 0.0]))?;
        let place = drawn.placement;
        let column = (x + i64::from(place.left) - i64::from(bitmap.placement.left)) as usize;
        let row = (i64::from(bitmap.placement.top) - i64::from(place.top)) as usize;
        let width = bitmap.placement.width.max(1) as usize;
        for (into, from) in bitmap.pixels.chunks_exact_mut(width).skip(row).zip(drawn.rows()) {
            into[column..].iter_mut().zip(from).for_each(|(below, above)| *below = over(*below, *above));
        }
    }
    Ok(bitmap)
}

/// Coverage over coverage, rounded: where glyphs overlap or share a pixel.
fn over(below: u8, above: u8) -> u8 {
    255 - ((u32::from(255 - below) * u32::from(255 - above) + 127) / 255) as u8
}

/// A box around ink, y up; empty while left is right.
#[derive(Clone, Copy, Default)]
struct Box {
    left: i64,
    right: i64,
    top: i64,
    bottom: i64,
}

impl Box {
    fn union(self, place: Placement, x: i64) -> Self {
        if place.area() == 0 {
            return self;
        }
        let left = x + i64::from(place.left);
        let (right, top) = (left + i64::from(place.width), i64::from(place.top));
        let bottom = top - i64::from(place.height);
        if self.left == self.right {
            return Self { left, right, top, bottom };
        }
        Self {
            left: self.left.min(left),
            right: self.right.max(right),
            top: self.top.max(top),
            bottom: self.bottom.min(bottom),
        }
    }
}

/// A bitmap without ink.
fn blank(ink: Box, limit: u64) -> Result<Bitmap, Failure> {
    let (width, height) = ((ink.right - ink.left) as u64, (ink.top - ink.bottom) as u64);
    let too_large = || Failure::LineTooLarge { width, height, limit };
    let fits = |number: i64| i32::try_from(number).map_err(|_| too_large());
    let area = width.checked_mul(height).filter(|area| *area <= limit).ok_or_else(too_large)?;
    let mut pixels = Vec::new();
    pixels.try_reserve_exact(area as usize).map_err(|_| Failure::Memory)?;
    pixels.resize(area as usize, 0);
    let (left, top) = (fits(ink.left)?, fits(ink.top)?);
    let placement = Placement { left, top, width: width as u32, height: height as u32 };
    Ok(Bitmap { placement, pixels })
}
