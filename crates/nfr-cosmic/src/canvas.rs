//! What is drawn on.

use cosmic_text::Color;

/// What bitmaps and rectangles are drawn on. Positions are in pixels from its top left, y down, and may be outside of it.
pub trait Canvas {
    /// Fills a rectangle, as for underlines, selections and cursors.
    fn rectangle(&mut self, x: i32, y: i32, width: u32, height: u32, color: Color);

    /// Draws `color` through a mask of coverage, a byte a pixel, whose top left is at (x, y).
    fn mask(&mut self, x: i32, y: i32, mask: Image<'_>, color: Color);

    /// Draws a picture, as that of an emoji: four bytes a pixel, red, green, blue and alpha, not premultiplied.
    fn picture(&mut self, x: i32, y: i32, picture: Image<'_>);
}

/// Pixels in rows from the top, one after the other.
#[derive(Debug, Clone, Copy)]
pub struct Image<'a> {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The pixels.
    pub data: &'a [u8],
}

/// Pixels of four bytes, red, green, blue and alpha, premultiplied or opaque. What lies outside is cut off.
#[derive(Debug)]
pub struct RgbaCanvas<'p> {
    pixels: &'p mut [[u8; 4]],
    width: usize,
    origin: [i32; 2],
}

impl<'p> RgbaCanvas<'p> {
    /// A canvas of `width` columns and as many whole rows as there are bytes for.
    pub fn new(pixels: &'p mut [u8], width: u32) -> Self {
        let (pixels, _) = pixels.as_chunks_mut();
        Self { pixels, width: width as usize, origin: [0; 2] }
    }

    /// The same with positions counted from (x, y).
    #[must_use]
    pub fn with_origin(self, x: i32, y: i32) -> Self {
        Self { origin: [x, y], ..self }
    }

    /// Calls `blend` with each row of a rectangle that is inside: where it begins in the rectangle, and its pixels.
    fn rows(&mut self, at: [i32; 2], size: [u32; 2], mut blend: impl FnMut([usize; 2], &mut [[u8; 4]])) {
        let height = self.pixels.len().checked_div(self.width).unwrap_or(0);
        let ends = [0, 1].map(|axis| {
            let start = i64::from(at[axis]) + i64::from(self.origin[axis]);
            let limit = [self.width, height][axis] as i64;
            let end = (start + i64::from(size[axis])).clamp(0, limit);
            (start, start.clamp(0, end), end)
        });
        let [(left, first, last), (top, first_row, last_row)] = ends;
        for y in first_row..last_row {
            let row = y as usize * self.width;
            let row = &mut self.pixels[row + first as usize..row + last as usize];
            blend([(first - left) as usize, (y - top) as usize], row);
        }
    }
}

impl Canvas for RgbaCanvas<'_> {
    fn rectangle(&mut self, x: i32, y: i32, width: u32, height: u32, color: Color) {
        let source = premultiplied(color.as_rgba(), 255);
        self.rows([x, y], [width, height], |_, row| row.iter_mut().for_each(|pixel| over(pixel, source)));
    }

    fn mask(&mut self, x: i32, y: i32, mask: Image<'_>, color: Color) {
        let color = color.as_rgba();
        let opaque = premultiplied(color, 255);
        self.rows([x, y], [mask.width, mask.height], |[column, row], pixels| {
            let start = row * mask.width as usize + column;
            let coverage = mask.data.get(start..).unwrap_or_default();
            for (pixel, coverage) in pixels.iter_mut().zip(coverage) {
                match coverage {
                    0 => {}
                    255 => over(pixel, opaque),
                    _ => over(pixel, premultiplied(color, *coverage)),
                }
            }
        });
    }

    fn picture(&mut self, x: i32, y: i32, picture: Image<'_>) {
        let (data, _) = picture.data.as_chunks();
        self.rows([x, y], [picture.width, picture.height], |[column, row], pixels| {
            let start = row * picture.width as usize + column;
            for (pixel, source) in pixels.iter_mut().zip(data.get(start..).unwrap_or_default()) {
                over(pixel, premultiplied(*source, 255));
            }
        });
    }
}

/// a · b / 255, rounded to the nearest.
fn times(a: u8, b: u8) -> u8 {
    let product = u32::from(a) * u32::from(b) + 128;
    ((product + (product >> 8)) >> 8) as u8
}

/// A colour under a coverage, with its components multiplied by its alpha.
fn premultiplied([red, green, blue, alpha]: [u8; 4], coverage: u8) -> [u8; 4] {
    let alpha = times(alpha, coverage);
    [times(red, alpha), times(green, alpha), times(blue, alpha), alpha]
}

/// Porter and Duff's `over`, with premultiplied colours.
fn over(pixel: &mut [u8; 4], source: [u8; 4]) {
    let rest = 255 - source[3];
    for (below, above) in pixel.iter_mut().zip(source) {
        *below = above.saturating_add(times(*below, rest));
    }
}
