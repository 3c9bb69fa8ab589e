//! Three ways to draw a glyph with the pen between pixels.

use std::error::Error;

use nfr::{Placement, Rasterizer, Setting};
use nfr_convert::compare::fonts::FontPair;
use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, HintingInstance};

use super::skrifa_zeno::{SkrifaZeno, hinting};

/// A renderer at one size.
pub(crate) enum Renderer<'a> {
    /// From the models.
    Neural { rasterizer: Box<Rasterizer<'a>>, ppem: f32, pixels: Vec<u8> },
    /// From the outlines, hinted by the font's programs.
    Hinted { renderer: SkrifaZeno<'a>, hinting: Box<HintingInstance> },
    /// From the outlines as they are.
    Unhinted { renderer: SkrifaZeno<'a>, size: Size },
}

impl<'a> Renderer<'a> {
    /// All three, the models first.
    pub(crate) fn all(pair: &'a FontPair<'a>, ppem: u16) -> Result<[Self; 3], Box<dyn Error>> {
        let outlines = pair.original().outline_glyphs();
        let hinting = hinting(&outlines, ppem, pair.font().target())?;
        let neural = Self::Neural {
            rasterizer: Box::new(Rasterizer::new(pair.font())),
            ppem: ppem.into(),
            pixels: Vec::new(),
        };
        let hinted = Self::Hinted { renderer: SkrifaZeno::new(outlines.clone()), hinting: Box::new(hinting) };
        Ok([neural, hinted, Self::unhinted(pair, ppem)])
    }

    /// The one that needs nothing but outlines.
    pub(crate) fn unhinted(pair: &'a FontPair<'a>, ppem: u16) -> Self {
        let outlines = pair.original().outline_glyphs();
        Self::Unhinted { renderer: SkrifaZeno::new(outlines), size: Size::new(ppem.into()) }
    }

    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Neural { .. } => "neural",
            Self::Hinted { .. } => "skrifa hinted",
            Self::Unhinted { .. } => "unhinted",
        }
    }

    /// Draws a glyph's coverage with the pen at `x`, a part of a pixel, on the baseline.
    pub(crate) fn draw(&mut self, gid: u16, x: f32) -> Result<(Placement, &[u8]), Box<dyn Error>> {
        let (place, pixels) = match self {
            Self::Neural { rasterizer, ppem, pixels } => {
                let setting = Setting { pen: [x, 0.0], ..Setting::from(*ppem) };
                let place = match rasterizer.render_into(gid, setting, pixels) {
                    // Grows to the largest glyph.
                    Err(nfr::Error::InvalidParameter(_)) => {
                        let area = rasterizer.placement(gid, setting)?.area();
                        pixels.resize(pixels.len().max(area), 0);
                        rasterizer.render_into(gid, setting, pixels)?
                    }
                    place => place?,
                };
                return Ok((place, &pixels[..place.area()]));
            }
            Self::Hinted { renderer, hinting } => {
                renderer.draw(gid, DrawSettings::hinted(hinting, false), x)?
            }
            Self::Unhinted { renderer, size } => {
                renderer.draw(gid, DrawSettings::unhinted(*size, LocationRef::default()), x)?
            }
        };
        let place = Placement { left: place.left, top: place.top, width: place.width, height: place.height };
        Ok((place, pixels))
    }
}
