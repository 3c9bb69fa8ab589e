//! Fonts without hints learn from skrifa's autohinter, which is FreeType's.

use std::collections::BTreeSet;
use std::rc::Rc;

use crate::samples::{FONTS, Silent, ascii, font, gid, gids};
use freetype::face::LoadFlag;
use nfr::Target;
use nfr_convert::assemble::assemble;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::ppem::PpemList;
use nfr_convert::teacher::Teacher;
use nfr_convert::{Error, Hinter, Options, convert};
use read_fonts::FontRef;

/// The largest error over printable ASCII at 8–64 ppem.
const MAE: f64 = 0.0006;

/// A font without its hints; its models are empty, and nobody looks at them.
fn unhinted(name: &str) -> Vec<u8> {
    let data = font(name);
    let bare = assemble(&FontRef::new(&data).unwrap(), &[], &BTreeSet::new()).unwrap();
    let bare = FontRef::new(&bare).unwrap();
    let mut builder = write_fonts::FontBuilder::new();
    for record in bare.table_directory().table_records().iter().filter(|record| record.tag() != "Nfrt") {
        builder.add_raw(record.tag(), bare.table_data(record.tag()).unwrap().as_bytes().to_vec());
    }
    builder.build()
}

#[test]
fn its_points_and_advances_are_those_of_freetypes_light_autohinter() {
    for name in FONTS {
        let data = unhinted(name);
        let teacher =
            Teacher::with_hinter(&FontRef::new(&data).unwrap(), Target::Smooth, Hinter::Auto).unwrap();
        let face = freetype::Library::init().unwrap().new_memory_face(Rc::new(data.clone()), 0).unwrap();
        for ppem in [8, 11, 12, 13, 16, 21, 32, 64] {
            let at = teacher.at(ppem).unwrap();
            face.set_pixel_sizes(0, ppem.into()).unwrap();
            for character in ascii().chars() {
                let gid = gid(&data, character);
                let ours = at.hinted(gid).unwrap();
                let flags = LoadFlag::TARGET_LIGHT | LoadFlag::FORCE_AUTOHINT | LoadFlag::NO_BITMAP;
                face.load_glyph(gid.into(), flags).unwrap();
                let bounds = |axis: usize| {
                    let values: Vec<i64> =
                        ours.points.iter().map(|point| (point[axis] * 64.0).round() as i64).collect();
                    (values.iter().min().copied().unwrap(), values.iter().max().copied().unwrap())
                };
                let theirs = face.glyph().outline().unwrap().points().to_vec();
                let low = |axis: fn(&freetype::Vector) -> i64| theirs.iter().map(axis).min().unwrap();
                let high = |axis: fn(&freetype::Vector) -> i64| theirs.iter().map(axis).max().unwrap();
                let place = format!("{name} {character:?} at {ppem} ppem");
                assert_eq!(bounds(0), (low(|p| p.x), high(|p| p.x)), "{place}, along x");
                assert_eq!(bounds(1), (low(|p| p.y), high(|p| p.y)), "{place}, along y");
                let advance = face.glyph().advance().x as f32 / 64.0;
                assert_eq!(ours.advance, Some(advance), "{place}");
            }
        }
    }
}

#[test]
fn models_of_an_unhinted_font_draw_what_the_autohinter_draws() {
    for name in ["LiberationSans-Regular", "Roboto_500Medium"] {
        let data = unhinted(name);
        let options = |hinter| Options { gids: gids(&data, &ascii()), hinter, ..Options::default() };
        let refused = convert(&data, &options(Hinter::Font), &Silent).unwrap_err();
        assert!(matches!(&refused, Error::Unsupported(text) if text.contains("--hinter auto")), "{refused}");
        let conversion = convert(&data, &options(Hinter::Auto), &Silent).unwrap();
        // The certificate says which hinter to compare with.
        let pair = FontPair::open(&data, 0, &conversion.font).unwrap();
        assert_eq!(pair.teacher().hinter(), Hinter::Auto);
        let report = pair.report(["", ""], &gids(&data, &ascii()), &PpemList::from(8..=64), 1).unwrap();
        let totals = report.totals;
        let (mae, unhinted) = (totals.neural.figures.mae, totals.unhinted.figures.mae);
        assert!(mae <= MAE && unhinted > 0.02, "{name}: {mae}, unhinted {unhinted}");
        assert_eq!(mae, conversion.sums.mae());
    }
}
