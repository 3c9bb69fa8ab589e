//! A renderer of cosmic-text.

use cosmic_text::{Color, FontSystem, PhysicalGlyph, SwashCache, SwashContent, SwashImage};

use crate::canvas::{Canvas, Image};
use crate::fonts::NeuralFonts;

/// Draws glyphs and rectangles onto a canvas, glyphs with models from these and others by swash. Made by
/// [`NeuralFonts::renderer`].
#[derive(Debug)]
pub struct NeuralRenderer<'r, C> {
    neural: &'r mut NeuralFonts,
    fonts: &'r mut FontSystem,
    cache: &'r mut SwashCache,
    canvas: &'r mut C,
}

impl<'r, C: Canvas> NeuralRenderer<'r, C> {
    pub(crate) fn new(
        neural: &'r mut NeuralFonts,
        fonts: &'r mut FontSystem,
        cache: &'r mut SwashCache,
        canvas: &'r mut C,
    ) -> Self {
        Self { neural, fonts, cache, canvas }
    }
}

impl<C: Canvas> cosmic_text::Renderer for NeuralRenderer<'_, C> {
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
