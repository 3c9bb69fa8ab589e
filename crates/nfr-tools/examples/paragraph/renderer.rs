//! Three ways to draw a glyph at a subpixel offset.

use std::error::Error;

use nfr::{BitmapRef, DrawOptions, Placement, Rasterizer};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::open::owned;
use nfr_tools::bench::skrifa_zeno::{SkrifaZeno, hint_options, hinted, outlines};
use skrifa::ScalerFont;

/// A renderer at one size.
pub(crate) enum Renderer {
    /// From the models.
    Neural { rasterizer: Box<Rasterizer>, ppem: f32 },
    /// From the outlines.
    Outlines { name: &'static str, renderer: SkrifaZeno, scaler: Box<ScalerFont> },
}

impl Renderer {
    /// All three, the models first.
    pub(crate) fn all(pair: &FontPair<'_>, ppem: u16) -> Result<[Self; 3], Box<dyn Error>> {
        let neural = Self::Neural { rasterizer: Box::new(Rasterizer::new(pair.font())), ppem: ppem.into() };
        let outlines = outlines(owned(pair.original())?);
        let scaler = hinted(outlines, ppem, hint_options(pair.font().target())?)?;
        Ok([neural, Self::of_outlines("skrifa hinted", scaler), Self::unhinted(pair, ppem)?])
    }

    /// The one that needs nothing but outlines.
    pub(crate) fn unhinted(pair: &FontPair<'_>, ppem: u16) -> Result<Self, Box<dyn Error>> {
        let outlines = outlines(owned(pair.original())?);
        Ok(Self::of_outlines("unhinted", ScalerFont::force_unhinted(outlines, Some(ppem.into()))))
    }

    fn of_outlines(name: &'static str, scaler: ScalerFont) -> Self {
        Self::Outlines { name, renderer: SkrifaZeno::default(), scaler: Box::new(scaler) }
    }

    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Neural { .. } => "neural",
            Self::Outlines { name, .. } => name,
        }
    }

    /// Draws a glyph's coverage at the subpixel offset `x`, on the baseline.
    pub(crate) fn draw(&mut self, gid: u16, x: f32) -> Result<(Placement, &[u8]), Box<dyn Error>> {
        match self {
            Self::Neural { rasterizer, ppem } => {
                let options = DrawOptions::new(*ppem).with_offset([x, 0.0]);
                let BitmapRef { placement, pixels, .. } = rasterizer.draw(gid.into(), options)?;
                Ok((placement, pixels))
            }
            Self::Outlines { renderer, scaler, .. } => {
                let (place, pixels) = renderer.draw(scaler, gid, x)?;
                let zeno::Placement { left, top, width, height } = place;
                Ok((Placement { left, top, width, height }, pixels))
            }
        }
    }
}
