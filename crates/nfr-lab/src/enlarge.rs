//! The masked network's representation of bitmaps of all sizes: each is embedded in one of the largest size by duplicating rows and
//! columns, with a mask of those that are the originals.

use super::SquareBitmap;

/// Where the rows (and columns) of a small bitmap go in a large one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Enlargement {
    /// For each row of the large bitmap, the row of the small one that it shows.
    pub source: Vec<usize>,
    /// For each row of the small bitmap, its first place in the large one: what the mask keeps.
    pub kept: Vec<usize>,
}

impl Enlargement {
    /// From `small` rows to `large`, at least as many. All rows are shown ⌊large/small⌋ times, and those that still
    /// miss are spread evenly, from the first row to the last. The paper's code spreads them in floating point; this
    /// is exact.
    pub fn new(small: usize, large: usize) -> Self {
        let (times, missing) = (large / small, large % small);
        let mut copies = vec![times; small];
        for k in 0..missing {
            copies[if missing == 1 { 0 } else { k * (small - 1) / (missing - 1) }] += 1;
        }
        let (mut source, mut kept) = (Vec::with_capacity(large), Vec::with_capacity(small));
        for (row, count) in copies.into_iter().enumerate() {
            kept.push(source.len());
            source.extend(std::iter::repeat_n(row, count));
        }
        Self { source, kept }
    }

    /// The bitmap, embedded.
    pub fn enlarge(&self, square: &SquareBitmap) -> SquareBitmap {
        let rows = self.source.iter().map(|y| &square.pixels[y * square.side..]);
        let pixels = rows.flat_map(|row| self.source.iter().map(move |x| row[*x])).collect();
        SquareBitmap { side: self.source.len(), pixels }
    }

    /// The values of a large bitmap at the pixels that the mask keeps: the small bitmap.
    pub fn shrink<T: Copy>(&self, large: &[T]) -> Vec<T> {
        let side = self.source.len();
        self.kept.iter().flat_map(|y| self.kept.iter().map(move |x| large[y * side + x])).collect()
    }

    /// 1 for the pixels of the large bitmap that are originals, 0 for duplicates.
    pub fn mask(&self) -> Vec<f32> {
        let mut kept = vec![false; self.source.len()];
        for place in &self.kept {
            kept[*place] = true;
        }
        kept.iter().flat_map(|y| kept.iter().map(move |x| f32::from(u8::from(*y && *x)))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_rows_are_spread_evenly_from_the_first_to_the_last() {
        // 7 = 4 + 3: rows 0, ⌊1.5⌋ and 3 twice.
        let enlargement = Enlargement::new(4, 7);
        assert_eq!(enlargement.source, [0, 0, 1, 1, 2, 3, 3]);
        assert_eq!(enlargement.kept, [0, 2, 4, 5]);
        assert_eq!(Enlargement::new(3, 7).source, [0, 0, 0, 1, 1, 2, 2], "one alone goes to the first row");
        assert_eq!(Enlargement::new(3, 3), Enlargement { source: vec![0, 1, 2], kept: vec![0, 1, 2] });
    }

    #[test]
    fn every_size_comes_back_from_the_largest_and_its_mask_has_its_pixels() {
        for side in 20..=63 {
            let pixels = (0..side * side).map(|k| (k * 31 % 256) as u8).collect();
            let square = SquareBitmap { side, pixels };
            let enlargement = Enlargement::new(side, 63);
            let large = enlargement.enlarge(&square);
            assert_eq!((large.side, large.pixels.len()), (63, 63 * 63));
            assert_eq!(enlargement.shrink(&large.pixels), square.pixels);
            let mask = enlargement.mask();
            assert_eq!(mask.iter().sum::<f32>() as usize, side * side);
            assert!(enlargement.shrink(&mask).iter().all(|kept| *kept == 1.0));
        }
    }
}
