//! What a conversion says of its result, and whether a check finds out if it is not so.

use std::collections::BTreeMap;

use crate::samples::{FONTS, Silent, font, gid, gids, table, with_changed_outline, with_tables};
use nfr::internals::table::{Certificate, CertifiedErrors, Dropout};
use nfr::{Font, Target};
use nfr_convert::compare::certificate::CertificateCheck;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::{Options, Quality, Shape, convert};

/// Curves, diagonals, an accent and a blank.
const TEXT: &str = "aR%é ";

fn options(data: &[u8], text: &str) -> Options {
    Options { gids: gids(data, text), jobs: 2, ..Options::default() }
}

fn exact(options: Options) -> Options {
    options.with_quality(Quality::new(100.0).unwrap())
}

fn converted(data: &[u8], options: &Options) -> Vec<u8> {
    convert(data, options, &Silent).unwrap().font
}

fn check(original: &[u8], neural: &[u8]) -> CertificateCheck {
    let pair = FontPair::open_edited(original, 0, neural).unwrap();
    let gids: Vec<u16> = nfr::internals::table(pair.font()).unwrap().gids().collect();
    pair.check_certificate(&gids, 2).unwrap().unwrap()
}

fn stated(neural: &[u8]) -> BTreeMap<u16, CertifiedErrors> {
    let font = Font::new(neural.to_vec()).unwrap();
    let table = nfr::internals::table(&font).unwrap();
    table.gids().zip(table.certificate().unwrap().errors()).collect()
}

/// Fields that were hardly trained.
fn fields(data: &[u8], text: &str) -> Options {
    let mut options = Options { shape: Shape::Field, ppem: 9..=14, ..options(data, text) };
    options.schedule.steps = 0;
    options.refinement.rounds = 0;
    options
}

#[test]
fn it_states_the_errors_of_each_glyph_rounded_up() {
    for name in FONTS {
        let data = font(name);
        for options in [options(&data, TEXT), fields(&data, "ae"), exact(options(&data, TEXT))] {
            let neural = converted(&data, &options);
            let pair = FontPair::open(&data, 0, &neural).unwrap();
            let (first, last) = pair.font().ppem_range();
            let stated = stated(&neural);
            let gids: Vec<u16> = stated.keys().copied().collect();
            let report = pair.report(["", ""], &gids, &(first..=last).into(), 2).unwrap();
            for glyph in &report.by_glyph {
                let (errors, figures) = (stated[&glyph.gid], glyph.compared.neural.figures);
                for (stated, measured) in [(errors.mae, figures.mae), (errors.bad16, figures.bad16)] {
                    let stated = stated.value();
                    assert!(stated >= measured && stated <= measured * 17.0 / 16.0 + 2e-6, "{glyph:?}");
                }
                assert_eq!(f64::from(errors.max) / 255.0, figures.max, "{glyph:?}");
            }
            let check = check(&data, &neural);
            assert_eq!((check.failures(), check.glyphs), (Vec::new(), gids.len()));
            assert_eq!(check.is_exact, options.fidelity.is_exact());
            assert!(check.teacher.starts_with("skrifa ") && check.converter.starts_with("nfr-convert "));
        }
    }
}

#[test]
fn sizes_that_were_predicted_are_counted() {
    let data = font(FONTS[0]);
    let options = Options { ppem: 10..=20, ppem_step: 2, ..exact(options(&data, "agR")) };
    let neural = converted(&data, &options);
    let check = check(&data, &neural);
    assert!(check.failures().is_empty() && !check.is_exact, "{check}");
    assert!(check.options.contains("--train-ppem 10-20:2"), "{}", check.options);
    assert!(stated(&neural).values().all(|errors| errors.max > 0));
}

#[test]
fn hints_that_are_others_are_found() {
    let data = font(FONTS[0]);
    let neural = converted(&data, &options(&data, TEXT));
    let mut cvt = table(&data, b"cvt ");
    cvt.iter_mut().skip(1).step_by(2).for_each(|byte| *byte = byte.wrapping_add(90));
    let check = check(&with_tables(&data, &[(b"cvt ", cvt)]), &neural);
    assert!(check.failures()[0].contains("are larger than it says"), "{check}");
    assert!(check.to_string().contains("does not hold"), "{check}");
    let worst = check.exceeded[0];
    assert!(worst.measured.max > worst.stated.max && worst.measured.mae > worst.stated.mae);
}

#[test]
fn errors_that_are_stated_too_low_are_found() {
    let data = font(FONTS[1]);
    let neural = converted(&data, &options(&data, "aR"));
    let (nfrt, errors) = (table(&neural, b"Nfrt"), stated(&neural));
    let start = nfrt.len() - 3 * errors.len();
    let mut found = 0;
    for at in start..nfrt.len() {
        if nfrt[at] > 0 {
            let mut lower = nfrt.clone();
            lower[at] -= 1;
            let check = check(&data, &with_tables(&neural, &[(b"Nfrt", lower)]));
            assert_eq!(check.exceeded.len(), 1, "byte {at}");
            found += 1;
        }
    }
    assert!(found >= 2, "{errors:?}");
}

#[test]
fn a_glyph_whose_outline_was_changed_is_not_measured() {
    let data = font(FONTS[0]);
    let neural = converted(&data, &options(&data, "ao"));
    let check = check(&data, &with_changed_outline(&neural, gid(&data, 'a')));
    assert_eq!((check.glyphs, check.failures()), (1, Vec::new()));
}

#[test]
fn another_advance_width_makes_a_glyph_stale() {
    let data = font(FONTS[0]);
    let neural = converted(&data, &options(&data, "aeé"));
    let mut hmtx = table(&neural, b"hmtx");
    for character in ['a', 'é'] {
        hmtx[4 * usize::from(gid(&data, character)) + 1] ^= 1;
    }
    let font = Font::new(with_tables(&neural, &[(b"hmtx", hmtx)])).unwrap();
    let mut rasterizer = nfr::Rasterizer::new(&font);
    for (character, is_stale) in [('a', true), ('e', false), ('é', true)] {
        let glyph = gid(&data, character).into();
        let is_refused = matches!(rasterizer.draw(glyph, 12.0), Err(nfr::Error::StaleModel(_)));
        assert_eq!(is_refused, is_stale, "{character}");
    }
}

#[test]
fn a_table_that_ends_in_its_certificate_is_refused() {
    let data = font(FONTS[0]);
    let neural = converted(&data, &options(&data, "a"));
    let nfrt = table(&neural, b"Nfrt");
    let length = {
        let mut bytes = Vec::new();
        let font = Font::new(neural.clone()).unwrap();
        let table = nfr::internals::table(&font).unwrap();
        let certificate: Certificate<'_> = table.certificate().unwrap();
        certificate.write(certificate.errors(), &mut bytes);
        bytes.len()
    };
    for cut in 1..=length {
        let short = with_tables(&neural, &[(b"Nfrt", nfrt[..nfrt.len() - cut].to_vec())]);
        assert!(Font::new(short).is_err(), "{cut} bytes fewer");
    }
}

#[test]
fn mono_fonts_have_the_modes_of_drop_out_control_and_others_have_not() {
    let [simple, smart] = [false, true].map(|smart| Dropout::new(smart, false));
    // In Roboto, `prep` asks for another scan type below 9 ppem.
    let expected =
        [("LiberationSans-Regular", 8, smart), ("DejaVuSans", 8, simple), ("Roboto_500Medium", 8, simple)];
    for (name, ppem, mode) in expected {
        let path = format!("{}/../../fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR"));
        let data = std::fs::read(path).unwrap();
        let options = Options { target: Target::Mono, ppem: 8..=12, ..options(&data, "ae ") };
        let font = Font::new(converted(&data, &options)).unwrap();
        let table = nfr::internals::table(&font).unwrap();
        let modes = table.dropout().unwrap();
        assert_eq!(modes.mode(gid(&data, 'a').into(), ppem), Some(mode), "{name}");
        assert_eq!(modes.exceptions().count(), 0);
        if name.starts_with("Roboto") {
            assert_eq!(modes.ranges().collect::<Vec<_>>(), [(8, simple), (12, smart)]);
        }
    }
    let data = font(FONTS[0]);
    let smooth = Font::new(converted(&data, &options(&data, "a"))).unwrap();
    assert!(nfr::internals::table(&smooth).unwrap().dropout().is_none());
}
