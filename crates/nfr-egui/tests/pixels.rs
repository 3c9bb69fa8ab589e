//! What egui paints, against the library's own bitmaps: no pixel may differ.

#![allow(clippy::unwrap_used)]

#[path = "../examples/shared/mod.rs"]
mod shared;

use std::sync::LazyLock;

use egui::epaint::{Shape, TextShape};
use egui::{Color32, ColorImage, FontFamily, FontId, RichText, Theme, Ui};
use nfr::{Bitmap, DrawOptions, Error, Font, Rasterizer, Target};
use shared::canvas::{Picture, Screen, over};
use shared::fonts;

const TEXT: &str = "Magic: 8 fjords, \"Wax\" & jelly?!";
const SIZE: [f32; 2] = [320.0, 40.0];

static ORIGINAL: LazyLock<Vec<u8>> =
    LazyLock::new(|| std::fs::read(fonts::path("LiberationSans-Regular")).unwrap());
static MONO: LazyLock<Font> = LazyLock::new(|| font(&ORIGINAL, Target::Mono));

fn font(original: &[u8], target: Target) -> Font {
    let ascii: String = (' '..='~').collect();
    Font::new(fonts::converted(original, &ascii, target).unwrap()).unwrap()
}

/// A dark screen, whose colours are the atlas' coverage.
fn screen(pixels_per_point: f32) -> Screen {
    let screen = Screen::new(SIZE, pixels_per_point, &ORIGINAL);
    screen.ctx.set_theme(Theme::Dark);
    nfr_egui::exact_coverage(&screen.ctx);
    screen
}

fn with_font(font: &Font) -> Screen {
    let screen = screen(1.0);
    nfr_egui::install(&screen.ctx, FontFamily::Proportional, font);
    screen
}

fn label(screen: &mut Screen, text: &str, size: f32) -> Picture {
    let text = RichText::new(text).font(FontId::proportional(size)).color(Color32::WHITE);
    screen.run(|ui: &mut Ui| {
        ui.label(text.clone());
    })
}

/// The text on a picture.
fn text_shape(picture: &Picture) -> TextShape {
    let mut texts = picture.shapes.iter().filter_map(|clipped| match &clipped.shape {
        Shape::Text(text) => Some(text.clone()),
        _ => None,
    });
    let text = texts.next().unwrap();
    assert!(texts.next().is_none());
    text
}

/// A glyph with the subpixel offset that leaves stems off half pixels.
fn bitmap(rasterizer: &mut Rasterizer, glyph: u32, ppem: f32) -> Bitmap {
    let mut drawn =
        |offset| rasterizer.render(glyph, DrawOptions::new(ppem).with_offset([offset, 0.0])).unwrap();
    let grey = |bitmap: &Bitmap| -> f64 {
        bitmap.pixels.iter().map(|c| f64::from(*c) * (255.0 - f64::from(*c))).sum()
    };
    let (whole, half) = (drawn(0.0), drawn(-0.5));
    if grey(&half) < 0.75 * grey(&whole) { half } else { whole }
}

/// A line of text by the library alone, its glyphs at whole pixels.
fn line(font: &Font, text: &str, ppem: f32, [left, baseline]: [f32; 2], size: [usize; 2]) -> ColorImage {
    let mut rasterizer = Rasterizer::new(font);
    let mut image = ColorImage::filled(size, Color32::BLACK);
    let mut pen = 0.0f32;
    for character in text.chars() {
        let glyph = font.glyph_for_char(character).unwrap();
        let bitmap = bitmap(&mut rasterizer, glyph, ppem);
        let x = left as i32 + pen.round() as i32 + bitmap.placement.left;
        let y = baseline as i32 - bitmap.placement.top;
        for (row, y) in bitmap.rows().zip(y as usize..) {
            for (coverage, x) in row.iter().zip(x as usize..) {
                image[(x, y)] = over(Color32::from_white_alpha(*coverage), image[(x, y)]);
            }
        }
        pen += rasterizer.hinted_advance(glyph, ppem).unwrap();
    }
    image
}

fn differing(a: &ColorImage, b: &ColorImage) -> usize {
    assert_eq!(a.size, b.size);
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| a != b).count()
}

fn ink(image: &ColorImage) -> usize {
    image.pixels.iter().filter(|pixel| **pixel != Color32::BLACK).count()
}

#[test]
fn a_label_has_the_pixels_of_the_library() {
    for font in [&*MONO, &font(&ORIGINAL, Target::Smooth)] {
        for pixels_per_point in [1.0, 1.25, 2.0] {
            let mut screen = screen(pixels_per_point);
            nfr_egui::install(&screen.ctx, FontFamily::Proportional, font);
            for size in 9..=14u8 {
                let size = f32::from(size);
                let picture = label(&mut screen, TEXT, size);
                let text = text_shape(&picture);
                let row = &text.galley.rows[0];
                let origin = (text.pos + row.pos.to_vec2()) * pixels_per_point;
                let baseline = origin.y.round() + row.glyphs[0].pos.y * pixels_per_point;
                let expected = line(
                    font,
                    TEXT,
                    size * pixels_per_point,
                    [origin.x.round(), baseline.round()],
                    picture.image.size,
                );
                assert!(ink(&expected) > 300);
                let differ = differing(&picture.image, &expected);
                assert_eq!(differ, 0, "{} {size} × {pixels_per_point}", font.target());
            }
        }
    }
}

#[test]
fn stems_of_a_narrow_letter_are_not_smeared_over_two_pixels() {
    // At 9 pixels per em the hints put the stem of this letter on half pixels.
    let picture = label(&mut with_font(&MONO), "lll", 9.0);
    let levels = picture.image.pixels.iter().map(|pixel| pixel.r());
    let (grey, covered) = (
        levels.clone().filter(|level| (64..192).contains(level)).count(),
        levels.filter(|l| *l >= 192).count(),
    );
    assert_eq!((grey, covered), (0, 3 * 7));
}

#[test]
fn what_the_font_cannot_draw_is_drawn_by_eguis_fonts() {
    // No model; a letter with a sign above, and with two; an invisible hyphen; Arabic, which has to be shaped; a tab.
    for text in ["é", "e\u{301}", "e\u{301}\u{302}", "\u{ad}", "عربي", "\t"] {
        let ours = label(&mut with_font(&MONO), text, 13.0);
        let eguis = label(&mut screen(1.0), text, 13.0);
        assert_eq!(differing(&ours.image, &eguis.image), 0, "{text:?}");
        assert!(ink(&ours.image) > 0 || ["\u{ad}", "\t"].contains(&text), "{text:?}");
    }
    // And the letters beside it by the library.
    let ours = label(&mut with_font(&MONO), "aé", 13.0);
    let eguis = label(&mut screen(1.0), "aé", 13.0);
    assert_ne!(differing(&ours.image, &eguis.image), 0);
}

#[test]
fn a_word_that_is_written_from_the_right_is_left_to_eguis_shaper() {
    let text = "שלום";
    let hebrew = Font::new(fonts::converted(&ORIGINAL, text, Target::Mono).unwrap()).unwrap();
    assert!(text.chars().all(|character| hebrew.has_model(hebrew.glyph_for_char(character).unwrap())));
    let ours = label(&mut with_font(&hebrew), text, 13.0);
    assert_eq!(differing(&ours.image, &label(&mut screen(1.0), text, 13.0).image), 0);
    assert!(ink(&ours.image) > 50);
}

#[test]
fn the_converted_font_serves_as_eguis_own_too() {
    let mut screen = Screen::new(SIZE, 1.0, MONO.data());
    screen.ctx.set_theme(Theme::Dark);
    nfr_egui::exact_coverage(&screen.ctx);
    nfr_egui::install(&screen.ctx, FontFamily::Proportional, &MONO);
    let original = label(&mut with_font(&MONO), TEXT, 12.0);
    assert_eq!(differing(&label(&mut screen, TEXT, 12.0).image, &original.image), 0);
    assert!(ink(&label(&mut screen, "é", 12.0).image) > 20);
}

#[test]
fn a_variant_without_a_glyph_of_its_own_is_the_character() {
    let plain = label(&mut with_font(&MONO), "8", 13.0);
    let text_form = label(&mut with_font(&MONO), "8\u{fe0e}", 13.0);
    assert_eq!(differing(&plain.image, &text_form.image), 0);
}

/// The font with another byte in the outline of a character: its model is stale.
fn stale(font: &Font, character: char) -> Font {
    use read_fonts::{FontRef, TableProvider, types::Tag};
    let mut data = font.data().to_vec();
    let glyph = font.glyph_for_char(character).unwrap() as usize;
    let file = FontRef::new(font.data()).unwrap();
    let records = file.table_directory().table_records();
    let glyf = records.iter().find(|record| record.tag() == Tag::new(b"glyf")).unwrap().offset() as usize;
    let end = glyf + file.loca(None).unwrap().get_raw(glyph + 1).unwrap() as usize;
    let at = (0..end).rev().find(|at| data[*at] != 0).unwrap();
    data[at] ^= 1;
    Font::new(data).unwrap()
}

#[test]
fn a_damaged_model_is_reported_and_eguis_font_draws_the_glyph() {
    let damaged = stale(&MONO, 'b');
    let mut screen = screen(1.0);
    let installed = nfr_egui::install(&screen.ctx, FontFamily::Proportional, &damaged);
    assert_eq!(installed.last_error(), None);
    let picture = label(&mut screen, "b", 12.0);
    let glyph = damaged.glyph_for_char('b').unwrap();
    assert_eq!(installed.last_error(), Some(Error::StaleModel(glyph)));
    let eguis = label(&mut self::screen(1.0), "b", 12.0);
    assert_eq!(differing(&picture.image, &eguis.image), 0);
    assert!(ink(&picture.image) > 0);
    // Others are drawn as before.
    let whole = label(&mut with_font(&MONO), "acd", 12.0);
    assert_eq!(differing(&label(&mut screen, "acd", 12.0).image, &whole.image), 0);
}

#[test]
fn no_damage_of_the_models_panics_or_hides_text() {
    let data = MONO.data();
    let directory = 12 + 16 * usize::from(u16::from_be_bytes([data[4], data[5]]));
    let record = (12..directory).step_by(16).find(|at| data[*at..].starts_with(b"Nfrt")).unwrap();
    let word = |at: usize| u32::from_be_bytes(data[at..at + 4].try_into().unwrap()) as usize;
    let (start, length) = (word(record + 8), word(record + 12));
    let mut reported = 0;
    for part in 1..24 {
        let mut data = data.to_vec();
        data[start + length * part / 24..][..length / 24].fill(0xA5);
        let Ok(font) = Font::new(data) else { continue };
        let mut screen = screen(1.0);
        let installed = nfr_egui::install(&screen.ctx, FontFamily::Proportional, &font);
        label(&mut screen, TEXT, 12.0);
        for character in TEXT.chars().filter(|character| *character != ' ') {
            let picture = label(&mut screen, &character.to_string(), 12.0);
            assert!(ink(&picture.image) > 0, "{character:?} with part {part} overwritten");
        }
        reported += usize::from(installed.last_error().is_some());
    }
    assert!(reported > 8, "{reported}");
}

#[test]
fn the_dark_theme_shows_exact_coverage_only_where_it_is_asked_for() {
    let mut plain = Screen::new(SIZE, 1.0, &ORIGINAL);
    plain.ctx.set_theme(Theme::Dark);
    nfr_egui::install(&plain.ctx, FontFamily::Proportional, &MONO);
    let lighter = label(&mut plain, TEXT, 12.0).image;
    nfr_egui::exact_coverage(&plain.ctx);
    let exact = label(&mut plain, TEXT, 12.0).image;
    assert!(lighter.pixels.iter().zip(&exact.pixels).all(|(lighter, exact)| lighter.r() >= exact.r()));
    assert_ne!(differing(&lighter, &exact), 0);
}
