//! The smallest program that draws text in black and white: its size less that of `bare` and of the font is the renderer's.

#![no_std]
#![no_main]

extern crate alloc;

use nfr_firmware::{FONT, exit, heap};

nfr_firmware::panics!();

#[cortex_m_rt::entry]
fn main() -> ! {
    heap::init(heap::ALL);
    exit(draw().is_ok_and(|ink| ink > 0))
}

fn draw() -> Result<u32, nfr::Error> {
    let font = nfr::Font::new(core::hint::black_box(FONT))?;
    let mut rasterizer = nfr::Rasterizer::new(&font).with_cache(8 << 10);
    let mut ink = 0;
    for glyph in "nfr".chars().filter_map(|character| font.glyph_for_char(character)) {
        ink += rasterizer.draw_mono(glyph, 12.0)?.bits.iter().map(|byte| byte.count_ones()).sum::<u32>();
        ink += rasterizer.hinted_advance(glyph, 12.0)? as u32;
    }
    Ok(ink)
}
