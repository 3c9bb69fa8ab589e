//! Text at several sizes on a display of 320×240 pixels with 16 bits each: `cargo run --release -p nfr-embedded --example simulator -- OUT.png`.

use std::error::Error;

use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use nfr_embedded::Face;

static FONT: &[u8] = include_bytes!("../fonts/ascii.nfr.ttf");
const PANGRAM: &str = "The quick brown fox jumps over the lazy dog.";

fn main() -> Result<(), Box<dyn Error>> {
    let out = std::env::args().nth(1).ok_or("usage: simulator OUT.png")?;
    let font = nfr::Font::new(FONT)?;
    let face = Face::new(&font);
    let mut display = SimulatorDisplay::<Rgb565>::with_default_color(Size::new(320, 240), Rgb565::WHITE);
    draw(&face, &mut display)?;
    if let Some(problem) = face.problem() {
        return Err(problem.into());
    }
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&out)?;
    Ok(())
}

fn draw<D: DrawTarget<Color = Rgb565>>(face: &Face, display: &mut D) -> Result<(), D::Error> {
    let (navy, paper) = (Rgb565::new(2, 8, 8), Rgb565::WHITE);
    let bar = Rectangle::new(Point::zero(), Size::new(320, 28));
    bar.into_styled(PrimitiveStyle::with_fill(navy)).draw(display)?;
    let title = face.style(16.0, Rgb565::WHITE, navy);
    Text::with_baseline("Kiln 3", Point::new(8, 5), title, Baseline::Top).draw(display)?;
    let right = TextStyleBuilder::new().alignment(Alignment::Right).baseline(Baseline::Top).build();
    let small = face.style(12.0, Rgb565::new(24, 52, 28), navy);
    Text::with_text_style("Sat 28 Nov  14:05", Point::new(312, 8), small, right).draw(display)?;

    let mut y = 44;
    for ppem in [10.0, 11.0, 12.0, 13.0, 14.0] {
        let style = face.style(ppem, Rgb565::BLACK, paper);
        Text::new(PANGRAM, Point::new(8, y), style).draw(display)?;
        y += ppem as i32 + 5;
    }
    let value = face.style(24.0, Rgb565::new(26, 8, 4), paper);
    let next = Text::new("1,240.5", Point::new(8, 142), value).draw(display)?;
    Text::new(" degrees, rising by 4/min", next, face.style(13.0, Rgb565::BLACK, paper)).draw(display)?;

    let log = face.style(12.0, Rgb565::BLACK, Rgb565::WHITE).with_background(Rgb565::new(28, 60, 30));
    Text::new("Underlined", Point::new(8, 165), log.with_underline()).draw(display)?;
    Text::new("struck through", Point::new(90, 165), log.with_strikethrough()).draw(display)?;

    let dark = Rectangle::new(Point::new(0, 180), Size::new(320, 60));
    dark.into_styled(PrimitiveStyle::with_fill(Rgb565::BLACK)).draw(display)?;
    let green = face.style(11.0, Rgb565::new(12, 58, 14), Rgb565::BLACK);
    let lines = "> valve A open, 0.8 bar {ok}\n> fan #2 at 1,150 rpm; filter fjord (73%)\n> next check in 00:14:59 @ hall";
    Text::with_baseline(lines, Point::new(8, 186), green, Baseline::Top).draw(display)?;
    Ok(())
}
