//! The picture of a failed pixel test.

use std::path::{Path, PathBuf};

use image::{GrayImage, Luma};

/// Edge of a pixel in the picture.
const ZOOM: u32 = 8;

/// Writes expected | difference | actual, bitmap below bitmap, as one picture, and returns its path. A bitmap is a list of
/// rows of coverage.
pub(crate) fn write(name: &str, bitmaps: &[[Vec<Vec<u8>>; 2]]) -> PathBuf {
    let width = |bitmap: &Vec<Vec<u8>>| bitmap.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let height = |pair: &[Vec<Vec<u8>>; 2]| pair.iter().map(Vec::len).max().unwrap_or(0) as u32 + 1;
    let column = bitmaps.iter().flatten().map(width).max().unwrap_or(0) + 1;
    let rows: u32 = bitmaps.iter().map(height).sum();
    let mut picture = GrayImage::from_pixel(3 * column * ZOOM, rows * ZOOM, Luma([96]));
    let mut top = 0;
    for pair in bitmaps {
        let [expected, actual] = pair;
        for y in 0..height(pair) - 1 {
            for x in 0..column - 1 {
                let pixel = |bitmap: &[Vec<u8>]| bitmap.get(y as usize)?.get(x as usize).copied();
                let (expected, actual) = (pixel(expected), pixel(actual));
                let difference = expected.unwrap_or(0).abs_diff(actual.unwrap_or(0));
                for (panel, level) in [expected, Some(difference), actual].into_iter().enumerate() {
                    let Some(level) = level else { continue };
                    let (left, top) = ((panel as u32 * column + x) * ZOOM, (top + y) * ZOOM);
                    for (dx, dy) in (0..ZOOM).flat_map(|dx| (0..ZOOM).map(move |dy| (dx, dy))) {
                        picture.put_pixel(left + dx, top + dy, Luma([255 - level]));
                    }
                }
            }
        }
        top += height(pair);
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    picture.save(&path).unwrap();
    path
}
