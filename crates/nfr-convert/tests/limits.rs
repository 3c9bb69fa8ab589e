//! Options and fonts that cannot be converted are refused before any training.
#![allow(clippy::unwrap_used)]

mod samples;

use std::sync::atomic::{AtomicUsize, Ordering};

use nfr_convert::options::Capacity;
use nfr_convert::{Conversion, Error, Options, Progress, Shape, convert};
use read_fonts::tables::glyf::{CurvePoint, Glyph};
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use write_fonts::FontBuilder;
use write_fonts::from_obj::ToOwnedTable;
use write_fonts::tables::glyf::{GlyfLocaBuilder, Glyph as NewGlyph, SimpleGlyph};

use samples::{font, gids};

// OpenType 1.9, "head".
const UNITS_PER_EM_AT: usize = 18;
const INDEX_TO_LOC_FORMAT_AT: usize = 50;
/// Of the shipped font.
const UNITS: i32 = 2048;

/// Counts what is told while a conversion runs: 0 if it ends before its first stage does.
#[derive(Default)]
struct Told(AtomicUsize);

impl Progress for Told {
    fn planned(&self, _: usize) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    fn glyph_done(&self, _: u16, _: f64) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

fn rounded(value: i16, units: u16) -> i16 {
    (f64::from(value) * f64::from(units) / f64::from(UNITS)).round() as i16
}

/// Liberation Sans drawn on another grid: simple glyphs and control values are scaled and rounded.
fn with_units(units: u16) -> Vec<u8> {
    let data = font("LiberationSans-Regular");
    let font = FontRef::new(&data).unwrap();
    let (loca, glyf) = (font.loca(None).unwrap(), font.glyf().unwrap());
    let mut glyphs = GlyfLocaBuilder::new();
    for gid in 0..font.maxp().unwrap().num_glyphs() {
        let scaled = match loca.get_glyf(gid.into(), &glyf).unwrap() {
            Some(Glyph::Simple(glyph)) => {
                let mut glyph: SimpleGlyph = glyph.to_owned_table();
                for contour in &mut glyph.contours {
                    let points: Vec<CurvePoint> = contour.clone().into();
                    let scale =
                        |p: CurvePoint| CurvePoint::new(rounded(p.x, units), rounded(p.y, units), p.on_curve);
                    *contour = points.into_iter().map(scale).collect::<Vec<_>>().into();
                }
                glyph.recompute_bounding_box();
                NewGlyph::Simple(glyph)
            }
            _ => NewGlyph::Empty,
        };
        glyphs.add_glyph(&scaled).unwrap();
    }
    let (glyf, loca, format) = glyphs.build();
    let bytes = |tag: &[u8; 4]| font.table_data(Tag::new(tag)).unwrap().as_bytes().to_vec();
    let mut head = bytes(b"head");
    head[UNITS_PER_EM_AT..][..2].copy_from_slice(&units.to_be_bytes());
    head[INDEX_TO_LOC_FORMAT_AT..][..2].copy_from_slice(&(format as u16).to_be_bytes());
    let cvt = bytes(b"cvt ");
    let cvt =
        cvt.chunks_exact(2).flat_map(|v| rounded(i16::from_be_bytes([v[0], v[1]]), units).to_be_bytes());
    let mut builder = FontBuilder::new();
    builder.add_table(&glyf).unwrap().add_table(&loca).unwrap();
    builder.add_raw(Tag::new(b"head"), head).add_raw(Tag::new(b"cvt "), cvt.collect::<Vec<u8>>());
    builder.copy_missing_tables(font);
    builder.build()
}

/// Steps of training, in builds that have it.
const STEPS: usize = if cfg!(feature = "train") { 4 } else { 0 };

fn options(font: &[u8]) -> Options {
    let mut options =
        Options { gids: gids(font, "BRags&"), ppem: 8..=40, shape: Shape::Field, ..Options::default() };
    options.schedule.steps = STEPS;
    options.refinement.rounds = 0;
    options
}

fn converted(data: &[u8], options: &Options) -> (Result<Conversion, Error>, usize) {
    let told = Told::default();
    let result = convert(data, options, &told);
    (result, told.0.into_inner())
}

#[test]
fn an_em_that_opentype_does_not_allow_is_refused_before_any_work() {
    let mut data = font("LiberationSans-Regular");
    let options = options(&data);
    let head = FontRef::new(&data).unwrap();
    let records = head.table_directory().table_records();
    let at = records.iter().find(|r| r.tag() == Tag::new(b"head")).unwrap().offset() as usize;
    for units in [0u16, 1, 8, 15, 16385, u16::MAX] {
        data[at + UNITS_PER_EM_AT..][..2].copy_from_slice(&units.to_be_bytes());
        let (result, told) = converted(&data, &options);
        let error = result.unwrap_err();
        assert!(
            matches!(&error, Error::Malformed(text) if text.contains("units per em")),
            "{units}: {error}"
        );
        assert_eq!(told, 0, "{units}");
        assert!(nfr_convert::open::open(&data, 0).is_err(), "{units}");
        let font = FontRef::new(&data).unwrap();
        assert!(nfr_convert::teacher::Teacher::new(&font, nfr::Target::Smooth).is_err(), "{units}");
    }
}

#[test]
fn a_font_with_few_units_in_an_em_converts() {
    for units in [16, 64, 100] {
        let data = with_units(units);
        for target in [nfr::Target::Smooth, nfr::Target::Mono] {
            let options = Options { target, ..options(&data) };
            let conversion = converted(&data, &options).0.unwrap_or_else(|e| panic!("{units}: {e}"));
            let font = nfr::Font::new(conversion.font.clone()).unwrap();
            for gid in &options.gids {
                let bitmap = nfr::Rasterizer::new(&font).render((*gid).into(), 16.0).unwrap();
                assert!(bitmap.pixels.iter().any(|p| *p > 200), "{units}: glyph {gid} is blank");
            }
        }
    }
}

#[test]
fn options_that_make_no_sense_are_refused_before_any_work() {
    let data = font("LiberationSans-Regular");
    let good = options(&data);
    assert_eq!(good.check(), Ok(()));
    let capacity = |change: fn(&mut Capacity)| {
        let mut options = good.clone();
        change(&mut options.capacity);
        options
    };
    let with = |change: fn(&mut Options)| {
        let mut options = good.clone();
        change(&mut options);
        options
    };
    let mut wrong = vec![
        with(|o| o.gids.clear()),
        with(|o| o.gids.reverse()),
        with(|o| o.gids[1] = o.gids[0]),
        with(|o| o.ppem = 0..=9),
        #[allow(clippy::reversed_empty_ranges)]
        with(|o| o.ppem = 9..=8),
        with(|o| o.ppem = 8..=1025),
        with(|o| o.ppem_step = 0),
        with(|o| o.jobs = 0),
        with(|o| o.schedule.steps = 65_536),
        capacity(|c| c.knots = 0),
        capacity(|c| c.knots = 1),
        capacity(|c| c.knots = 33),
        capacity(|c| c.rank = 17),
        capacity(|c| c.least_rank = 9),
        capacity(|c| c.least_rank = 0),
        capacity(|c| c.knot_gain = f64::NAN),
        capacity(|c| c.pattern_gain = -1.0),
    ];
    for v in [f32::NAN, f32::INFINITY, 0.0, -0.03, 1e-6, 7.0] {
        let mut options = good.clone();
        options.capacity.cell = v;
        wrong.push(options);
    }
    for v in [f32::NAN, f32::INFINITY, -0.1, 1.1] {
        let mut options = good.clone();
        options.schedule.rounded_from = v;
        wrong.push(options);
    }
    for v in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0] {
        let numbers: [fn(&mut Options) -> &mut f64; 6] = [
            |o| &mut o.schedule.field_rate,
            |o| &mut o.schedule.warp_rate,
            |o| &mut o.schedule.pattern_rate,
            |o| &mut o.schedule.embedding_rate,
            |o| &mut o.schedule.smoothness,
            |o| &mut o.refinement.error_per_bit,
        ];
        for number in numbers {
            let mut options = good.clone();
            *number(&mut options) = v;
            wrong.push(options);
        }
    }
    for options in wrong {
        let (result, told) = converted(&data, &options);
        assert!(matches!(result, Err(Error::InvalidParameter(_))), "{options:?}");
        assert_eq!(told, 0, "{options:?}");
    }
}

#[test]
fn options_at_their_limits_convert() {
    let data = font("LiberationSans-Regular");
    let least =
        Capacity { cell: 0.5, knots: 2, knot_gain: 0.0, rank: 1, least_rank: 1, pattern_gain: f64::INFINITY };
    let most =
        Capacity { cell: 0.0001, knots: 32, knot_gain: 0.0, rank: 16, least_rank: 16, pattern_gain: 0.0 };
    for capacity in [least, most] {
        let mut options = Options { capacity, ..options(&data) };
        options.gids.truncate(1);
        let conversion = converted(&data, &options).0.unwrap_or_else(|e| panic!("{capacity:?}: {e}"));
        assert!(nfr::Font::new(conversion.font.clone()).is_ok());
    }
}

#[cfg(feature = "train")]
#[test]
fn a_training_that_diverges_is_an_error_and_no_blank_glyph() {
    let data = font("LiberationSans-Regular");
    let mut options = options(&data);
    options.gids.truncate(1);
    options.schedule.field_rate = f64::MAX;
    let error = converted(&data, &options).0.unwrap_err();
    assert!(matches!(&error, Error::InvalidParameter(text) if text.contains("not finite")), "{error}");
}

#[cfg(not(feature = "train"))]
#[test]
fn a_build_without_training_refuses_a_field_before_any_glyph_is_ready() {
    let data = font("LiberationSans-Regular");
    let (space, a) = (gids(&data, " ")[0], gids(&data, "A")[0]);
    let mut fields = options(&data);
    fields.gids = vec![space, a];
    // Neither a blank glyph nor an initial fit is trained.
    assert!(converted(&data, &fields).0.is_ok());
    fields.schedule.steps = 1;
    let dropped = Options { shape: Shape::Auto, drop_outlines: true, ..fields.clone() };
    for (options, reason) in
        [(&fields, "the shape asked for is 'field'"), (&dropped, "its outline is to be dropped")]
    {
        let (result, told) = converted(&data, options);
        let error = result.unwrap_err();
        assert_eq!(error, Error::TrainingNotBuilt { gid: a, outlines_dropped: options.drop_outlines });
        for part in [&format!("glyph {a} "), reason, "cargo build --release --bins --features train"] {
            assert!(error.to_string().contains(part), "{part:?} is not in {error}");
        }
        // The number of glyphs, which is planned, is all that is told.
        assert_eq!(told, 1);
    }
    let outlines = Options { shape: Shape::Auto, ..fields };
    assert!(converted(&data, &outlines).0.is_ok());
}
