//! What `nfr bake` refuses, what it warns of, and that nothing is written then.

use std::fs;

use crate::baked::neural;
use crate::common::{Directory, SANS, nfr, nfr_convert};
use serde_json::Value;

#[test]
fn what_a_format_cannot_hold_is_named_before_anything_is_written() {
    let directory = Directory::new();
    let output = directory.write("out.ttf", b"precious");
    let refused = |ppem: &str, text: &str, parts: &[&str]| {
        let run = nfr(&["bake", neural(), &output, "--ppem", ppem, "--text", text]);
        assert_eq!((run.code, run.stdout.as_str()), (1, ""));
        let error = run.stderr.lines().last().unwrap();
        for part in parts {
            assert!(error.contains(part), "{part:?} is not in {error}");
        }
    };
    refused("12,300", "-", &["the size at 300 ppem", "EBLC holds 0 to 255"]);
    refused("200", "A", &["the top of glyph 36 (A) at 200 ppem is 138", "-128 to 127", "smaller sizes"]);
    refused("150", "-", &["the ascent of a line at 150 ppem is 136"]);
    assert_eq!(fs::read(&output).unwrap(), b"precious");
    assert_eq!(directory.files(), ["out.ttf"]);
    // A strike just within the limits is written.
    nfr(&["bake", neural(), &directory.name("most.ttf"), "--ppem", "140", "--text", "A"]).succeeds();
}

#[test]
fn glyphs_without_models_are_errors_blank_or_outlines() {
    let directory = Directory::new();
    let output = directory.name("out.png");
    let bake =
        |more: &[&str]| nfr(&[&["bake", neural(), &output, "--ppem", "12", "--text", "Aß"], more].concat());
    bake(&[]).fails_with(&["(germandbls) has no model", "--missing outline"]);
    assert!(directory.files().is_empty());
    let width = || {
        let json: Value = serde_json::from_slice(&fs::read(directory.path("out.json")).unwrap()).unwrap();
        let glyph = json["glyphs"]
            .as_array()
            .unwrap()
            .iter()
            .find(|glyph| glyph["name"] == "germandbls")
            .unwrap()
            .clone();
        (glyph["width"].as_u64().unwrap(), glyph["hinted_advance"].as_f64().unwrap())
    };
    bake(&["--missing", "blank"]).succeeds();
    let (blank, advance) = width();
    bake(&["--missing", "outline"]).succeeds();
    assert!(blank == 0 && advance > 7.0 && width() == (7, advance), "{:?}", width());
    bake(&["--missing", "none"]).rejects_usage(&["error, blank or outline"]);
}

#[test]
fn what_cannot_be_baked_is_refused_with_the_reason() {
    let directory = Directory::new();
    let output = directory.name("out.ttf");
    nfr(&["bake", SANS, &output, "--ppem", "12"]).fails_with(&["no 'Nfrt' table", "nfr-convert"]);
    let bake = |output: &str, more: &[&str]| nfr(&[&["bake", neural(), output], more].concat());
    bake(&output, &["--ppem", "12", "--text", "一"]).fails_with(&["U+4E00"]);
    bake(&output, &["--ppem", "12", "--text", ""]).fails_with(&["selection is empty"]);
    bake(&directory.name("out.c"), &["--ppem", "12", "--gids", "0"]).fails_with(&[
        "no glyph",
        "character",
        "--text",
    ]);
    bake(&output, &[]).rejects_usage(&["--ppem"]);
    bake(&output, &["--ppem", "0"]).rejects_usage(&["outside 1-1024"]);
    for bits in ["0", "3", "16", "x"] {
        bake(&output, &["--ppem", "12", "--bits", bits]).rejects_usage(&["1, 2, 4 or 8"]);
    }
    bake(&directory.name("out.woff2"), &["--ppem", "12"]).rejects_usage(&["out.woff2", "--format"]);
    bake(&output, &["--ppem", "12", "--format", "pcf"]).rejects_usage(&["ttf, bdf, lvgl or png"]);
    bake(&directory.name("out.json"), &["--ppem", "12", "--format", "png"])
        .rejects_usage(&["out.json", ".png"]);
    bake(neural(), &["--ppem", "12"]).rejects_usage(&["the output is the input"]);
    bake(&directory.name("no/such/out.ttf"), &["--ppem", "12"])
        .fails_with(&["cannot write", "no/such/out.ttf"]);
    assert!(directory.files().is_empty());
    // The second file of two cannot be written, and the first is not either.
    fs::create_dir(directory.path("out_16.bdf")).unwrap();
    let run = bake(&directory.name("out.bdf"), &["--ppem", "12,16", "--bits", "4"]);
    run.fails_with(&["out_16.bdf", "directory"]);
    assert_eq!(directory.files(), ["out_16.bdf"]);
}

#[test]
fn one_bit_of_smooth_models_warns_and_of_mono_models_does_not() {
    let directory = Directory::new();
    let (mono, output) = (directory.name("mono.ttf"), directory.name("out.bdf"));
    nfr_convert(&["--quiet", "--target", "mono", "--ppem", "10-12", "--text", "Ag", SANS, &mono]).succeeds();
    let warns = |font: &str| {
        nfr(&["bake", font, &output, "--ppem", "12"]).succeeds().stderr.contains("--target mono")
    };
    assert_eq!((warns(neural()), warns(&mono)), (true, false));
}
