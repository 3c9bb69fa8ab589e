//! Drawing the three subpixels of each pixel: the glyph is drawn three times, or once with three samples a pixel, which are
//! filtered.

use alloc::vec::Vec;

use super::rasterizer::Rasterizer;
use crate::bitmap::Canvas;
use crate::error::Error;
use crate::lcd::{Lcd, LcdBitmap, LcdBitmapRef, SUBPIXELS};
use crate::options::DrawOptions;
use crate::placement::{Placement, union};

impl Rasterizer {
    /// Draws coverage of red, green and blue into a buffer of the rasterizer's own, and lends it until the next drawing.
    ///
    /// A channel is blended by its own coverage, as `red += (colour.red - red) * coverage[0] / 255`. The repository's
    /// `docs/lcd.md` says which values to blend, those of the screen or those of light; the example `lcd` does both. Fonts that
    /// are converted with `--target lcd` have the hints for subpixels.
    ///
    /// ```
    /// # let font = nfr::Font::new(include_bytes!("../../spec/vectors/outline.ttf").as_slice())?;
    /// let mut rasterizer = nfr::Rasterizer::new(&font);
    /// let glyph = font.glyph_for_char('g').unwrap_or(0);
    /// let bitmap = rasterizer.draw_lcd(glyph, 16.0, nfr::Lcd::default())?;
    /// for [red, green, blue] in bitmap.rows().next().unwrap_or_default() {
    ///     println!("{red} {green} {blue}");
    /// }
    /// # Ok::<(), nfr::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Rasterizer`] lists them, and `NetworkSubpixels` for a glyph that a network draws. Where subpixels are filtered,
    /// [`Limits::bitmap_side`](crate::Limits::bitmap_side) counts them.
    pub fn draw_lcd(
        &mut self,
        glyph: u32,
        options: impl Into<DrawOptions>,
        lcd: Lcd,
    ) -> Result<LcdBitmapRef<'_>, Error> {
        let options = options.into();
        let mut pixels = core::mem::take(&mut self.scratch.lcd);
        let drawn = match lcd.weights() {
            None => self.draw_shifted(glyph, options, lcd, &mut pixels),
            Some(weights) => self.draw_filtered(glyph, options, lcd, weights, &mut pixels),
        };
        self.scratch.lcd = pixels;
        let placement = drawn?;
        Ok(LcdBitmapRef::new(placement, &self.scratch.lcd[..placement.area()]))
    }

    /// Draws coverage of red, green and blue into a new bitmap.
    ///
    /// # Errors
    ///
    /// As [`Self::draw_lcd`].
    pub fn render_lcd(
        &mut self,
        glyph: u32,
        options: impl Into<DrawOptions>,
        lcd: Lcd,
    ) -> Result<LcdBitmap, Error> {
        self.draw_lcd(glyph, options, lcd).map(LcdBitmap::from)
    }

    /// The glyph is drawn for each subpixel.
    fn draw_shifted(
        &mut self,
        glyph: u32,
        options: DrawOptions,
        lcd: Lcd,
        pixels: &mut Vec<[u8; 3]>,
    ) -> Result<Placement, Error> {
        let moved = |subpixel: usize| DrawOptions { sampling: lcd.shifted(subpixel), ..options };
        let mut whole = Placement::default();
        for subpixel in 0..SUBPIXELS {
            whole = union(whole, self.placement(glyph, moved(subpixel))?);
        }
        pixels.clear();
        pixels.resize(whole.area(), [0; 3]);
        for subpixel in 0..SUBPIXELS {
            let placement = self.draw_samples(glyph, moved(subpixel))?;
            let channel = lcd.channel(subpixel);
            let (left, top) = (placement.left.abs_diff(whole.left), placement.top.abs_diff(whole.top));
            let rows = pixels.chunks_mut(whole.width.max(1) as usize).skip(top as usize);
            let drawn = self.scratch.subpixels.chunks(placement.width.max(1) as usize);
            for (row, drawn) in rows.zip(drawn.take(placement.height as usize)) {
                row[left as usize..].iter_mut().zip(drawn).for_each(|(pixel, level)| pixel[channel] = *level);
            }
        }
        Ok(whole)
    }

    /// The glyph is drawn once, with three samples a pixel, and each subpixel is the weighed mean of samples around it, as in
    /// FreeType's `ft_lcd_filter_fir`.
    fn draw_filtered(
        &mut self,
        glyph: u32,
        options: DrawOptions,
        lcd: Lcd,
        weights: [u32; 3],
        pixels: &mut Vec<[u8; 3]>,
    ) -> Result<Placement, Error> {
        let samples = self.draw_samples(glyph, DrawOptions { sampling: lcd.stretched(), ..options })?;
        pixels.clear();
        if samples.area() == 0 {
            return Ok(Placement::default());
        }
        let reach = weights[1..].iter().filter(|weight| **weight > 0).count() as i32;
        let (placement, before) = pixels_of(samples, lcd.is_vertical(), reach);
        pixels.resize(placement.area(), [0; 3]);
        let (width, stride) = (placement.width as usize, samples.width as usize);
        let (step, length) = if lcd.is_vertical() { (stride, samples.height) } else { (1, samples.width) };
        for (at, pixel) in pixels.iter_mut().enumerate() {
            let (column, row) = (at % width, at / width);
            let (first, along) = if lcd.is_vertical() { (column, row) } else { (row * stride, column) };
            for subpixel in 0..SUBPIXELS {
                let middle = (along * SUBPIXELS + subpixel) as i32 - before;
                let sample = |k: i32| match u32::try_from(k) {
                    Ok(k) if k < length => u32::from(self.scratch.subpixels[first + k as usize * step]),
                    _ => 0,
                };
                let sides =
                    (1..=reach).map(|k| weights[k as usize] * (sample(middle - k) + sample(middle + k)));
                let sum = weights[0] * sample(middle) + sides.sum::<u32>();
                pixel[lcd.channel(subpixel)] = (sum >> 8).min(255) as u8;
            }
        }
        Ok(placement)
    }

    /// Draws into the buffer for subpixels.
    fn draw_samples(&mut self, glyph: u32, options: DrawOptions) -> Result<Placement, Error> {
        let mut samples = core::mem::take(&mut self.scratch.subpixels);
        let drawn = self.draw_with(glyph, options, |placement| {
            samples.clear();
            samples.resize(placement.area(), 0);
            Canvas::new(placement, &mut samples, placement.width as usize).map(Some)
        });
        self.scratch.subpixels = samples;
        drawn.map(Option::unwrap_or_default)
    }
}

/// The pixels that hold all samples and `reach` samples more on either side, and how many samples they begin before those.
fn pixels_of(samples: Placement, is_vertical: bool, reach: i32) -> (Placement, i32) {
    let (start, length) =
        if is_vertical { (-samples.top, samples.height) } else { (samples.left, samples.width) };
    let three = SUBPIXELS as i32;
    let first = (start - reach).div_euclid(three);
    let end = (start + length as i32 + reach + three - 1).div_euclid(three);
    let placement = if is_vertical {
        Placement { top: -first, height: end.abs_diff(first), ..samples }
    } else {
        Placement { left: first, width: end.abs_diff(first), ..samples }
    };
    (placement, start - first * three)
}
