//! A grey picture: black ink on white paper.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::ops::Range;
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

/// No picture has more pixels.
const MAX_PIXELS: usize = 64_000_000;

/// One byte a pixel, 255 is white; top row first.
pub(crate) struct Picture {
    width: usize,
    pixels: Vec<u8>,
}

/// Coverage 0–255 and where its top left pixel lies in the picture, which may be outside.
pub(crate) struct Ink<'a> {
    pub(crate) x: i64,
    pub(crate) y: i64,
    pub(crate) width: usize,
    pub(crate) coverage: &'a [u8],
}

impl Picture {
    /// White paper.
    pub(crate) fn new(width: usize, height: usize) -> Result<Self, String> {
        let pixels = width.saturating_mul(height);
        if pixels > MAX_PIXELS {
            return Err(format!(
                "the picture would have {width}×{height} pixels; choose fewer sizes or less text"
            ));
        }
        Ok(Self { width, pixels: vec![255; pixels] })
    }

    /// Lays ink over what is there, within these columns: where two glyphs overlap, the light that the first lets
    /// through meets the second. What lies outside is not drawn.
    pub(crate) fn blend(&mut self, ink: &Ink<'_>, columns: &Range<i64>, darkness: u8) {
        for (y, row) in (ink.y..).zip(ink.coverage.chunks_exact(ink.width.max(1))) {
            let Ok(y) = usize::try_from(y) else { continue };
            let Some(line) = self.pixels.get_mut(y * self.width..(y + 1) * self.width) else { return };
            for (x, &coverage) in (ink.x..).zip(row) {
                let pixel = usize::try_from(x).ok().and_then(|x| line.get_mut(x));
                if let Some(pixel) = pixel.filter(|_| columns.contains(&x)) {
                    let opacity = product(coverage, darkness);
                    *pixel = product(*pixel, 255 - opacity);
                }
            }
        }
    }

    /// Writes a PNG file.
    pub(crate) fn save(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let height = self.pixels.len() / self.width.max(1);
        let (width, height) = (u32::try_from(self.width)?, u32::try_from(height)?);
        let unwritable = |e: &dyn std::fmt::Display| format!("cannot write {} ({e})", path.display());
        let file = File::create(path).map_err(|e| unwritable(&e))?;
        PngEncoder::new(BufWriter::new(file))
            .write_image(&self.pixels, width, height, ExtendedColorType::L8)
            .map_err(|e| unwritable(&e))?;
        Ok(())
    }
}

/// Two shares of 255, multiplied and rounded.
fn product(a: u8, b: u8) -> u8 {
    // At most 255.
    ((u16::from(a) * u16::from(b) + 127) / 255) as u8
}
