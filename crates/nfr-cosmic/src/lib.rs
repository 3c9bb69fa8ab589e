//! Grid-fitted text in [cosmic-text](https://crates.io/crates/cosmic-text): the glyphs of fonts that `nfr-convert` made are drawn from
//! their models, those of all other fonts by swash, as before.
//!
//! [`NeuralFonts`] is kept beside the `SwashCache`, and shares its cache of images. There are three ways to use it:
//!
//! - [`NeuralFonts::draw`] draws a buffer onto a [`Canvas`], in whole bitmaps.
//! - [`NeuralFonts::fill`] puts a buffer's images into the cache, from which `Buffer::draw` then takes them.
//! - [`NeuralFonts::renderer`] is a [`cosmic_text::Renderer`], for `Editor::render` and one's own loops.
//!
//! ```
//! use cosmic_text::{Attrs, Buffer, Color, Family, FontSystem, Metrics, Shaping, SwashCache};
//! use nfr_cosmic::{NeuralFonts, RgbaCanvas};
//!
//! # let font = include_bytes!("../../../spec/vectors/outline.ttf").to_vec();
//! let (mut fonts, mut cache) = (FontSystem::new(), SwashCache::new());
//! let mut neural = NeuralFonts::new();
//! fonts.db_mut().load_font_data(font);
//! let mut buffer = Buffer::new(&mut fonts, Metrics::new(14.0, 18.0));
//! let attrs = Attrs::new().family(Family::Name("Nfr Vectors Outline"));
//! buffer.set_text("mask", &attrs, Shaping::Advanced, None);
//!
//! let mut pixels = vec![255; 4 * 100 * 20];
//! let mut canvas = RgbaCanvas::new(&mut pixels, 100);
//! neural.draw(&mut buffer, &mut fonts, &mut cache, Color::rgb(0, 0, 0), &mut canvas);
//! # assert!(pixels.contains(&0));
//! ```

#![forbid(unsafe_code)]

mod canvas;
mod fonts;
mod renderer;

pub use canvas::{Canvas, Image, RgbaCanvas};
pub use fonts::{NeuralFonts, Problem};
pub use renderer::NeuralRenderer;
