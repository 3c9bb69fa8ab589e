//! Adding models to a converted font.

use crate::samples::{FONTS, Silent, font, gid, gids, table};
use nfr::{Font, Rasterizer, Target};
use nfr_convert::combine::{compact, merge};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::{Options, Shape, convert};

fn options(data: &[u8], text: &str) -> Options {
    Options { gids: gids(data, text), jobs: 2, ..Options::default() }
}

fn converted(data: &[u8], options: &Options) -> Vec<u8> {
    convert(data, options, &Silent).unwrap().font
}

/// Fields that were hardly trained.
fn fields(data: &[u8], text: &str) -> Options {
    let mut options = Options { shape: Shape::Field, ppem: 9..=14, ..options(data, text) };
    options.schedule.steps = 0;
    options.refinement.rounds = 0;
    options
}

/// Every glyph of `part` is drawn in `whole` as there.
fn assert_draws_as(whole: &[u8], part: &[u8]) {
    assert_draws_some_as(whole, part, |_| true);
}

fn assert_draws_some_as(whole: &[u8], part: &[u8], is_compared: impl Fn(u32) -> bool) {
    let [whole, part] = [whole, part].map(|data| Font::new(data.to_vec()).unwrap());
    let [mut after, mut before] = [&whole, &part].map(Rasterizer::new);
    for glyph in part.modelled_glyphs().filter(|glyph| is_compared(*glyph)) {
        for ppem in [9.0, 12.0, 33.3, 64.0] {
            assert_eq!(
                after.render(glyph, ppem).unwrap(),
                before.render(glyph, ppem).unwrap(),
                "{glyph} {ppem}"
            );
            assert_eq!(after.hinted_advance(glyph, ppem), before.hinted_advance(glyph, ppem));
        }
    }
}

fn assert_certificate_holds(original: &[u8], neural: &[u8]) {
    let pair = FontPair::open(original, 0, neural).unwrap();
    let gids: Vec<u16> = nfr::internals::table(pair.font()).unwrap().gids().collect();
    let check = pair.check_certificate(&gids, 2).unwrap().unwrap();
    assert_eq!((check.failures(), check.glyphs), (Vec::new(), gids.len()));
}

#[test]
fn models_are_added_and_those_that_are_there_draw_the_same() {
    for name in FONTS {
        let data = font(name);
        for target in [Target::Smooth, Target::Mono] {
            let with = |text: &str| converted(&data, &Options { target, ..options(&data, text) });
            // "é" has a part in the first font, and "½" is composed in both.
            let (base, addition) = (with("aegp½"), with("éüñgR½"));
            let merged = merge((&data, 0), &base, &addition, 2).unwrap();
            assert_draws_as(&merged, &base);
            // Glyphs that are not composed are those of the second font, but for those that the first has.
            let new = "Ru".chars().map(|c| u32::from(gid(&data, c))).collect::<Vec<_>>();
            assert_draws_some_as(&merged, &addition, |glyph| new.contains(&glyph));
            assert_certificate_holds(&data, &merged);
            let font = Font::new(merged.clone()).unwrap();
            assert!("aegp½éüñR".chars().all(|c| font.has_model(gid(&data, c).into())), "{name}");
            // Nothing is in it that no glyph needs, and what both had is there once.
            assert_eq!(compact(&merged).unwrap().len(), merged.len());
            let lengths = [&base, &addition].map(|font| table(font, b"Nfrt").len());
            assert!(font.table_len() < lengths[0] + lengths[1], "{name} {target}");
            assert_eq!(nfr::internals::table(&font).unwrap().dropout().is_some(), target == Target::Mono);
        }
    }
}

#[test]
fn a_font_gets_nothing_from_itself() {
    let data = font(FONTS[0]);
    let base = converted(&data, &options(&data, "aegé"));
    assert_eq!(merge((&data, 0), &base, &base, 1).unwrap(), base);
}

#[test]
fn fields_are_added_to_fields_and_to_outline_models() {
    let data = font(FONTS[0]);
    for (base, text) in
        [(fields(&data, "aé"), "aeé"), (Options { ppem: 9..=14, ..options(&data, "aé") }, "aé")]
    {
        let (base, addition) = (converted(&data, &base), converted(&data, &fields(&data, "egñ")));
        let merged = merge((&data, 0), &base, &addition, 2).unwrap();
        assert_draws_as(&merged, &base);
        assert_certificate_holds(&data, &merged);
        let font = Font::new(merged).unwrap();
        assert!(text.chars().chain("gñ".chars()).all(|c| font.has_model(gid(&data, c).into())), "{text}");
    }
}

#[test]
fn outlines_that_were_dropped_stay_dropped() {
    let data = font(FONTS[0]);
    let dropping = |text: &str| Options { drop_outlines: true, shape: Shape::Auto, ..fields(&data, text) };
    let (base, addition) = (converted(&data, &dropping("%")), converted(&data, &dropping("&")));
    let merged = merge((&data, 0), &base, &addition, 2).unwrap();
    assert_draws_as(&merged, &base);
    assert_draws_as(&merged, &addition);
    assert_certificate_holds(&data, &merged);
    let length = |font: &[u8]| table(font, b"glyf").len();
    assert!(length(&merged) < length(&base) && length(&merged) < length(&addition));
}

#[test]
fn conversions_of_other_sizes_targets_or_fonts_are_refused() {
    let data = font(FONTS[0]);
    let base = converted(&data, &options(&data, "a"));
    let other = font(FONTS[1]);
    let additions = [
        converted(&data, &Options { ppem: 8..=63, ..options(&data, "g") }),
        converted(&data, &Options { target: Target::Mono, ..options(&data, "g") }),
        converted(&other, &options(&other, "g")),
    ];
    for addition in additions {
        let error = merge((&data, 0), &base, &addition, 1).unwrap_err().to_string();
        assert!(error.contains("not conversions of the same font"), "{error}");
    }
}
