//! A renderer of cosmic-text.

use cosmic_text::{
    Buffer, Color, FontSystem, PhysicalGlyph, Renderer, SwashCache, SwashContent, SwashImage,
    render_decoration,
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
                renderer.glyph(glyph.physical((0.0, run.line_y), 1.0), color);
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

fn show(canvas: &mut impl Canvas, glyph: &PhysicalGlyph, image: &SwashImage, color: Color) {
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
