//! How an application draws hinted glyphs in Rust without models: skrifa runs the font's programs, zeno fills the
//! outlines. Whatever can be kept from one glyph to the next is kept.

use std::error::Error;

use nfr::Target;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{
    DrawSettings, Engine, Hinting, HintingInstance, HintingOptions, OutlineGlyphCollection, OutlinePen,
    SmoothMode, Target as SkrifaTarget,
};
use zeno::{Command, Mask, Origin, PathBuilder, Placement, Scratch};

/// Draws glyphs from their outlines.
pub(crate) struct SkrifaZeno<'a> {
    outlines: OutlineGlyphCollection<'a>,
    path: Path,
    memory: Vec<u8>,
    scratch: Scratch,
    pixels: Vec<u8>,
}

impl<'a> SkrifaZeno<'a> {
    /// Draws these outlines.
    pub(crate) fn new(outlines: OutlineGlyphCollection<'a>) -> Self {
        Self {
            outlines,
            path: Path::default(),
            memory: Vec::new(),
            scratch: Scratch::new(),
            pixels: Vec::new(),
        }
    }

    /// Draws a glyph's coverage, 0–255, top row first, with the pen at `x` pixels.
    pub(crate) fn draw<'s>(
        &'s mut self,
        gid: u16,
        settings: DrawSettings<'s>,
        x: f32,
    ) -> Result<(Placement, &'s [u8]), Box<dyn Error>> {
        let glyph = self.outlines.get(gid.into()).ok_or_else(|| format!("glyph {gid} is not in the font"))?;
        let needed = glyph.draw_memory_size(Hinting::Embedded);
        self.memory.resize(self.memory.len().max(needed), 0);
        self.path.0.clear();
        glyph
            .draw(settings.with_memory(Some(&mut self.memory)), &mut self.path)
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

impl OutlinePen for Path {
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

/// The hinting that the models were trained on: the font's own programs, as in [`nfr_convert::teacher`].
pub(crate) fn hinting_options(target: Target) -> HintingOptions {
    let smooth =
        |mode| SkrifaTarget::Smooth { mode, symmetric_rendering: true, preserve_linear_metrics: false };
    let target = match target {
        Target::Smooth => smooth(SmoothMode::Normal),
        Target::Mono => SkrifaTarget::Mono,
        Target::Lcd => smooth(SmoothMode::Lcd),
    };
    HintingOptions { engine: Engine::Interpreter, target }
}

/// Sets hinting up for a size: runs the programs `fpgm` and `prep`.
pub(crate) fn hinting(
    outlines: &OutlineGlyphCollection<'_>,
    ppem: u16,
    target: Target,
) -> Result<HintingInstance, Box<dyn Error>> {
    let size = Size::new(f32::from(ppem));
    HintingInstance::new(outlines, size, LocationRef::default(), hinting_options(target))
        .map_err(|e| format!("the original font's programs fail at {ppem} ppem ({e})").into())
}
