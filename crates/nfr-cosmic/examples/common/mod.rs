//! Texts that are laid out, and drawing them in two ways.
#![allow(dead_code, reason = "each example uses a part of it")]

use std::error::Error;
use std::time::Instant;

use cosmic_text::{
    Attrs, Buffer, CacheKey, CacheKeyFlags, Color, Family, FontSystem, Metrics, Shaping, SwashCache, fontdb,
};
use image::RgbaImage;
use nfr_convert::closure::{LayoutFeatures, close};
use nfr_convert::select::Selection;
use nfr_convert::{Options, Progress, convert};
use nfr_cosmic::{NeuralFonts, RgbaCanvas};
use read_fonts::FontRef;

const BLACK: Color = Color::rgb(0, 0, 0);

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// A font of the repository.
pub(crate) fn font(name: &str) -> Result<Vec<u8>, Box<dyn Error>> {
    let path = format!("{}/../../fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR"));
    Ok(std::fs::read(path)?)
}

/// Models of a text's glyphs.
pub(crate) fn converted(font: &[u8], text: &str) -> Result<Vec<u8>, Box<dyn Error>> {
    let parsed = FontRef::new(font)?;
    let selection = Selection { text: Some(text.into()), ..Default::default() };
    let gids = [selection.resolve(&parsed, [])?.gids, selection.shaped_glyphs(&parsed)?].concat();
    let gids = close(&parsed, &gids, &LayoutFeatures::default())?;
    Ok(convert(font, &Options { gids, ..Options::default() }, &Silent)?.font)
}

/// The median of some passes in seconds.
pub(crate) fn median_time(passes: usize, mut pass: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..passes)
        .map(|_| {
            let start = Instant::now();
            pass();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[passes / 2]
}

/// Who draws.
#[derive(Clone, Copy)]
pub(crate) enum Drawing {
    /// [`NeuralFonts::draw`].
    Models,
    /// `Buffer::draw`, which gives one pixel after the other.
    Swash,
}

/// Texts that are shaped and laid out, one below the other.
pub(crate) struct Setting {
    fonts: FontSystem,
    width: u32,
    buffers: Vec<(Buffer, u32)>,
    height: u32,
}

impl Setting {
    /// A column, with these fonts and no others; the first is that of the text.
    pub(crate) fn new(fonts: impl Iterator<Item = Vec<u8>>, width: u32) -> Self {
        let mut db = fontdb::Database::new();
        fonts.for_each(|font| db.load_font_data(font));
        Self {
            fonts: FontSystem::new_with_locale_and_db("en".into(), db),
            width,
            buffers: Vec::new(),
            height: 0,
        }
    }

    /// Adds a text at several sizes.
    pub(crate) fn add(&mut self, text: &str, sizes: &[f32], flags: CacheKeyFlags) {
        for size in sizes {
            let mut buffer = Buffer::new(&mut self.fonts, Metrics::new(*size, (size * 1.3).round()));
            buffer.set_size(Some(self.width as f32), None);
            let attrs = Attrs::new().family(Family::Name("Liberation Sans")).cache_key_flags(flags);
            buffer.set_text(text, &attrs, Shaping::Advanced, None);
            buffer.shape_until_scroll(&mut self.fonts, false);
            let height = buffer.layout_runs().map(|run| run.line_height).sum::<f32>() as u32;
            self.buffers.push((buffer, self.height));
            self.height += height + 8;
        }
    }

    pub(crate) fn height(&self) -> u32 {
        self.height
    }

    /// The keys of all glyphs.
    pub(crate) fn keys(&self) -> impl Iterator<Item = CacheKey> {
        let runs = self.buffers.iter().flat_map(|(buffer, _)| buffer.layout_runs());
        runs.flat_map(|run| run.glyphs.iter().map(|glyph| glyph.physical((0.0, 0.0), 1.0).cache_key))
    }

    /// The number of glyphs.
    pub(crate) fn glyphs(&self) -> usize {
        self.keys().count()
    }

    /// Draws everything in black.
    pub(crate) fn draw(
        &mut self,
        drawing: Drawing,
        picture: &mut RgbaImage,
        [left, top]: [i32; 2],
        (neural, cache): &mut (NeuralFonts, SwashCache),
    ) {
        let width = picture.width();
        for (buffer, down) in &mut self.buffers {
            let top = top + *down as i32;
            match drawing {
                Drawing::Models => {
                    let mut canvas = RgbaCanvas::new(picture, width).with_origin(left, top);
                    neural.draw(buffer, &mut self.fonts, cache, BLACK, &mut canvas);
                }
                // A callback gets pixels and the rectangles of underlines alike.
                Drawing::Swash => buffer.draw(&mut self.fonts, cache, BLACK, |x, y, columns, rows, color| {
                    for y in (0..rows).map(|row| row.wrapping_add_signed(top + y)) {
                        for x in (0..columns).map(|column| column.wrapping_add_signed(left + x)) {
                            if let Some(pixel) = picture.get_pixel_mut_checked(x, y) {
                                blend(&mut pixel.0, color);
                            }
                        }
                    }
                }),
            }
        }
    }
}

/// Blends a colour with an opaque pixel.
fn blend(pixel: &mut [u8; 4], color: Color) {
    let [source @ .., alpha] = color.as_rgba();
    let alpha = u32::from(alpha);
    for (below, above) in pixel.iter_mut().zip(source) {
        let sum = u32::from(above) * alpha + u32::from(*below) * (255 - alpha) + 128;
        *below = ((sum + (sum >> 8)) >> 8) as u8;
    }
}
