//! Paper that grows downwards, with captions.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{GrayImage, imageops};
use nfr_convert::compare::picture::LabelFont;
use read_fonts::FontRef;

use crate::ink::blank;

/// Pixels: web pages show pictures of this width without scaling them.
pub(crate) const WIDTH: usize = 830;
/// White space around everything.
pub(crate) const MARGIN: usize = 10;
/// The font of the captions.
const CAPTIONS: &[u8] = include_bytes!("../../../../fonts/LiberationSans-Regular.ttf");
/// How dark captions are, of 255.
const CAPTION_DARKNESS: u16 = 170;

/// A picture whose height is that of what was drawn.
pub(crate) struct Sheet {
    pub(crate) picture: GrayImage,
    captions: LabelFont,
}

impl Sheet {
    pub(crate) fn new() -> Result<Self, Box<dyn Error>> {
        Ok(Self { picture: blank(WIDTH, 0)?, captions: LabelFont::new(&FontRef::new(CAPTIONS)?)? })
    }

    /// Makes room down to a row.
    pub(crate) fn grow(&mut self, bottom: usize) -> Result<(), Box<dyn Error>> {
        let mut taller = blank(WIDTH, bottom.max(self.picture.height() as usize))?;
        imageops::replace(&mut taller, &self.picture, 0, 0);
        self.picture = taller;
        Ok(())
    }

    /// How light a pixel is. Outside it is white.
    pub(crate) fn light(&self, x: u32, y: u32) -> u8 {
        self.picture.get_pixel_checked(x, y).map_or(255, |pixel| pixel.0[0])
    }

    /// Writes a caption with its baseline 12 pixels below `top`.
    pub(crate) fn caption(&mut self, text: &str, left: usize, top: usize) -> Result<(), Box<dyn Error>> {
        let line = self.captions.line(text, 1)?;
        self.grow(top + line.height() as usize)?;
        for (x, y, pixel) in line.enumerate_pixels() {
            let darkness = u16::from(255 - pixel.0[0]) * CAPTION_DARKNESS / 255;
            if let Some(paper) = self.picture.get_pixel_mut_checked(left as u32 + x, top as u32 + y) {
                paper.0[0] = paper.0[0].min(255 - darkness as u8);
            }
        }
        Ok(())
    }

    /// Writes the picture with a margin below, as small as PNG gets it.
    pub(crate) fn write(mut self, path: &Path) -> Result<(), Box<dyn Error>> {
        self.grow(self.picture.height() as usize + MARGIN)?;
        let cannot = |e: &dyn std::fmt::Display| format!("cannot write {} ({e})", path.display());
        let file = BufWriter::new(File::create(path).map_err(|e| cannot(&e))?);
        let encoder = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::NoFilter);
        self.picture.write_with_encoder(encoder).map_err(|e| cannot(&e).into())
    }
}
