//! Memory and instructions of printable ASCII at two sizes, with several sizes of the cache.

#![no_std]
#![no_main]

extern crate alloc;

use cortex_m_semihosting::hprintln;
use nfr_firmware::clock::Clock;
use nfr_firmware::{FONT, exit, heap, stack};

/// The bytes of decoded models that are kept; 0 keeps one glyph.
const CACHES: [usize; 4] = [0, 2 << 10, 4 << 10, 8 << 10];
const SIZES: [u16; 2] = [12, 16];

nfr_firmware::panics!(info => hprintln!("{}", info));

#[cortex_m_rt::entry]
fn main() -> ! {
    heap::init(heap::ALL);
    let Some(core) = cortex_m::Peripherals::take() else { exit(false) };
    let clock = Clock::start(core.SYST);
    hprintln!("million {}", clock.calibrate());
    exit(run(&clock).is_ok())
}

/// Prints lines of numbers, which the script `check` makes a table of.
fn run(clock: &Clock) -> Result<(), nfr::Error> {
    let paint = stack::paint();
    let (opening, font) = clock.count(|| nfr::Font::new(FONT));
    let font = font?;
    hprintln!("open {} {} {}", opening, heap::used(), paint.depth());
    for cache in CACHES {
        heap::reset();
        let mut rasterizer = nfr::Rasterizer::new(&font).with_cache(cache);
        for ppem in SIZES {
            let (first, again) = draw(clock, &font, &mut rasterizer, ppem)?;
            hprintln!("size {} {} {} {}", cache, ppem, first, again);
        }
        hprintln!("memory {} {} {} {}", cache, heap::peak(), heap::extent(), paint.depth());
    }
    Ok(())
}

/// The mean instructions of a glyph of printable ASCII: for the first drawing at a size, and for the next one.
fn draw(
    clock: &Clock,
    font: &nfr::Font,
    rasterizer: &mut nfr::Rasterizer,
    ppem: u16,
) -> Result<(u32, u32), nfr::Error> {
    let (mut first, mut again, mut glyphs) = (0, 0, 0);
    for glyph in (' '..='~').filter_map(|character| font.glyph_for_char(character)) {
        for sum in [&mut first, &mut again] {
            let (instructions, bitmap) = clock.count(|| rasterizer.draw(glyph, f32::from(ppem)).map(|_| ()));
            bitmap?;
            *sum += instructions;
        }
        glyphs += 1;
    }
    Ok((first / glyphs, again / glyphs))
}
