//! The neural fonts of a `FontSystem`, and images of their glyphs.

use std::collections::HashMap;
use std::sync::Arc;

use cosmic_text::{
    Buffer, CacheKey, CacheKeyFlags, FontSystem, Placement, SwashCache, SwashContent, SwashImage, fontdb,
};
use nfr::{DrawOptions, Error, Font, Rasterizer};
use read_fonts::{FontRef, TableProvider};

/// The fonts with models among those of a `FontSystem`. They are found by themselves when their glyphs are drawn.
///
/// Glyphs that it does not draw, swash draws as before: those of other fonts, glyphs without models, coloured glyphs, and spans
/// that ask for a slanted or an unhinted font (`CacheKeyFlags::FAKE_ITALIC`, `DISABLE_HINTING`). So does it draw those whose
/// models are damaged or do not belong to the font, and one [`Problem`] is kept for each such font.
#[derive(Debug, Default)]
pub struct NeuralFonts {
    /// `None` for a font without models.
    fonts: HashMap<fontdb::ID, Option<NeuralFont>>,
    problems: Vec<Problem>,
}

/// A font whose models cannot be used, or the first of its glyphs whose model cannot.
#[derive(Debug)]
#[non_exhaustive]
pub struct Problem {
    /// The font.
    pub font: fontdb::ID,
    /// What is wrong with it.
    pub error: Error,
}

#[derive(Debug)]
struct NeuralFont {
    rasterizer: Rasterizer,
    index: u32,
    is_reported: bool,
}

/// The bytes of a font that cosmic-text holds.
struct Shared(Arc<cosmic_text::Font>);

impl AsRef<[u8]> for Shared {
    fn as_ref(&self) -> &[u8] {
        self.0.data()
    }
}

impl NeuralFonts {
    /// Knows no font yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts the images of a buffer's glyphs into `cache`, so that `Buffer::draw`, which looks there first, draws them. Glyphs that
    /// the cache has already stay as they are, so this comes before the first drawing.
    pub fn fill(&mut self, buffer: &mut Buffer, fonts: &mut FontSystem, cache: &mut SwashCache) {
        buffer.shape_until_scroll(fonts, false);
        for run in buffer.layout_runs() {
            for glyph in run.glyphs {
                let key = glyph.physical((0.0, run.line_y), 1.0).cache_key;
                if !cache.image_cache.contains_key(&key)
                    && let Some(image) = self.image(fonts, key)
                {
                    cache.image_cache.insert(key, Some(image));
                }
            }
        }
    }

    /// The image of a glyph, or `None` where swash has to draw it. Nothing is kept but the decoded model.
    pub fn image(&mut self, fonts: &mut FontSystem, key: CacheKey) -> Option<SwashImage> {
        let options = draw_options(key)?;
        let font = self.font(fonts, key)?;
        let glyph = u32::from(key.glyph_id);
        if is_coloured(font.rasterizer.font(), font.index, glyph) {
            return None;
        }
        match font.rasterizer.draw(glyph, options) {
            Ok(bitmap) => {
                let nfr::Placement { left, top, width, height } = bitmap.placement;
                let placement = Placement { left, top, width, height };
                let (content, data) = (SwashContent::Mask, bitmap.pixels.to_vec());
                Some(SwashImage { content, placement, data, ..SwashImage::new() })
            }
            Err(Error::MissingModel(_)) => None,
            Err(error) => {
                if !std::mem::replace(&mut font.is_reported, true) {
                    report(&mut self.problems, key.font_id, error);
                }
                None
            }
        }
    }

    /// What is wrong with fonts whose glyphs were drawn: the first error of each, which is also logged as a warning.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// Forgets all fonts, with their decoded models and problems; they are found again. Images stay in the `SwashCache`.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    fn font(&mut self, fonts: &mut FontSystem, key: CacheKey) -> Option<&mut NeuralFont> {
        let id = key.font_id;
        let problems = &mut self.problems;
        let open = || match open(fonts, key)? {
            Ok(font) => Some(font),
            Err(Error::NotConverted) => None,
            Err(error) => {
                report(problems, id, error);
                None
            }
        };
        self.fonts.entry(id).or_insert_with(open).as_mut()
    }
}

fn report(problems: &mut Vec<Problem>, font: fontdb::ID, error: Error) {
    log::warn!("a font's models cannot be used, swash draws its glyphs: {error}");
    problems.push(Problem { font, error });
}

fn open(fonts: &mut FontSystem, key: CacheKey) -> Option<Result<NeuralFont, Error>> {
    let index = fonts.db().face(key.font_id)?.index;
    let data = Shared(fonts.get_font(key.font_id, key.font_weight)?);
    let font = Font::from_index(data, index);
    Some(font.map(|font| NeuralFont { rasterizer: Rasterizer::new(&font), index, is_reported: false }))
}

/// The size and the subpixel offset of a key; `None` where a model is not what is asked for.
fn draw_options(key: CacheKey) -> Option<DrawOptions> {
    if key.flags.intersects(CacheKeyFlags::FAKE_ITALIC | CacheKeyFlags::DISABLE_HINTING) {
        return None;
    }
    let whole = key.flags.contains(CacheKeyFlags::PIXEL_FONT);
    let offset =
        [key.x_bin, key.y_bin].map(|bin| if whole { bin.as_float().round() } else { bin.as_float() });
    Some(DrawOptions::new(f32::from_bits(key.font_size_bits)).with_offset(offset))
}

/// Whether a glyph has a picture or layers in colour, which are drawn in place of its outline (OpenType 1.9, `COLR`, `CBDT`,
/// `sbix`).
fn is_coloured(font: &Font, index: u32, glyph: u32) -> bool {
    let Ok(font) = FontRef::from_index(font.data(), index) else { return false };
    if font.cbdt().is_ok() || font.sbix().is_ok() {
        return true;
    }
    let Ok(colr) = font.colr() else { return false };
    colr.v0_base_glyph(glyph.into()).is_some() || colr.v1_base_glyph(glyph.into()).is_some()
}
