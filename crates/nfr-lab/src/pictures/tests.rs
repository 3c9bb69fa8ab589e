//! The contents of pictures. With `NFR_PICTURES` set to a directory, they are left there to be looked at.
#![allow(clippy::unwrap_used)]

use nfr_convert::compare::picture::png;
use nfr_convert::open::owned;
use read_fonts::FontRef;

use super::*;
use crate::resize::{Method, resized, single_wrong_pixel};
use crate::truth::Truth;

fn keep(name: &str, picture: RgbImage) -> RgbImage {
    if let Some(place) = std::env::var_os("NFR_PICTURES") {
        picture.save(std::path::Path::new(&place).join(format!("{name}.png"))).unwrap();
    }
    assert!(png(&picture).is_ok());
    picture
}

const SERIF: &[u8] = include_bytes!("../../../../fonts/LiberationSerif-Regular.ttf");

fn label_font() -> LabelFont {
    LabelFont::new(&FontRef::new(SERIF).unwrap()).unwrap()
}

fn letters(text: &str, zoom: u32) -> RgbImage {
    label_font().line(text, zoom).unwrap()
}

/// The truth of a character in Liberation Serif for all sizes from 20, and its glyph.
fn truth(character: char) -> (Truth, u16) {
    let font = FontRef::new(SERIF).unwrap();
    let owned = owned(&font).unwrap();
    let gid = |c: char| owned.charmap().map_unicode(c).unwrap().to_u32() as u16;
    let gids: Vec<u16> = ('a'..='z').map(gid).collect();
    (Truth::new(&font, &gids, 20..=63).unwrap(), gid(character))
}

#[test]
fn ink_is_black_and_errors_are_red_where_too_dark_and_blue_where_too_light() {
    let prediction = SquareBitmap { side: 2, pixels: vec![255, 20, 10, 0] };
    let truth = SquareBitmap { side: 2, pixels: vec![0, 10, 20, 0] };
    assert_eq!(ink(&prediction).unwrap().into_raw()[..6], [0, 0, 0, 235, 235, 235]);
    let error = signed_error(&prediction, &truth).unwrap();
    let expected = [[255, 0, 0], [255, 215, 215], [215, 215, 255], [255; 3]];
    assert_eq!(error.into_raw(), expected.concat());
}

#[test]
fn tiles_are_enlarged_and_boxed() {
    let square = SquareBitmap { side: 1, pixels: vec![255] };
    let tile = boxed(&enlarged(&ink(&square).unwrap(), 3));
    assert_eq!(
        (tile.dimensions(), tile.get_pixel(0, 0), tile.get_pixel(3, 3)),
        ((5, 5), &EDGE, &Rgb([0; 3]))
    );
}

#[test]
fn a_triptych_has_room_for_its_label_and_three_boxes() {
    let (truth, gid) = truth('a');
    let sizes = [0, 10, 30];
    let truths = sizes.map(|index| truth.hinted(gid, index).unwrap());
    let plain = sizes.map(|index| truth.plain(gid, index).unwrap());
    let labels = sizes.map(|index| format!("plain {}", truth.sizes[index].side));
    let rows: Vec<_> = (0..3)
        .map(|i| PredictionRow { label: &labels[i], prediction: &plain[i], truth: &truths[i] })
        .collect();
    let picture = keep("prediction_rows", prediction_rows(&label_font(), &rows, 5).unwrap());
    let label = letters("plain 20", 5);
    assert_eq!(picture.width(), 2 * MARGIN + label.width() + 3 * (50 * 5 + 2 + GAP));
    let head = letters("model", 5).height() + GAP;
    assert_eq!(picture.height(), 2 * MARGIN + head + (20 + 30 + 50) * 5 + 3 * (2 + GAP));
}

#[test]
fn a_cascade_goes_on_below_and_shows_every_size_of_every_model() {
    let (truth, gid) = truth('g');
    let squares = |plain: bool| -> Vec<SquareBitmap> {
        let draw = |index| if plain { truth.plain(gid, index) } else { truth.hinted(gid, index) };
        (0..44).map(|index| draw(index).unwrap()).collect()
    };
    let (hinted, plain) = (squares(false), squares(true));
    let rows = [("truth", &hinted), ("plain", &plain)];
    let rows = rows.map(|(label, squares)| BitmapRow { label, squares: squares.iter().collect() });
    let picture = keep("size_series", size_series(&label_font(), &rows, 22, 1).unwrap());
    // Two blocks of two rows, as high as the largest of each: 41 and 63.
    let head = letters("20", 1).height() + GAP;
    assert_eq!(picture.height(), 2 * (2 * MARGIN + head + 2 * GAP) + 2 * 41 + 2 * 63);
    let dark = |picture: &RgbImage| picture.pixels().map(|p| u64::from(255 - p[0])).sum::<u64>();
    let coverage: u64 = hinted.iter().chain(&plain).flat_map(|s| &s.pixels).map(|&p| u64::from(p)).sum();
    let texts =
        (20..=63).map(|s: u32| s.to_string()).chain(["truth", "plain", "truth", "plain"].map(String::from));
    let written: u64 = texts.map(|text| dark(&letters(&text, 1))).sum();
    assert_eq!(dark(&picture), coverage + written);
}

#[test]
fn strips_show_shrunk_bitmaps_and_a_wrong_pixel_beside_the_truth() {
    let (truth, gid) = truth('m');
    let (hinted, large) = (truth.hinted(gid, 4).unwrap(), truth.hinted(gid, 43).unwrap());
    let small: Vec<_> = Method::ALL.iter().map(|&method| resized(&large, 24, method).unwrap()).collect();
    let headings: Vec<_> = std::iter::once("truth").chain(Method::ALL.map(Method::name)).collect();
    let row = BitmapRow { label: "s 24", squares: std::iter::once(&hinted).chain(&small).collect() };
    keep("resized", bitmap_rows(&label_font(), &headings, &[row], 4).unwrap());
    let (plain, (wrong, _)) = (truth.plain(gid, 4).unwrap(), single_wrong_pixel(&hinted));
    let row = BitmapRow { label: "s 24", squares: vec![&hinted, &plain, &wrong] };
    let picture = keep(
        "wrong",
        bitmap_rows(&label_font(), &["hinted", "unhinted", "one wrong pixel"], &[row], 5).unwrap(),
    );
    assert!(picture.width() > 3 * 24 * 5);
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let square = |side: usize, count| SquareBitmap { side, pixels: vec![0; count] };
    let (whole, other, broken) = (square(2, 4), square(3, 9), square(2, 3));
    let row = PredictionRow { label: "", prediction: &whole, truth: &other };
    assert!(prediction_rows(&label_font(), &[row], 1).unwrap_err().to_string().contains("one of 3"));
    let row = BitmapRow { label: "", squares: vec![&broken] };
    assert!(
        bitmap_rows(&label_font(), &[], std::slice::from_ref(&row), 1)
            .unwrap_err()
            .to_string()
            .contains("3 pixels")
    );
    assert!(size_series(&label_font(), &[row], 5, 1).is_err());
    assert!(blank(1 << 20, 1 << 20).unwrap_err().to_string().contains("fewer glyphs"));
    assert!(bitmap_rows(&label_font(), &[], &[], 1).is_ok() && size_series(&label_font(), &[], 0, 1).is_ok());
}

#[test]
fn a_note_stands_below_a_picture_that_stays_as_it_is() {
    let square = SquareBitmap { side: 20, pixels: vec![128; 400] };
    let row = BitmapRow { label: "a", squares: vec![&square] };
    let plain = bitmap_rows(&label_font(), &[], &[row], 2).unwrap();
    let (before, after) = (
        keep("plain", plain.clone()),
        keep("captioned", captioned(&label_font(), &plain, "small scale").unwrap()),
    );
    assert!(after.height() > before.height() && after.width() >= before.width());
    assert!(before.enumerate_pixels().all(|(x, y, pixel)| after.get_pixel(x, y) == pixel));
    let below = after.enumerate_pixels().filter(|(_, y, _)| *y >= before.height());
    assert!(below.filter(|(_, _, pixel)| pixel.0 != [255; 3]).count() > 50, "the note has ink");
}
