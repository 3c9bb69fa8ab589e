//! Memory and instructions of printable ASCII at two sizes, with a cache of 8 kB.

#![no_std]
#![no_main]

extern crate alloc;

use cortex_m_semihosting::hprintln;
use nfr_firmware::clock::Clock;
use nfr_firmware::{FONT, exit, heap, stack};

const CACHE: usize = 8 << 10;
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

fn run(clock: &Clock) -> Result<(), nfr::Error> {
    let paint = stack::paint();
    let (opening, font) = clock.count(|| nfr::Font::new(FONT));
    let font = font?;
    hprintln!("open {} {} {}", opening, heap::used(), heap::peak());
    let mut rasterizer = nfr::Rasterizer::new(&font).with_cache(CACHE);
    for ppem in SIZES {
        let (mut first, mut again, mut glyphs) = (0, 0, 0);
        for glyph in (' '..='~').filter_map(|character| font.glyph_for_char(character)) {
            for sum in [&mut first, &mut again] {
                let (instructions, bitmap) =
                    clock.count(|| rasterizer.draw(glyph, f32::from(ppem)).map(|_| ()));
                bitmap?;
                *sum += instructions;
            }
            glyphs += 1;
        }
        hprintln!("size {} {} {} {}", ppem, glyphs, first / glyphs, again / glyphs);
    }
    hprintln!("memory {} {} {}", heap::peak(), heap::extent(), paint.depth());
    Ok(())
}
