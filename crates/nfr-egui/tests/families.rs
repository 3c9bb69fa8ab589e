//! Which font draws which family, and when that changes.

#![allow(clippy::unwrap_used)]

#[path = "../examples/shared/mod.rs"]
mod shared;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

use egui::{Color32, ColorImage, FontFamily, FontId, GlyphRasterizer, RichText, Ui};
use nfr::{Font, Target};
use nfr_egui::install;
use shared::canvas::{Picture, Screen};
use shared::fonts;

const TEXT: &str = "Quick";
const SIZE: [f32; 2] = [100.0, 40.0];

static ORIGINAL: LazyLock<Vec<u8>> =
    LazyLock::new(|| std::fs::read(fonts::path("LiberationSans-Regular")).unwrap());
static SANS: LazyLock<Font> = LazyLock::new(|| font("LiberationSans-Regular"));
static SERIF: LazyLock<Font> = LazyLock::new(|| font("LiberationSerif-Regular"));

fn font(name: &str) -> Font {
    let original = std::fs::read(fonts::path(name)).unwrap();
    Font::new(fonts::converted(&original, TEXT, Target::Mono).unwrap()).unwrap()
}

fn screen() -> Screen {
    Screen::new(SIZE, 1.0, &ORIGINAL)
}

fn label(screen: &mut Screen, family: FontFamily) -> Picture {
    let text = RichText::new(TEXT).font(FontId::new(12.0, family)).color(Color32::WHITE);
    screen.run(|ui: &mut Ui| {
        ui.label(text.clone());
    })
}

fn proportional(screen: &mut Screen) -> ColorImage {
    label(screen, FontFamily::Proportional).image
}

/// The text by a font, or by egui alone.
fn text_of(font: Option<&Font>) -> ColorImage {
    let mut screen = screen();
    if let Some(font) = font {
        install(&screen.ctx, FontFamily::Proportional, font);
    }
    proportional(&mut screen)
}

#[test]
fn the_three_kinds_of_text_differ() {
    let [egui, sans, serif] = [text_of(None), text_of(Some(&SANS)), text_of(Some(&SERIF))];
    assert!(egui.pixels != sans.pixels && sans.pixels != serif.pixels && egui.pixels != serif.pixels);
}

#[test]
fn a_font_replaces_the_one_before_it() {
    let mut screen = screen();
    for font in [&*SANS, &*SERIF, &*SANS, &*SERIF] {
        install(&screen.ctx, FontFamily::Proportional, font);
        assert!(proportional(&mut screen) == text_of(Some(font)));
    }
}

#[test]
fn a_font_that_is_replaced_in_the_middle_of_a_frame_is_gone_in_the_next() {
    let mut screen = screen();
    install(&screen.ctx, FontFamily::Proportional, &SANS);
    screen.run(|ui| {
        ui.label(TEXT);
        install(ui.ctx(), FontFamily::Proportional, &SERIF);
    });
    assert!(proportional(&mut screen) == text_of(Some(&SERIF)));
}

#[test]
fn a_font_that_is_removed_leaves_the_family_to_egui() {
    let mut screen = screen();
    install(&screen.ctx, FontFamily::Proportional, &SANS);
    proportional(&mut screen);
    nfr_egui::remove(&screen.ctx, &FontFamily::Proportional);
    assert!(proportional(&mut screen) == text_of(None));
}

#[test]
fn installing_a_font_every_frame_draws_nothing_again() {
    let mut screen = screen();
    for frame in 0..4 {
        install(&screen.ctx, FontFamily::Proportional, &SANS);
        let uploads = label(&mut screen, FontFamily::Proportional).uploads;
        assert_eq!(uploads > 0, frame == 0, "frame {frame}");
    }
}

#[test]
fn other_families_are_left_alone() {
    let mut screen = screen();
    let alone = label(&mut screen, FontFamily::Monospace).image;
    install(&screen.ctx, FontFamily::Proportional, &SERIF);
    assert!(label(&mut screen, FontFamily::Monospace).image == alone);
    install(&screen.ctx, FontFamily::Monospace, &SANS);
    assert!(label(&mut screen, FontFamily::Monospace).image == text_of(Some(&SANS)));
    assert!(proportional(&mut screen) == text_of(Some(&SERIF)));
}

#[test]
fn the_font_stays_when_the_application_resets_its_memory() {
    let mut screen = screen();
    install(&screen.ctx, FontFamily::Proportional, &SANS);
    proportional(&mut screen);
    screen.ctx.memory_mut(|memory| *memory = egui::Memory::default());
    assert!(proportional(&mut screen) == text_of(Some(&SANS)));
    install(&screen.ctx, FontFamily::Proportional, &SERIF);
    assert!(proportional(&mut screen) == text_of(Some(&SERIF)));
}

#[test]
fn installing_brings_back_what_the_application_has_cleared() {
    let mut screen = screen();
    install(&screen.ctx, FontFamily::Proportional, &SANS);
    proportional(&mut screen);
    screen.ctx.set_glyph_rasterizers(Vec::new());
    assert!(proportional(&mut screen) == text_of(None));
    install(&screen.ctx, FontFamily::Proportional, &SANS);
    assert!(proportional(&mut screen) == text_of(Some(&SANS)));
}

#[test]
fn rasterizers_of_others_are_kept() {
    let mut screen = screen();
    let asked = Arc::new(AtomicBool::new(false));
    let ask = Arc::clone(&asked);
    let another = GlyphRasterizer::new("another", move |_| {
        ask.store(true, Ordering::Relaxed);
        None
    });
    screen.ctx.add_glyph_rasterizer(another.with_priority(egui::FontPriority::Highest));
    install(&screen.ctx, FontFamily::Proportional, &SANS);
    install(&screen.ctx, FontFamily::Proportional, &SERIF);
    assert!(proportional(&mut screen) == text_of(Some(&SERIF)));
    assert!(asked.load(Ordering::Relaxed));
}
