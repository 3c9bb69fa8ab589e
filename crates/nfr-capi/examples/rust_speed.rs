//! Microseconds a glyph by the Rust interface, the best of many rounds over ASCII at 16 pixels per em, as `tests/c/speed.c` measures
//! the C interface: `cargo run --release -p nfr-capi --example rust_speed -- FONT`.

#![allow(clippy::print_stdout)]

use std::time::Instant;

use nfr::{Font, Rasterizer};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("usage: rust_speed FONT")?;
    let font = Font::new(std::fs::read(path)?)?;
    let mut rasterizer = Rasterizer::new(&font);
    let glyphs: Vec<u32> = (' '..='~').filter_map(|c| font.glyph_for_char(c)).collect();
    let (mut pixels, mut best) = (vec![0; 4096], f64::INFINITY);
    for _ in 0..2000 {
        let start = Instant::now();
        for glyph in &glyphs {
            rasterizer.render_into(*glyph, 16.0, &mut pixels, 64)?;
        }
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("the Rust call: {:.2} us", best * 1e6 / glyphs.len() as f64);
    Ok(())
}
