//! The same window three times, drawn by egui alone and with nfr from a font that is converted for grey and for sharp stems:
//! `cargo run --release -p nfr-egui --example compare -- OUT.png [FONT.ttf]`. Also times a new glyph.

#![allow(clippy::print_stdout)]

mod shared;

use std::error::Error;
use std::time::Instant;

use egui::{Color32, ColorImage, FontFamily, FontId, RichText, Theme, Ui};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use nfr::{Font, Target};
use shared::canvas::Screen;
use shared::fonts;

const SIZE: [f32; 2] = [270.0, 232.0];
/// A pixel of the window takes so many of the picture.
const ZOOM: usize = 2;
const TEXT: &str = "Hinted text sits on the pixel grid: stems, bars and bowls are whole pixels wide or nearly so, and every letter \
                    looks the same wherever it stands. Without that, small text is grey.";

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (out, font) = match args.as_slice() {
        [out] => (out, fonts::path("LiberationSans-Regular")),
        [out, font] => (out, font.clone()),
        _ => return Err("usage: compare OUT.png [FONT.ttf]".into()),
    };
    let original = std::fs::read(font)?;
    let (smooth, mono) = (converted(&original, Target::Smooth)?, converted(&original, Target::Mono)?);
    let sides = [("egui alone", None), ("nfr, smooth", Some(&smooth)), ("nfr, mono", Some(&mono))];
    let pictures = sides.map(|(title, font)| window(&original, title, font));
    write(&pictures, out)?;
    println!("microseconds per new glyph, at 9 to 14 pixels per em");
    for (title, font) in sides {
        println!("{title:12} {:.1}", time(&original, font));
    }
    Ok(())
}

/// The font with models of printable ASCII and of the ellipsis.
fn converted(original: &[u8], target: Target) -> Result<Font, Box<dyn Error>> {
    let characters: String = (' '..='~').chain(['…']).collect();
    Ok(Font::new(fonts::converted(original, &characters, target)?)?)
}

/// A window whose text egui draws, or the font.
fn window(original: &[u8], title: &str, font: Option<&Font>) -> ColorImage {
    let mut screen = Screen::new(SIZE, 1.0, original);
    screen.ctx.set_theme(Theme::Light);
    if let Some(font) = font {
        nfr_egui::install(&screen.ctx, FontFamily::Proportional, font);
    }
    let mut fruit = "Apple".to_owned();
    // egui measures in the first frame what it draws in the second.
    screen.run(|ui| content(ui, title, &mut fruit));
    screen.run(|ui| content(ui, title, &mut fruit)).image
}

fn content(ui: &mut Ui, title: &str, fruit: &mut String) {
    egui::CentralPanel::default().show(ui, |ui| {
        ui.heading(title);
        for size in [9.0, 10.0, 11.0, 12.0, 13.0, 14.0] {
            ui.label(RichText::new(format!("{size} px: Magic illusion of 1,234 files")).size(size));
        }
        ui.horizontal(|ui| {
            for (label, size) in [("Open…", 11.0), ("Save", 12.0), ("Cancel", 13.0)] {
                let _ = ui.button(RichText::new(label).size(size));
            }
            ui.checkbox(&mut true, "All");
        });
        ui.text_edit_singleline(fruit);
        ui.label(RichText::new(TEXT).size(12.0));
    });
}

/// The median time that a glyph takes which is drawn for the first time, beyond that of text whose glyphs are in the atlas.
fn time(original: &[u8], font: Option<&Font>) -> f64 {
    let text: String = ('!'..='~').collect();
    let mut times: Vec<f64> = (0..25)
        .map(|_| {
            let mut screen = Screen::new([64.0, 64.0], 1.0, original);
            if let Some(font) = font {
                nfr_egui::install(&screen.ctx, FontFamily::Proportional, font);
            }
            screen.run(|_| {});
            // Another colour is laid out again, and takes the glyphs from the atlas.
            let layout = |color| {
                let begin = Instant::now();
                for size in 9..=14u8 {
                    let font = FontId::proportional(size.into());
                    screen.ctx.fonts_mut(|fonts| fonts.layout_no_wrap(text.clone(), font, color));
                }
                begin.elapsed().as_secs_f64() * 1e6 / (6 * text.len()) as f64
            };
            layout(Color32::WHITE) - layout(Color32::BLACK)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Writes the pictures side by side, enlarged.
fn write(pictures: &[ColorImage], out: &str) -> Result<(), Box<dyn Error>> {
    let (width, height) = (pictures[0].width() * ZOOM, pictures[0].height() * ZOOM);
    let image = image::RgbImage::from_fn((width * pictures.len()) as u32, height as u32, |x, y| {
        let (x, y) = (x as usize, y as usize);
        let [r, g, b, _] = pictures[x / width][(x % width / ZOOM, y / ZOOM)].to_array();
        image::Rgb([r, g, b])
    });
    let file = std::io::BufWriter::new(std::fs::File::create(out)?);
    let encoder = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::NoFilter);
    Ok(image.write_with_encoder(encoder)?)
}
