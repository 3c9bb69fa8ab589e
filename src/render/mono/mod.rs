//! Drawing in black and white, with drop-out control.

mod grid;
pub(super) mod paint;
mod profiles;
mod sweep;

#[cfg(any(feature = "fields", feature = "networks"))]
use alloc::vec::Vec;

use self::paint::Mono;
use super::outline::plain_model;
use super::rasterizer::{Rasterizer, Source};
#[cfg(any(feature = "fields", feature = "networks"))]
use crate::bitmap::Canvas;
use crate::error::Error;
use crate::model::sizes::HintedSize;
use crate::mono::{MonoBitmap, MonoBitmapRef};
use crate::number::round;
use crate::options::DrawOptions;
use crate::placement::Placement;
use crate::table::Dropout;

/// The least coverage of a pixel that is black where a glyph has no outline.
#[cfg(any(feature = "fields", feature = "networks"))]
const HALF: u8 = 128;

impl Rasterizer {
    /// Draws a glyph in black and white into a buffer of the rasterizer's own, and lends it until the next drawing.
    ///
    /// A pixel is black if its centre is inside the outline, and drop-out control fills the gaps that thin strokes would have. The
    /// box and all pixels are those of FreeType's `FT_RENDER_MODE_MONO` for the same points. Fonts that are converted with `--target
    /// mono` have the hints for it, and know which mode of drop-out control the hints ask for at each size. Where nothing is known,
    /// as for other targets, for sizes without models and for outlines without hints, gaps are filled except at the ends of strokes,
    /// which is FreeType's default, too.
    ///
    /// A subpixel offset is rounded to 1/64 pixel. Glyphs that a field or a network draws have no outline; their pixels are black
    /// from half coverage on.
    ///
    /// ```
    /// # let font = nfr::Font::new(include_bytes!("../../../spec/vectors/outline.ttf").as_slice())?;
    /// let mut rasterizer = nfr::Rasterizer::new(&font);
    /// let glyph = font.glyph_for_char('g').unwrap_or(0);
    /// for row in rasterizer.draw_mono(glyph, 11.0)?.rows() {
    ///     println!("{:08b}", row[0]);
    /// }
    /// # Ok::<(), nfr::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Rasterizer`] lists them.
    pub fn draw_mono(
        &mut self,
        glyph: u32,
        options: impl Into<DrawOptions>,
    ) -> Result<MonoBitmapRef<'_>, Error> {
        let mut mono = core::mem::take(&mut self.mono);
        let drawn = self.draw_bits(glyph, options.into(), &mut mono);
        self.mono = mono;
        Ok(MonoBitmapRef::new(drawn?, &self.mono.bits))
    }

    /// Draws a glyph in black and white into a new bitmap.
    ///
    /// # Errors
    ///
    /// As [`Self::draw_mono`].
    pub fn render_mono(&mut self, glyph: u32, options: impl Into<DrawOptions>) -> Result<MonoBitmap, Error> {
        self.draw_mono(glyph, options).map(MonoBitmap::from)
    }

    fn draw_bits(&mut self, glyph: u32, options: DrawOptions, mono: &mut Mono) -> Result<Placement, Error> {
        mono.outline.clear();
        mono.bits.clear();
        let size = match self.source(glyph, options)? {
            Source::Model(entry) => {
                let options = options.checked()?;
                match entry.glyph().outline_at(options, &mut mono.outline, &mut mono.points)? {
                    Some(size) => size,
                    #[cfg(any(feature = "fields", feature = "networks"))]
                    None => return self.threshold(glyph, options, &mut mono.bits),
                    #[cfg(not(any(feature = "fields", feature = "networks")))]
                    None => return Ok(Placement::default()),
                }
            }
            Source::Blank => {
                options.checked()?;
                return Ok(Placement::default());
            }
            Source::Plain => {
                let options = options.checked()?;
                let size = HintedSize::plain(options.ppem());
                let model = plain_model(self.font(), glyph)?;
                mono.outline.add(&model, &size, [0; 2], &mut mono.points)?;
                size
            }
        };
        let mode = self.dropout(glyph, &size);
        let offset = options.offset().map(|offset| round(offset * 64.0));
        mono.draw(size.trained_ppem, mode, offset, glyph, self.limits())
    }

    /// What hints ask of drop-out control, or else FreeType's default.
    fn dropout(&self, glyph: u32, size: &HintedSize) -> Dropout {
        let modes = self.font().table().ok().and_then(|table| table.dropout());
        let asked = modes.filter(|_| size.strength > 0.0).and_then(|modes| {
            let ppem = self.font().scale().ppem_of(size.index);
            modes.mode(glyph, ppem as u16)
        });
        asked.unwrap_or(Dropout::new(false, false))
    }

    /// Draws coverage, and makes what is covered by half or more black.
    #[cfg(any(feature = "fields", feature = "networks"))]
    fn threshold(
        &mut self,
        glyph: u32,
        options: DrawOptions,
        bits: &mut Vec<u8>,
    ) -> Result<Placement, Error> {
        let mut samples = core::mem::take(&mut self.scratch.subpixels);
        let drawn = self.draw_with(glyph, options, |placement| {
            samples.clear();
            samples.resize(placement.area(), 0);
            Canvas::new(placement, &mut samples, placement.width as usize).map(Some)
        });
        if let Ok(Some(placement)) = drawn {
            for row in samples.chunks(placement.width.max(1) as usize).take(placement.height as usize) {
                bits.extend(row.chunks(8).map(|eight| {
                    let set = |(at, level): (usize, &u8)| if *level >= HALF { 0x80 >> at } else { 0 };
                    eight.iter().enumerate().map(set).sum::<u8>()
                }));
            }
        }
        self.scratch.subpixels = samples;
        drawn.map(Option::unwrap_or_default)
    }
}
