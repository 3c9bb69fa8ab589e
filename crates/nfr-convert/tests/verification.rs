//! Verifying converted fonts: what is equal is found equal, and whatever is not is found.

use crate::samples::{FONTS, Silent, font, gid, gids, table, with_changed_outline, with_tables};
use nfr::Target;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::verification::{NoPoints, Verification};
use nfr_convert::{Conversion, Error, Options, Quality, Shape, convert};

/// Letters, a ring of curves, a letter composed of others, and a blank.
const TEXT: &str = "aegR%8éúü ";

fn options(data: &[u8], text: &str, quality: f32) -> Options {
    let quality = Quality::new(quality).unwrap();
    Options { gids: gids(data, text), jobs: 2, ..Options::default().with_quality(quality) }
}

fn converted(data: &[u8], text: &str, quality: f32) -> Conversion {
    convert(data, &options(data, text, quality), &Silent).unwrap()
}

/// Verifies some glyphs at all trained sizes.
fn verify(original: &[u8], neural: &[u8], gids: &[u16]) -> Result<Verification, Error> {
    let pair = FontPair::open_edited(original, 0, neural)?;
    pair.verify(["original", "neural"], gids, &(8..=64).into(), 2)
}

#[test]
fn at_quality_100_every_point_and_advance_width_is_equal() {
    for name in FONTS {
        let data = font(name);
        for target in [Target::Smooth, Target::Mono] {
            let options = Options { target, ..options(&data, TEXT, 100.0) };
            let conversion = convert(&data, &options, &Silent).unwrap();
            // Hinting in x moves accents of some letters by fractions of a pixel.
            let composed = conversion.glyphs.iter().filter(|glyph| glyph.composed).count();
            assert!(target == Target::Mono || composed >= 3, "{name}: {composed} glyphs are composed");
            let found = verify(&data, &conversion.font, &options.gids).unwrap();
            assert_eq!(found.failures(0), Vec::<String>::new(), "{name} {target}\n{found}");
            // 57 sizes, and more than ten points a glyph.
            assert_eq!(found.totals.glyph_sizes, 57 * options.gids.len() as u64);
            assert_eq!(found.totals.advances, found.totals.glyph_sizes);
            // A blank has none.
            assert_eq!(found.totals.bearings, found.totals.glyph_sizes - 57);
            assert!(found.totals.points > 10 * found.totals.glyph_sizes && found.not_compared.is_empty());
        }
    }
}

#[test]
fn by_default_points_differ_a_little_and_advance_widths_do_not() {
    let data = font(FONTS[0]);
    let found = verify(&data, &converted(&data, TEXT, 50.0).font, &gids(&data, TEXT)).unwrap();
    let totals = found.totals;
    assert!(totals.differing_points > 0 && totals.differing_points < totals.points / 5, "{found}");
    assert!((1..64).contains(&totals.largest_difference) && totals.differing_advances == 0, "{found}");
    assert!(found.failures(totals.largest_difference).is_empty());
    assert!(found.failures(totals.largest_difference - 1)[0].contains("points differ"));
    assert_eq!(found.by_glyph[0].tally.largest_difference, totals.largest_difference);
    assert!(found.by_ppem.iter().any(|size| Some(size.ppem) == found.by_glyph[0].worst_ppem));
}

#[test]
fn an_original_that_is_hinted_otherwise_is_found() {
    let data = font(FONTS[0]);
    let neural = converted(&data, "ae", 100.0).font;
    // Alignment zones and stem widths.
    let mut cvt = table(&data, b"cvt ");
    cvt.iter_mut().skip(1).step_by(2).for_each(|byte| *byte = byte.wrapping_add(90));
    let found = verify(&with_tables(&data, &[(b"cvt ", cvt)]), &neural, &gids(&data, "ae")).unwrap();
    assert!(found.failures(0)[0].contains("points differ"), "{found}");
}

#[test]
fn advance_widths_that_were_changed_are_found() {
    let data = font(FONTS[0]);
    let neural = converted(&data, "ae", 100.0).font;
    let mut hmtx = table(&data, b"hmtx");
    hmtx[4 * usize::from(gid(&data, 'a'))] ^= 1;
    let found = verify(&data, &with_tables(&neural, &[(b"hmtx", hmtx)]), &gids(&data, "e")).unwrap();
    assert!(found.failures(0).is_empty(), "{found}");
    let mut hmtx = table(&data, b"hmtx");
    hmtx[4 * usize::from(gid(&data, 'a'))] ^= 1;
    let found = verify(&with_tables(&data, &[(b"hmtx", hmtx)]), &neural, &gids(&data, "a")).unwrap();
    assert!(found.totals.differing_advances > 0 && found.failures(100)[0].contains("advance"), "{found}");
}

#[test]
fn a_model_that_was_changed_is_an_error_or_found() {
    let data = font(FONTS[1]);
    let (neural, gids) = (converted(&data, "R", 100.0).font, gids(&data, "R"));
    let nfrt = table(&neural, b"Nfrt");
    let mut differ = 0;
    // Models are before the certificate.
    let mut certificate = Vec::new();
    let read = nfr::Font::new(neural.clone()).unwrap();
    let stated = nfr::internals::table(&read).unwrap().certificate().unwrap();
    stated.write(stated.errors(), &mut certificate);
    for from_end in (certificate.len() + 8..nfrt.len() - nfr::internals::table::HEADER_LEN).step_by(3) {
        let mut nfrt = nfrt.clone();
        let at = nfrt.len() - from_end;
        nfrt[at] ^= 0x10;
        if let Ok(found) = verify(&data, &with_tables(&neural, &[(b"Nfrt", nfrt)]), &gids) {
            assert!(!found.failures(0).is_empty(), "byte {at}\n{found}");
            differ += 1;
        }
    }
    assert!(differ > 0, "every change is an error");
}

#[test]
fn a_glyph_whose_outline_was_changed_is_told_and_the_others_are_compared() {
    let data = font(FONTS[0]);
    let neural = with_changed_outline(&converted(&data, "ao", 100.0).font, gid(&data, 'a'));
    let found = verify(&data, &neural, &gids(&data, "ao")).unwrap();
    let not_compared: Vec<_> = found.not_compared.iter().map(|glyph| (glyph.gid, glyph.reason)).collect();
    assert_eq!(not_compared, [(gid(&data, 'a'), NoPoints::Stale)]);
    assert!(found.totals.is_equal() && found.by_glyph.len() == 1 && found.failures(0).len() == 1);
}

#[test]
fn glyphs_without_points_are_told_with_the_reason() {
    let data = font(FONTS[0]);
    let mut fields = Options { shape: Shape::Field, ..options(&data, "e", 50.0) };
    fields.schedule.steps = 0;
    fields.refinement.rounds = 0;
    let neural = convert(&data, &fields, &Silent).unwrap().font;
    let network =
        std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../spec/vectors/network.ttf")).unwrap();
    let network = with_tables(&data, &[(b"Nfrt", table(&network, b"Nfrt"))]);
    let (a, e) = (gid(&data, 'a'), gid(&data, 'e'));
    for (neural, gid, reason) in
        [(&neural, e, NoPoints::Field), (&neural, a, NoPoints::NoModel), (&network, 1, NoPoints::Network)]
    {
        let found = verify(&data, neural, &[gid]).unwrap();
        assert_eq!(found.reasons().into_iter().collect::<Vec<_>>(), [(reason, 1)]);
        assert!(found.failures(0)[0].contains("cannot be compared"));
    }
}

#[test]
fn predicted_sizes_are_compared_with_the_hints_that_were_not_learned() {
    let data = font(FONTS[0]);
    let options = Options { ppem: 10..=20, ppem_step: 2, ..options(&data, "agR", 100.0) };
    let neural = convert(&data, &options, &Silent).unwrap().font;
    let found = verify(&data, &neural, &options.gids).unwrap();
    for size in &found.by_ppem {
        let is_learned = (10..=20).contains(&size.ppem) && size.ppem % 2 == 0;
        assert_eq!(size.tally.is_equal(), is_learned, "{} ppem: {:?}", size.ppem, size.tally);
    }
}

#[test]
fn fonts_that_do_not_belong_together_are_refused() {
    let data = font(FONTS[0]);
    let neural = converted(&data, "ab", 50.0).font;
    let refusal = |original: &[u8]| verify(original, &neural, &gids(&data, "ab")).unwrap_err().to_string();
    assert!(refusal(&font(FONTS[2])).contains("2620"));
    // 'a' and 'b' change places, and so do their names (OpenType 1.9, "post", version 2).
    let (a, b) = (usize::from(gid(&data, 'a')), usize::from(gid(&data, 'b')));
    let (mut post, mut loca) = (table(&data, b"post"), table(&data, b"loca"));
    (0..2).for_each(|k| post.swap(34 + 2 * a + k, 34 + 2 * b + k));
    let reordered = with_tables(&data, &[(b"post", post)]);
    assert!(verify(&reordered, &neural, &gids(&data, "ab")).unwrap().failures(100).is_empty());
    assert_eq!(b, a + 1, "one entry of 'loca' changes");
    let width = if table(&data, b"head")[51] == 0 { 2 } else { 4 };
    let entry = |loca: &[u8], k: usize| {
        loca[k * width..][..width].iter().fold(0u32, |value, byte| value << 8 | u32::from(*byte))
    };
    let [start, middle, end] = [a, b, b + 1].map(|k| entry(&loca, k));
    let scale = if width == 2 { 2 } else { 1 };
    let [from, at, to] = [start, middle, end].map(|offset| (offset * scale) as usize);
    let mut glyf = table(&data, b"glyf");
    glyf[from..to].rotate_left(at - from);
    let value = (start + end - middle).to_be_bytes();
    loca[b * width..][..width].copy_from_slice(&value[4 - width..]);
    let reordered = with_tables(&reordered, &[(b"loca", loca), (b"glyf", glyf)]);
    let error = refusal(&reordered);
    assert!(error.contains("order of glyphs") && error.contains("'b' in the original"), "{error}");
}
