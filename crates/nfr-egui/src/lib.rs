//! Crisp small text in [egui]: one call lets an [`nfr::Font`] draw the glyphs of a font family.
//!
//! ```no_run
//! # fn glue(ctx: &egui::Context) -> Result<(), Box<dyn std::error::Error>> {
//! let font = nfr::Font::new(std::fs::read("sans.nfr.ttf")?)?;
//! let sans = nfr_egui::install(ctx, egui::FontFamily::Proportional, &font);
//! // Later, if it matters: whether a glyph's model was damaged.
//! if let Some(error) = sans.last_error() {
//!     eprintln!("{error}");
//! }
//! # Ok(())
//! # }
//! ```
//!
//! It is egui's own hook, [`egui::Context::add_glyph_rasterizer`]. Whatever the font cannot draw is left to egui's fonts: characters
//! that it lacks or has no model of, damaged models, text that has to be shaped. Lines are as high as those of egui's font
//! of the family, so that egui should have the same file first in it (see the crate's README).

#![forbid(unsafe_code)]

mod cluster;
mod drawing;
mod install;

pub use install::{Installed, install, remove};

/// Sets [`egui::epaint::FontColorTransferFunction::Off`] in both themes, so that a pixel of the atlas is the coverage that the font gives.
///
/// egui has it in its light theme anyway. Its dark theme makes partly covered pixels lighter, because blending in sRGB makes light text
/// on a dark ground look thin; that holds for the glyphs of every rasterizer. So this is for applications that blend in linear
/// light, or compare pixels. It changes the text of all fonts.
pub fn exact_coverage(ctx: &egui::Context) {
    ctx.all_styles_mut(|style| {
        style.visuals.text_options.color_transfer_function = egui::epaint::FontColorTransferFunction::Off;
    });
}

/// Runs the example of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
