//! A picture in memory, and PNG files from it.

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use crate::compare::metrics::{coverage_at, union_box};
use crate::error::Error;
use nfr::{Bitmap, Placement};

pub(super) type Rgb = [u8; 3];
pub(super) const INK: Rgb = [0, 0, 0];

/// No picture has more pixels: 192 MB in memory, and more than any viewer shows at once.
const MAX_PIXELS: u64 = 64_000_000;

/// Differences are drawn this many times as strong, so that small ones can be seen at all.
pub const DIFFERENCE_GAIN: u16 = 4;

/// Red, green, blue; top row first; white until something is drawn. What lies outside is not drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Canvas {
    /// A white canvas.
    ///
    /// # Errors
    ///
    /// `LimitExceeded` for more than 64 million pixels.
    pub fn new(width: u64, height: u64) -> Result<Self, Error> {
        let pixels = width.saturating_mul(height);
        match (u32::try_from(width), u32::try_from(height)) {
            (Ok(width), Ok(height)) if pixels <= MAX_PIXELS => {
                Ok(Self { width, height, pixels: vec![255; pixels as usize * 3] })
            }
            _ => Err(Error::LimitExceeded(format!(
                "the picture would have {width}×{height} pixels; select fewer glyphs or sizes, or enlarge less"
            ))),
        }
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Paints a rectangle.
    pub(super) fn fill(&mut self, x: i64, y: i64, width: i64, height: i64, colour: Rgb) {
        let clamp = |v: i64, end: u32| v.clamp(0, end.into()) as usize;
        let (left, right) = (clamp(x, self.width), clamp(x + width, self.width));
        for y in clamp(y, self.height)..clamp(y + height, self.height) {
            let row = y * self.width as usize;
            for pixel in self.pixels[(row + left) * 3..(row + right) * 3].chunks_exact_mut(3) {
                pixel.copy_from_slice(&colour);
            }
        }
    }

    /// Draws coverage black on white, each pixel `zoom`×`zoom`, the pen and baseline at (x, y).
    pub(super) fn draw(&mut self, bitmap: &Bitmap, x: i64, y: i64, zoom: u32) {
        let (place, zoom) = (&bitmap.placement, i64::from(zoom));
        let left = x + i64::from(place.left) * zoom;
        let top = y - i64::from(place.top) * zoom;
        for (row, pixels) in (0i64..).zip(bitmap.pixels.chunks_exact(place.width.max(1) as usize)) {
            for (column, &coverage) in (0i64..).zip(pixels).filter(|(_, coverage)| **coverage > 0) {
                self.fill(left + column * zoom, top + row * zoom, zoom, zoom, [255 - coverage; 3]);
            }
        }
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    ///
    /// `LimitExceeded` if it cannot be encoded, as a picture without pixels cannot.
    pub fn png(&self) -> Result<Vec<u8>, Error> {
        let (width, height) = (self.width, self.height);
        let mut file = Vec::new();
        PngEncoder::new(&mut file)
            .write_image(&self.pixels, width, height, ExtendedColorType::Rgb8)
            .map_err(|e| {
                Error::LimitExceeded(format!("a picture of {width}×{height} cannot be written ({e})"))
            })?;
        Ok(file)
    }
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

/// A bitmap in a frame, black on white, one pixel a pixel.
///
/// # Errors
///
/// As [`Canvas::new`].
pub fn coverage(bitmap: &Bitmap, frame: &Placement) -> Result<Canvas, Error> {
    let mut canvas = framed(frame)?;
    canvas.draw(bitmap, -i64::from(frame.left), frame.top.into(), 1);
    Ok(canvas)
}

/// Where a bitmap differs from the truth, in a frame: red where it is too dark, blue where it is too light,
/// [`DIFFERENCE_GAIN`] times as strong as the difference is.
///
/// # Errors
///
/// As [`Canvas::new`].
pub fn difference(truth: &Bitmap, other: &Bitmap, frame: &Placement) -> Result<Canvas, Error> {
    let mut canvas = framed(frame)?;
    let (columns, rows) = union_box(&truth.placement, &other.placement);
    for y in rows {
        for x in columns.clone() {
            let (truth, other) = (coverage_at(truth, x, y), coverage_at(other, x, y));
            let strength = (u16::from(truth.abs_diff(other)) * DIFFERENCE_GAIN).min(255) as u8;
            let rest = 255 - strength;
            let colour = if other > truth { [255, rest, rest] } else { [rest, rest, 255] };
            canvas.fill(x - i64::from(frame.left), y + i64::from(frame.top), 1, 1, colour);
        }
    }
    Ok(canvas)
}

/// A canvas as large as a frame. An empty frame has one pixel, since a PNG file must.
fn framed(frame: &Placement) -> Result<Canvas, Error> {
    Canvas::new(frame.width.max(1).into(), frame.height.max(1).into())
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
        let canvas = coverage(&square(1, 2, 255), &frame).unwrap();
        assert_eq!(canvas.pixels, [[255; 3], [0; 3], [255; 3], [255; 3]].concat());
    }

    #[test]
    fn too_dark_is_red_and_too_light_is_blue() {
        let frame = Placement { left: 0, top: 1, width: 1, height: 1 };
        let pixels =
            |truth, other| difference(&square(0, 1, truth), &square(0, 1, other), &frame).unwrap().pixels;
        assert_eq!(pixels(10, 20), [255, 215, 215]);
        assert_eq!(pixels(20, 10), [215, 215, 255]);
        assert_eq!(pixels(20, 20), [255, 255, 255]);
        assert_eq!(pixels(0, 200), [255, 0, 0]);
    }

    #[test]
    fn a_picture_of_absurd_size_is_refused() {
        let error = Canvas::new(1 << 20, 1 << 20).unwrap_err().to_string();
        assert!(error.contains("select fewer"), "{error}");
    }
}
