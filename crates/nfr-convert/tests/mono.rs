//! Black and white against FreeType's.

use std::rc::Rc;

use crate::freetype_mono::{monochrome, moved, rasterised};
use freetype::face::LoadFlag;
use freetype::{Face, Library};
use nfr::internals::table::Dropout;
use nfr::internals::{HintedOutline, decode};
use nfr::{DrawOptions, Font, MissingModel, MonoBitmap, Rasterizer, Target};
use nfr_convert::{Options, Quality, convert};
use proptest::prelude::*;

use crate::samples::{FONTS, Silent, ascii, font, gid, gids};

/// Letters with accents, which are composed, beside printable ASCII and the blank.
const COMPOSED: &str = " \u{E9}\u{C5}\u{F1}\u{FC}\u{E7}\u{D8}";

/// A font converted for black and white, with what the hints say or with a share of it, and its glyphs.
fn converted(original: &[u8], quality: f32) -> (Font, Vec<u16>) {
    let gids = gids(original, &(ascii() + COMPOSED));
    let options = Options { gids: gids.clone(), target: Target::Mono, ..Options::default() };
    let options = options.with_quality(Quality::new(quality).unwrap());
    (Font::new(convert(original, &options, &Silent).unwrap().font).unwrap(), gids)
}

fn face(original: &[u8]) -> Face {
    Library::init().unwrap().new_memory_face(Rc::new(original.to_vec()), 0).unwrap()
}

/// The bitmap as text, for messages.
fn shown(bitmap: &MonoBitmap) -> String {
    let (width, height) = (bitmap.placement.width, bitmap.placement.height);
    let row = |y| (0..width).map(move |x| if bitmap.is_black(x, y) { '#' } else { '.' }).chain(['\n']);
    format!("{:?}\n{}", bitmap.placement, (0..height).flat_map(row).collect::<String>())
}

#[track_caller]
fn assert_equal(ours: &MonoBitmap, theirs: &MonoBitmap, what: &str) {
    assert!(ours == theirs, "{what}: ours is\n{}FreeType's is\n{}", shown(ours), shown(theirs));
}

#[test]
fn bits_and_boxes_are_freetypes_where_models_are_exact() {
    for name in FONTS {
        let original = font(name);
        let (font, gids) = converted(&original, 100.0);
        let (face, mut rasterizer) = (face(&original), Rasterizer::new(&font));
        for ppem in 8..=64 {
            for gid in &gids {
                let theirs = monochrome(&face, *gid, ppem, LoadFlag::TARGET_MONO).unwrap();
                let ours = rasterizer.render_mono((*gid).into(), f32::from(ppem)).unwrap();
                if ours.bits.is_empty() {
                    assert!(theirs.bits.iter().all(|byte| *byte == 0), "{name}, glyph {gid} at {ppem} ppem");
                    continue;
                }
                assert_equal(&ours, &theirs, &format!("{name}, glyph {gid} at {ppem} ppem"));
            }
        }
    }
}

#[test]
fn bits_are_those_that_freetype_draws_from_the_same_points() {
    for name in FONTS {
        let original = font(name);
        let (font, gids) = converted(&original, 50.0);
        let (face, mut rasterizer) = (face(&original), Rasterizer::new(&font));
        for (ppem, gid) in (8..=64).flat_map(|ppem| gids.iter().map(move |gid| (ppem, *gid))) {
            let outline = decode(&font, gid.into()).unwrap().hinted_outline(ppem.into()).unwrap();
            let theirs = moved(&face, gid, ppem, &outline).unwrap().unwrap();
            let ours = rasterizer.draw_mono(gid.into(), f32::from(ppem)).unwrap();
            if !outline.on_curve.is_empty() {
                assert_equal(&ours.into(), &theirs, &format!("{name}, glyph {gid} at {ppem} ppem"));
            }
        }
    }
}

#[test]
fn outlines_without_hints_are_freetypes_at_any_size() {
    for name in FONTS {
        let original = font(name);
        let options = Options { gids: gids(&original, "a"), ..Options::default() };
        let font = Font::new(convert(&original, &options, &Silent).unwrap().font).unwrap();
        let face = face(&original);
        let mut rasterizer = Rasterizer::new(&font).with_missing_model(MissingModel::Outline);
        for (ppem, character) in [5, 9, 12, 23, 24, 70, 300]
            .into_iter()
            .flat_map(|ppem| ascii().chars().map(move |character| (ppem, character)).collect::<Vec<_>>())
        {
            let gid = gid(&original, character);
            let theirs = monochrome(&face, gid, ppem, LoadFlag::NO_HINTING).unwrap();
            let options = DrawOptions::new(ppem.into()).with_hinting(false);
            let what = format!("{name}, {character} at {ppem} ppem");
            assert_equal(&rasterizer.render_mono(gid.into(), options).unwrap(), &theirs, &what);
            if character != 'a' || ppem == 5 || ppem == 70 {
                let unmodelled = rasterizer.render_mono(gid.into(), f32::from(ppem)).unwrap();
                assert_equal(&unmodelled, &theirs, &what);
            }
        }
    }
}

/// Contours of points in 1/64 pixel, each on the curve or not.
fn outline() -> impl Strategy<Value = HintedOutline> {
    // Many positions are on centres and borders of pixels, and many edges lie along them.
    let position = prop_oneof![-300i32..900, (-10i32..28).prop_map(|v| v * 32)];
    let point = (position.clone(), position, prop::bool::weighted(0.6));
    prop::collection::vec(prop::collection::vec(point, 1..9), 1..4).prop_map(|contours| {
        let mut outline = HintedOutline::default();
        for (x, y, on_curve) in contours.iter().flatten() {
            outline.points[0].push(*x);
            outline.points[1].push(*y);
            outline.on_curve.push(*on_curve);
        }
        let lengths = contours.iter().map(Vec::len);
        outline.ends = lengths
            .scan(0, |end, length| {
                *end += length;
                Some(*end)
            })
            .collect();
        outline
    })
}

fn mode() -> impl Strategy<Value = Dropout> {
    let enabled = any::<[bool; 2]>().prop_map(|[smart, stubs]| Dropout::new(smart, stubs));
    prop_oneof![1 => Just(Dropout::default()), 4 => enabled]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_outline_is_drawn_as_freetype_draws_it(outline in outline(), mode in mode(), ppem in 23u16..25) {
        let library = Library::init().unwrap();
        let ours = outline.black_and_white(ppem.into(), mode).unwrap();
        let theirs = rasterised(&library, &outline, ours.placement, ppem, mode);
        prop_assert!(
            ours == theirs, "{mode:?} of {outline:?}: ours is\n{}FreeType's is\n{}", shown(&ours), shown(&theirs)
        );
    }
}
