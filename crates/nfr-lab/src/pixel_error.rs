//! The error of a bitmap against the ground truth.

use super::SquareBitmap;
use nfr::{Bitmap, Placement};
use nfr_convert::compare::metrics::Sums;
use nfr_convert::error::Error;

/// The error of a picture against the truth, over all pixels of the box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelError {
    /// Mean squared error with coverage 0..1, the paper's measure.
    pub mse: f64,
    /// Mean absolute error with coverage 0..1.
    pub mae: f64,
    /// Share of pixels off by more than 16/255.
    pub bad16: f64,
}

/// Measures a picture against the truth.
///
/// # Errors
///
/// `InvalidParameter` if the two differ in size.
pub fn pixel_error(truth: &SquareBitmap, other: &SquareBitmap) -> Result<PixelError, Error> {
    if (truth.side, truth.pixels.len()) != (other.side, other.pixels.len()) {
        return Err(Error::InvalidParameter(format!(
            "a picture of {} pixels a side cannot be measured against one of {}; draw both at one size",
            other.side, truth.side
        )));
    }
    let figures = Sums::of(&bitmap(truth), &bitmap(other)).figures();
    Ok(PixelError { mse: figures.rmse * figures.rmse, mae: figures.mae, bad16: figures.bad16 })
}

/// The whole box as a bitmap, its origin in the lower left corner.
pub(super) fn bitmap(square: &SquareBitmap) -> Bitmap {
    let side = square.side as u32;
    let placement = Placement { left: 0, top: side as i32, width: side, height: side };
    Bitmap { placement, pixels: square.pixels.clone() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn every_pixel_of_the_box_counts() {
        let truth = SquareBitmap { side: 2, pixels: vec![0, 255, 100, 0] };
        let other = SquareBitmap { side: 2, pixels: vec![0, 0, 116, 17] };
        let error = pixel_error(&truth, &other).unwrap();
        // Off by 255, 16 and 17 levels in three of four pixels.
        let squared = (255.0 * 255.0 + 16.0 * 16.0 + 17.0 * 17.0) / 4.0 / 255.0 / 255.0;
        assert!((error.mse - squared).abs() < 1e-15);
        assert!((error.mae - 288.0 / 4.0 / 255.0).abs() < 1e-15);
        assert_eq!(error.bad16, 0.5);
    }

    #[test]
    fn pictures_of_two_sizes_are_not_compared() {
        let square = |side| SquareBitmap { side, pixels: vec![0; side * side] };
        let error = pixel_error(&square(2), &square(3)).unwrap_err().to_string();
        assert!(error.contains("one of 2"), "{error}");
    }
}
