//! Drawing one font's glyphs as egui wants them.

use std::sync::{Mutex, MutexGuard, PoisonError};

use egui::{Color32, ColorImage, GlyphBitmap, GlyphRasterizerRequest, RasterizedGlyph, vec2};
use nfr::{Bitmap, DrawOptions, Error, Font, Limits, Placement, Rasterizer};

use crate::cluster;

/// A font and what it is drawn with.
#[derive(Debug)]
pub(crate) struct Drawing {
    font: Font,
    rasterizer: Mutex<Rasterizer>,
    error: Mutex<Option<Error>>,
}

impl Drawing {
    pub(crate) fn new(font: &Font) -> Self {
        Self { font: font.clone(), rasterizer: Mutex::new(rasterizer(font)), error: Mutex::new(None) }
    }

    pub(crate) fn font(&self) -> &Font {
        &self.font
    }

    /// Whether this is the same font, opened from the same bytes. The fonts of a collection share their bytes, and count as different.
    pub(crate) fn is_of(&self, font: &Font) -> bool {
        std::ptr::eq(self.font.data(), font.data()) && !font.data().starts_with(b"ttcf")
    }

    /// The last error of a damaged model.
    pub(crate) fn last_error(&self) -> Option<Error> {
        *self.error.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Draws a cluster; `None` leaves it to egui's fonts.
    pub(crate) fn draw(&self, request: &GlyphRasterizerRequest<'_>) -> Option<RasterizedGlyph> {
        let glyph = cluster::glyph(&self.font, request.cluster)?;
        let drawn = bitmap_and_advance(&mut self.lock(), glyph, request);
        match drawn {
            Ok((bitmap, advance_px)) => Some(RasterizedGlyph { bitmap: converted(&bitmap), advance_px }),
            Err(error) => {
                if is_damage(&error) {
                    self.report(error);
                }
                None
            }
        }
    }

    /// The rasterizer; a new one if another thread panicked while it drew.
    fn lock(&self) -> MutexGuard<'_, Rasterizer> {
        self.rasterizer.lock().unwrap_or_else(|poisoned| {
            self.rasterizer.clear_poison();
            let mut guard = poisoned.into_inner();
            *guard = rasterizer(&self.font);
            guard
        })
    }

    /// Keeps an error, and logs the first one.
    fn report(&self, error: Error) {
        let before = self.error.lock().unwrap_or_else(PoisonError::into_inner).replace(error);
        if before.is_none() {
            log::warn!("nfr: {error}; egui's own font draws it");
        }
    }
}

/// A glyph and its hinted advance width. egui rounds each glyph's position to a whole pixel: hinted widths, which are whole, keep the
/// distances between letters even; linear ones let them touch and gap.
fn bitmap_and_advance(
    rasterizer: &mut Rasterizer,
    glyph: u32,
    request: &GlyphRasterizerRequest<'_>,
) -> Result<(Bitmap, f32), Error> {
    let (ppem, offset) = (request.font_size_px, request.subpixel_offset_px);
    let mut drawn = |offset| rasterizer.render(glyph, DrawOptions::new(ppem).with_offset([offset, 0.0]));
    let mut bitmap = drawn(offset)?;
    if offset == 0.0 {
        let shifted = drawn(HALF_LEFT)?;
        if greyness(&shifted) * 4 < greyness(&bitmap) * 3 {
            bitmap = shifted;
        }
    }
    Ok((bitmap, rasterizer.hinted_advance(glyph, ppem)?))
}

/// Hints centre a stem in its advance width, which is narrow for i and l: at 9 pixels per em the stem covers two pixels by half, and
/// "ill" is a grey block. Such a glyph is drawn half a pixel further left, if that takes off a quarter of its [`greyness`]. It is also
/// where one-bit rasterizers draw it: a pixel whose centre is on the left edge of a stem is set, and one on the right edge is not.
const HALF_LEFT: f32 = -0.5;

/// How far the pixels are from being covered or not.
fn greyness(bitmap: &Bitmap) -> u64 {
    bitmap.pixels.iter().map(|coverage| u64::from(*coverage) * u64::from(255 - coverage)).sum()
}

/// A rasterizer that draws nothing that egui would not take.
fn rasterizer(font: &Font) -> Rasterizer {
    let mut limits = Limits::default();
    limits.bitmap_side = egui::MAX_GLYPH_SIZE.try_into().unwrap_or(limits.bitmap_side);
    Rasterizer::new(font).with_limits(limits)
}

/// Whether an error tells that something is wrong with the font, and not only that it does not draw this glyph at this size.
fn is_damage(error: &Error) -> bool {
    !matches!(
        error,
        Error::MissingModel(_)
            | Error::NoSuchGlyph(_)
            | Error::InvalidSize(_)
            | Error::InvalidOffset(_)
            | Error::BitmapTooLarge { .. }
            | Error::NetworkSize { .. }
            | Error::NetworkOffset { .. }
            | Error::NetworkSubpixels(_)
    )
}

/// White pixels with the coverage as alpha.
fn converted(bitmap: &Bitmap) -> GlyphBitmap {
    let Placement { left, top, width, height } = bitmap.placement;
    let image = if bitmap.pixels.is_empty() {
        // egui takes an empty image for "not drawn". A space would then have the width that it has in another font, a fraction of a
        // pixel with it, and the gaps between words would be uneven.
        ColorImage::filled([1, 1], Color32::TRANSPARENT)
    } else {
        let pixels = bitmap.pixels.iter().map(|coverage| Color32::from_white_alpha(*coverage)).collect();
        ColorImage::new([width as usize, height as usize], pixels)
    };
    GlyphBitmap { image, offset_px: vec2(left as f32, -top as f32), is_color: false }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use egui::FontFamily;

    use super::*;

    fn bytes() -> Vec<u8> {
        std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../spec/vectors/sans.ttf")).unwrap()
    }

    fn pixels(drawing: &Drawing, cluster: &str) -> Option<Vec<Color32>> {
        let family = &FontFamily::Proportional;
        let request = GlyphRasterizerRequest { cluster, family, font_size_px: 12.0, subpixel_offset_px: 0.0 };
        drawing.draw(&request).map(|glyph| glyph.bitmap.image.pixels)
    }

    #[test]
    fn after_a_panic_of_another_thread_glyphs_are_drawn_as_before() {
        let drawing = Drawing::new(&Font::new(bytes()).unwrap());
        let before = pixels(&drawing, "M").unwrap();
        let panicked = std::thread::scope(|scope| {
            let hold = || {
                let _guard = drawing.rasterizer.lock();
                std::panic::resume_unwind(Box::new(()));
            };
            scope.spawn(hold).join()
        });
        assert!(panicked.is_err() && drawing.rasterizer.is_poisoned());
        assert_eq!(pixels(&drawing, "M"), Some(before));
        assert!(!drawing.rasterizer.is_poisoned());
    }

    static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

    struct Log;

    impl log::Log for Log {
        fn enabled(&self, _: &log::Metadata<'_>) -> bool {
            true
        }

        fn log(&self, record: &log::Record<'_>) {
            if record.level() == log::Level::Warn {
                MESSAGES.lock().unwrap().push(record.args().to_string());
            }
        }

        fn flush(&self) {}
    }

    #[test]
    fn only_the_first_error_of_a_font_is_logged() {
        log::set_logger(&Log).unwrap();
        log::set_max_level(log::LevelFilter::Warn);
        let drawing = Drawing::new(&Font::new(bytes()).unwrap());
        drawing.report(Error::StaleModel(7));
        drawing.report(Error::StaleModel(8));
        assert_eq!(drawing.last_error(), Some(Error::StaleModel(8)));
        let messages = MESSAGES.lock().unwrap();
        assert!(matches!(messages.as_slice(), [one] if one.contains("glyph 7")), "{messages:?}");
    }

    #[test]
    fn only_one_opening_of_a_file_is_the_same_font() {
        let font = Font::new(bytes()).unwrap();
        let drawing = Drawing::new(&font);
        assert!(drawing.is_of(&font.clone()));
        assert!(!drawing.is_of(&Font::new(bytes()).unwrap()));
    }
}
