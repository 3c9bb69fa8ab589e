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
    /// Columns and rows.
    size: [usize; 2],
    origin: [i32; 2],
}

impl<'p> RgbaCanvas<'p> {
    /// A canvas of `width` columns and as many whole rows as there are bytes for.
    pub fn new(pixels: &'p mut [u8], width: u32) -> Self {
        let (pixels, _) = pixels.as_chunks_mut();
        let width = width as usize;
        let height = pixels.len().checked_div(width).unwrap_or(0);
        Self { pixels, size: [width, height], origin: [0; 2] }
    }

    /// The same with positions counted from (x, y).
    #[must_use]
    pub fn with_origin(self, x: i32, y: i32) -> Self {
        Self { origin: [x, y], ..self }
    }

    /// The rows of a rectangle that are inside, and where they begin in the rectangle: a column and a row.
    #[inline(always)]
    fn rows(&mut self, at: [i32; 2], size: [u32; 2]) -> ([usize; 2], impl Iterator<Item = &mut [[u8; 4]]>) {
        let [(skipped, columns), (skipped_rows, rows)] = [0, 1].map(|axis| {
            let start = i64::from(at[axis]) + i64::from(self.origin[axis]);
            let end = (start + i64::from(size[axis])).clamp(0, self.size[axis] as i64);
            let first = start.clamp(0, end);
            ((first - start) as usize, first as usize..end as usize)
        });
        let width = self.size[0].max(1);
        let rows = self.pixels[rows.start * width..rows.end * width].chunks_exact_mut(width);
        ([skipped, skipped_rows], rows.map(move |row| &mut row[columns.clone()]))
    }
}

impl Canvas for RgbaCanvas<'_> {
    fn rectangle(&mut self, x: i32, y: i32, width: u32, height: u32, color: Color) {
        let source = Source::new(color.as_rgba());
        let (_, rows) = self.rows([x, y], [width, height]);
        rows.flatten().for_each(|pixel| source.over::<false, 1>(std::array::from_mut(pixel), [255]));
    }

    fn mask(&mut self, x: i32, y: i32, mask: Image<'_>, color: Color) {
        let source = Source::new(color.as_rgba());
        let ([column, row], rows) = self.rows([x, y], [mask.width, mask.height]);
        let coverage = mask.data.chunks(mask.width.max(1) as usize).skip(row);
        let rows = rows.zip(coverage.map(|row| row.get(column..).unwrap_or_default()));
        if color.a() == 255 {
            rows.for_each(|(pixels, coverage)| source.over_row::<true>(pixels, coverage));
        } else {
            rows.for_each(|(pixels, coverage)| source.over_row::<false>(pixels, coverage));
        }
    }

    fn picture(&mut self, x: i32, y: i32, picture: Image<'_>) {
        let ([column, row], rows) = self.rows([x, y], [picture.width, picture.height]);
        let (data, _) = picture.data.as_chunks();
        for (pixels, colors) in rows.zip(data.chunks(picture.width.max(1) as usize).skip(row)) {
            for (pixel, color) in pixels.iter_mut().zip(colors.get(column..).unwrap_or_default()) {
                Source::new(*color).over::<false, 1>(std::array::from_mut(pixel), [255]);
            }
        }
    }
}

/// A colour that is drawn.
#[derive(Clone, Copy)]
struct Source {
    /// Premultiplied.
    color: [u16; 4],
}

impl Source {
    #[inline(always)]
    fn new([red, green, blue, alpha]: [u8; 4]) -> Self {
        Self { color: [red, green, blue, 255].map(|v| by_255(u16::from(v) * u16::from(alpha))) }
    }

    /// Porter and Duff's `over`, with premultiplied colours, under a coverage. `OPAQUE` colours have an alpha of 255.
    #[inline(always)]
    fn over<const OPAQUE: bool, const N: usize>(self, pixels: &mut [[u8; 4]; N], coverage: [u8; N]) {
        for (pixel, coverage) in pixels.iter_mut().zip(coverage) {
            let coverage = u16::from(coverage);
            let rest = 255 - if OPAQUE { coverage } else { by_255(self.color[3] * coverage) };
            for (byte, color) in pixel.iter_mut().zip(self.color) {
                *byte = by_255(color * coverage + u16::from(*byte) * rest) as u8;
            }
        }
    }

    /// Draws as many pixels as there are, or as there is coverage for.
    #[inline(always)]
    fn over_row<const OPAQUE: bool>(self, pixels: &mut [[u8; 4]], coverage: &[u8]) {
        let count = pixels.len().min(coverage.len());
        let (pixels, coverage) = (&mut pixels[..count], &coverage[..count]);
        let (pixels, coverage) = self.over_blocks::<OPAQUE, 4>(pixels, coverage);
        let (pixels, coverage) = self.over_blocks::<OPAQUE, 2>(pixels, coverage);
        self.over_blocks::<OPAQUE, 1>(pixels, coverage);
    }

    /// Draws `N` pixels at a time, and gives what is left.
    #[inline(always)]
    fn over_blocks<'p, 'c, const OPAQUE: bool, const N: usize>(
        self,
        pixels: &'p mut [[u8; 4]],
        coverage: &'c [u8],
    ) -> (&'p mut [[u8; 4]], &'c [u8]) {
        let (blocks, pixels) = pixels.as_chunks_mut();
        let (coverages, rest) = coverage.as_chunks::<N>();
        for (block, coverage) in blocks.iter_mut().zip(coverages) {
            if *coverage != [0; N] {
                self.over::<OPAQUE, N>(block, *coverage);
            }
        }
        (pixels, rest)
    }
}

/// A number up to 65,152 divided by 255, rounded to the nearest.
#[inline(always)]
fn by_255(number: u16) -> u16 {
    let number = number.wrapping_add(128);
    number.wrapping_add(number >> 8) >> 8
}
