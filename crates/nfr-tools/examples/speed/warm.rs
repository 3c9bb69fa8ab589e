//! Drawing at a size that has been drawn before. Opening the font and setting the size are not timed.
//!
//! - `nfr`: `Rasterizer::render_into` a buffer that is used again, the models decoded. The box is part of that call.
//! - `skrifa_zeno`: skrifa with the hinting that the models learnt and a `ScalerFont` for the size, zeno with its
//!   `Scratch`; path and pixels go to memory that is used again.
//! - `swash`: one `Scaler` for all glyphs, hinted, and `Render::render_into` an image that is used again. Its hinting
//!   is for subpixels and cannot be chosen, and its fonts are read by an older skrifa.
//! - `freetype`: `FT_Load_Glyph` with the font's own programs, and `FT_Render_Glyph`. The bitmap stays in its slot.
//! - `fontdue`: `Font::rasterize_indexed`, which has no hinting and allocates each bitmap. It has turned all outlines
//!   into lines when it opened the font.

use std::error::Error;
use std::hint::black_box;
use std::rc::Rc;
use std::time::Instant;

use freetype::face::LoadFlag;
use freetype::{Face, Library, RenderMode};
use nfr::{Rasterizer, Target};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::open::owned;
use skrifa::{HintOptions, ScalerFont, ScalerSource};
use swash::scale::{Render, ScaleContext, Source, image::Image};

use super::buffer::{Buffer, Coverage};
use super::round::Candidate;
use super::skrifa_zeno::{SkrifaZeno, hint_options, hinted, outlines};

/// A renderer that keeps what it can from one glyph to the next.
trait Renderer {
    /// Gets ready for a size.
    fn set_size(&mut self, ppem: u16, gids: &[u16]) -> Result<(), Box<dyn Error>>;

    /// Draws each glyph and shows its pixels.
    fn draw(&mut self, gids: &[u16], show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>>;
}

/// The candidates that draw at a size that they have drawn before.
pub(crate) fn candidates<'a>(
    pair: &'a FontPair<'a>,
    original: &'a [u8],
) -> Result<Vec<Candidate<'a>>, Box<dyn Error>> {
    let target = pair.font().target();
    Ok(vec![
        candidate(
            "nfr",
            Nfr { rasterizer: Rasterizer::new(pair.font()), ppem: 0.0, buffer: Buffer::default() },
        ),
        candidate("skrifa_zeno", Skrifa::new(pair)?),
        candidate("swash", Swash::new(original)?),
        candidate("freetype", FreeType::new(original, target)?),
        candidate("fontdue", Fontdue::new(original)?),
    ])
}

fn candidate<'a>(name: &'static str, mut renderer: impl Renderer + 'a) -> Candidate<'a> {
    let mut last = None;
    Candidate::new(name, move |ppem, gids| {
        if last != Some(ppem) {
            renderer.set_size(ppem, gids)?;
            check_ink(&mut renderer, gids)?;
            last = Some(ppem);
        }
        let start = Instant::now();
        renderer.draw(black_box(gids), |coverage| {
            black_box(coverage);
        })?;
        Ok(start.elapsed())
    })
}

/// Refuses a renderer whose bitmaps are mostly empty.
fn check_ink(renderer: &mut impl Renderer, gids: &[u16]) -> Result<(), Box<dyn Error>> {
    let mut inked = 0;
    renderer.draw(gids, |coverage| inked += usize::from(coverage.has_ink()))?;
    if 2 * inked < gids.len() {
        return Err(format!("only {inked} of {} glyphs have ink", gids.len()).into());
    }
    Ok(())
}

struct Nfr {
    rasterizer: Rasterizer,
    ppem: f32,
    buffer: Buffer,
}

impl Renderer for Nfr {
    fn set_size(&mut self, ppem: u16, gids: &[u16]) -> Result<(), Box<dyn Error>> {
        self.ppem = ppem.into();
        self.buffer = Buffer::new(&mut self.rasterizer, &[ppem], gids)?;
        Ok(())
    }

    fn draw(&mut self, gids: &[u16], mut show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>> {
        for &gid in gids {
            show(self.buffer.draw(&mut self.rasterizer, gid, self.ppem)?);
        }
        Ok(())
    }
}

struct Skrifa {
    outlines: ScalerSource,
    options: HintOptions,
    scaler: Option<ScalerFont>,
    renderer: SkrifaZeno,
}

impl Skrifa {
    fn new(pair: &FontPair<'_>) -> Result<Self, Box<dyn Error>> {
        let options = hint_options(pair.font().target())?;
        let outlines = outlines(owned(pair.original())?);
        Ok(Self { outlines, options, scaler: None, renderer: SkrifaZeno::new() })
    }
}

impl Renderer for Skrifa {
    fn set_size(&mut self, ppem: u16, _: &[u16]) -> Result<(), Box<dyn Error>> {
        self.scaler = Some(hinted(self.outlines.clone(), ppem, self.options)?);
        Ok(())
    }

    fn draw(&mut self, gids: &[u16], mut show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>> {
        let scaler = self.scaler.as_ref().ok_or("no size is set")?;
        for &gid in gids {
            show(Coverage::packed(self.renderer.draw(scaler, gid, 0.0)?.1));
        }
        Ok(())
    }
}

struct Swash<'a> {
    context: ScaleContext,
    font: swash::FontRef<'a>,
    ppem: f32,
    image: Image,
}

impl<'a> Swash<'a> {
    fn new(data: &'a [u8]) -> Result<Self, Box<dyn Error>> {
        let font = swash::FontRef::from_index(data, 0).ok_or("swash cannot read the original font")?;
        Ok(Self { context: ScaleContext::new(), font, ppem: 0.0, image: Image::new() })
    }
}

impl Renderer for Swash<'_> {
    fn set_size(&mut self, ppem: u16, _: &[u16]) -> Result<(), Box<dyn Error>> {
        self.ppem = ppem.into();
        Ok(())
    }

    fn draw(&mut self, gids: &[u16], mut show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>> {
        let mut scaler = self.context.builder(self.font).size(self.ppem).hint(true).build();
        let render = Render::new(&[Source::Outline]);
        for &gid in gids {
            // swash blends into the image's old contents.
            self.image.clear();
            if !render.render_into(&mut scaler, gid, &mut self.image) {
                return Err(format!("glyph {gid} cannot be drawn").into());
            }
            show(Coverage::packed(&self.image.data));
        }
        Ok(())
    }
}

/// FreeType with a font.
pub(crate) struct FreeType {
    face: Face<Rc<Vec<u8>>>,
    flags: LoadFlag,
}

impl FreeType {
    /// Opens a font, to be hinted as the models learnt it.
    pub(crate) fn new(data: &[u8], target: Target) -> Result<Self, Box<dyn Error>> {
        let target = match target {
            Target::Smooth => LoadFlag::TARGET_NORMAL,
            Target::Mono => LoadFlag::TARGET_MONO,
            Target::Lcd => LoadFlag::TARGET_LCD,
            other => return Err(format!("this example does not know the target {other}").into()),
        };
        let face = Library::init()?.new_memory_face(Rc::new(data.to_vec()), 0)?;
        Ok(Self { face, flags: LoadFlag::NO_AUTOHINT | target })
    }

    pub(crate) fn set_size(&self, ppem: u16) -> Result<(), Box<dyn Error>> {
        Ok(self.face.set_pixel_sizes(0, ppem.into())?)
    }

    pub(crate) fn draw(&self, gid: u16, show: &mut impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>> {
        self.face.load_glyph(gid.into(), self.flags)?;
        // Grey coverage, whatever the hinting is for.
        self.face.glyph().render_glyph(RenderMode::Normal)?;
        show(Coverage::packed(self.face.glyph().bitmap().buffer()));
        Ok(())
    }
}

impl Renderer for FreeType {
    fn set_size(&mut self, ppem: u16, _: &[u16]) -> Result<(), Box<dyn Error>> {
        FreeType::set_size(self, ppem)
    }

    fn draw(&mut self, gids: &[u16], mut show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>> {
        gids.iter().try_for_each(|gid| FreeType::draw(self, *gid, &mut show))
    }
}

struct Fontdue {
    font: fontdue::Font,
    ppem: f32,
}

impl Fontdue {
    fn new(data: &[u8]) -> Result<Self, Box<dyn Error>> {
        let settings = fontdue::FontSettings { load_substitutions: false, ..Default::default() };
        Ok(Self { font: fontdue::Font::from_bytes(data, settings)?, ppem: 0.0 })
    }
}

impl Renderer for Fontdue {
    fn set_size(&mut self, ppem: u16, _: &[u16]) -> Result<(), Box<dyn Error>> {
        self.ppem = ppem.into();
        Ok(())
    }

    fn draw(&mut self, gids: &[u16], mut show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>> {
        for &gid in gids {
            show(Coverage::packed(&self.font.rasterize_indexed(gid, self.ppem).1));
        }
        Ok(())
    }
}
