//! What matters for whole fonts: glyphs that share models, interrupted conversions, outlines left out, and sizes
//! left out. Training is cut short or left out: the models are rough, but whole.

use std::collections::BTreeSet;

use nfr::internals::decode;
use nfr::{Font, Rasterizer, Target};
use nfr_convert::Error;
use nfr_convert::assemble::assemble;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::metrics::Sums;
use nfr_convert::compare::picture::check_close;
use nfr_convert::partial::Partial;
use nfr_convert::teacher::Teacher;
use nfr_convert::{Conversion, Options, Shape, convert, resume};
use read_fonts::types::GlyphId;
use read_fonts::{FontRef, TableProvider};

use crate::common::{Directory, SANS, font, nfr_convert, sans};
use crate::samples::{Silent, gid, gids};

/// Capitals and small letters with accents above and below, and all that they are made of but the accents.
const ACCENTED: &str = "AEaeoucÁÀÂÄÅáàâäåéèêëóòôöúùûüç";

fn options(data: &[u8], text: &str, steps: usize) -> Options {
    let mut options =
        Options { gids: gids(data, text), ppem: 8..=40, shape: Shape::Field, ..Options::default() };
    options.schedule.steps = steps;
    options.refinement.rounds = 0;
    options
}

fn composed(conversion: &Conversion) -> BTreeSet<u16> {
    conversion.glyphs.iter().filter(|glyph| glyph.composed).map(|glyph| glyph.gid).collect()
}

#[test]
fn accented_letters_are_put_together_from_the_models_of_their_parts() {
    for name in ["LiberationSans-Regular", "LiberationSerif-Regular", "DejaVuSans"] {
        let data = font(name);
        let conversion = convert(&data, &options(&data, ACCENTED, 0), &Silent).unwrap();
        let composed = composed(&conversion);
        for character in "ÁÀáàâéèêëóòôöúùûü".chars() {
            assert!(composed.contains(&gid(&data, character)), "{name}: {character} has a model of its own");
        }
        let bytes = |of: bool| {
            let lengths = conversion.glyphs.iter().filter(|glyph| glyph.composed == of).map(|g| g.bytes);
            lengths.clone().sum::<usize>() / lengths.count()
        };
        assert!(bytes(true) * 8 < bytes(false), "{name}: {} bytes for {}", bytes(true), bytes(false));
    }
}

#[test]
fn a_composed_glyph_is_drawn_as_its_parts_where_hints_put_them() {
    let data = font("LiberationSans-Regular");
    let conversion = convert(&data, &options(&data, ACCENTED, 0), &Silent).unwrap();
    let font = Font::new(conversion.font.clone()).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
    let (mut base, mut accented) = (Sums::default(), Sums::default());
    for ppem in 8..=40 {
        let at = teacher.at(ppem).unwrap();
        let mut add = |sums: &mut Sums, text: &str| {
            for gid in gids(&data, text) {
                let truth = at.hinted(gid).unwrap().rasterize().unwrap();
                sums.add(&truth, &rasterizer.render(gid.into(), f32::from(ppem)).unwrap());
            }
        };
        add(&mut base, "aeou");
        add(&mut accented, "áàâéèêóòôúùû");
    }
    // The accents' models are as rough as the letters', and the boxes are larger.
    assert!(accented.mae() < 1.2 * base.mae(), "{} for {}", accented.mae(), base.mae());
}

#[test]
fn a_composed_glyph_of_the_font_equals_that_of_the_rasterizer_at_any_size() {
    let data = font("DejaVuSans");
    let conversion = convert(&data, &options(&data, ACCENTED, 0), &Silent).unwrap();
    let font = Font::new(conversion.font.clone()).unwrap();
    assert!(font.modelled_glyphs().is_sorted());
    assert_eq!(font.modelled_glyphs().len(), conversion.glyphs.len());
    // A cache of one byte holds one glyph.
    let mut rasterizers = [8 << 20, 1].map(|bytes| Rasterizer::new(&font).with_cache(bytes));
    for gid in font.modelled_glyphs() {
        let glyph = decode(&font, gid).unwrap();
        for ppem in [7.0, 12.0, 13.4, 40.0, 90.0] {
            let bitmap = glyph.render(ppem).unwrap();
            for rasterizer in &mut rasterizers {
                let drawn = rasterizer.render(gid, ppem).unwrap();
                assert_eq!(drawn.placement, bitmap.placement, "glyph {gid} at {ppem} ppem");
                check_close(&format!("glyph {gid} at {ppem} ppem"), &bitmap, &drawn, 0).unwrap();
                // Whatever the buffer held is drawn over.
                let mut pixels = vec![77; bitmap.pixels.len() + 1];
                let pitch = bitmap.placement.width as usize;
                assert_eq!(rasterizer.render_into(gid, ppem, &mut pixels, pitch), Ok(bitmap.placement));
                assert!(pixels[..bitmap.pixels.len()] == bitmap.pixels && pixels.ends_with(&[77]));
            }
        }
    }
}

#[test]
fn equal_shapes_have_one_model() {
    let data = font("LiberationSans-Regular");
    // Latin A, Greek Alpha and Cyrillic A.
    let conversion = convert(&data, &options(&data, "A\u{391}\u{410}", 0), &Silent).unwrap();
    let font = Font::new(conversion.font.clone()).unwrap();
    let bitmaps = ['A', '\u{391}', '\u{410}'].map(|c| {
        let gid = font.glyph_for_char(c).unwrap();
        decode(&font, gid).unwrap().render(17.0).unwrap()
    });
    assert_eq!(composed(&conversion).len(), conversion.glyphs.len() - 1);
    assert!(bitmaps[0] == bitmaps[1] && bitmaps[0] == bitmaps[2]);
}

#[test]
fn an_accented_letter_alone_has_a_model_of_its_own() {
    let data = font("LiberationSans-Regular");
    let conversion = convert(&data, &options(&data, "é", 0), &Silent).unwrap();
    assert_eq!(conversion.glyphs.len(), 1);
    assert!(composed(&conversion).is_empty());
}

/// Steps of the conversions that are interrupted: where training is built, their weights must not be the first guesses.
const STEPS: usize = if cfg!(feature = "train") { 3 } else { 0 };
const RESUMED: &str = "abcdefghé";

fn options_of_resumed(data: &[u8]) -> Options {
    Options { ppem: 10..=14, ..options(data, RESUMED, STEPS) }
}

#[test]
fn an_interrupted_conversion_gives_the_same_font_wherever_its_file_was_cut_off() {
    let data = sans();
    let options = options_of_resumed(&data);
    let whole = convert(&data, &options, &Silent).unwrap();
    let directory = Directory::new();
    let path = directory.path("out.ttf.partial");
    let partial = Partial::open(&path, &data, &options, false).unwrap();
    assert!(directory.files().is_empty(), "the file is there before it holds anything");
    assert!(resume(&data, &options, &Silent, Some(&partial)).unwrap().font == whole.font);
    drop(partial);
    let bytes = std::fs::read(&path).unwrap();
    let mut found = BTreeSet::new();
    for cut in [0, 5, 21, 22, 30, bytes.len() / 2, bytes.len() - 1, bytes.len()] {
        std::fs::write(&path, &bytes[..cut]).unwrap();
        let partial = Partial::open(&path, &data, &options, true).unwrap();
        found.insert(partial.found());
        let resumed = resume(&data, &options, &Silent, Some(&partial)).unwrap();
        assert!(resumed.font == whole.font && resumed.sums == whole.sums, "cut off at {cut}");
        // What was found was not trained again, or the file would be longer.
        assert_eq!(std::fs::read(&path).unwrap().len(), bytes.len(), "cut off at {cut}");
        partial.remove().unwrap();
        assert!(directory.files().is_empty());
    }
    let trained = whole.glyphs.iter().filter(|glyph| !glyph.composed).count();
    assert_eq!((found.first(), found.last()), (Some(&0), Some(&trained)));
    assert!(found.len() > 2, "the cut in the middle keeps nothing: {found:?}");
}

#[test]
fn a_damaged_record_and_what_follows_are_trained_again() {
    let data = sans();
    let options = options_of_resumed(&data);
    let directory = Directory::new();
    let path = directory.path("out.ttf.partial");
    let partial = Partial::open(&path, &data, &options, false).unwrap();
    let whole = resume(&data, &options, &Silent, Some(&partial)).unwrap();
    drop(partial);
    let mut bytes = std::fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&path, &bytes).unwrap();
    let partial = Partial::open(&path, &data, &options, true).unwrap();
    assert!((1..whole.glyphs.len() - 1).contains(&partial.found()), "{}", partial.found());
    assert!(resume(&data, &options, &Silent, Some(&partial)).unwrap().font == whole.font);
}

#[test]
fn a_work_file_of_another_conversion_is_refused_and_kept() {
    let data = sans();
    let options = options_of_resumed(&data);
    let directory = Directory::new();
    let path = directory.path("out.ttf.partial");
    let partial = Partial::open(&path, &data, &options, false).unwrap();
    resume(&data, &options, &Silent, Some(&partial)).unwrap();
    let refused = |data: &[u8], options: &Options, resume: bool| {
        let error = Partial::open(&path, data, options, resume).unwrap_err();
        assert!(matches!(error, Error::Io(_)), "{error:?}");
        error.to_string()
    };
    assert!(refused(&data, &options, true).contains("being written by another conversion"));
    drop(partial);
    let before = std::fs::read(&path).unwrap();
    assert!(refused(&data, &options, false).contains("--resume"));
    assert!(refused(&data, &Options { seed: 2, ..options.clone() }, true).contains("other options"));
    assert!(refused(&font("DejaVuSans"), &options, true).contains("another font"));
    // The result does not depend on the threads.
    assert!(Partial::open(&path, &data, &Options { jobs: 2, ..options }, true).unwrap().found() > 0);
    assert!(std::fs::read(&path).unwrap() == before);
}

#[test]
fn the_converter_leaves_no_work_file_and_does_not_overwrite_one() {
    let directory = Directory::new();
    let (output, _) = (directory.name("out.ttf"), directory.write("out.ttf.partial", b"precious"));
    let args = ["--text", "i", "--ppem", "12", SANS, &output];
    nfr_convert(&args).fails_with(&["out.ttf.partial", "no work file", "another output"]);
    nfr_convert(&[&args[..], &["--resume"]].concat()).fails_with(&["out.ttf.partial", "another font"]);
    assert_eq!(std::fs::read(directory.path("out.ttf.partial")).unwrap(), b"precious");
    std::fs::remove_file(directory.path("out.ttf.partial")).unwrap();
    nfr_convert(&[&args[..], &["--resume"]].concat()).succeeds();
    assert_eq!(directory.files(), ["out.ttf"]);
}

#[test]
fn the_work_file_of_another_conversion_is_kept_aside_and_an_empty_one_is_replaced() {
    let directory = Directory::new();
    let output = directory.name("out.ttf");
    let args = ["--text", "i", "--ppem", "12", SANS, &output];
    directory.write("out.ttf.partial", b"nfr partial 4\n12345678 and a record of another font");
    let told = nfr_convert(&args).succeeds().stderr;
    let aside: Vec<String> =
        directory.files().into_iter().filter(|name| name.starts_with("out.ttf.partial")).collect();
    assert!(aside.len() == 1 && told.contains(&aside[0]), "{aside:?}: {told}");
    assert!(std::fs::read(directory.path(&aside[0])).unwrap().ends_with(b"another font"));
    std::fs::remove_file(directory.path(&aside[0])).unwrap();
    directory.write("out.ttf.partial", b"nfr partial 4\n");
    assert_eq!(nfr_convert(&[&args[..], &["--quiet"]].concat()).succeeds().stderr, "");
    assert_eq!(directory.files(), ["out.ttf"]);
}

#[test]
fn dropped_outlines_leave_blanks_that_other_programs_read() {
    let data = sans();
    let options = Options { drop_outlines: true, ..options(&data, "aeéiæ", 0) };
    let kept = convert(&data, &Options { drop_outlines: false, ..options.clone() }, &Silent).unwrap();
    let dropped = convert(&data, &options, &Silent).unwrap();
    assert!(dropped.font.len() < kept.font.len());
    let files = [&data, &dropped.font].map(|data| FontRef::new(data).unwrap());
    let outlines = files.each_ref().map(|file| (file.loca(None).unwrap(), file.glyf().unwrap()));
    let has_outline = |k: usize, gid: u16| {
        let (loca, glyf) = &outlines[k];
        loca.get_glyf(GlyphId::from(gid), glyf).unwrap().is_some()
    };
    // Unmodelled composites are made of some modelled glyphs, which therefore stay.
    let (e, i, ae) = (gid(&data, 'é'), gid(&data, 'i'), gid(&data, 'æ'));
    assert!(!has_outline(1, e) && has_outline(1, gid(&data, 'a')) && has_outline(1, gid(&data, 'b')));
    assert!(has_outline(0, i) && has_outline(0, ae) && has_outline(0, e));
    let fonts = [&data, &dropped.font].map(|data| skrifa::Font::new(data.clone(), 0).unwrap());
    let metrics = fonts.each_ref().map(|font| font.glyph_metrics());
    for gid in 0..files[0].maxp().unwrap().num_glyphs() {
        let gid = GlyphId::from(gid);
        assert_eq!(metrics[0].h_advance(gid), metrics[1].h_advance(gid));
    }
    let library = freetype::Library::init().unwrap();
    let face = library.new_memory_face(dropped.font.clone(), 0).unwrap();
    face.set_pixel_sizes(0, 20).unwrap();
    for gid in 0..face.num_glyphs() as u32 {
        face.load_glyph(gid, freetype::face::LoadFlag::RENDER).unwrap();
    }
    let font = Font::new(dropped.font.clone()).unwrap();
    assert!(font.outlines_dropped() && font.outlines_match());
    assert!(FontPair::open(&data, 0, &dropped.font).is_ok());
    let other = std::fs::read(SANS.replace("Sans-", "Serif-")).unwrap();
    assert!(matches!(FontPair::open(&other, 0, &dropped.font), Err(Error::InvalidParameter(_))));
}

#[test]
fn a_font_may_lose_all_its_outlines() {
    let data = sans();
    let file = FontRef::new(&data).unwrap();
    let all = (0..file.maxp().unwrap().num_glyphs()).collect();
    let blank = assemble(&file, b"models", &all).unwrap();
    let font = FontRef::new(&blank).unwrap();
    let (loca, glyf) = (font.loca(None).unwrap(), font.glyf().unwrap());
    assert!(all.iter().all(|gid| loca.get_glyf(GlyphId::from(*gid), &glyf).unwrap().is_none()));
    let library = freetype::Library::init().unwrap();
    let face = library.new_memory_face(blank.clone(), 0).unwrap();
    face.set_pixel_sizes(0, 20).unwrap();
    for gid in all {
        face.load_glyph(gid.into(), freetype::face::LoadFlag::RENDER).unwrap();
        assert_eq!(face.glyph().bitmap().width(), 0);
    }
}

#[test]
fn sizes_left_out_of_the_training_are_predicted() {
    let data = sans();
    let every = options(&data, "aeg", 0);
    let options = Options { ppem: 8..=41, ppem_step: 3, ..every };
    let conversion = convert(&data, &options, &Silent).unwrap();
    let font = Font::new(conversion.font.clone()).unwrap();
    assert_eq!(font.ppem_range(), (8, 41));
    // The report is about the sizes that the teacher has shown.
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
    let mut sums = Sums::default();
    for ppem in (8..=41).step_by(3) {
        for gid in &options.gids {
            let truth = teacher.at(ppem).unwrap().hinted(*gid).unwrap().rasterize().unwrap();
            sums.add(&truth, &decode(&font, (*gid).into()).unwrap().render(f32::from(ppem)).unwrap());
        }
    }
    assert_eq!(sums, conversion.sums);
    for ppem in 8..=41 {
        for gid in &options.gids {
            let truth = teacher.at(ppem).unwrap().hinted(*gid).unwrap().rasterize().unwrap();
            let ours = decode(&font, (*gid).into()).unwrap().render(f32::from(ppem)).unwrap();
            // A level that is rounded the other way ends a pixel further.
            let near = |a: u32, b: u32| a.abs_diff(b) <= 2;
            let (ours, truth) = (ours.placement, truth.placement);
            assert!(
                near(ours.width, truth.width) && near(ours.height, truth.height),
                "glyph {gid} at {ppem} ppem"
            );
        }
    }
    let wrong = convert(&data, &Options { ppem_step: 0, ..options }, &Silent).unwrap_err();
    assert!(matches!(wrong, Error::InvalidParameter(_)), "{wrong:?}");
}
