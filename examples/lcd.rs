//! Draws a line of text for an LCD panel, with each filter, on white and on black, and blends it in both ways that there are:
//! `cargo run --release --example lcd -- FONT OUT.png [TEXT [PPEM]]`.
//!
//! From top to bottom: grey coverage, then subpixels shifted, light, of five subpixels, and unfiltered. On the left the values of the
//! screen are blended as they are, on the right the light that they stand for. Look at the picture on an LCD panel whose
//! subpixels are red, green, blue from left to right, without any scaling.

use std::error::Error;

use image::{Rgb, RgbImage};
use nfr::{DrawOptions, Font, Lcd, LcdBitmap, LcdFilter, MissingModel, Rasterizer, SubpixelOrder};

/// What is drawn with: grey, or a filter.
const FILTERS: [Option<LcdFilter>; 5] = [
    None,
    Some(LcdFilter::Shifted),
    Some(LcdFilter::Light),
    Some(LcdFilter::Fir5),
    Some(LcdFilter::Unfiltered),
];

/// A channel of the ground behind a channel of the text, blended as the screen's values are.
fn as_values(ground: u8, text: u8, coverage: u8) -> u8 {
    let [ground, text, coverage] = [ground, text, coverage].map(i32::from);
    (ground + ((text - ground) * coverage + 127) / 255) as u8
}

/// The same, blended as light is. sRGB values stand for light to the power of 2.2, roughly.
fn as_light(ground: u8, text: u8, coverage: u8) -> u8 {
    let [from, to] = [ground, text].map(|value| (f32::from(value) / 255.0).powf(2.2));
    let light = from + (to - from) * f32::from(coverage) / 255.0;
    (light.powf(1.0 / 2.2) * 255.0).round() as u8
}

/// A way of blending a channel.
type Blend = fn(ground: u8, text: u8, coverage: u8) -> u8;

/// What a line of text is drawn with.
struct Line<'a> {
    rasterizer: Rasterizer,
    text: &'a str,
    ppem: f32,
}

impl Line<'_> {
    /// A glyph's coverage of red, green and blue.
    fn glyph(&mut self, glyph: u32, offset: f32, filter: Option<LcdFilter>) -> Result<LcdBitmap, nfr::Error> {
        let options = DrawOptions::new(self.ppem).with_offset([offset, 0.0]);
        let Some(filter) = filter else {
            let grey = self.rasterizer.render(glyph, options)?;
            let pixels = grey.pixels.into_iter().map(|level| [level; 3]).collect();
            return Ok(LcdBitmap { placement: grey.placement, pixels });
        };
        self.rasterizer.render_lcd(glyph, options, Lcd::new(SubpixelOrder::Rgb).with_filter(filter))
    }

    /// Draws the line with its origin at a position, in a colour.
    fn draw(
        &mut self,
        image: &mut RgbImage,
        [mut x, y]: [f32; 2],
        filter: Option<LcdFilter>,
        (colour, blend): ([u8; 3], Blend),
    ) -> Result<(), nfr::Error> {
        for character in self.text.chars() {
            let font = self.rasterizer.font();
            let Some(glyph) = font.glyph_for_char(character) else { continue };
            let advance = font.advance(glyph, self.ppem);
            // Steps of a quarter pixel are as fine as anybody sees, and leave four bitmaps a glyph to keep.
            let whole = ((x * 4.0).round() / 4.0).floor();
            let bitmap = self.glyph(glyph, (x * 4.0).round() / 4.0 - whole, filter)?;
            let place = bitmap.placement;
            for (row, pixels) in bitmap.rows().enumerate() {
                for (column, coverage) in pixels.iter().enumerate() {
                    let at = [whole as i32 + place.left + column as i32, y as i32 - place.top + row as i32];
                    let [Ok(column), Ok(row)] = at.map(u32::try_from) else { continue };
                    if let Some(Rgb(pixel)) = image.get_pixel_mut_checked(column, row) {
                        *pixel = [0, 1, 2].map(|k| blend(pixel[k], colour[k], coverage[k]));
                    }
                }
            }
            x += advance;
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [font, out, rest @ ..] = args.as_slice() else {
        return Err("usage: lcd FONT OUT.png [TEXT [PPEM]]".into());
    };
    let font = Font::new(std::fs::read(font)?)?;
    let text = rest.first().map_or("Sphinx of black quartz, judge my vow", String::as_str);
    let ppem: f32 = rest.get(1).map_or(Ok(14.0), |ppem| ppem.parse())?;
    let rasterizer = Rasterizer::new(&font).with_missing_model(MissingModel::Outline);
    let mut line = Line { rasterizer, text, ppem };
    let metrics = font.line_metrics(ppem);
    let height = (metrics.ascent - metrics.descent).ceil() + 6.0;
    let advance = |c| font.glyph_for_char(c).map_or(0.0, |glyph| font.advance(glyph, ppem));
    let width = text.chars().map(advance).sum::<f32>().ceil() + 20.0;
    let grounds = [([255; 3], [0; 3]), ([0; 3], [255; 3])];
    let lines = (FILTERS.len() * grounds.len()) as f32;
    let mut image = RgbImage::new(2 * width as u32, (lines * height) as u32);
    for (half, (ground, colour)) in grounds.into_iter().enumerate() {
        for (row, filter) in FILTERS.into_iter().enumerate() {
            let top = (half * FILTERS.len() + row) as f32 * height;
            (0..height as u32).flat_map(|y| (0..2 * width as u32).map(move |x| (x, y))).for_each(|(x, y)| {
                image.put_pixel(x, top as u32 + y, Rgb(ground));
            });
            let blends: [Blend; 2] = [as_values, as_light];
            for (column, blend) in blends.into_iter().enumerate() {
                let origin = [column as f32 * width + 10.0, (top + 3.0 + metrics.ascent).round()];
                line.draw(&mut image, origin, filter, (colour, blend))?;
            }
        }
    }
    image.save(out)?;
    Ok(())
}
