//! How an application draws hinted glyphs in Rust without models: skrifa runs the font's programs, zeno fills the
//! outlines. Memory is kept from one glyph to the next.

use std::error::Error;

use nfr::Target;
use skrifa::font::Font;
use skrifa::font::glyph::GlyphSourceOrder;
use skrifa::{
    DrawMemory, GlyphId, HintEngine, HintOptions, PathSink, RasterTarget, ScalerFont, ScalerSource,
};
use zeno::{Command, Mask, Origin, PathBuilder, Placement, Scratch};

/// Draws glyphs from their outlines.
#[derive(Default)]
pub struct SkrifaZeno {
    path: Path,
    memory: Vec<u8>,
    scratch: Scratch,
    pixels: Vec<u8>,
}

impl SkrifaZeno {
    /// Draws a glyph's coverage, 0–255, top row first, with its origin at `x` pixels. Font, size and hinting are the
    /// scaler's.
    ///
    /// # Errors
    ///
    /// A glyph that is not in the font, or whose outline cannot be read.
    pub fn draw(
        &mut self,
        scaler: &ScalerFont,
        gid: u16,
        x: f32,
    ) -> Result<(Placement, &[u8]), Box<dyn Error>> {
        let outline =
            scaler.outline(GlyphId::from(gid)).ok_or_else(|| format!("glyph {gid} is not in the font"))?;
        let needed = outline.required_memory_size();
        self.memory.resize(self.memory.len().max(needed), 0);
        self.path.0.clear();
        outline
            .draw(DrawMemory::Buffer(&mut self.memory), &mut self.path)
            .map_err(|e| format!("glyph {gid} cannot be drawn ({e})"))?;
        let pixels = &mut self.pixels;
        let place = Mask::with_scratch(&self.path.0, &mut self.scratch)
            .origin(Origin::BottomLeft)
            .offset([x, 0.0])
            .render_offset([x, 0.0])
            .inspect(|format, width, height| {
                pixels.clear();
                pixels.resize(format.buffer_size(width, height), 0);
            })
            .render_into(pixels, None);
        Ok((place, &self.pixels))
    }
}

/// An outline, y up.
#[derive(Default)]
struct Path(Vec<Command>);

impl PathSink for Path {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to([x, y]);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to([x, y]);
    }
    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.0.quad_to([cx, cy], [x, y]);
    }
    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.0.curve_to([ax, ay], [bx, by], [x, y]);
    }
    fn close(&mut self) {
        self.0.close();
    }
}

/// The outlines of a font that the models were trained on, as in [`nfr_convert::teacher`].
pub fn outlines(font: Font) -> ScalerSource {
    ScalerSource::new(font, GlyphSourceOrder::BASE_OUTLINES)
}

/// The hinting that the models were trained on: the font's own programs, as in [`nfr_convert::teacher`]. A glyph whose
/// program fails is drawn as the program left it.
///
/// # Errors
///
/// A target that skrifa has no counterpart of.
pub fn hint_options(target: Target) -> Result<HintOptions, Box<dyn Error>> {
    let target = match target {
        Target::Smooth => RasterTarget::Normal,
        Target::Mono => RasterTarget::Mono,
        Target::Lcd => RasterTarget::Lcd,
        other => return Err(format!("skrifa has no counterpart of the target {other}").into()),
    };
    Ok(HintOptions::interpreter()
        .with_target(target)
        .with_classic_cleartype(true)
        .with_symmetric_rendering(true)
        .with_preserve_linear_metrics(false)
        .with_pedantic(false))
}

/// Sets hinting up for a size: runs the programs `fpgm` and `prep`.
///
/// # Errors
///
/// Programs that fail, or that do not run.
pub fn hinted(outlines: ScalerSource, ppem: u16, options: HintOptions) -> Result<ScalerFont, Box<dyn Error>> {
    let scaler = ScalerFont::hinted(outlines, f32::from(ppem), options);
    if scaler.hint_engine() == Some(HintEngine::TrueType) {
        return Ok(scaler);
    }
    Err(match scaler.hinting_error() {
        Some(e) => format!("the original font's programs fail at {ppem} ppem ({e})"),
        None => format!("skrifa does not run the original font's programs at {ppem} ppem"),
    }
    .into())
}
