//! The differences between two bitmaps.
//!
//! Everything is counted over the union of the two bitmaps' boxes, in integers, so that sums over many
//! bitmaps come out the same in any order. A pixel outside a bitmap's box has coverage 0.

use std::ops::Range;

use serde::Serialize;

use nfr::internals::table::{Bound, CertifiedErrors};
use nfr::{Bitmap, Placement};

/// A pixel off by more than this, of 255, is visibly wrong: `bad16` counts them.
pub const BAD_DIFFERENCE: u8 = 16;

/// Full coverage, the unit of `mae`, `rmse` and `max`.
const FULL: f64 = 255.0;

/// Sums over the pixels of any number of pairs of bitmaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sums {
    pixels: u64,
    absolute: u64,
    squared: u64,
    max: u8,
    bad: u64,
    exact: u64,
}

/// The metrics of the sums. Without any pixels there is no error, and everything is exact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Figures {
    /// Mean absolute error, 0..1.
    pub mae: f64,
    /// Root of the mean squared error, 0..1.
    pub rmse: f64,
    /// The largest error of a pixel, 0..1.
    pub max: f64,
    /// Share of pixels off by more than 16/255, 0..1.
    pub bad16: f64,
    /// Share of pixels that are equal, 0..1.
    pub exact: f64,
    /// The pixels that were compared.
    pub pixels: u64,
}

impl Sums {
    /// The sums of one pair of bitmaps.
    pub fn of(truth: &Bitmap, other: &Bitmap) -> Self {
        let mut sums = Self::default();
        sums.add(truth, other);
        sums
    }

    /// Adds every pixel of the union box of two bitmaps.
    pub fn add(&mut self, truth: &Bitmap, other: &Bitmap) {
        let (columns, rows) = union_box(&truth.placement, &other.placement);
        let mut uncovered = (columns.end - columns.start) as u64 * (rows.end - rows.start) as u64;
        for y in rows {
            let before = self.pixels;
            self.add_rows(PixelRow::of(truth, y), PixelRow::of(other, y));
            uncovered -= self.pixels - before;
        }
        // Pixels that neither box covers are 0 in both bitmaps.
        self.pixels += uncovered;
        self.exact += uncovered;
    }

    /// Adds other sums to these.
    pub fn merge(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.absolute += other.absolute;
        self.squared += other.squared;
        self.max = self.max.max(other.max);
        self.bad += other.bad;
        self.exact += other.exact;
    }

    /// The sums as bytes.
    pub(crate) fn to_bytes(self) -> [u8; 48] {
        let numbers = [self.pixels, self.absolute, self.squared, self.max.into(), self.bad, self.exact];
        let mut bytes = [0; 48];
        bytes.as_chunks_mut().0.iter_mut().zip(numbers).for_each(|(to, number)| *to = number.to_be_bytes());
        bytes
    }

    /// The sums that [`Sums::to_bytes`] gave.
    pub(crate) fn from_bytes(bytes: [u8; 48]) -> Self {
        let number = |at: usize| u64::from_be_bytes(bytes.as_chunks().0[at]);
        let [pixels, absolute, squared, max, bad, exact] = [0, 1, 2, 3, 4, 5].map(number);
        Self { pixels, absolute, squared, max: max as u8, bad, exact }
    }

    /// The largest difference of a pixel, of 255.
    pub fn max(&self) -> u8 {
        self.max
    }

    /// The sum of absolute errors; a pixel that is off by full coverage adds 255.
    pub fn absolute(&self) -> u64 {
        self.absolute
    }

    /// Mean absolute error, 0..1.
    pub fn mae(&self) -> f64 {
        self.share(self.absolute) / FULL
    }

    /// The metrics.
    pub fn figures(&self) -> Figures {
        Figures {
            mae: self.mae(),
            rmse: self.share(self.squared).sqrt() / FULL,
            max: f64::from(self.max) / FULL,
            bad16: self.share(self.bad),
            exact: if self.pixels == 0 { 1.0 } else { self.share(self.exact) },
            pixels: self.pixels,
        }
    }

    /// What a certificate says of a glyph with these sums.
    pub fn certified(&self) -> CertifiedErrors {
        let figures = self.figures();
        CertifiedErrors { mae: Bound::of(figures.mae), bad16: Bound::of(figures.bad16), max: self.max }
    }

    fn share(&self, part: u64) -> f64 {
        part as f64 / self.pixels.max(1) as f64
    }

    fn add_rows(&mut self, a: PixelRow<'_>, b: PixelRow<'_>) {
        let start = a.start.max(b.start);
        let shared = (a.end().min(b.end()) - start).max(0) as usize;
        let (a_before, a_rest) = a.split(start);
        let (b_before, b_rest) = b.split(start);
        let ((a_shared, a_after), (b_shared, b_after)) = (a_rest.split_at(shared), b_rest.split_at(shared));
        for (&a, &b) in a_shared.iter().zip(b_shared) {
            self.add_pixel(a.abs_diff(b));
        }
        for row in [a_before, a_after, b_before, b_after] {
            self.add_uncovered(row);
        }
    }

    fn add_uncovered(&mut self, row: &[u8]) {
        for &value in row {
            self.add_pixel(value);
        }
    }

    fn add_pixel(&mut self, difference: u8) {
        let wide = u64::from(difference);
        self.pixels += 1;
        self.absolute += wide;
        self.squared += wide * wide;
        self.max = self.max.max(difference);
        self.bad += u64::from(difference > BAD_DIFFERENCE);
        self.exact += u64::from(difference == 0);
    }
}

/// The pixels of one row, and the column of the first.
#[derive(Clone, Copy)]
struct PixelRow<'a> {
    start: i64,
    pixels: &'a [u8],
}

impl<'a> PixelRow<'a> {
    /// PixelRow `y` of a bitmap, counted downwards from the baseline; empty outside its box.
    fn of(bitmap: &'a Bitmap, y: i64) -> Self {
        let placement = &bitmap.placement;
        let width = placement.width as usize;
        let index = usize::try_from(y + i64::from(placement.top)).ok().filter(|_| placement.area() > 0);
        let first = index.map_or(usize::MAX, |index| index.saturating_mul(width));
        let pixels = bitmap.pixels.get(first..first.saturating_add(width)).unwrap_or_default();
        Self { start: placement.left.into(), pixels }
    }

    fn end(&self) -> i64 {
        self.start + self.pixels.len() as i64
    }

    /// The pixels left of a column, and the others.
    fn split(&self, column: i64) -> (&'a [u8], &'a [u8]) {
        let left = (column - self.start).clamp(0, self.pixels.len() as i64);
        self.pixels.split_at(left as usize)
    }
}

/// Columns from the origin and rows downwards from the baseline that either box covers. An empty box covers
/// nothing, wherever it lies.
pub fn union_box(a: &Placement, b: &Placement) -> (Range<i64>, Range<i64>) {
    let sides = |p: &Placement| {
        let (left, top) = (i64::from(p.left), -i64::from(p.top));
        (left..left + i64::from(p.width), top..top + i64::from(p.height))
    };
    let join = |a: Range<i64>, b: Range<i64>| a.start.min(b.start)..a.end.max(b.end);
    match (a.area(), b.area()) {
        (0, 0) => (0..0, 0..0),
        (_, 0) => sides(a),
        (0, _) => sides(b),
        _ => (join(sides(a).0, sides(b).0), join(sides(a).1, sides(b).1)),
    }
}

/// The coverage at a column from the origin and a row counted downwards from the baseline.
pub fn coverage_at(bitmap: &Bitmap, x: i64, y: i64) -> u8 {
    let p = &bitmap.placement;
    let (column, row) = (x - i64::from(p.left), y + i64::from(p.top));
    let inside = (0..i64::from(p.width)).contains(&column) && (0..i64::from(p.height)).contains(&row);
    if inside { bitmap.pixels[(row * i64::from(p.width) + column) as usize] } else { 0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use proptest::prelude::*;

    /// The definition, pixel by pixel.
    fn naive(pairs: &[(Bitmap, Bitmap)]) -> Figures {
        let mut differences = Vec::new();
        for (a, b) in pairs {
            let (columns, rows) = union_box(&a.placement, &b.placement);
            for y in rows {
                for x in columns.clone() {
                    differences.push(f64::from(coverage_at(a, x, y)) - f64::from(coverage_at(b, x, y)));
                }
            }
        }
        let count = differences.len().max(1) as f64;
        let share =
            |test: &dyn Fn(f64) -> bool| differences.iter().filter(|d| test(**d)).count() as f64 / count;
        Figures {
            mae: differences.iter().map(|d| d.abs()).sum::<f64>() / count / 255.0,
            rmse: (differences.iter().map(|d| d * d).sum::<f64>() / count).sqrt() / 255.0,
            max: differences.iter().fold(0.0, |max: f64, d| max.max(d.abs())) / 255.0,
            bad16: share(&|d| d.abs() > 16.0),
            exact: if differences.is_empty() { 1.0 } else { share(&|d| d == 0.0) },
            pixels: differences.len() as u64,
        }
    }

    fn bitmap() -> impl Strategy<Value = Bitmap> {
        (-5..5i32, -5..5i32, 0..6u32, 0..6u32).prop_flat_map(|(left, top, width, height)| {
            let area = (width * height) as usize;
            // Few distinct values, so that equal pixels and differences of exactly 16 occur.
            let value = prop_oneof![Just(0u8), Just(16), Just(17), Just(255), any::<u8>()];
            proptest::collection::vec(value, area)
                .prop_map(move |pixels| Bitmap { placement: Placement { left, top, width, height }, pixels })
        })
    }

    proptest! {
        #[test]
        fn the_sums_are_those_of_the_naive_definition(
            pairs in proptest::collection::vec((bitmap(), bitmap()), 0..5),
            split in 0..5usize,
        ) {
            let sum = |pairs: &[(Bitmap, Bitmap)]| {
                let mut sums = Sums::default();
                pairs.iter().for_each(|(a, b)| sums.add(a, b));
                sums
            };
            let split = split.min(pairs.len());
            let mut merged = sum(&pairs[split..]);
            merged.merge(&sum(&pairs[..split]));
            prop_assert_eq!(merged, sum(&pairs));
            let (fast, naive) = (merged.figures(), naive(&pairs));
            prop_assert!((fast.mae - naive.mae).abs() < 1e-12);
            prop_assert!((fast.rmse - naive.rmse).abs() < 1e-12);
            prop_assert_eq!(
                (fast.max, fast.bad16, fast.exact, fast.pixels),
                (naive.max, naive.bad16, naive.exact, naive.pixels)
            );
        }
    }

    #[test]
    fn a_bitmap_against_nothing_is_all_error() {
        let placement = Placement { left: -1, top: 2, width: 2, height: 1 };
        let black = Bitmap { placement, pixels: vec![255, 255] };
        let figures = Sums::of(&black, &Bitmap::default()).figures();
        assert_eq!((figures.mae, figures.max, figures.bad16, figures.exact), (1.0, 1.0, 1.0, 0.0));
    }

    #[test]
    fn no_pixels_are_no_error() {
        let figures = Sums::default().figures();
        assert_eq!((figures.mae, figures.rmse, figures.exact, figures.pixels), (0.0, 0.0, 1.0, 0));
    }
}
