//! Coverage accumulation: the exact area that polygons cover of each pixel, by signed areas as in FreeType's `ftgrays`
//! and in font-rs, in integers, so that the order of additions does not matter.
//!
//! An edge of a polygon changes the coverage of the pixels that it passes through, and by its width that of all pixels
//! below them. Both are stored as differences from a pixel to the one below; prefix sums down the columns are the
//! coverage. A vertical edge has no width and costs nothing.

use alloc::vec::Vec;

use wide::{i16x8, i32x8, u8x16};

use crate::number::{UNIT, UNIT_BITS as SHIFT};

const MASK: i32 = UNIT - 1;
/// The sum of a pixel that is covered in full.
const FULL: i32 = 2 * UNIT * UNIT;
/// Pixels that are summed at once.
const LANES: usize = 8;

/// The differences that the edges in some adjacent pixels of a row make.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    /// The width of the edges that go left, less that of the edges that go right.
    cover: [i32; LANES],
    /// The same, each piece of an edge times twice its mean depth below the pixel's upper border.
    area: [i32; LANES],
}

/// Accumulates the coverage of one bitmap.
#[derive(Debug, Clone, Default)]
pub(super) struct Area {
    /// Rows of `stride` blocks; all zero between two bitmaps.
    blocks: Vec<Block>,
    /// The cover of all rows down to the current one.
    sums: Vec<i32x8>,
    width: usize,
    height: usize,
    stride: usize,
}

impl Area {
    /// Makes room for a bitmap.
    pub(super) fn start(&mut self, width: usize, height: usize) {
        (self.width, self.height, self.stride) = (width, height, width.div_ceil(LANES));
        // Horizontal edges on the lower border are stored in the row below it.
        let len = self.stride * (height + 1);
        if self.blocks.len() < len {
            self.blocks.resize(len, Block::default());
        }
    }

    /// An upper bound of the steps that polygons with so many vertices take: each edge may cross all rows and columns.
    pub(super) fn most_steps(&self, vertices: usize) -> u64 {
        vertices as u64 * (self.width as u64 + self.height as u64)
    }

    /// Adds a polygon, given by its vertices' coordinates along x and y, in units from the upper left corner, y down, with
    /// the inside on the left as seen with y up. Its vertices lie within the bitmap; with `CLIP`, only between its
    /// upper and its lower border.
    pub(super) fn polygon<const CLIP: bool>(&mut self, x: &[i32], y: &[i32]) {
        let (Some(&last_x), Some(&last_y)) = (x.last(), y.last()) else { return };
        let [mut xa, mut ya] = [last_x, last_y];
        for (&xb, &yb) in x.iter().zip(y) {
            if same_pixel(xa ^ xb | ya ^ yb) {
                self.add::<CLIP>(ya >> SHIFT, xa >> SHIFT, xa - xb, (ya & MASK) + (yb & MASK));
            } else if xa != xb {
                let down = ya < yb;
                let (from, to) = if down { ([xa, ya], [xb, yb]) } else { ([xb, yb], [xa, ya]) };
                self.edge::<CLIP>(from, to, if down { 1 } else { -1 });
            }
            [xa, ya] = [xb, yb];
        }
    }

    /// An edge that goes down through several pixels.
    #[inline]
    fn edge<const CLIP: bool>(&mut self, a: [i32; 2], b: [i32; 2], sign: i32) {
        let (width, height) = ((b[0] - a[0]).abs(), b[1] - a[1]);
        let edge = Edge { a, width, height, right: i32::from(a[0] < b[0]), sign };
        let (first, last) = (a[1] >> SHIFT, (b[1] - 1).max(a[1]) >> SHIFT);
        let slope = Slope::new(width, height);
        if same_pixel(a[0] ^ b[0]) {
            self.vertical::<CLIP>(&edge, first, last, slope);
            return;
        }
        let (mut x, mut depth, mut below) = (a[0], a[1] & MASK, (first + 1) << SHIFT);
        for row in first..last {
            let next = a[0] + slope.at(below - a[1]) * edge.step();
            self.piece::<CLIP>(&edge, row, [x, depth], [next, UNIT]);
            (x, depth, below) = (next, 0, below + UNIT);
        }
        self.piece::<CLIP>(&edge, last, [x, depth], [b[0], b[1] - (last << SHIFT)]);
    }

    /// An edge within one column of pixels, row by row.
    #[inline]
    fn vertical<const CLIP: bool>(&mut self, edge: &Edge, first: i32, last: i32, slope: Slope) {
        let column = edge.a[0] >> SHIFT;
        if CLIP && !(0..self.width as i32).contains(&column) {
            return;
        }
        let (mut at, lane) = self.place(first, column);
        let towards = edge.step() * edge.sign;
        let (mut done, mut depth) = (0, edge.a[1] & MASK);
        let mut below = ((first + 1) << SHIFT) - edge.a[1];
        for _ in first..last {
            let until = slope.at(below);
            self.add_at(at, lane, (done - until) * towards, depth + UNIT);
            (done, depth, at, below) = (until, 0, at + self.stride, below + UNIT);
        }
        let end = edge.a[1] + edge.height - (last << SHIFT);
        self.add_at(at, lane, (done - edge.width) * towards, depth + end);
    }

    /// The piece of an edge within one row of pixels, from one end to the other, column by column. The `y` of the ends counts
    /// from the row's upper border.
    #[inline]
    fn piece<const CLIP: bool>(
        &mut self,
        edge: &Edge,
        row: i32,
        [mut x, mut y]: [i32; 2],
        [next, until]: [i32; 2],
    ) {
        if x == next {
            return;
        }
        let mut column = (x - 1 + edge.right) >> SHIFT;
        let end = (next - edge.right) >> SHIFT;
        if column != end {
            let slope = Slope::new(edge.height, edge.width);
            let top = edge.a[1] - (row << SHIFT);
            while column != end {
                let cut = (column + edge.right) << SHIFT;
                let at = top + slope.at((cut - edge.a[0]).abs());
                self.add::<CLIP>(row, column, (x - cut) * edge.sign, y + at);
                (x, y) = (cut, at);
                column += edge.step();
            }
        }
        self.add::<CLIP>(row, column, (x - next) * edge.sign, y + until);
    }

    /// The block of a pixel, and its lane in the block.
    #[inline]
    fn place(&self, row: i32, column: i32) -> (usize, usize) {
        (row as usize * self.stride + column as usize / LANES, column as usize % LANES)
    }

    #[inline]
    fn add<const CLIP: bool>(&mut self, row: i32, column: i32, width: i32, depths: i32) {
        if !CLIP || (0..self.width as i32).contains(&column) {
            let (block, lane) = self.place(row, column);
            self.add_at(block, lane, width, depths);
        }
    }

    /// Adds a piece within one pixel. `depths` is the sum of the depths of its two ends below the pixel's upper border, in
    /// units.
    #[inline]
    fn add_at(&mut self, block: usize, lane: usize, width: i32, depths: i32) {
        if let Some(block) = self.blocks.get_mut(block) {
            block.cover[lane] = block.cover[lane].wrapping_add(width);
            block.area[lane] = block.area[lane].wrapping_add(width * depths);
        }
    }

    /// Writes the coverage, top row first, in rows that begin `stride` bytes apart.
    pub(super) fn finish(&mut self, stride: usize, pixels: &mut [u8]) {
        self.sums.clear();
        self.sums.resize(self.stride, i32x8::ZERO);
        let rows = self.blocks.chunks_exact_mut(self.stride).take(self.height);
        for (blocks, pixels) in rows.zip(pixels.chunks_mut(stride)) {
            write_row(blocks, &mut self.sums, &mut pixels[..self.width]);
        }
        self.blocks[self.stride * self.height..][..self.stride].fill(Block::default());
    }
}

/// Whether coordinates lie in the same pixel; `difference` is their exclusive or. Coordinates on either edge of a strip's
/// left border differ in sign.
#[inline]
fn same_pixel(difference: i32) -> bool {
    (0..UNIT).contains(&difference)
}

/// An edge, from its upper end to its lower one.
struct Edge {
    /// Its upper end.
    a: [i32; 2],
    width: i32,
    height: i32,
    /// 1 if it goes to the right, else 0.
    right: i32,
    /// -1 if the polygon goes up along it.
    sign: i32,
}

impl Edge {
    #[inline]
    fn step(&self) -> i32 {
        2 * self.right - 1
    }
}

/// How far an edge goes along one axis per unit along the other, in 2⁻³² units.
#[derive(Clone, Copy)]
struct Slope(i64);

impl Slope {
    #[inline]
    fn new(rise: i32, run: i32) -> Self {
        Self((rise as f32 / run as f32 * 4_294_967_296.0) as i64)
    }

    /// How far it goes in so many units of the other axis, to the nearest unit.
    #[inline]
    fn at(self, units: i32) -> i32 {
        ((i64::from(units) * self.0 + (1 << 31)) >> 32) as i32
    }
}

/// Adds a row of blocks to the sums, clears it, and writes the coverage that the sums stand for.
fn write_row(blocks: &mut [Block], sums: &mut [i32x8], pixels: &mut [u8]) {
    for ((block, sum), pixels) in blocks.iter_mut().zip(sums).zip(pixels.chunks_mut(LANES)) {
        let Block { cover, area } = core::mem::take(block);
        *sum += i32x8::new(cover);
        let coverage = block_coverage((*sum << (SHIFT + 1)) - i32x8::new(area));
        match <&mut [u8; LANES]>::try_from(&mut *pixels) {
            Ok(pixels) => *pixels = coverage,
            Err(_) => pixels.copy_from_slice(&coverage[..pixels.len()]),
        }
    }
}

/// The coverage, 0 to 255, that sums stand for.
#[inline]
fn block_coverage(sums: i32x8) -> [u8; LANES] {
    // Coverage in 1/16384; times 255 is 256 times less once.
    let shares = i16x8::from_i32x8_saturate(sums >> 5);
    let shares = shares.max(i16x8::ZERO).min(i16x8::splat((FULL >> 5) as i16));
    let coverage: i16x8 = (shares - (shares >> 8) + i16x8::splat(32)) >> 6;
    let coverage = u8x16::narrow_i16x8(coverage, coverage).to_array();
    core::array::from_fn(|k| coverage[k])
}

#[cfg(test)]
mod tests;
