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
    /// The colour of the last mask.
    ink: Option<Box<Ink>>,
}

impl<'p> RgbaCanvas<'p> {
    /// A canvas of `width` columns and as many whole rows as there are bytes for.
    pub fn new(pixels: &'p mut [u8], width: u32) -> Self {
        let (pixels, _) = pixels.as_chunks_mut();
        let width = width as usize;
        let height = pixels.len().checked_div(width).unwrap_or(0);
        Self { pixels, size: [width, height], origin: [0; 2], ink: None }
    }

    /// The same with positions counted from (x, y).
    #[must_use]
    pub fn with_origin(self, x: i32, y: i32) -> Self {
        Self { origin: [x, y], ..self }
    }

    /// The rows of a rectangle that are inside, from its left edge to the right edge of the canvas; the columns of them that are the
    /// rectangle's; and where they begin in the rectangle: a column and a row.
    #[inline(always)]
    fn rows(
        &mut self,
        at: [i32; 2],
        size: [u32; 2],
    ) -> ([usize; 2], usize, impl Iterator<Item = &mut [[u8; 4]]>) {
        let [(skipped, columns), (skipped_rows, rows)] = [0, 1].map(|axis| {
            let start = i64::from(at[axis]) + i64::from(self.origin[axis]);
            let end = (start + i64::from(size[axis])).clamp(0, self.size[axis] as i64);
            let first = start.clamp(0, end);
            ((first - start) as usize, first as usize..end as usize)
        });
        let width = self.size[0].max(1);
        let rows = self.pixels[rows.start * width..rows.end * width].chunks_exact_mut(width);
        ([skipped, skipped_rows], columns.len(), rows.map(move |row| &mut row[columns.start..]))
    }
}

impl Canvas for RgbaCanvas<'_> {
    fn rectangle(&mut self, x: i32, y: i32, width: u32, height: u32, color: Color) {
        let source = Source::new(color.as_rgba());
        let (_, columns, rows) = self.rows([x, y], [width, height]);
        rows.flat_map(|row| &mut row[..columns]).for_each(|pixel| source.over(pixel));
    }

    fn mask(&mut self, x: i32, y: i32, mask: Image<'_>, color: Color) {
        let ink = match self.ink.take() {
            Some(ink) if ink.color == color => ink,
            _ => Ink::new(color),
        };
        let ([column, row], columns, rows) = self.rows([x, y], [mask.width, mask.height]);
        let stride = mask.width as usize;
        let mut coverage = mask.data.get(row.saturating_mul(stride) + column..).unwrap_or_default();
        for pixels in rows {
            ink.over_row(pixels, coverage, columns);
            coverage = coverage.get(stride..).unwrap_or_default();
        }
        self.ink = Some(ink);
    }

    fn picture(&mut self, x: i32, y: i32, picture: Image<'_>) {
        let ([column, row], columns, rows) = self.rows([x, y], [picture.width, picture.height]);
        let (data, _) = picture.data.as_chunks();
        for (pixels, colors) in rows.zip(data.chunks(picture.width.max(1) as usize).skip(row)) {
            for (pixel, color) in pixels[..columns].iter_mut().zip(colors.get(column..).unwrap_or_default()) {
                Source::new(*color).over(pixel);
            }
        }
    }
}

/// A colour that is drawn, premultiplied.
#[derive(Clone, Copy)]
struct Source([u16; 4]);

impl Source {
    #[inline(always)]
    fn new([red, green, blue, alpha]: [u8; 4]) -> Self {
        Self([red, green, blue, 255].map(|v| by_255(u16::from(v) * u16::from(alpha) + HALF)))
    }

    /// The colour under a coverage, and what is left of what is below, both times 255 and the first with [`HALF`].
    #[inline(always)]
    fn covered(self, coverage: u16) -> [[u16; 4]; 2] {
        let rest = 255 - by_255(self.0[3] * coverage + HALF);
        [self.0.map(|color| color * coverage + HALF), [rest; 4]]
    }

    #[inline(always)]
    fn over(self, pixel: &mut [u8; 4]) {
        blend(pixel, &self.covered(255));
    }
}

/// A colour under each coverage: the same is drawn through one mask after the other.
struct Ink {
    color: Color,
    covered: [[[u16; 4]; 2]; 256],
}

impl std::fmt::Debug for Ink {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.color.fmt(formatter)
    }
}

impl Ink {
    #[cold]
    #[inline(never)]
    fn new(color: Color) -> Box<Self> {
        let source = Source::new(color.as_rgba());
        Box::new(Self { color, covered: std::array::from_fn(|coverage| source.covered(coverage as u16)) })
    }

    /// Draws the first `columns` pixels, or as many as there is coverage for, four at a time. The last four may be more than there
    /// are: coverage 0 leaves a pixel as it is.
    #[inline(always)]
    fn over_row(&self, pixels: &mut [[u8; 4]], coverage: &[u8], columns: usize) {
        // Letters of text: one step a row.
        if (1..=8).contains(&columns)
            && let (Some(pixels), Some(coverage)) = (pixels.first_chunk_mut::<8>(), coverage.first_chunk())
        {
            let coverage = u64::from_le_bytes(*coverage) & (u64::MAX >> (64 - 8 * columns));
            let (blocks, _) = pixels.as_chunks_mut();
            self.over(&mut blocks[0], (coverage as u32).to_le_bytes());
            self.over(&mut blocks[1], ((coverage >> 32) as u32).to_le_bytes());
            return;
        }
        let (blocks, edge) = pixels.as_chunks_mut();
        let (coverages, end) = coverage.as_chunks();
        let columns = columns.min(coverage.len());
        let whole = columns / 4;
        for (block, coverage) in blocks.iter_mut().zip(coverages).take(whole) {
            self.over(block, *coverage);
        }
        let last = match (coverages.get(whole), end) {
            (Some(last), _) => *last,
            (None, [a]) => [*a, 0, 0, 0],
            (None, [a, b]) => [*a, *b, 0, 0],
            (None, [a, b, c]) => [*a, *b, *c, 0],
            _ => return,
        };
        let last = (u32::from_le_bytes(last) & FIRST[columns % 4]).to_le_bytes();
        match blocks.get_mut(whole) {
            Some(block) => self.over(block, last),
            None => edge.iter_mut().zip(last).for_each(|(pixel, coverage)| blend(pixel, self.at(coverage))),
        }
    }

    #[inline(always)]
    fn over(&self, pixels: &mut [[u8; 4]; 4], coverage: [u8; 4]) {
        if coverage != [0; 4] {
            // All is read before any is written, so that the compiler may compute them together.
            let covered = coverage.map(|coverage| *self.at(coverage));
            let mut blended = *pixels;
            for (pixel, covered) in blended.iter_mut().zip(&covered) {
                blend(pixel, covered);
            }
            *pixels = blended;
        }
    }

    #[inline(always)]
    fn at(&self, coverage: u8) -> &[[u16; 4]; 2] {
        &self.covered[usize::from(coverage)]
    }
}

/// Porter and Duff's `over`, with premultiplied colours.
#[inline(always)]
fn blend(pixel: &mut [u8; 4], [color, rest]: &[[u16; 4]; 2]) {
    for ((byte, color), rest) in pixel.iter_mut().zip(color).zip(rest) {
        *byte = by_255((u16::from(*byte) * rest).wrapping_add(*color)) as u8;
    }
}

/// The first 0 to 3 bytes of a number with the least byte first.
const FIRST: [u32; 4] = [0, 0xFF, 0xFFFF, 0xFF_FFFF];

/// What is added before [`by_255`], which then rounds to the nearest.
const HALF: u16 = 128;

/// A number of at most 255 times 255, to which [`HALF`] was added, divided by 255.
#[inline(always)]
fn by_255(number: u16) -> u16 {
    number.wrapping_add(number >> 8) >> 8
}
