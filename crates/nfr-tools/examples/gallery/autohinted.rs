//! Bitmaps by skrifa's autohinter, a port of FreeType's: `light`, which moves points only up and down, as the hints do with the
//! target smooth. It ignores the hints of the font.

use nfr::Bitmap;
use nfr_convert::Error;
use nfr_convert::compare::source::{BitmapSource, SizedSource};
use nfr_convert::teacher::Outline;
use skrifa::font::Font;
use skrifa::{DrawMemory, GlyphId, HintEngine, HintOptions, RasterTarget, ScalerFont};

/// A font's outlines, autohinted.
pub(crate) struct Autohinted(pub(crate) Font);

/// The same at a size.
pub(crate) struct AutohintedAt(ScalerFont);

impl Autohinted {
    pub(crate) fn at_size(&self, ppem: u16) -> Result<AutohintedAt, Error> {
        let options = HintOptions::auto().with_target(RasterTarget::Light);
        let scaler = ScalerFont::hinted(self.0.clone(), f32::from(ppem), options);
        if scaler.hint_engine() != Some(HintEngine::Auto) {
            return Err(Error::Unsupported(format!("skrifa does not autohint the font at {ppem} ppem")));
        }
        Ok(AutohintedAt(scaler))
    }
}

impl AutohintedAt {
    pub(crate) fn outline(&self, gid: u16) -> Result<Outline, Error> {
        let mut outline = Outline::default();
        let glyph = self.0.outline(GlyphId::from(gid)).ok_or(Error::NoSuchGlyph(gid.into()))?;
        glyph
            .draw(DrawMemory::Scratch, &mut outline)
            .map_err(|e| Error::Malformed(format!("glyph {gid} cannot be autohinted ({e})")))?;
        Ok(outline)
    }
}

impl BitmapSource for Autohinted {
    fn at(&self, ppem: u16) -> Result<Box<dyn SizedSource + '_>, Error> {
        Ok(Box::new(self.at_size(ppem)?))
    }
}

impl SizedSource for AutohintedAt {
    fn bitmap(&mut self, gid: u16) -> Result<Bitmap, Error> {
        self.outline(gid)?.rasterize()
    }
}
