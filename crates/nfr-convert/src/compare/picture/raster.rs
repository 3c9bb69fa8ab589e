//! Bitmaps as pictures in memory, and PNG files from these.

use std::io::Cursor;

use image::imageops::{self, FilterType};
use image::{ImageFormat, Rgb, RgbImage};

use crate::compare::metrics::{coverage_at, union_box};
use crate::error::Error;
use nfr::{Bitmap, Placement};

const WHITE: Rgb<u8> = Rgb([255; 3]);

/// No picture has more pixels: 192 MB in memory, and more than any viewer shows at once.
const MAX_PIXELS: u64 = 64_000_000;

/// Differences are drawn this many times as strong, so that small ones can be seen at all.
pub const DIFFERENCE_GAIN: u16 = 4;

/// A white picture.
///
/// # Errors
///
/// `LimitExceeded` for more than 64 million pixels.
pub fn blank(width: u64, height: u64) -> Result<RgbImage, Error> {
    match (u32::try_from(width), u32::try_from(height)) {
        (Ok(w), Ok(h)) if width * height <= MAX_PIXELS => Ok(RgbImage::from_pixel(w, h, WHITE)),
        _ => Err(Error::LimitExceeded(format!(
            "the picture would have {width}×{height} pixels; select fewer glyphs or sizes, or enlarge less"
        ))),
    }
}

/// A picture as a PNG file.
///
/// # Errors
///
/// `LimitExceeded` if it cannot be encoded, as a picture without pixels cannot.
pub fn png(picture: &RgbImage) -> Result<Vec<u8>, Error> {
    let mut file = Cursor::new(Vec::new());
    picture.write_to(&mut file, ImageFormat::Png).map_err(|e| {
        let (width, height) = picture.dimensions();
        Error::LimitExceeded(format!("a picture of {width}×{height} cannot be written ({e})"))
    })?;
    Ok(file.into_inner())
}

/// A picture with each pixel `zoom`×`zoom`.
pub fn enlarged(picture: &RgbImage, zoom: u32) -> RgbImage {
    imageops::resize(picture, picture.width() * zoom, picture.height() * zoom, FilterType::Nearest)
}

/// The smallest box around several bitmaps; empty ones do not count.
pub fn enclosing<'b>(bitmaps: impl IntoIterator<Item = &'b Bitmap>) -> Placement {
    bitmaps.into_iter().fold(Placement::default(), |all, bitmap| {
        let (columns, rows) = union_box(&all, &bitmap.placement);
        // The sides of a box that bitmaps in memory fill are far from the limits of these types.
        Placement {
            left: columns.start as i32,
            top: -rows.start as i32,
            width: (columns.end - columns.start) as u32,
            height: (rows.end - rows.start) as u32,
        }
    })
}

/// A bitmap in a frame, black on white, one pixel a pixel. Pixels outside of the frame are cut off.
///
/// # Errors
///
/// As [`blank`].
pub fn coverage(bitmap: &Bitmap, frame: &Placement) -> Result<RgbImage, Error> {
    in_frame(frame, |x, y| [255 - coverage_at(bitmap, x, y); 3])
}

/// Where a bitmap differs from the truth, in a frame: red where it is too dark, blue where it is too light,
/// [`DIFFERENCE_GAIN`] times as strong as the difference is.
///
/// # Errors
///
/// As [`blank`].
pub fn difference(truth: &Bitmap, other: &Bitmap, frame: &Placement) -> Result<RgbImage, Error> {
    in_frame(frame, |x, y| {
        let (truth, other) = (coverage_at(truth, x, y), coverage_at(other, x, y));
        let rest = 255 - (u16::from(truth.abs_diff(other)) * DIFFERENCE_GAIN).min(255) as u8;
        if other > truth { [255, rest, rest] } else { [rest, rest, 255] }
    })
}

/// A picture as large as a frame, with the colour at each column from the origin and row downwards from the baseline.
/// An empty frame has one white pixel, since PNG knows no empty pictures.
fn in_frame(frame: &Placement, colour: impl Fn(i64, i64) -> [u8; 3]) -> Result<RgbImage, Error> {
    let mut picture = blank(frame.width.max(1).into(), frame.height.max(1).into())?;
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        *pixel = Rgb(colour(i64::from(frame.left) + i64::from(x), i64::from(y) - i64::from(frame.top)));
    }
    Ok(picture)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn square(left: i32, top: i32, value: u8) -> Bitmap {
        Bitmap { placement: Placement { left, top, width: 1, height: 1 }, pixels: vec![value] }
    }

    #[test]
    fn the_enclosing_box_ignores_empty_bitmaps() {
        let far = Bitmap { placement: Placement { left: 90, ..Default::default() }, pixels: vec![] };
        let frame = enclosing([&square(-1, 3, 9), &far, &square(2, 1, 9)]);
        assert_eq!(frame, Placement { left: -1, top: 3, width: 4, height: 3 });
    }

    #[test]
    fn coverage_is_black_on_white_and_the_first_row_is_on_top() {
        let frame = Placement { left: 0, top: 2, width: 2, height: 2 };
        let picture = coverage(&square(1, 2, 255), &frame).unwrap();
        assert_eq!(picture.into_raw(), [[255; 3], [0; 3], [255; 3], [255; 3]].concat());
    }

    #[test]
    fn too_dark_is_red_and_too_light_is_blue() {
        let frame = Placement { left: 0, top: 1, width: 1, height: 1 };
        let pixels =
            |truth, other| difference(&square(0, 1, truth), &square(0, 1, other), &frame).unwrap().into_raw();
        assert_eq!(pixels(10, 20), [255, 215, 215]);
        assert_eq!(pixels(20, 10), [215, 215, 255]);
        assert_eq!(pixels(20, 20), [255, 255, 255]);
        assert_eq!(pixels(0, 200), [255, 0, 0]);
    }

    #[test]
    fn a_picture_of_absurd_size_is_refused() {
        let error = blank(1 << 20, 1 << 20).unwrap_err().to_string();
        assert!(error.contains("select fewer"), "{error}");
    }
}
