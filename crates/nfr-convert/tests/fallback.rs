//! A glyph that has no model: an error, or with the feature `fallback` its unhinted outline.
//!
//!     cargo test --release --features fallback --test fallback
#![allow(clippy::unwrap_used)]

mod samples;

use nfr::{Error, Font, Rasterizer};
#[cfg(feature = "fallback")]
use nfr::{MAX_PEN, Setting};

use samples::{converted, font, gid};

#[cfg(not(feature = "fallback"))]
#[test]
fn without_the_feature_a_glyph_that_has_no_model_is_missing() {
    let original = font("LiberationSans-Regular");
    let data = converted(&original, ".", 0).font;
    let font = Font::parse(&data).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    let g = gid(&original, 'g');
    assert!(g < font.glyph_count() && !font.has_model(g));
    assert_eq!(rasterizer.placement(g, 16.0), Err(Error::MissingGlyph(g)));
    assert_eq!(rasterizer.render_into(g, 16.0, &mut [0; 1000]), Err(Error::MissingGlyph(g)));
}

#[cfg(feature = "fallback")]
#[test]
fn with_the_feature_a_glyph_that_has_no_model_is_drawn_from_its_outline() {
    use nfr_convert::teacher::Teacher;

    let original = font("LiberationSans-Regular");
    let data = converted(&original, ".", 0).font;
    let font = Font::parse(&data).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    let teacher = Teacher::new(&read_fonts::FontRef::new(&original).unwrap(), font.target()).unwrap();
    for ppem in [0.7, 8.0, 16.5, 64.0, 300.0] {
        for character in ['g', 'é', ' '] {
            let gid = gid(&original, character);
            assert!(!font.has_model(gid));
            let plain = teacher.unhinted(gid, ppem).unwrap().rasterize();
            assert_eq!(rasterizer.placement(gid, ppem), Ok(plain.placement));
            assert_eq!(rasterizer.render(gid, ppem).unwrap(), plain, "{character:?} at {ppem} ppem");
            let mut pixels = vec![9; plain.placement.area() + 1];
            assert_eq!(rasterizer.render_into(gid, ppem, &mut pixels), Ok(plain.placement));
            assert_eq!(pixels.pop(), Some(9));
            assert_eq!(pixels, plain.pixels);
        }
    }
}

#[cfg(feature = "fallback")]
#[test]
fn with_the_feature_the_outline_is_moved_with_the_pen() {
    use nfr_convert::teacher::Teacher;

    let original = font("LiberationSans-Regular");
    let data = converted(&original, ".", 0).font;
    let font = Font::parse(&data).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    let teacher = Teacher::new(&read_fonts::FontRef::new(&original).unwrap(), font.target()).unwrap();
    let pens = [[0.25, 0.0], [0.5, 0.5], [-0.75, 3.0], [1000.5, -0.1]];
    for (ppem, pen) in [8.0, 16.5, 64.0].into_iter().flat_map(|ppem| pens.map(|pen| (ppem, pen))) {
        let setting = Setting { pen, ..Setting::from(ppem) };
        for character in ['g', 'é', ' '] {
            let gid = gid(&original, character);
            let mut plain = teacher.unhinted(gid, ppem).unwrap();
            plain.translate(pen);
            let plain = plain.rasterize();
            assert_eq!(rasterizer.placement(gid, setting), Ok(plain.placement));
            assert_eq!(rasterizer.render(gid, setting).unwrap(), plain, "{character:?} at {setting:?}");
        }
    }
}

#[cfg(feature = "fallback")]
#[test]
fn with_the_feature_the_errors_are_those_of_a_model() {
    let original = font("LiberationSans-Regular");
    let data = converted(&original, ".", 0).font;
    let font = Font::parse(&data).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    let g = gid(&original, 'g');
    for ppem in [0.0, -1.0, f32::NAN, f32::INFINITY, 2049.0] {
        assert!(matches!(rasterizer.render(g, ppem), Err(Error::InvalidParameter(_))), "{ppem}");
    }
    for pen in [[f32::NAN, 0.0], [0.0, f32::INFINITY], [MAX_PEN + 1.0, 0.0]] {
        let setting = Setting { pen, ..Setting::from(16.0) };
        assert!(matches!(rasterizer.render(g, setting), Err(Error::InvalidParameter(_))), "{pen:?}");
    }
    assert!(matches!(rasterizer.render_into(g, 16.0, &mut [0; 3]), Err(Error::InvalidParameter(_))));
    let missing = font.glyph_count();
    assert_eq!(rasterizer.render(missing, 16.0), Err(Error::MissingGlyph(missing)));
    assert!(font.glyph(g).is_err(), "there is no model to hand out");
    assert!(font.has_model(gid(&original, '.')) && rasterizer.render(gid(&original, '.'), 16.0).is_ok());
}
