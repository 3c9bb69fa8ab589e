//! Outline models of real fonts: how near they are, what they take, and what happens to outlines that were changed.

use crate::samples::{Silent, font, gids, with_changed_outline, with_whole_sizes};
use nfr::{Font, Rasterizer, Target};
use nfr_convert::combine::compact;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::teacher::Teacher;
use nfr_convert::{Conversion, Options, Quality, convert};
use proptest::prelude::*;
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::pen::ControlBoundsPen;
use skrifa::outline::{DrawSettings, Engine, HintingInstance, HintingOptions, SmoothMode};
use write_fonts::FontBuilder;

const FONTS: [&str; 3] = ["LiberationSans-Regular", "LiberationSerif-Regular", "DejaVuSans"];

fn ascii() -> String {
    (' '..='~').collect()
}

fn options(data: &[u8], text: &str, target: Target, quality: f32) -> Options {
    let quality = Quality::new(quality).unwrap();
    Options { gids: gids(data, text), target, jobs: 2, ..Options::default().with_quality(quality) }
}

fn converted(data: &[u8], text: &str, target: Target, quality: f32) -> Conversion {
    convert(data, &options(data, text, target, quality), &Silent).unwrap()
}

#[test]
fn at_quality_100_bitmaps_and_advances_are_those_of_the_hints() {
    for name in FONTS {
        let data = font(name);
        for (target, most) in [(Target::Smooth, 150.0), (Target::Mono, 340.0)] {
            let text = ascii() + "éÅ";
            let conversion = converted(&data, &text, target, 100.0);
            let figures = conversion.sums.figures();
            assert_eq!((figures.mae, figures.exact), (0.0, 1.0), "{name} {target}");
            let gids = gids(&data, &text);
            let bytes = conversion.table_bytes as f64 / gids.len() as f64;
            assert!(bytes <= most, "{name} {target}: {bytes} bytes a glyph");
            let teacher = Teacher::new(&FontRef::new(&data).unwrap(), target).unwrap();
            let font = Font::new(conversion.font).unwrap();
            let mut rasterizer = Rasterizer::new(&font);
            for ppem in [9, 16, 33, 64] {
                let teacher = teacher.at(ppem).unwrap();
                for &gid in &gids {
                    let advance = rasterizer.hinted_advance(gid.into(), ppem.into()).unwrap();
                    let hinted = teacher.hinted(gid).unwrap();
                    assert_eq!(Some(advance), hinted.advance, "{name} {target} {gid} {ppem}");
                    let bearing = rasterizer.hinted_side_bearing(gid.into(), ppem.into()).unwrap();
                    let left = hinted.points.iter().map(|point| point[0]).reduce(f32::min);
                    assert_eq!(bearing, left.unwrap_or(0.0), "{name} {target} {gid} {ppem}");
                }
            }
        }
    }
}

#[test]
fn by_default_models_are_small_and_near() {
    for name in FONTS {
        let data = font(name);
        for (target, most_bytes, most) in [(Target::Smooth, 110.0, 0.0002), (Target::Mono, 260.0, 0.0006)] {
            let conversion = converted(&data, &ascii(), target, 50.0);
            let figures = conversion.sums.figures();
            assert!(figures.mae <= most && figures.bad16 <= 0.0003, "{name} {target}: {figures:?}");
            let bytes = conversion.table_bytes as f64 / gids(&data, &ascii()).len() as f64;
            assert!(bytes <= most_bytes, "{name} {target}: {bytes} bytes a glyph");
        }
    }
}

#[test]
fn less_quality_takes_fewer_bytes() {
    let data = font(FONTS[0]);
    let of = |quality| {
        let conversion = converted(&data, &ascii(), Target::Smooth, quality);
        (conversion.table_bytes, conversion.sums.mae())
    };
    let all = [0.0, 25.0, 50.0, 75.0].map(of);
    assert!(all.is_sorted_by(|a, b| a.0 < b.0 && a.1 > b.1), "{all:?}");
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let data = font(FONTS[1]);
    let of = |jobs| {
        let options = Options { jobs, ..options(&data, "RagÉ%", Target::Mono, 50.0) };
        convert(&data, &options, &Silent).unwrap().font
    };
    assert!(of(1) == of(3));
}

#[test]
fn odd_sizes_are_predicted_from_even_ones() {
    let data = font(FONTS[0]);
    let options = Options { ppem_step: 2, ..options(&data, &ascii(), Target::Smooth, 50.0) };
    let conversion = convert(&data, &options, &Silent).unwrap();
    let font = Font::new(conversion.font).unwrap();
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
    let (mut rasterizer, mut sums) = (Rasterizer::new(&font), nfr_convert::compare::metrics::Sums::default());
    for ppem in (9..64).step_by(2) {
        let at = teacher.at(ppem).unwrap();
        for gid in gids(&data, &ascii()) {
            let truth = at.hinted(gid).unwrap().rasterize().unwrap();
            sums.add(&truth, &rasterizer.render(gid.into(), f32::from(ppem)).unwrap());
        }
    }
    assert!(sums.mae() <= 0.0080, "{}", sums.mae());
}

#[test]
fn a_size_is_drawn_alike_after_smaller_and_after_larger_ones() {
    let data = font(FONTS[2]);
    let font = Font::new(converted(&data, "gé", Target::Mono, 50.0).font).unwrap();
    let sizes = [8.0, 12.4, 30.0, 64.0, 100.0, 9.0];
    for gid in gids(&data, "gé") {
        let mut rasterizer = Rasterizer::new(&font);
        let warm = sizes.map(|ppem| rasterizer.render(gid.into(), ppem).unwrap());
        let fresh = sizes.map(|ppem| Rasterizer::new(&font).render(gid.into(), ppem).unwrap());
        assert!(warm == fresh);
    }
}

/// The columns of pixels that skrifa's hinted outline of a glyph reaches into, for smooth text.
fn hinted_columns(data: &[u8], gid: u16, ppem: f32) -> Option<[i32; 2]> {
    let font = FontRef::new(data).unwrap();
    let mode = SmoothMode::Normal;
    let target =
        skrifa::outline::Target::Smooth { mode, symmetric_rendering: true, preserve_linear_metrics: true };
    let options = HintingOptions { engine: Engine::Interpreter, target };
    let outlines = font.outline_glyphs();
    let hinting = HintingInstance::new(&outlines, Size::new(ppem), LocationRef::default(), options).unwrap();
    let mut pen = ControlBoundsPen::new();
    outlines.get(gid.into()).unwrap().draw(DrawSettings::hinted(&hinting, false), &mut pen).unwrap();
    let bounds = pen.bounding_box()?;
    Some([bounds.x_min.floor() as i32, bounds.x_max.ceil() as i32])
}

#[test]
fn fractional_sizes_are_as_wide_as_with_hints() {
    // With fractional sizes, letters that hinting does not move in x: others have the width of the nearest whole size.
    for (name, text, whole) in
        FONTS.into_iter().flat_map(|name| [(name, "HIl", false), (name, "HIlEXow0%", true)])
    {
        let data = with_whole_sizes(&font(name), whole);
        let font = Font::new(converted(&data, text, Target::Smooth, 50.0).font).unwrap();
        let mut rasterizer = Rasterizer::new(&font);
        for gid in gids(&data, text) {
            for ppem in [8.5, 12.4, 12.6, 17.25, 33.3, 44.5, 63.75] {
                let placement = rasterizer.render(gid.into(), ppem).unwrap().placement;
                let columns = [placement.left, placement.left + placement.width as i32];
                let hinted = hinted_columns(&data, gid, ppem);
                assert_eq!(Some(columns), hinted, "{name}, whole: {whole}, glyph {gid}, {ppem} ppem");
            }
        }
    }
}

#[test]
fn a_model_knows_its_outline() {
    let data = font(FONTS[0]);
    let conversion = converted(&data, "ao", Target::Smooth, 50.0);
    let [a, o] = gids(&data, "ao")[..] else { panic!("two glyphs") };
    let font = Font::new(with_changed_outline(&conversion.font, a)).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    assert_eq!(rasterizer.render(a.into(), 16.0), Err(nfr::Error::StaleModel(a.into())));
    assert!(rasterizer.render(o.into(), 16.0).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_tables_are_errors_or_pictures(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        use std::sync::OnceLock;
        static FONT: OnceLock<Vec<u8>> = OnceLock::new();
        let text = "ag%éÅi";
        let data = FONT.get_or_init(|| converted(&font(FONTS[0]), text, Target::Mono, 100.0).font);
        let file = FontRef::new(data).unwrap();
        let mut table = file.table_data(Tag::new(b"Nfrt")).unwrap().as_bytes().to_vec();
        for (at, byte) in changes {
            let at = at.index(table.len());
            table[at] = byte;
        }
        if let Some(cut) = cut {
            table.truncate(cut.index(table.len()));
        }
        let mut builder = FontBuilder::new();
        builder.add_raw(Tag::new(b"Nfrt"), table).copy_missing_tables(file);
        if let Ok(font) = Font::new(builder.build()) {
            let mut rasterizer = Rasterizer::new(&font);
            for glyph in gids(data, text) {
                for ppem in [9.0, 64.0] {
                    let _ = rasterizer.render(glyph.into(), ppem);
                    let _ = rasterizer.hinted_advance(glyph.into(), ppem);
                }
            }
        }
    }
}

/// The same font with one table changed.
fn with_table(data: &[u8], tag: &[u8; 4], change: impl FnOnce(&FontRef<'_>, &mut Vec<u8>)) -> Vec<u8> {
    let font = FontRef::new(data).unwrap();
    let mut bytes = font.table_data(Tag::new(tag)).unwrap().as_bytes().to_vec();
    change(&font, &mut bytes);
    let mut builder = FontBuilder::new();
    builder.add_raw(Tag::new(tag), bytes).copy_missing_tables(font);
    builder.build()
}

#[test]
fn other_bytes_for_the_same_outline_are_no_other_outline() {
    let data = font("LiberationSans-Regular");
    let converted = converted(&data, "ao", Target::Smooth, 50.0).font;
    // The first flag of the 'o' says that contours overlap, as some compressors write it.
    let same = with_table(&converted, b"glyf", |font, glyf| {
        let loca = font.loca(None).unwrap();
        let at = loca.get_raw(usize::from(gids(&data, "o")[0])).unwrap() as usize;
        let contours = usize::from(u16::from_be_bytes([glyf[at], glyf[at + 1]]));
        glyf[at + 10 + 2 * contours + 2] |= 0x40;
    });
    assert_ne!(same, converted);
    assert!(Font::new(same.clone()).unwrap().outlines_match());
    assert!(FontPair::open(&data, 0, &same).is_ok());
    let other = with_changed_outline(&converted, gids(&data, "o")[0]);
    assert!(!Font::new(other.clone()).unwrap().outlines_match());
    assert!(FontPair::open(&data, 0, &other).is_err());
}

#[test]
fn a_glyph_that_cannot_be_drawn_is_left_out_and_the_others_are_converted() {
    let data = font("LiberationSans-Regular");
    let (a, o) = (gids(&data, "a")[0], gids(&data, "o")[0]);
    // A composite glyph whose only component is itself, at (0, 0).
    let [high, low] = o.to_be_bytes();
    let endless = with_table(&data, b"glyf", |font, glyf| {
        let at = font.loca(None).unwrap().get_raw(o.into()).unwrap() as usize;
        glyf[at..at + 16].copy_from_slice(&[255, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, high, low, 0, 0]);
    });
    let conversion = converted(&endless, "ao", Target::Smooth, 50.0);
    assert_eq!(conversion.left_out, [o]);
    let font = Font::new(conversion.font).unwrap();
    assert!(font.has_model(a.into()) && !font.has_model(o.into()));
    let alone = convert(&endless, &options(&endless, "o", Target::Smooth, 50.0), &Silent).unwrap_err();
    assert!(alone.to_string().contains(&format!("glyph {o}")), "{alone}");
}

#[test]
fn a_font_is_compact_already_and_draws_the_same_when_it_is_written_again() {
    let data = font("LiberationSans-Regular");
    let whole = converted(&data, "abcdeéñop½", Target::Smooth, 50.0).font;
    let again = compact(&whole).unwrap();
    let (whole, again) = (Font::new(whole).unwrap(), Font::new(again).unwrap());
    assert_eq!(whole.table_len(), again.table_len());
    let [mut before, mut after] = [&whole, &again].map(Rasterizer::new);
    for glyph in whole.modelled_glyphs() {
        for ppem in [9.0, 16.0, 40.0, 64.0] {
            assert_eq!(before.render(glyph, ppem), after.render(glyph, ppem), "{glyph} {ppem}");
            assert_eq!(before.hinted_advance(glyph, ppem), after.hinted_advance(glyph, ppem));
        }
    }
}

#[test]
fn a_font_with_another_number_of_glyphs_is_refused() {
    let data = font("LiberationSans-Regular");
    let converted = converted(&data, "a", Target::Smooth, 50.0).font;
    let fewer = with_table(&converted, b"maxp", |_, maxp| maxp[4..6].copy_from_slice(&15u16.to_be_bytes()));
    let error = Font::new(fewer).unwrap_err();
    assert_eq!(error, nfr::Error::Renumbered { models: 2620, font: 15 });
    let told = nfr_convert::Error::from(error).to_string();
    assert!(told.contains("2620") && told.contains("15") && told.contains("convert it"), "{told}");
}
