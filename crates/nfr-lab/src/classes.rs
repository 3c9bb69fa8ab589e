//! Coverage as classes: the implicit network does not regress a pixel's coverage, it chooses one of 21 levels: 0, 5 %,
//! … 100 %. The paper's text says 20, its code has 21.

use super::SquareBitmap;
pub use nfr::internals::network::{CLASSES, coverage_of};

/// The class of a coverage: the highest level that it reaches, as the paper's code rounds.
pub fn class_of(coverage: u8) -> usize {
    usize::from(coverage) * (CLASSES - 1) / 255
}

/// The bitmap of a network that predicts every pixel's class correctly.
pub fn rounded(bitmap: &SquareBitmap) -> SquareBitmap {
    let pixels = bitmap.pixels.iter().map(|coverage| coverage_of(class_of(*coverage))).collect();
    SquareBitmap { side: bitmap.side, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_class_begins_at_its_level_and_only_full_coverage_is_in_the_last() {
        assert_eq!([0, 12, 13, 25, 26, 127, 128, 254, 255].map(class_of), [0, 0, 1, 1, 2, 9, 10, 19, 20]);
    }

    #[test]
    fn a_class_stands_for_its_multiple_of_five_percent() {
        assert_eq!([0, 1, 10, 19, 20].map(coverage_of), [0, 13, 128, 242, 255]);
        let worst = (0..=255).map(|v: u8| v.abs_diff(coverage_of(class_of(v)))).max();
        assert_eq!(worst, Some(12), "never a whole class, 12.75 levels, off");
    }

    #[test]
    fn a_rounded_bitmap_is_less_than_a_class_lighter_and_never_darker() {
        let bitmap = SquareBitmap { side: 16, pixels: (0..=255).collect() };
        let rounded = rounded(&bitmap);
        assert_eq!((rounded.side, rounded.pixels[0], rounded.pixels[255]), (16, 0, 255));
        assert!(
            rounded
                .pixels
                .iter()
                .zip(&bitmap.pixels)
                .all(|(r, v)| (0..13).contains(&(i32::from(*v) - i32::from(*r))))
        );
    }
}
