//! Exact areas: what polygons cover of each pixel, in integers, so that no order of additions matters.
//!
//! A side changes the coverage of the pixels that it passes through, and by its width that of all pixels below them.
//! Both are noted where it passes, as changes from a pixel to the one below; sums down the columns are the coverage.
//! An upright side has no width and costs nothing.

use alloc::vec::Vec;

use wide::{i16x8, i32x8, u8x16};

/// Units in a pixel along each axis.
pub(super) const UNIT: i32 = 1 << SHIFT;
const SHIFT: i32 = 9;
const MASK: i32 = UNIT - 1;
/// What a pixel that is covered in full sums up to.
const FULL: i32 = 2 * UNIT * UNIT;
/// Pixels that are summed at once.
const LANES: usize = 8;

/// What the sides in some pixels beside each other change.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    /// The width of the sides, to the left less that to the right.
    cover: [i32; LANES],
    /// The same, each piece times twice its mean depth below the pixel's upper border.
    area: [i32; LANES],
}

/// Coverage in the making.
#[derive(Debug, Clone, Default)]
pub(super) struct Area {
    /// Rows of `stride` blocks; nothing but zeros between two bitmaps.
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
        // Level sides on the lower border are noted in the row below it.
        let len = self.stride * (height + 1);
        if self.blocks.len() < len {
            self.blocks.resize(len, Block::default());
        }
    }

    /// The most steps that polygons with so many vertices take: each side may cross all rows and columns.
    pub(super) fn most_steps(&self, vertices: usize) -> u64 {
        vertices as u64 * (self.width as u64 + self.height as u64)
    }

    /// Adds a polygon, given by its vertices' places along x and y, in units from the upper left corner, y down, with
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
                self.side::<CLIP>(from, to, if down { 1 } else { -1 });
            }
            [xa, ya] = [xb, yb];
        }
    }

    /// A side that goes down through several pixels.
    #[inline]
    fn side<const CLIP: bool>(&mut self, a: [i32; 2], b: [i32; 2], sign: i32) {
        let (width, height) = ((b[0] - a[0]).abs(), b[1] - a[1]);
        let side = Side { a, width, height, right: i32::from(a[0] < b[0]), sign };
        let (first, last) = (a[1] >> SHIFT, (b[1] - 1).max(a[1]) >> SHIFT);
        let slope = Slope::new(width, height);
        if same_pixel(a[0] ^ b[0]) {
            self.upright::<CLIP>(&side, first, last, slope);
            return;
        }
        let (mut x, mut depth, mut below) = (a[0], a[1] & MASK, (first + 1) << SHIFT);
        for row in first..last {
            let next = a[0] + slope.at(below - a[1]) * side.step();
            self.piece::<CLIP>(&side, row, [x, depth], [next, UNIT]);
            (x, depth, below) = (next, 0, below + UNIT);
        }
        self.piece::<CLIP>(&side, last, [x, depth], [b[0], b[1] - (last << SHIFT)]);
    }

    /// A side in one column of pixels, row by row.
    #[inline]
    fn upright<const CLIP: bool>(&mut self, side: &Side, first: i32, last: i32, slope: Slope) {
        let column = side.a[0] >> SHIFT;
        if CLIP && !(0..self.width as i32).contains(&column) {
            return;
        }
        let (mut at, lane) = self.place(first, column);
        let towards = side.step() * side.sign;
        let (mut done, mut depth) = (0, side.a[1] & MASK);
        let mut below = ((first + 1) << SHIFT) - side.a[1];
        for _ in first..last {
            let until = slope.at(below);
            self.add_at(at, lane, (done - until) * towards, depth + UNIT);
            (done, depth, at, below) = (until, 0, at + self.stride, below + UNIT);
        }
        let end = side.a[1] + side.height - (last << SHIFT);
        self.add_at(at, lane, (done - side.width) * towards, depth + end);
    }

    /// What lies of a side in one row of pixels, from one end to the other, column by column. The `y` of the ends counts
    /// from the row's upper border.
    #[inline]
    fn piece<const CLIP: bool>(
        &mut self,
        side: &Side,
        row: i32,
        [mut x, mut y]: [i32; 2],
        [next, until]: [i32; 2],
    ) {
        if x == next {
            return;
        }
        let mut column = (x - 1 + side.right) >> SHIFT;
        let end = (next - side.right) >> SHIFT;
        if column != end {
            let slope = Slope::new(side.height, side.width);
            let top = side.a[1] - (row << SHIFT);
            while column != end {
                let cut = (column + side.right) << SHIFT;
                let at = top + slope.at((cut - side.a[0]).abs());
                self.add::<CLIP>(row, column, (x - cut) * side.sign, y + at);
                (x, y) = (cut, at);
                column += side.step();
            }
        }
        self.add::<CLIP>(row, column, (x - next) * side.sign, y + until);
    }

    /// The block of a pixel, and which of its pixels it is.
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

    /// Adds a piece in one pixel, whose ends lie `depths` units below the pixel's upper border, both together.
    #[inline]
    fn add_at(&mut self, block: usize, lane: usize, width: i32, depths: i32) {
        if let Some(block) = self.blocks.get_mut(block) {
            block.cover[lane] = block.cover[lane].wrapping_add(width);
            block.area[lane] = block.area[lane].wrapping_add(width * depths);
        }
    }

    /// Writes the levels, top row first, in rows that begin `stride` bytes apart.
    pub(super) fn finish(&mut self, stride: usize, pixels: &mut [u8]) {
        self.sums.clear();
        self.sums.resize(self.stride, i32x8::ZERO);
        let rows = self.blocks.chunks_exact_mut(self.stride).take(self.height);
        for (blocks, pixels) in rows.zip(pixels.chunks_mut(stride)) {
            levels(blocks, &mut self.sums, &mut pixels[..self.width]);
        }
        self.blocks[self.stride * self.height..][..self.stride].fill(Block::default());
    }
}

/// Whether coordinates lie in the same pixel, by what differs between them. On either side of a strip's left border
/// they have different signs.
#[inline]
fn same_pixel(difference: i32) -> bool {
    (0..UNIT).contains(&difference)
}

/// A side that does not go up.
struct Side {
    /// Its upper end.
    a: [i32; 2],
    width: i32,
    height: i32,
    /// 1 if it goes to the right, else 0.
    right: i32,
    /// -1 if the polygon goes along it the other way.
    sign: i32,
}

impl Side {
    #[inline]
    fn step(&self) -> i32 {
        2 * self.right - 1
    }
}

/// How far a side goes along one axis for a unit along the other, in 2⁻³² units.
#[derive(Clone, Copy)]
struct Slope(i64);

impl Slope {
    #[inline]
    fn new(rise: i32, run: i32) -> Self {
        Self((rise as f32 / run as f32 * 4_294_967_296.0) as i64)
    }

    /// How far it has gone after so many units of the other axis, to the nearest unit.
    #[inline]
    fn at(self, units: i32) -> i32 {
        ((i64::from(units) * self.0 + (1 << 31)) >> 32) as i32
    }
}

/// The nearest integer to a number of at most 2²² either way, the even one of two.
#[inline]
pub(super) fn rounded(v: f32) -> i32 {
    // Added to this, a number's fraction is rounded away, and its integer part is in the lowest bits.
    const SHIFTER: f32 = (3 << 22) as f32;
    (v + SHIFTER).to_bits() as i32 - SHIFTER.to_bits() as i32
}

/// Adds a row of blocks to the sums, leaves zeros, and writes what they stand for.
fn levels(blocks: &mut [Block], sums: &mut [i32x8], pixels: &mut [u8]) {
    for ((block, sum), pixels) in blocks.iter_mut().zip(sums).zip(pixels.chunks_mut(LANES)) {
        let Block { cover, area } = core::mem::take(block);
        *sum += i32x8::new(cover);
        let levels = block_levels((*sum << (SHIFT + 1)) - i32x8::new(area));
        match <&mut [u8; LANES]>::try_from(&mut *pixels) {
            Ok(pixels) => *pixels = levels,
            Err(_) => pixels.copy_from_slice(&levels[..pixels.len()]),
        }
    }
}

/// The levels, 0 to 255, of sums.
#[inline]
fn block_levels(sums: i32x8) -> [u8; LANES] {
    // Coverage in 1/16384; times 255 is 256 times less once.
    let shares = i16x8::from_i32x8_saturate(sums >> 5);
    let shares = shares.max(i16x8::ZERO).min(i16x8::splat((FULL >> 5) as i16));
    let levels: i16x8 = (shares - (shares >> 8) + i16x8::splat(32)) >> 6;
    let levels = u8x16::narrow_i16x8(levels, levels).to_array();
    core::array::from_fn(|k| levels[k])
}

#[cfg(test)]
mod tests;
