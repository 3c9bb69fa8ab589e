//! Coverage accumulation: the area that polygons cover of each pixel, in integers, so that the order of additions does not
//! matter. Where an edge crosses the borders of pixels is computed as in zeno 0.3, after FreeType's `ftgrays.c`
//! (`gray_render_line`), so that the same polygon gives the same coverage as in zeno to the last bit. FreeType itself may use
//! finer reciprocals.
//!
//! FreeType sums the heights of edges along rows. Here widths are summed down columns, many columns at once: an edge changes
//! the coverage of the pixels that it passes through, and by its width that of all pixels below them. A vertical edge has no
//! width and costs nothing.

use alloc::vec::Vec;

use wide::i32x8;

use crate::number::{UNIT, UNIT_BITS as SHIFT};

const MASK: i32 = UNIT - 1;
/// Reciprocals count so many units to one.
const RECIPROCAL: u32 = (1 << 24) - 1;
/// Twice the area of a pixel, in square units, is 256 times as much as one level of coverage, as a shift.
const LEVEL_BITS: i32 = 2 * SHIFT + 1 - 8;
/// Pixels that are summed at once.
const LANES: usize = 8;

/// What the edges in some adjacent pixels of a row change.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    /// The width of the edges that go right, less that of the edges that go left.
    cover: [i32; LANES],
    /// Twice the area below those edges, within the pixels.
    area: [i32; LANES],
}

/// What the rows above one cover of adjacent columns.
#[derive(Debug, Clone, Copy)]
struct Columns {
    cover: i32x8,
    /// The coverage of pixels that no edge passes through, if it is known.
    coverage: Option<[u8; LANES]>,
}

/// Accumulates the coverage of one bitmap.
#[derive(Debug, Clone, Default)]
pub(super) struct Area {
    /// Rows of `stride` blocks, the first of which is above the bitmap; all zero between two bitmaps.
    blocks: Vec<Block>,
    /// What all rows above the current one cover.
    columns: Vec<Columns>,
    width: usize,
    height: usize,
    stride: usize,
}

impl Area {
    /// Makes room for a bitmap.
    pub(super) fn start(&mut self, width: usize, height: usize) {
        (self.width, self.height, self.stride) = (width, height, width.div_ceil(LANES));
        // Edges on the upper border count as edges in the row above it.
        let len = self.stride * (height + 1);
        if self.blocks.len() < len {
            self.blocks.resize(len, Block::default());
        }
    }

    /// An upper bound of the steps that polygons with so many vertices take: each edge may cross all rows and columns.
    pub(super) fn most_steps(&self, vertices: usize) -> u64 {
        vertices as u64 * (self.width as u64 + self.height as u64)
    }

    /// Adds a polygon, given by its vertices' coordinates along x and y, in units from the upper left corner, y down. Its
    /// vertices lie within the bitmap; with `CLIP`, only between its upper and its lower border.
    #[cfg(feature = "fields")]
    pub(super) fn polygon<const CLIP: bool>(&mut self, x: &[i32], y: &[i32]) {
        let bottom = (self.height as i32) << SHIFT;
        self.closed::<CLIP>(x.iter().zip(y).map(|(x, y)| [*x, bottom - y]));
    }

    /// Adds a polygon whose vertices are given with y up, from wherever the lower left corner is at `corner`.
    pub(super) fn polygon_up<const CLIP: bool>(&mut self, x: &[i32], y: &[i32], corner: [i32; 2]) {
        self.closed::<CLIP>(x.iter().zip(y).map(|(x, y)| [x - corner[0], y - corner[1]]));
    }

    /// Adds the edges between vertices, the last one and the first one included. Coordinates are from the lower left corner, y
    /// up.
    #[inline(always)]
    fn closed<const CLIP: bool>(&mut self, vertices: impl DoubleEndedIterator<Item = [i32; 2]> + Clone) {
        let Some([mut xa, mut ya]) = vertices.clone().next_back() else { return };
        for [xb, yb] in vertices {
            if same_pixel(xa ^ xb | ya ^ yb) {
                self.add::<CLIP>(ya >> SHIFT, xa >> SHIFT, xb - xa, (ya & MASK) + (yb & MASK));
            } else if xa != xb {
                self.edge::<CLIP>([xa, ya], [xb, yb]);
            }
            [xa, ya] = [xb, yb];
        }
    }

    /// An edge that passes through several pixels and is not vertical. Coordinates have y up here, and rows are counted from
    /// the lower border: all roundings go to the left and down.
    #[inline]
    fn edge<const CLIP: bool>(&mut self, a: [i32; 2], b: [i32; 2]) {
        if a[1] == b[1] {
            return self.level_edge::<CLIP>(a[1] >> SHIFT, [a[0], b[0]], a[1] & MASK);
        }
        match (a[0] < b[0], a[1] < b[1]) {
            (false, false) => self.sloped_edge::<CLIP, false, false>(a, b),
            (false, true) => self.sloped_edge::<CLIP, false, true>(a, b),
            (true, false) => self.sloped_edge::<CLIP, true, false>(a, b),
            (true, true) => self.sloped_edge::<CLIP, true, true>(a, b),
        }
    }

    /// An edge that goes to the right or to the left, and up or down.
    fn sloped_edge<const CLIP: bool, const RIGHT: bool, const UP: bool>(&mut self, a: [i32; 2], b: [i32; 2]) {
        let [mut column, mut row] = a.map(|v| v >> SHIFT);
        let [mut x, mut y] = a.map(|v| v & MASK);
        let [dx, dy] = [0, 1].map(|axis| i64::from(b[axis] - a[axis]));
        let (across, up) = (dx << SHIFT, dy << SHIFT);
        let columns = (b[0] >> SHIFT).abs_diff(column);
        let rows = (b[1] >> SHIFT).abs_diff(row);
        let reciprocal = |pixels: u32, from: i32, to: i32| {
            if pixels == 0 { 0 } else { i64::from(RECIPROCAL / to.abs_diff(from)) }
        };
        let per_x = reciprocal(columns, a[0], b[0]);
        let per_y = reciprocal(rows, a[1], b[1]);
        // How far the edge's line passes the pixel's lower left corner, times its length: positive if it passes on the left.
        let mut side = dx * i64::from(y) - dy * i64::from(x);
        for _ in 0..columns + rows {
            let to_side = match (RIGHT, UP) {
                (true, true) => side - across + up <= 0,
                (true, false) => side + up >= 0,
                (false, true) => side - across > 0,
                (false, false) => side <= 0,
            };
            let (next, until);
            let enter;
            if to_side {
                until = divide(if RIGHT { side + up } else { -side }, per_x);
                side = if RIGHT { side + up } else { side - up };
                next = if RIGHT { UNIT } else { 0 };
                enter = [UNIT - next, until];
            } else {
                next = divide(if UP { across - side } else { side }, per_y);
                side = if UP { side - across } else { side + across };
                until = if UP { UNIT } else { 0 };
                enter = [next, UNIT - until];
            }
            self.add::<CLIP>(row, column, next - x, y + until);
            [x, y] = enter;
            if to_side {
                column += if RIGHT { 1 } else { -1 };
            } else {
                row += if UP { 1 } else { -1 };
            }
        }
        self.add::<CLIP>(row, column, (b[0] & MASK) - x, y + (b[1] & MASK));
    }

    /// A level edge, `y` above the lower border of its row.
    fn level_edge<const CLIP: bool>(&mut self, row: i32, [from, to]: [i32; 2], y: i32) {
        let (low, high, sign) = if from < to { (from, to, 1) } else { (to, from, -1) };
        let mut x = low;
        while x < high {
            let next = ((x >> SHIFT) + 1) << SHIFT;
            self.add::<CLIP>(row, x >> SHIFT, (next.min(high) - x) * sign, 2 * y);
            x = next;
        }
    }

    /// Adds a piece of an edge within one pixel. `heights` is the sum of the heights of its two ends above the pixel's lower
    /// border, in units.
    #[inline]
    fn add<const CLIP: bool>(&mut self, row: i32, column: i32, width: i32, heights: i32) {
        if CLIP && !(0..self.width as i32).contains(&column) {
            return;
        }
        let at = (self.height as i32 - row) as usize * self.stride + column as usize / LANES;
        if let Some(block) = self.blocks.get_mut(at) {
            let lane = column as usize % LANES;
            block.cover[lane] = block.cover[lane].wrapping_add(width);
            block.area[lane] = block.area[lane].wrapping_add(width * heights);
        }
    }

    /// Writes the coverage, top row first, in rows that begin `stride` bytes apart.
    pub(super) fn finish(&mut self, stride: usize, pixels: &mut [u8]) {
        self.columns.clear();
        let mut rows = self.blocks.chunks_exact_mut(self.stride).take(self.height + 1);
        if let Some(above) = rows.next() {
            let columns = |block: &mut Block| Columns {
                cover: i32x8::new(core::mem::take(block).cover),
                coverage: None,
            };
            self.columns.extend(above.iter_mut().map(columns));
        }
        for (blocks, pixels) in rows.zip(pixels.chunks_mut(stride)) {
            write_row(blocks, &mut self.columns, &mut pixels[..self.width]);
        }
    }
}

/// Whether coordinates lie in the same pixel; `difference` is their exclusive or. Coordinates on either edge of a strip's
/// left border differ in sign.
#[inline]
fn same_pixel(difference: i32) -> bool {
    (0..UNIT).contains(&difference)
}

/// A quotient in units, by the divisor's reciprocal, which is rounded down: both are positive, or 0.
#[inline]
fn divide(value: i64, reciprocal: i64) -> i32 {
    ((value * reciprocal) >> (32 - SHIFT)) as i32
}

/// Writes the coverage of a row of blocks, adds them to what is above the next row, and clears them.
fn write_row(blocks: &mut [Block], columns: &mut [Columns], pixels: &mut [u8]) {
    for ((block, above), pixels) in blocks.iter_mut().zip(columns).zip(pixels.chunks_mut(LANES)) {
        let (cover, area) = (i32x8::new(block.cover), i32x8::new(block.area));
        let plain = above.cover << (SHIFT + 1);
        let coverage = if (cover | area) == i32x8::splat(0) {
            // No edge passes through, as through most pixels of a large bitmap.
            *above.coverage.get_or_insert_with(|| block_coverage(plain))
        } else {
            *block = Block::default();
            *above = Columns { cover: above.cover + cover, coverage: None };
            block_coverage(plain + area)
        };
        match <&mut [u8; LANES]>::try_from(&mut *pixels) {
            Ok(pixels) => *pixels = coverage,
            Err(_) => pixels.copy_from_slice(&coverage[..pixels.len()]),
        }
    }
}

/// The coverage, 0 to 255, that twice the areas stand for. Polygons may go round clockwise, as in TrueType, or not.
#[inline]
fn block_coverage(areas: i32x8) -> [u8; LANES] {
    let levels = areas >> LEVEL_BITS;
    // The complement of a negative number is one less than its absolute value.
    let signs: i32x8 = levels >> 31;
    let levels: i32x8 = levels ^ signs;
    let levels = levels.min(i32x8::splat(255));
    levels.to_array().map(|level| level as u8)
}

#[cfg(test)]
mod tests;
