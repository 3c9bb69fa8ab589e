//! Draws a word as text, the darker the more of a pixel is covered: `cargo run --example word -- [FONT [WORD]]`.

use std::error::Error;

use nfr::{Font, Rasterizer};

#[allow(clippy::print_stdout)]
fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let font = args.first().map_or("spec/vectors/sans.ttf", String::as_str);
    let word = args.get(1).map_or("Magic", String::as_str);

    let font = Font::new(std::fs::read(font)?)?;
    let mut rasterizer = Rasterizer::new(&font);
    let mut rows = vec![String::new(); 13];
    for glyph in word.chars().filter_map(|c| font.glyph_for_char(c)) {
        let bitmap = rasterizer.draw(glyph, 13.0)?;
        let blank = vec![0; bitmap.placement.width as usize];
        for (y, row) in (0..).zip(&mut rows) {
            // The baseline is below row 9.
            let pixels = bitmap.rows().nth((y - 10 + bitmap.placement.top) as usize).unwrap_or(&blank);
            row.extend(pixels.iter().chain(&[0]).map(|level| [' ', '.', 'o', '#'][usize::from(level / 64)]));
        }
    }
    println!("{}", rows.join("\n"));
    Ok(())
}
