//! Labels of pictures, in the letters of a font that is at hand.

use image::{RgbImage, imageops};
use read_fonts::FontRef;
use skrifa::GlyphId;
use skrifa::font::Font as SkrifaFont;

use super::line::text_line;
use super::raster::{blank, coverage};
use crate::compare::source::SizedSource;
use crate::error::Error;
use crate::input::open::owned;
use crate::teacher::unhinted::UnhintedOutlines;
use nfr::{Bitmap, Font, Placement, Rasterizer};

/// From this enlargement on, labels are large, to match.
const ZOOM_OF_LARGE_LABELS: u32 = 3;
/// The sizes of labels in pixels per em.
const PPEM: u16 = 12;
const LARGE_PPEM: u16 = 20;

/// A font that labels are written in: its outlines without hints. Characters that it does not have are left out.
pub struct LabelFont {
    font: SkrifaFont,
    outlines: UnhintedOutlines,
    models: Option<Font>,
}

impl LabelFont {
    /// Takes a font's outlines.
    ///
    /// # Errors
    ///
    /// `Malformed` for a font that cannot be read.
    pub fn new(font: &FontRef<'_>) -> Result<Self, Error> {
        Ok(Self { font: owned(font)?, outlines: UnhintedOutlines::new(font)?, models: None })
    }

    /// Takes a neural font, whose outlines may have been dropped: glyphs that have models are drawn from these.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn neural(font: &FontRef<'_>, models: &Font) -> Result<Self, Error> {
        Ok(Self { models: Some(models.clone()), ..Self::new(font)? })
    }

    /// The height of a line, and that of its baseline from the top, in pixels.
    pub(super) fn line_height(zoom: u32) -> (u32, u32) {
        let ppem = u32::from(ppem(zoom));
        (ppem * 5 / 4, ppem)
    }

    /// A line of text as high as every line is beside pictures that are enlarged `zoom` times, and as wide as its ink; no
    /// columns for no ink.
    ///
    /// # Errors
    ///
    /// As the outlines' and the models', and `LimitExceeded` for a text that is too long.
    pub fn line(&self, text: &str, zoom: u32) -> Result<RgbImage, Error> {
        let ppem = ppem(zoom);
        let charmap = self.font.charmap();
        let gids: Vec<u16> = text
            .chars()
            .filter_map(|c| charmap.map_unicode(c).and_then(|gid| u16::try_from(gid.to_u32()).ok()))
            .collect();
        let metrics = self.font.glyph_metrics();
        let pixels_per_unit = f32::from(ppem) / f32::from(self.outlines.units_per_em());
        let advance = |gid: u16| metrics.h_advance(GlyphId::from(gid)) * pixels_per_unit;
        let rasterizer = self.models.as_ref().map(Rasterizer::new);
        let line =
            text_line(&mut LabelSource { label: self, rasterizer, ppem: ppem.into() }, &gids, advance)?;
        let (height, baseline) = Self::line_height(zoom);
        let Placement { left, width, .. } = line.placement;
        let mut picture = blank(width.into(), height.into())?;
        let frame = Placement { left, top: baseline as i32, width, height };
        if width > 0 {
            imageops::replace(&mut picture, &coverage(&line, &frame)?, 0, 0);
        }
        Ok(picture)
    }
}

fn ppem(zoom: u32) -> u16 {
    if zoom >= ZOOM_OF_LARGE_LABELS { LARGE_PPEM } else { PPEM }
}

struct LabelSource<'l> {
    label: &'l LabelFont,
    rasterizer: Option<Rasterizer>,
    ppem: f32,
}

impl SizedSource for LabelSource<'_> {
    fn bitmap(&mut self, gid: u16) -> Result<Bitmap, Error> {
        match (&mut self.rasterizer, &self.label.models) {
            (Some(rasterizer), Some(font)) if font.has_model(gid.into()) => {
                Ok(rasterizer.render(gid.into(), self.ppem)?)
            }
            _ => self.label.outlines.at(gid, self.ppem)?.rasterize(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const SANS: &[u8] = include_bytes!("../../../fonts/LiberationSans-Regular.ttf");

    #[test]
    fn a_longer_text_is_wider_and_all_lines_are_equally_high() {
        let font = LabelFont::new(&FontRef::new(SANS).unwrap()).unwrap();
        let size = |text, zoom| font.line(text, zoom).unwrap().dimensions();
        assert!(size("neural", 1).0 > size("ink", 1).0);
        assert_eq!((size("gg", 1).1, size("a", 1).1, size("a", 3).1), (15, 15, 25));
        assert_eq!((size("", 1), size(" ", 1)), ((0, 15), (0, 15)));
        assert_eq!(
            size("a\u{1F600}", 1),
            size("a", 1),
            "a character that the font does not have is left out"
        );
    }
}
