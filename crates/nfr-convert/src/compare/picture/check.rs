//! Pixel tests that show what failed: "expected | difference | actual" in one picture.

use std::fs;
use std::path::{Path, PathBuf};

use image::{RgbImage, imageops};

use super::raster::{blank, coverage, difference, enclosing, enlarged, png};
use crate::compare::metrics::Sums;
use crate::error::Error;
use nfr::{Bitmap, Placement};

/// The enlargement of failures.
const ZOOM: u32 = 8;
/// Pixels between their parts.
const GAP: u32 = 8;

/// Writes a picture of a failed pixel test: what was expected, where the two differ (red too dark, blue too light), and
/// what came instead.
///
/// # Errors
///
/// `Io` if it cannot be written, `LimitExceeded` for bitmaps that are too large.
pub fn write_failure(expected: &Bitmap, actual: &Bitmap, path: &Path) -> Result<(), Error> {
    let frame = enclosing([expected, actual]);
    let parts =
        [coverage(expected, &frame)?, difference(expected, actual, &frame)?, coverage(actual, &frame)?];
    let parts = parts.map(|part| enlarged(&part, ZOOM));
    let (width, height) = parts[0].dimensions();
    let mut picture = blank(u64::from(width + GAP) * 3, height.into())?;
    for (part, x) in parts.iter().zip((0..).step_by((width + GAP) as usize)) {
        imageops::replace(&mut picture, part, x, 0);
    }
    write(path, &png(&picture)?)
}

/// Checks that no pixel differs by more than `tolerance`. The message says where the failure's picture is.
///
/// # Errors
///
/// A sentence for a test to panic with.
pub fn check_close(name: &str, expected: &Bitmap, actual: &Bitmap, tolerance: u8) -> Result<(), String> {
    let max = Sums::of(expected, actual).max();
    if max <= tolerance {
        return Ok(());
    }
    let path = failure_path(name);
    write_failure(expected, actual, &path).map_err(|e| e.to_string())?;
    let path = path.display();
    Err(format!(
        "{name}: a pixel is off by {max}, {tolerance} is allowed; expected | difference | actual: {path}"
    ))
}

/// Checks a picture against the PNG file that it has to equal. With `REPLACE=1` in the environment the file is written
/// anew, and the check fails all the same, so that nobody blesses a picture without seeing it.
///
/// # Errors
///
/// A sentence for a test to panic with.
pub fn check_golden(golden: &Path, actual: &RgbImage) -> Result<(), String> {
    let golden_path = golden.display();
    let expected = image::open(golden).map(|picture| picture.into_rgb8());
    if matches!(&expected, Ok(expected) if expected == actual) {
        return Ok(());
    }
    if std::env::var_os("REPLACE").is_some_and(|value| value == "1") {
        png(actual).and_then(|file| write(golden, &file)).map_err(|e| e.to_string())?;
        return Err(format!("{golden_path} is replaced; look at it, and run the test again without REPLACE"));
    }
    let expected =
        expected.map_err(|e| format!("{golden_path} cannot be read ({e}); REPLACE=1 writes it"))?;
    let path = failure_path(&golden.file_stem().unwrap_or_default().to_string_lossy());
    write_failure(&bitmap(&expected), &bitmap(actual), &path).map_err(|e| e.to_string())?;
    Err(format!(
        "the picture is not {golden_path}; expected | difference | actual: {}; REPLACE=1 replaces it",
        path.display()
    ))
}

/// A grey picture as coverage.
fn bitmap(picture: &RgbImage) -> Bitmap {
    let (width, height) = picture.dimensions();
    let placement = Placement { left: 0, top: height as i32, width, height };
    Bitmap { placement, pixels: imageops::grayscale(picture).pixels().map(|grey| 255 - grey.0[0]).collect() }
}

fn failure_path(name: &str) -> PathBuf {
    let name: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    std::env::temp_dir().join("nfr-failures").join(name + ".png")
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let directory = path.parent().map_or(Ok(()), fs::create_dir_all);
    directory
        .and_then(|()| fs::write(path, bytes))
        .map_err(|e| Error::Io(format!("cannot write {} ({e})", path.display())))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn pixel(value: u8) -> Bitmap {
        Bitmap { placement: Placement { left: 0, top: 1, width: 1, height: 1 }, pixels: vec![value] }
    }

    #[test]
    fn a_failure_shows_expected_difference_and_actual() {
        assert_eq!(check_close("close", &pixel(10), &pixel(14), 4), Ok(()));
        let message = check_close("not close", &pixel(255), &pixel(0), 4).unwrap_err();
        let path = failure_path("not close");
        assert!(message.contains("off by 255") && message.contains(&path.display().to_string()), "{message}");
        let picture = image::open(&path).unwrap().into_rgb8();
        let colours = [0, ZOOM + GAP, 2 * (ZOOM + GAP)].map(|x| picture.get_pixel(x, 0).0);
        assert_eq!(colours, [[0; 3], [0, 0, 255], [255; 3]]);
    }

    #[test]
    fn a_golden_picture_is_compared_pixel_by_pixel() {
        let directory = tempfile::tempdir().unwrap();
        let golden = directory.path().join("golden.png");
        let picture = |value| coverage(&pixel(value), &pixel(value).placement).unwrap();
        assert!(check_golden(&golden, &picture(9)).unwrap_err().contains("REPLACE=1"));
        fs::write(&golden, png(&picture(9)).unwrap()).unwrap();
        assert_eq!(check_golden(&golden, &picture(9)), Ok(()));
        assert!(check_golden(&golden, &picture(8)).unwrap_err().contains("expected | difference | actual"));
    }
}
