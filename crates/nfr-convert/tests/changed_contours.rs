//! Glyphs whose contours hinting changes: their hint programs put control points on the curve or take points off it.

use crate::samples::{FONTS, Silent, Warnings, font, gid, gids, with_flipped_points};
use nfr::{Font, Rasterizer, Target};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::metrics::Sums;
use nfr_convert::teacher::Teacher;
use nfr_convert::{Conversion, Error, Options, Quality, Shape, convert};
use read_fonts::FontRef;

/// Liberation Sans with an 'e' whose points 3 to 6 are taken off the curve below 12 ppem.
fn flipped() -> Vec<u8> {
    let data = font(FONTS[0]);
    with_flipped_points(&data, gid(&data, 'e'), [3, 6, 12])
}

/// Options of a conversion without training.
fn options(data: &[u8], text: &str, shape: Shape) -> Options {
    let quality = Quality::new(100.0).unwrap();
    let mut options =
        Options { gids: gids(data, text), ppem: 8..=20, shape, ..Options::default().with_quality(quality) };
    options.schedule.steps = 0;
    options.refinement.rounds = 0;
    options
}

fn converted(data: &[u8], options: &Options) -> (Conversion, Vec<String>) {
    let warnings = Warnings::default();
    let conversion = convert(data, options, &warnings).unwrap();
    let mut warnings = warnings.0.into_inner().unwrap();
    // That of fields, which have more error than the unhinted outlines before they are trained.
    warnings.retain(|warning| !warning.contains("farther from the hinted bitmaps"));
    (conversion, warnings)
}

#[test]
fn with_outlines_they_are_left_out_told_in_one_line_and_the_others_are_exact() {
    let data = flipped();
    // An accented letter has the points of its base.
    let (conversion, warnings) = converted(&data, &options(&data, "aeéo", Shape::Outline));
    let left_out = gids(&data, "eé");
    assert_eq!(conversion.left_out, left_out);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    for part in [format!("2 glyphs ({}, {})", left_out[0], left_out[1]), "--shape auto".into()] {
        assert!(warnings[0].contains(&part), "{part:?} is not in {warnings:?}");
    }
    let font = Font::new(conversion.font.clone()).unwrap();
    assert!(font.modelled_glyphs().eq(gids(&data, "ao").into_iter().map(u32::from)));
    let pair = FontPair::open(&data, 0, &conversion.font).unwrap();
    let found = pair.verify(["", ""], &gids(&data, "ao"), &(8..=20).into(), 1).unwrap();
    assert!(found.failures(0).is_empty(), "{found}");
    assert_eq!(conversion.sums.figures().exact, 1.0);
}

#[test]
fn by_default_fields_draw_them_beside_the_outline_models_of_the_others() {
    let data = flipped();
    let (conversion, warnings) = converted(&data, &options(&data, "aeo", Shape::Auto));
    let e = gid(&data, 'e');
    assert!(conversion.left_out.is_empty() && conversion.glyphs.len() == 3);
    assert!(warnings.len() == 1 && warnings[0].contains(&format!("1 glyph ({e})")), "{warnings:?}");
    let font = Font::new(conversion.font.clone()).unwrap();
    assert!(nfr::internals::table(&font).unwrap().field_gids().eq([e]));
    // The first guess is rough, but what is drawn at a size is the glyph.
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    for (character, most) in [('a', 0.0), ('e', 0.1), ('o', 0.0)] {
        let mut sums = Sums::default();
        for ppem in [9, 18] {
            let gid = gid(&data, character);
            let truth = teacher.at(ppem).unwrap().hinted(gid).unwrap().rasterize().unwrap();
            sums.add(&truth, &rasterizer.render(gid.into(), f32::from(ppem)).unwrap());
        }
        assert!(sums.mae() <= most, "{character}: {}", sums.mae());
    }
}

#[test]
fn a_change_that_keeps_the_number_of_points_is_noticed() {
    // A bar of four corners: the path of three points on the curve and a control point has as many points.
    let data = font(FONTS[0]);
    let data = with_flipped_points(&data, gid(&data, 'l'), [1, 1, 12]);
    let (conversion, _) = converted(&data, &options(&data, "al", Shape::Outline));
    assert_eq!(conversion.left_out, gids(&data, "l"));
}

#[test]
fn at_other_sizes_than_the_learned_ones_the_contours_may_change() {
    let data = flipped();
    let options = Options { ppem: 12..=20, ..options(&data, "e", Shape::Outline) };
    let conversion = convert(&data, &options, &Silent).unwrap();
    let pair = FontPair::open(&data, 0, &conversion.font).unwrap();
    let found = pair.verify(["", ""], &options.gids, &(11..=12).into(), 1).unwrap();
    assert_eq!((found.totals.glyph_sizes, found.totals.changed_contours), (2, 1));
    assert!(found.failures(1000)[0].contains("contours"), "{found}");
}

#[test]
fn a_conversion_that_would_leave_out_every_glyph_is_an_error() {
    let data = flipped();
    let error = convert(&data, &options(&data, "e", Shape::Outline), &Silent).unwrap_err();
    assert!(matches!(&error, Error::Unsupported(text) if text.contains("all selected glyphs")), "{error}");
}

#[test]
fn fields_are_trained_for_them_when_fields_are_asked_for() {
    let data = flipped();
    let (conversion, warnings) = converted(&data, &options(&data, "eé", Shape::Field));
    assert_eq!((conversion.glyphs.len(), warnings), (2, Vec::new()));
}

#[cfg(not(feature = "train"))]
#[test]
fn a_build_without_training_leaves_them_out_and_says_how_to_get_fields() {
    let data = flipped();
    let mut options = options(&data, "aeo", Shape::Auto);
    options.schedule.steps = 1;
    let (conversion, warnings) = converted(&data, &options);
    assert_eq!(conversion.left_out, gids(&data, "e"));
    assert!(warnings.len() == 1 && warnings[0].contains("built with --features train"), "{warnings:?}");
}
