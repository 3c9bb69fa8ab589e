//! Drawing without hints, whatever models a font has.

use nfr::{Bitmap, DrawOptions, Font, MissingModel, Rasterizer};

use crate::samples::{bytes, font, without_models};

/// At trained sizes, between them and beyond them.
const PPEM: [f32; 7] = [3.0, 8.0, 11.0, 16.4, 31.9, 64.0, 200.0];

/// Levels that a pixel of a composed glyph may be off: where its parts lie is rounded to 1/64 pixel, before their points are.
const ROUNDED_PART: u8 = 8;

fn draw(rasterizer: &mut Rasterizer, character: char, ppem: f32, hinting: bool) -> Bitmap {
    let options = DrawOptions::new(ppem).with_offset([0.25, 0.5]).with_hinting(hinting);
    let glyph = rasterizer.font().glyph_for_char(character).unwrap();
    rasterizer.render(glyph, options).unwrap()
}

#[test]
fn without_hints_a_glyph_is_the_plain_outline() {
    for name in ["outline", "outline-mono", "postscript"] {
        let mut hinted = Rasterizer::new(&font(name));
        let bare = Font::new(without_models(&bytes(name))).unwrap();
        let mut plain = Rasterizer::new(&bare).with_missing_model(MissingModel::Outline);
        let mut differ = 0;
        for (character, ppem) in "agé".chars().flat_map(|c| PPEM.map(|ppem| (c, ppem))) {
            let unhinted = draw(&mut plain, character, ppem, true);
            differ += usize::from(draw(&mut hinted, character, ppem, true) != unhinted);
            let drawn = draw(&mut hinted, character, ppem, false);
            if character == 'é' {
                assert_eq!(drawn.placement, unhinted.placement);
                let pairs = drawn.pixels.iter().zip(&unhinted.pixels);
                let most = pairs.map(|(a, b)| a.abs_diff(*b)).max();
                assert!(most <= Some(ROUNDED_PART), "{name}: {character} at {ppem} is off by {most:?}");
            } else {
                assert_eq!(drawn, unhinted, "{name}: {character} at {ppem}");
            }
        }
        assert!(differ > 9, "{name}: hints change {differ} bitmaps only");
    }
}

#[test]
fn without_hints_a_field_is_drawn_as_beyond_its_sizes() {
    let mut rasterizer = Rasterizer::new(&font("sans"));
    for character in "ag8é".chars() {
        let [trained, beyond] = [11.0, 200.0].map(|ppem| {
            let [hinted, plain] =
                [true, false].map(|hinting| draw(&mut rasterizer, character, ppem, hinting));
            hinted == plain
        });
        assert!(!trained && beyond, "{character}");
    }
}

#[test]
fn without_hints_no_model_is_missed() {
    let bare = Font::new(without_models(&bytes("outline"))).unwrap();
    let outline =
        draw(&mut Rasterizer::new(&bare).with_missing_model(MissingModel::Outline), 'g', 16.0, true);
    for missing in [MissingModel::Error, MissingModel::Blank] {
        let mut rasterizer = Rasterizer::new(&bare).with_missing_model(missing);
        assert_eq!(draw(&mut rasterizer, 'g', 16.0, false), outline);
    }
}

#[cfg(feature = "networks")]
#[test]
fn without_hints_a_network_gives_way_to_the_outline() {
    let font = font("network");
    let bare = Font::new(without_models(&bytes("network"))).unwrap();
    let mut plain = Rasterizer::new(&bare).with_missing_model(MissingModel::Outline);
    let drawn = draw(&mut Rasterizer::new(&font), 'a', 20.0, false);
    assert_eq!(drawn, draw(&mut plain, 'a', 20.0, true));
}
