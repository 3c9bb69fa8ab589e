//! Other renderers, with the original font.
//!
//! At a size that has been drawn before:
//!
//! - `skrifa_zeno`: skrifa with the hinting that the models learnt and a `ScalerFont` for the size, zeno with its
//!   `Scratch`; path and pixels go to memory that is used again.
//! - `swash`: one `Scaler` for all glyphs, hinted, and `Render::render_into` an image that is used again. Its hinting
//!   is for subpixels and cannot be chosen, and its fonts are read by an older skrifa.
//! - `freetype`: `FT_Load_Glyph` with the font's own programs, and `FT_Render_Glyph`. The bitmap stays in its slot.
//! - `fontdue`: `Font::rasterize_indexed`, which has no hinting and allocates each bitmap. It has turned all outlines
//!   into lines when it opened the font.
//!
//! The first glyph at a size, the font open:
//!
//! - `skrifa_cold`: a new `ScalerFont`, which runs `fpgm` and `prep`, and the glyph, as in `skrifa_zeno`.

use std::error::Error;
use std::hint::black_box;
use std::rc::Rc;
use std::time::Instant;

use freetype::face::LoadFlag;
use freetype::{Face, Library, RenderMode};
use nfr::Target;
use skrifa::{HintOptions, ScalerFont, ScalerSource};
use swash::scale::{Render, ScaleContext, Source, image::Image};

use super::buffer::Coverage;
use super::renderer::{Renderer, warm};
use super::round::Candidate;
use super::skrifa_zeno::{SkrifaZeno, hint_options, hinted, outlines};

/// The hinted font, and the target that it is hinted for.
pub(super) struct Original<'a> {
    pub(super) data: &'a [u8],
    /// Counts the fonts of a collection.
    pub(super) index: u32,
    pub(super) target: Target,
}

/// Every other renderer.
pub(super) fn candidates<'a>(original: &Original<'a>) -> Result<Vec<Candidate<'a>>, Box<dyn Error>> {
    Ok(vec![
        warm("skrifa_zeno", "hinted; the size is set up", Skrifa::new(original)?),
        skrifa_cold(Skrifa::new(original)?),
        warm("swash", "hinted", Swash::new(original)?),
        warm("freetype", "hinted", FreeType::new(original)?),
        warm("fontdue", "not hinted", Fontdue::new(original)?),
    ])
}

struct Skrifa {
    outlines: ScalerSource,
    options: HintOptions,
    scaler: Option<ScalerFont>,
    renderer: SkrifaZeno,
}

impl Skrifa {
    fn new(original: &Original<'_>) -> Result<Self, Box<dyn Error>> {
        let options = hint_options(original.target)?;
        let font = skrifa::Font::new(original.data.to_vec(), original.index);
        let outlines = outlines(font.ok_or("skrifa cannot read the original font")?);
        Ok(Self { outlines, options, scaler: None, renderer: SkrifaZeno::default() })
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

fn skrifa_cold<'a>(skrifa: Skrifa) -> Candidate<'a> {
    let Skrifa { outlines, options, mut renderer, .. } = skrifa;
    Candidate::new("skrifa_cold", "hinted; the size is set up by running fpgm and prep", move |ppem, gids| {
        let start = Instant::now();
        for &gid in gids {
            let scaler = hinted(outlines.clone(), black_box(ppem), options)?;
            black_box(renderer.draw(&scaler, black_box(gid), 0.0)?);
        }
        Ok(start.elapsed())
    })
}

struct Swash<'a> {
    context: ScaleContext,
    font: swash::FontRef<'a>,
    ppem: f32,
    image: Image,
}

impl<'a> Swash<'a> {
    fn new(original: &Original<'a>) -> Result<Self, Box<dyn Error>> {
        let font = swash::FontRef::from_index(original.data, original.index as usize)
            .ok_or("swash cannot read the original font")?;
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

struct FreeType {
    face: Face<Rc<Vec<u8>>>,
    flags: LoadFlag,
}

impl FreeType {
    fn new(original: &Original<'_>) -> Result<Self, Box<dyn Error>> {
        // Hinted as the models learnt it.
        let target = match original.target {
            Target::Smooth => LoadFlag::TARGET_NORMAL,
            Target::Mono => LoadFlag::TARGET_MONO,
            Target::Lcd => LoadFlag::TARGET_LCD,
            other => return Err(format!("FreeType has no counterpart of the target {other}").into()),
        };
        let data = Rc::new(original.data.to_vec());
        let face = Library::init()?.new_memory_face(data, original.index.try_into()?)?;
        Ok(Self { face, flags: LoadFlag::NO_AUTOHINT | target })
    }
}

impl Renderer for FreeType {
    fn set_size(&mut self, ppem: u16, _: &[u16]) -> Result<(), Box<dyn Error>> {
        Ok(self.face.set_pixel_sizes(0, ppem.into())?)
    }

    fn draw(&mut self, gids: &[u16], mut show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>> {
        for &gid in gids {
            self.face.load_glyph(gid.into(), self.flags)?;
            // Grey coverage, whatever the hinting is for.
            self.face.glyph().render_glyph(RenderMode::Normal)?;
            show(Coverage::packed(self.face.glyph().bitmap().buffer()));
        }
        Ok(())
    }
}

struct Fontdue {
    font: fontdue::Font,
    ppem: f32,
}

impl Fontdue {
    fn new(original: &Original<'_>) -> Result<Self, Box<dyn Error>> {
        let settings = fontdue::FontSettings {
            collection_index: original.index,
            load_substitutions: false,
            ..Default::default()
        };
        Ok(Self { font: fontdue::Font::from_bytes(original.data, settings)?, ppem: 0.0 })
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
