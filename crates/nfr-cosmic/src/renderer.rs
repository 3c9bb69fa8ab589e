//! A renderer of cosmic-text.

use cosmic_text::{
    Buffer, CacheKey, Color, FontSystem, LayoutGlyph, PhysicalGlyph, Renderer, SubpixelBin, SwashCache,
    SwashContent, SwashImage, render_decoration,
};

use crate::canvas::{Canvas, Image};
use crate::fonts::NeuralFonts;

impl NeuralFonts {
    /// Draws a buffer onto a canvas: what `Buffer::draw` does, whole bitmaps at a time. Images are kept in `cache`.
    pub fn draw(
        &mut self,
        buffer: &mut Buffer,
        fonts: &mut FontSystem,
        cache: &mut SwashCache,
        color: Color,
        canvas: &mut impl Canvas,
    ) {
        buffer.shape_until_scroll(fonts, false);
        let mut renderer = self.renderer(fonts, cache, canvas);
        for run in buffer.layout_runs() {
            for glyph in run.glyphs {
                let color = glyph.color_opt.unwrap_or(color);
                renderer.glyph(physical(glyph, run.line_y), color);
            }
            render_decoration(&mut renderer, &run, color);
        }
    }

    /// A renderer of cosmic-text that draws onto a canvas.
    pub fn renderer<'r, C: Canvas>(
        &'r mut self,
        fonts: &'r mut FontSystem,
        cache: &'r mut SwashCache,
        canvas: &'r mut C,
    ) -> NeuralRenderer<'r, C> {
        NeuralRenderer { neural: self, fonts, cache, canvas }
    }
}

/// Draws glyphs and rectangles onto a canvas, glyphs with models from these and others by swash. Made by
/// [`NeuralFonts::renderer`].
#[derive(Debug)]
pub struct NeuralRenderer<'r, C> {
    neural: &'r mut NeuralFonts,
    fonts: &'r mut FontSystem,
    cache: &'r mut SwashCache,
    canvas: &'r mut C,
}

impl<C: Canvas> Renderer for NeuralRenderer<'_, C> {
    fn rectangle(&mut self, x: i32, y: i32, w: u32, h: u32, color: Color) {
        self.canvas.rectangle(x, y, w, h, color);
    }

    fn glyph(&mut self, glyph: PhysicalGlyph, color: Color) {
        let Self { neural, fonts, cache, canvas } = self;
        let key = glyph.cache_key;
        let image = match cache.image_cache.get(&key) {
            Some(image) => image,
            None => {
                let image = neural.image(fonts, key).or_else(|| cache.get_image_uncached(fonts, key));
                cache.image_cache.entry(key).or_insert(image)
            }
        };
        if let Some(image) = image {
            show(*canvas, &glyph, image, color);
        }
    }
}

/// `glyph.physical((0.0, line_y), 1.0)`, which calls functions of the mathematical library for each glyph: a tenth of the time in which a
/// page is drawn.
#[inline(always)]
fn physical(glyph: &LayoutGlyph, line_y: f32) -> PhysicalGlyph {
    let (x, x_bin) = SubpixelBin::new(glyph.x + glyph.font_size * glyph.x_offset);
    // Lines are at whole pixels: the fraction is cut off.
    let y = (glyph.y - glyph.font_size * glyph.y_offset + line_y) as i32;
    let cache_key = CacheKey {
        font_id: glyph.font_id,
        glyph_id: glyph.glyph_id,
        font_size_bits: glyph.font_size.to_bits(),
        x_bin,
        y_bin: SubpixelBin::Zero,
        font_weight: glyph.font_weight,
        flags: glyph.cache_key_flags,
    };
    PhysicalGlyph { cache_key, x, y }
}

fn show(canvas: &mut impl Canvas, glyph: &PhysicalGlyph, image: &SwashImage, color: Color) {
    if image.data.is_empty() {
        return;
    }
    let placement = image.placement;
    let (x, y) = (glyph.x.saturating_add(placement.left), glyph.y.saturating_sub(placement.top));
    let pixels = Image { width: placement.width, height: placement.height, data: &image.data };
    match image.content {
        SwashContent::Mask => canvas.mask(x, y, pixels, color),
        SwashContent::Color => canvas.picture(x, y, pixels),
        // cosmic-text never asks for it.
        SwashContent::SubpixelMask => {}
    }
}

#[cfg(test)]
mod tests {
    use cosmic_text::{Attrs, Family, Metrics, Shaping};
    use proptest::prelude::*;

    use super::*;

    fn a_glyph() -> LayoutGlyph {
        let mut fonts = FontSystem::new();
        fonts.db_mut().load_font_data(include_bytes!("../../../spec/vectors/outline.ttf").to_vec());
        let mut buffer = Buffer::new(&mut fonts, Metrics::new(14.0, 18.0));
        let attrs = Attrs::new().family(Family::Name("Nfr Vectors Outline"));
        buffer.set_text("a", &attrs, Shaping::Advanced, None);
        buffer.shape_until_scroll(&mut fonts, false);
        buffer.layout_runs().next().and_then(|run| run.glyphs.first()).expect("a glyph").clone()
    }

    #[test]
    fn glyphs_stand_where_cosmic_text_puts_them() {
        let glyph = a_glyph();
        let numbers = || prop_oneof![-50f32..50.0, (-40i32..40).prop_map(|eighths| eighths as f32 / 8.0)];
        let places = [numbers(), numbers(), numbers(), numbers(), numbers()];
        proptest!(|([x, y, x_offset, y_offset, line_y] in places, font_size in 1f32..100.0)| {
            let glyph = LayoutGlyph { x, y, x_offset, y_offset, font_size, ..glyph.clone() };
            let (ours, theirs) = (physical(&glyph, line_y), glyph.physical((0.0, line_y), 1.0));
            prop_assert_eq!((ours.cache_key, ours.x, ours.y), (theirs.cache_key, theirs.x, theirs.y));
        });
    }
}
