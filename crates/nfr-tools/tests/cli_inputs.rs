//! Inputs other than a hinted font file: collections, web fonts, fonts without hints, and fonts with bitmaps.

use std::collections::BTreeSet;

use crate::common::{Directory, SANS, collection_of, nfr, nfr_convert, sans, sans_with};
use nfr_convert::assemble::assemble;
use read_fonts::FontRef;
use serde_json::Value;

const INPUTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../nfr-convert/tests/inputs");
/// Few sizes.
const QUICK: [&str; 5] = ["--text", "Ag", "--no-closure", "--ppem", "10-12"];
/// Every point is where the hints put it.
const EXACT: [&str; 2] = ["--quality", "100"];

fn input(name: &str) -> String {
    format!("{INPUTS}/{name}")
}

fn small() -> Vec<u8> {
    std::fs::read(input("small.ttf")).unwrap()
}

/// Liberation Sans without its hints.
fn unhinted() -> Vec<u8> {
    let data = sans();
    let bare = assemble(&FontRef::new(&data).unwrap(), &[], &BTreeSet::new()).unwrap();
    let mut builder = write_fonts::FontBuilder::new();
    let font = FontRef::new(&bare).unwrap();
    for record in font.table_directory().table_records().iter().filter(|record| record.tag() != "Nfrt") {
        builder.add_raw(record.tag(), font.table_data(record.tag()).unwrap().as_bytes().to_vec());
    }
    builder.build()
}

fn convert(input: &str, output: &str, args: &[&str]) -> crate::common::Run {
    nfr_convert(&[&QUICK[..], args, &[input, output]].concat())
}

#[test]
fn all_fonts_of_a_collection_are_written_under_their_names_and_compared() {
    let directory = Directory::new();
    let file = directory.write("in.ttc", &collection_of(&[&small(), &sans(), &small()]));
    let (out, report) = (directory.name("out"), directory.name("report.json"));
    let run = convert(&file, &out, &["--all-faces", "--report", &report]).succeeds();
    for part in ["font 0, Nfr Inputs", "font 1, Liberation Sans\n", "font 2, Nfr Inputs"] {
        assert!(run.stdout.contains(part), "{part:?} is not in {}", run.stdout);
    }
    let mut files: Vec<_> = std::fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name()).collect();
    files.sort();
    let names = ["LiberationSans.nfr.ttf", "NfrInputs-2.nfr.ttf", "NfrInputs.nfr.ttf"];
    assert_eq!(files, names);
    let report: Value = serde_json::from_str(&std::fs::read_to_string(report).unwrap()).unwrap();
    let indices: Vec<_> = report.as_array().unwrap().iter().map(|face| face["index"].clone()).collect();
    assert_eq!(indices, [0, 1, 2]);
    // As the font by itself.
    let alone = directory.name("alone.ttf");
    convert(SANS, &alone, &["--quiet"]).succeeds();
    let sans = format!("{out}/{}", names[0]);
    assert_eq!(std::fs::read(&sans).unwrap(), std::fs::read(alone).unwrap());
    nfr(&["verify", &file, &sans, "--index", "1"]).succeeds();
    nfr(&["diff", &file, &sans, "--index", "0", "--ppem", "12"]).fails_with(&["glyph"]);
}

#[test]
fn a_font_that_cannot_be_converted_does_not_keep_the_others_from_it() {
    let directory = Directory::new();
    let (bare, report) = (unhinted(), directory.name("report.json"));
    let file = directory.write("in.ttc", &collection_of(&[&bare, &small()]));
    let run = convert(&file, &directory.name("out"), &["--all-faces", "--report", &report]);
    assert_eq!(run.code, 1);
    for part in ["font 0, Liberation Sans: ", "no hint programs", "1 of 2 fonts", "(index 0)"] {
        assert!(run.stderr.contains(part), "{part:?} is not in {}", run.stderr);
    }
    assert!(run.stdout.contains("font 1, Nfr Inputs\n"), "{}", run.stdout);
    let files: Vec<_> = std::fs::read_dir(directory.path("out")).unwrap().collect();
    assert_eq!(files.len(), 1);
    let report: Value = serde_json::from_str(&std::fs::read_to_string(report).unwrap()).unwrap();
    assert!(report[0]["error"].as_str().unwrap().contains("no hint programs"));
    assert_eq!(report[1]["hinter"], "font");
}

#[test]
fn a_collection_with_a_font_beyond_the_end_of_the_file_is_no_reason_to_refuse_the_others() {
    let directory = Directory::new();
    let mut data = collection_of(&[&small(), &small()]);
    data[16..20].copy_from_slice(&0xFFFF_FF00u32.to_be_bytes());
    let (file, out) = (directory.write("in.ttc", &data), directory.name("out"));
    convert(&file, &directory.name("out.ttf"), &["--index", "1"]).fails_with(&["in.ttc"]);
    convert(&file, &directory.name("out.ttf"), &["--index", "0"]).succeeds();
    let run = convert(&file, &out, &["--all-faces"]);
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("font 1: ") && run.stderr.contains("1 of 2 fonts"), "{}", run.stderr);
    assert_eq!(std::fs::read_dir(out).unwrap().count(), 1);
}

#[test]
fn all_faces_write_into_a_directory_and_go_with_no_index() {
    let directory = Directory::new();
    let taken = directory.write("taken", b"file");
    convert(&input("small.ttf"), &taken, &["--all-faces"]).fails_with(&["taken", "directory"]);
    assert_eq!(std::fs::read(taken).unwrap(), b"file");
    convert(SANS, &directory.name("out"), &["--all-faces", "--index", "0"]).rejects_usage(&["--index"]);
}

#[test]
fn web_fonts_are_converted_and_compared_as_the_fonts_that_are_packed_in_them() {
    let directory = Directory::new();
    let plain = directory.name("plain.ttf");
    convert(&input("small.ttf"), &plain, &EXACT).succeeds();
    for name in ["small.woff", "small.woff2"] {
        let (packed, out) = (input(name), directory.name("out.ttf"));
        convert(&packed, &out, &EXACT).succeeds();
        nfr(&["verify", &packed, &out]).succeeds();
        nfr(&["verify", &packed, &plain]).succeeds();
        nfr(&["diff", &input("small.ttf"), &out, "--ppem", "10-12", "--fail-on", "mae>0"]).succeeds();
    }
    convert(&input("small.woff"), &directory.name("woff.ttf"), &EXACT).succeeds();
    assert_eq!(std::fs::read(directory.path("woff.ttf")).unwrap(), std::fs::read(plain).unwrap());
}

#[test]
fn damaged_web_fonts_are_refused_in_one_line_and_nothing_is_written() {
    let directory = Directory::new();
    let refuse = |data: &[u8], parts: &[&str]| {
        let file = directory.write("in", data);
        convert(&file, &directory.name("out.ttf"), &[]).fails_with(parts);
        assert_eq!(directory.files(), ["in"]);
    };
    for name in ["small.woff", "small.woff2"] {
        let whole = std::fs::read(input(name)).unwrap();
        for length in [4, 40, 100, whole.len() / 2, whole.len() - 1] {
            refuse(&whole[..length], &["truncated"]);
        }
        refuse(&[&whole[..], b"more"].concat(), &["damaged"]);
        let mut flipped = whole.clone();
        let middle = whole.len() / 2;
        flipped[middle..middle + 40].iter_mut().for_each(|byte| *byte ^= 0x55);
        refuse(&flipped, &["damaged"]);
    }
    // WOFF 1.0: the first entry of the directory is at byte 44; its checksum is its last field, its original length the one before.
    let mut woff = std::fs::read(input("small.woff")).unwrap();
    woff[44 + 16] ^= 1;
    refuse(&woff, &["checksum"]);
    woff[44 + 12..44 + 16].copy_from_slice(&[0xFF; 4]);
    refuse(&woff, &["limit exceeded"]);
}

#[test]
fn a_font_without_hints_is_refused_with_advice_and_learns_from_the_autohinter_if_asked_for() {
    let directory = Directory::new();
    let (file, out) = (directory.write("in.ttf", &unhinted()), directory.name("out.ttf"));
    convert(&file, &out, &[]).fails_with(&["no hint programs", "--hinter auto"]);
    let run = convert(&file, &out, &["--hinter", "auto"]).succeeds();
    assert!(
        run.stdout.contains("autohinter") && run.stdout.contains("no hint programs in the original"),
        "{}",
        run.stdout
    );
    let told = nfr(&["info", &out]).succeeds().stdout;
    assert!(told.contains("skrifa 0.49 autohinter") && told.contains("--hinter auto"), "{told}");
    let compared = nfr(&["diff", &file, &out, "--ppem", "10-12"]).succeeds().stdout;
    assert!(compared.contains("hinter auto"), "{compared}");
    let checked = nfr(&["verify", &file, &out]).succeeds().stdout;
    assert!(checked.contains("autohinter") && checked.contains("certificate   holds"), "{checked}");
    // The hints of the font are others.
    convert(&file, &out, &["--hinter", "auto", EXACT[0], EXACT[1]]).succeeds();
    nfr(&["verify", &file, &out, "--at-most", "0"]).succeeds();
    nfr(&["verify", SANS, &out, "--at-most", "0"]).succeeds();
    let own = directory.name("own.ttf");
    convert(SANS, &own, &EXACT).succeeds();
    assert_ne!(std::fs::read(own).unwrap(), std::fs::read(out).unwrap());
    convert(SANS, &directory.name("other.ttf"), &["--hinter", "light"]).rejects_usage(&["font or auto"]);
}

#[test]
fn models_are_added_by_the_hinter_of_those_that_are_there() {
    let directory = Directory::new();
    let (file, out) = (directory.write("in.ttf", &unhinted()), directory.name("out.ttf"));
    convert(&file, &out, &["--hinter", "auto"]).succeeds();
    convert(&file, &out, &["--into", &out, "--unicodes", "U+62", "--hinter", "font"])
        .rejects_usage(&["--hinter auto", "leave --hinter out"]);
    convert(&file, &out, &["--into", &out, "--unicodes", "U+62"]).succeeds();
    nfr(&["verify", &file, &out]).succeeds();
}

#[test]
fn embedded_bitmaps_are_told_of() {
    let directory = Directory::new();
    let data = sans_with(&[], &[(b"EBDT", &[0, 2, 0, 0]), (b"EBLC", &[0, 2, 0, 0, 0, 0, 0, 0])]);
    let (file, out) = (directory.write("in.ttf", &data), directory.name("out.ttf"));
    let run = convert(&file, &out, &[]).succeeds();
    assert!(run.stderr.contains("embedded bitmaps ('EBDT')"), "{}", run.stderr);
    let run = convert(SANS, &out, &[]).succeeds();
    assert!(!run.stderr.contains("bitmaps"), "{}", run.stderr);
}
