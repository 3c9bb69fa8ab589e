//! How close converted glyphs come to their hinted bitmaps, and what they cost. The glyphs are few, training and
//! refinement short, so that the bounds hold a small effort to what it reaches; a real conversion does better.

use nfr::{Font, Rasterizer, Target};
use nfr_convert::compare::metrics::{Figures, Sums};
use nfr_convert::teacher::Teacher;
use nfr_convert::{Options, Quality, Shape, convert};
use read_fonts::FontRef;

use crate::samples::{Silent, font, gids};

/// Round, straight and slanted glyphs, some of the hardest among them.
const TEXT: &str = "egR%8";
/// A small part of the default training.
const STEPS: usize = 120;

/// The largest errors of a font's glyphs as a share of the unhinted outlines' errors, and the most bytes of a glyph in a
/// table that only a few glyphs share.
struct Bounds {
    mae: f64,
    bad16: f64,
    bytes_per_glyph: usize,
}

/// The errors and bytes of a conversion.
struct Measured {
    neural: Figures,
    unhinted: Figures,
    bytes_per_glyph: usize,
}

fn options(data: &[u8], text: &str, target: Target, steps: usize) -> Options {
    let mut options = Options { gids: gids(data, text), target, shape: Shape::Field, ..Options::default() };
    options.schedule.steps = steps;
    options.refinement.rounds = 1;
    options
}

fn measure(name: &str, target: Target) -> Measured {
    let data = font(name);
    let options = options(&data, TEXT, target, STEPS);
    let conversion = convert(&data, &options, &Silent).unwrap();
    let neural = Font::new(conversion.font.clone()).unwrap();
    let mut rasterizer = Rasterizer::new(&neural);
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), target).unwrap();
    let (mut ours, mut unhinted) = (Sums::default(), Sums::default());
    for ppem in options.ppem.clone() {
        let at = teacher.at(ppem).unwrap();
        for gid in &options.gids {
            let truth = at.hinted(*gid).unwrap().rasterize().unwrap();
            ours.add(&truth, &rasterizer.render((*gid).into(), f32::from(ppem)).unwrap());
            unhinted.add(&truth, &teacher.unhinted(*gid, ppem.into()).unwrap().rasterize().unwrap());
        }
    }
    assert_eq!(ours, conversion.sums, "{name}: the report is not about what the font draws");
    let bytes_per_glyph = conversion.table_bytes / options.gids.len();
    Measured { neural: ours.figures(), unhinted: unhinted.figures(), bytes_per_glyph }
}

fn hold(name: &str, target: Target, bounds: &Bounds) {
    let measured = measure(name, target);
    let (neural, unhinted) = (measured.neural, measured.unhinted);
    let told = format!(
        "{name}, {target}: mae {:.5} for {:.5}, bad16 {:.4} for {:.4}, {} bytes a glyph",
        neural.mae, unhinted.mae, neural.bad16, unhinted.bad16, measured.bytes_per_glyph
    );
    assert!(neural.mae <= unhinted.mae * bounds.mae, "{told}");
    assert!(neural.bad16 <= unhinted.bad16 * bounds.bad16, "{told}");
    assert!(measured.bytes_per_glyph <= bounds.bytes_per_glyph, "{told}");
    eprintln!("{told}");
}

/// In y alone.
const SMOOTH: Bounds = Bounds { mae: 0.13, bad16: 0.08, bytes_per_glyph: 1200 };
/// In x and y, where the warp has twice as many numbers.
const MONO: Bounds = Bounds { mae: 0.13, bad16: 0.08, bytes_per_glyph: 1250 };

#[test]
fn liberation_sans_is_much_closer_to_its_hinted_bitmaps_than_its_outlines_are() {
    hold("LiberationSans-Regular", Target::Smooth, &SMOOTH);
}

#[test]
fn liberation_serif_is_much_closer_to_its_hinted_bitmaps_than_its_outlines_are() {
    hold("LiberationSerif-Regular", Target::Smooth, &SMOOTH);
}

#[test]
fn dejavu_sans_is_much_closer_to_its_hinted_bitmaps_than_its_outlines_are() {
    hold("DejaVuSans", Target::Smooth, &SMOOTH);
}

#[test]
fn roboto_is_much_closer_to_its_hinted_bitmaps_than_its_outlines_are() {
    hold("Roboto_500Medium", Target::Smooth, &SMOOTH);
}

#[test]
fn hinting_in_x_and_y_is_learnt_too() {
    hold("LiberationSans-Regular", Target::Mono, &MONO);
}

#[test]
fn lcd_hinting_is_learnt_too() {
    hold("DejaVuSans", Target::Lcd, &MONO);
}

#[test]
fn quality_trades_error_for_bytes() {
    let data = font("LiberationSerif-Regular");
    let reached = [0.0, 50.0, 100.0].map(|quality| {
        let mut options =
            options(&data, "gR", Target::Smooth, STEPS).with_quality(Quality::new(quality).unwrap());
        options.refinement.rounds = 1;
        let conversion = convert(&data, &options, &Silent).unwrap();
        (conversion.table_bytes, conversion.sums.mae())
    });
    for pair in reached.windows(2) {
        let ((fewer, worse), (more, better)) = (pair[0], pair[1]);
        assert!(fewer < more && better < worse, "{reached:?}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let data = font("LiberationSans-Regular");
    // More than one chunk.
    let with = |jobs: usize| {
        let options = Options { jobs, ppem: 8..=24, ..options(&data, "abcdefg", Target::Smooth, 12) };
        convert(&data, &options, &Silent).unwrap().font
    };
    let one = with(1);
    assert!(with(1) == one && with(2) == one && with(3) == one);
}
