//! Small bitmaps shrunk from larger ones instead of learned, as in the paper's comparison of resizing methods; and the
//! effect of a single wrong pixel.

use std::cmp::Reverse;

use fast_image_resize::images::Image;
use fast_image_resize::{FilterType, PixelType, ResizeAlg, ResizeOptions, Resizer};

use super::SquareBitmap;
use super::pixel_error::{PixelError, pixel_error};
use super::truth::Truth;
use nfr_convert::error::Error;

/// A resampling method. All but the first take every pixel into account, with a filter as wide as the pixels
/// become (as in Pillow).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// The one pixel in the middle of each new pixel.
    Nearest,
    /// A triangle of 2 pixels.
    Bilinear,
    /// A cosine window over a sinc of 2 pixels.
    Hamming,
    /// The cubic of Catmull and Rom (a = -1/2, as Pillow's `BICUBIC`), 4 pixels.
    Bicubic,
    /// A sinc in a window of 6 pixels (Lanczos 3, as Pillow's `LANCZOS`).
    Lanczos,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 5] = [Self::Nearest, Self::Bilinear, Self::Hamming, Self::Bicubic, Self::Lanczos];

    /// Its name in tables and charts, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Bilinear => "bilinear",
            Self::Hamming => "hamming",
            Self::Bicubic => "bicubic",
            Self::Lanczos => "lanczos",
        }
    }

    fn algorithm(self) -> ResizeAlg {
        match self {
            Self::Nearest => ResizeAlg::Nearest,
            Self::Bilinear => ResizeAlg::Convolution(FilterType::Bilinear),
            Self::Hamming => ResizeAlg::Convolution(FilterType::Hamming),
            Self::Bicubic => ResizeAlg::Convolution(FilterType::CatmullRom),
            Self::Lanczos => ResizeAlg::Convolution(FilterType::Lanczos3),
        }
    }
}

/// A bitmap with `side` pixels a side instead.
///
/// # Errors
///
/// `InvalidParameter` if either bitmap has no pixels.
pub fn resized(square: &SquareBitmap, side: usize, method: Method) -> Result<SquareBitmap, Error> {
    let refused = |what: String| {
        Error::InvalidParameter(format!(
            "a bitmap of {} pixels a side cannot be resized to {side} ({what}); choose sizes from 1",
            square.side
        ))
    };
    if square.side == 0 || side == 0 {
        return Err(refused("there is nothing to resize".into()));
    }
    let from =
        Image::from_vec_u8(square.side as u32, square.side as u32, square.pixels.clone(), PixelType::U8);
    let from = from.map_err(|e| refused(e.to_string()))?;
    let mut to = Image::new(side as u32, side as u32, PixelType::U8);
    let options = ResizeOptions::new().resize_alg(method.algorithm());
    Resizer::new().resize(&from, &mut to, &options).map_err(|e| refused(e.to_string()))?;
    Ok(SquareBitmap { side, pixels: to.into_vec() })
}

/// The hinted bitmap of the largest size shrunk to the size with this index, and its error against the hinted bitmap of
/// that size.
///
/// # Errors
///
/// `InvalidParameter` for a glyph that the truth does not have, or an index that has no size.
pub fn shrunk(
    truth: &Truth,
    gid: u16,
    index: usize,
    method: Method,
) -> Result<(SquareBitmap, PixelError), Error> {
    let hinted = truth.hinted(gid, index)?;
    let largest = truth.hinted(gid, truth.sizes.len() - 1)?;
    let small = resized(&largest, hinted.side, method)?;
    let error = pixel_error(&hinted, &small)?;
    Ok((small, error))
}

/// A bitmap with one pixel wrong where an eye sees it: of the darkest pixels, the one nearest to half the height of
/// the ink becomes blank; of those of one row, the one amid the darkest others. Its eight neighbours decide, those
/// that share a side counting twice; of equal ones it is the first, from the top and then from the left. Also returns
/// its column and row. A blank bitmap stays as it is, and there is no such pixel.
pub fn single_wrong_pixel(square: &SquareBitmap) -> (SquareBitmap, Option<[usize; 2]>) {
    let side = square.side;
    let at = |x: i64, y: i64| {
        let inside = (0..side as i64).contains(&x) && (0..side as i64).contains(&y);
        let index = inside.then_some((y * side as i64 + x) as usize);
        index.and_then(|index| square.pixels.get(index)).map_or(0, |&coverage| u32::from(coverage))
    };
    let ink_around = |x: usize, y: usize| -> u32 {
        let offsets = [-1i64, 0, 1].map(|dy| [-1i64, 0, 1].map(|dx| (dx, dy)));
        let others = offsets.into_iter().flatten().filter(|&offset| offset != (0, 0));
        let weight = |dx: i64, dy: i64| if dx == 0 || dy == 0 { 2 } else { 1 };
        others.map(|(dx, dy)| at(x as i64 + dx, y as i64 + dy) * weight(dx, dy)).sum()
    };
    let inked = square.pixels.iter().enumerate().filter(|(_, coverage)| **coverage > 0);
    let rows = || inked.clone().map(|(index, _)| index / side);
    let ends = rows().min().unwrap_or(0) + rows().max().unwrap_or(0);
    let rank = |index: usize, coverage: u8| {
        let (x, y) = (index % side, index / side);
        (coverage, Reverse((2 * y).abs_diff(ends)), ink_around(x, y), Reverse(index))
    };
    let worst = inked.clone().max_by_key(|&(index, &coverage)| rank(index, coverage)).map(|(index, _)| index);
    let mut wrong = square.clone();
    if let Some(index) = worst {
        wrong.pixels[index] = 0;
    }
    (wrong, worst.map(|index| [index % side, index / side]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn what_is_even_stays_even_by_every_method() {
        let square = SquareBitmap { side: 63, pixels: vec![200; 63 * 63] };
        for method in Method::ALL {
            let small = resized(&square, 20, method).unwrap();
            assert_eq!(small.pixels, vec![200; 400], "{}", method.name());
        }
    }

    #[test]
    fn each_method_weighs_the_pixels_by_its_filter() {
        // Black in the left half; half as many pixels. The filter is twice as wide as its name says.
        let square = SquareBitmap { side: 8, pixels: [[255, 255, 255, 255, 0, 0, 0, 0]; 8].concat() };
        let row = |method| resized(&square, 4, method).unwrap().pixels[..4].to_vec();
        assert_eq!(row(Method::Nearest), [255, 255, 0, 0]);
        // Pixels at -1.5, -0.5, 0.5, 1.5 of 2 weigh 1, 3, 3, 1; of the last new black pixel, 1/8 is white.
        assert_eq!(row(Method::Bilinear), [255, 223, 32, 0]);
        // At 1/4, 3/4, 5/4 and 7/4 of a new pixel Catmull-Rom is 111/128, 29/128, -9/128 and -3/128, and both sides
        // make 2. The second pixel loses (29 - 9 - 3)/256 to the white ones: 239/256 remain.
        let bicubic = row(Method::Bicubic);
        assert!((i32::from(bicubic[1]) - 238).abs() <= 1, "{bicubic:?}");
        assert!(row(Method::Lanczos)[1] > 223 && row(Method::Hamming)[1] > 223);
    }

    #[test]
    fn every_method_is_pillows_of_that_name() {
        let pixels = (0..49).map(|i| ((i % 7 * 37 + i / 7 * 91) % 256) as u8).collect();
        let square = SquareBitmap { side: 7, pixels };
        // The results of Pillow 13.0's `resize((3, 3), …)`, which also rounds between rows and columns.
        let pillow: [[u8; 9]; 5] = [
            [128, 202, 20, 54, 128, 202, 236, 54, 128],
            [98, 131, 127, 108, 114, 135, 129, 112, 114],
            [91, 145, 120, 100, 114, 148, 136, 103, 123],
            [92, 133, 132, 114, 108, 132, 128, 113, 114],
            [87, 133, 137, 121, 105, 128, 124, 116, 114],
        ];
        for (method, pillow) in Method::ALL.into_iter().zip(pillow) {
            let ours = resized(&square, 3, method).unwrap().pixels;
            let near = ours.iter().zip(&pillow).all(|(a, b): (&u8, &u8)| a.abs_diff(*b) <= 1);
            assert!(near, "{}: {ours:?}", method.name());
        }
    }

    #[test]
    fn an_empty_bitmap_cannot_be_resized() {
        let square = SquareBitmap { side: 2, pixels: vec![0; 4] };
        assert!(resized(&square, 0, Method::Nearest).is_err());
        assert!(resized(&SquareBitmap { side: 0, pixels: vec![] }, 2, Method::Lanczos).is_err());
    }

    #[test]
    fn the_largest_bitmap_shrinks_to_itself_without_error_and_to_others_with_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/LiberationSans-Regular.ttf");
        let data = std::fs::read(path).unwrap();
        // Glyph 74 is 'g'.
        let truth = Truth::new(&read_fonts::FontRef::new(&data).unwrap(), &[74], 20..=30).unwrap();
        for method in Method::ALL {
            let (same, error) = shrunk(&truth, 74, 10, method).unwrap();
            assert_eq!((same.side, error.mse), (30, 0.0), "{}", method.name());
            let (small, error) = shrunk(&truth, 74, 0, method).unwrap();
            assert!(small.side == 20 && error.mse > 1e-4 && error.mse < 0.1, "{}: {error:?}", method.name());
        }
    }

    #[test]
    fn the_wrong_pixel_is_a_black_one_at_half_height_amid_black_ones() {
        // A cross: the row through its middle is at half height, and its middle has four black neighbours.
        let square =
            SquareBitmap { side: 4, pixels: [[0, 255, 0, 0], [255; 4], [0, 255, 0, 0], [0; 4]].concat() };
        let (wrong, place) = single_wrong_pixel(&square);
        assert_eq!(place, Some([1, 1]));
        let differing: Vec<_> = (0..16).filter(|&i| wrong.pixels[i] != square.pixels[i]).collect();
        assert_eq!((differing, wrong.pixels[5]), (vec![5], 0));
        // A stem of 5 rows with a foot: the stem's middle, not the corner.
        let stem = SquareBitmap { side: 5, pixels: [[255, 0, 0, 0, 0]; 4].concat() };
        let stem = SquareBitmap { pixels: [stem.pixels, vec![255; 5]].concat(), ..stem };
        assert_eq!(single_wrong_pixel(&stem).1, Some([0, 2]));
    }

    #[test]
    fn of_equal_pixels_the_first_is_wrong_and_a_blank_bitmap_has_none() {
        assert_eq!(single_wrong_pixel(&SquareBitmap { side: 2, pixels: vec![9; 4] }).1, Some([0, 0]));
        let blank = SquareBitmap { side: 2, pixels: vec![0; 4] };
        assert_eq!(single_wrong_pixel(&blank), (blank, None));
    }
}
