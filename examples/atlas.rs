//! Packs glyphs into a texture atlas as a toolkit does, one call a glyph, and writes it as a portable graymap:
//! `cargo run --example atlas -- FONT OUT.pgm [TEXT [PPEM]]`.

#![allow(clippy::print_stdout)]

use std::error::Error;

use nfr::{DrawOptions, Font, MissingModel, Placement, Rasterizer};

/// One byte a pixel.
struct Atlas {
    pixels: Vec<u8>,
    width: usize,
    /// The next free column in the current row of glyphs, the row's top, and its height.
    next: usize,
    top: usize,
    height: usize,
}

impl Atlas {
    /// Room for a bitmap, with a free pixel to the right of it and below. `None` if the atlas is full.
    fn room(&mut self, placement: Placement) -> Option<(&mut [u8], usize)> {
        let (width, height) = (placement.width as usize + 1, placement.height as usize + 1);
        if self.next + width > self.width {
            (self.next, self.top, self.height) = (0, self.top + self.height, 0);
        }
        self.height = self.height.max(height);
        let at = self.top * self.width + self.next;
        self.next += width;
        let fits = self.next <= self.width && (self.top + height) * self.width <= self.pixels.len();
        fits.then(|| (&mut self.pixels[at..], self.width))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [font, out, rest @ ..] = args.as_slice() else {
        return Err("usage: atlas FONT OUT.pgm [TEXT [PPEM]]".into());
    };
    let font = Font::new(std::fs::read(font)?)?;
    let text = rest.first().map_or("Magic 8", String::as_str);
    let ppem: f32 = rest.get(1).map_or(Ok(24.0), |ppem| ppem.parse())?;
    let mut rasterizer = Rasterizer::new(&font).with_missing_model(MissingModel::Outline);
    let mut atlas = Atlas { pixels: vec![0; 256 * 256], width: 256, next: 0, top: 0, height: 0 };
    for character in text.chars() {
        let Some(glyph) = font.glyph_for_char(character) else { continue };
        // Each glyph at four subpixel offsets, as text at fractional positions needs them.
        for quarter in [0.0, 0.25, 0.5, 0.75] {
            let options = DrawOptions::new(ppem).with_offset([quarter, 0.0]);
            let placed = rasterizer.render_with(glyph, options, |placement| atlas.room(placement))?;
            let placement = placed.ok_or("the atlas is full")?;
            println!("{character:?} at {quarter}: left {}, top {}", placement.left, placement.top);
        }
    }
    let header = format!("P5 {} {} 255\n", atlas.width, atlas.pixels.len() / atlas.width);
    std::fs::write(out, [header.as_bytes(), &atlas.pixels].concat())?;
    Ok(())
}
