//! The tools refuse what they cannot do, say why and what to do, and leave files alone. Nothing here trains.

#![allow(clippy::unwrap_used)]

mod common;

use std::collections::BTreeSet;

use common::{Directory, SANS, collection, nfr, nfr_convert, sans, sans_with};
use nfr::internals::table::TAG;
use nfr_convert::assemble::assemble;
use read_fonts::FontRef;
use read_fonts::types::Tag;
use write_fonts::FontBuilder;

/// Converts a font file with few glyphs at few sizes, should it get that far.
fn convert(directory: &Directory, input: &str, more: &[&str]) -> common::Run {
    let output = directory.name("out.ttf");
    nfr_convert(&[&["--ppem", "10-11", "--gids", "36", "--no-closure", input, &output], more].concat())
}

#[test]
fn help_and_version_succeed() {
    for args in [["--help"], ["--version"]] {
        assert_eq!((nfr(&args).code, nfr_convert(&args).code), (0, 0));
    }
    for command in ["render", "diff", "verify", "info", "subset", "bake"] {
        assert!(nfr(&[command, "--help"]).succeeds().stdout.contains("Usage: nfr "));
    }
}

#[test]
fn a_command_that_is_not_built_in_says_how_to_build_it() {
    for (command, built) in [("bench", cfg!(feature = "bench")), ("lab", cfg!(feature = "lab"))] {
        let usage = nfr(&["--help"]).succeeds().stdout;
        let line = usage.lines().find(|line| line.trim_start().starts_with(command)).unwrap();
        assert_eq!(line.contains("Not in this build"), !built, "{line}");
        let advice = format!("`cargo build --release --bins --features {command}`");
        for more in [&[][..], &["--help"], &["report", "--jobs", "2"]].into_iter().filter(|_| !built) {
            nfr(&[&[command], more].concat()).rejects_usage(&[&format!("without `nfr {command}`"), &advice]);
        }
    }
}

#[cfg(not(feature = "train"))]
#[test]
fn without_training_fields_are_refused_and_nothing_is_written() {
    let directory = Directory::new();
    let parts = ["glyph 36 needs a trained field", "cargo build --release --bins --features train"];
    let field = convert(&directory, SANS, &["--shape", "field"]);
    field.fails_with(&[&parts[..], &["--shape outline"]].concat());
    let dropped = convert(&directory, SANS, &["--drop-outlines"]);
    dropped.fails_with(&[&parts[..], &["keep the outlines"]].concat());
    // With a work file to go on with, too.
    convert(&directory, SANS, &["--shape", "field", "--resume"]).fails_with(&parts);
    assert!(directory.files().is_empty());
}

#[test]
fn what_is_no_font_is_refused() {
    let directory = Directory::new();
    for bytes in [b"".as_slice(), b"hello", &[0; 4096], b"<html></html>"] {
        let input = directory.write("in.ttf", bytes);
        convert(&directory, &input, &[]).fails_with(&["in.ttf", "pass a .ttf"]);
        nfr(&["info", &input]).fails_with(&["in.ttf", "pass a .ttf"]);
        nfr(&["render", &input, "--json"]).fails_with(&["in.ttf", "pass a .ttf"]);
        nfr(&["diff", SANS, &input]).fails_with(&["in.ttf", "pass a .ttf"]);
    }
    let web_font = directory.write("in.woff2", b"wOF2\0\x01\0\0");
    convert(&directory, &web_font, &[]).fails_with(&["in.woff2", "truncated"]);
    nfr(&["info", &web_font]).fails_with(&["in.woff2", "unpack it"]);
}

#[test]
fn a_truncated_font_is_called_so() {
    let directory = Directory::new();
    let font = sans();
    for len in [font.len() - 1, font.len() / 2, 2000] {
        let input = directory.write("in.ttf", &font[..len]);
        convert(&directory, &input, &[]).fails_with(&["in.ttf", "truncated", "get the file again"]);
    }
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let directory = Directory::new();
    let missing = directory.name("missing.ttf");
    for run in [
        convert(&directory, &missing, &[]),
        nfr(&["info", &missing]),
        nfr(&["render", &missing, "--json"]),
        nfr(&["diff", &missing, SANS]),
        convert(&directory, SANS, &["--text-file", &missing]),
    ] {
        run.fails_with(&["cannot read", "missing.ttf", "check the path"]);
    }
}

/// Liberation Sans without hint programs, and with some tables more.
fn unhinted(with: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let data = sans();
    let stripped = assemble(&FontRef::new(&data).unwrap(), &[], &BTreeSet::new()).unwrap();
    let font = FontRef::new(&stripped).unwrap();
    let mut builder = FontBuilder::new();
    for (tag, bytes) in with {
        builder.add_raw(Tag::new(tag), bytes.to_vec());
    }
    for record in font.table_directory().table_records().iter().filter(|record| record.tag() != TAG) {
        builder.add_raw(record.tag(), font.table_data(record.tag()).unwrap().as_bytes().to_vec());
    }
    builder.build()
}

#[test]
fn a_font_that_cannot_teach_is_refused_with_the_reason() {
    let directory = Directory::new();
    let refused = |font: &[u8], parts: &[&str]| {
        let input = directory.write("in.ttf", font);
        convert(&directory, &input, &[]).fails_with(&[&["in.ttf"], parts].concat());
    };
    refused(&sans_with(&[b"glyf", b"loca"], &[]), &["glyf", "pass a hinted TrueType or OpenType font"]);
    refused(&unhinted(&[]), &["no hint programs", "pass a hinted font"]);
    // What tools write into fonts without hints: PUSHW 511, SCANCTRL, PUSHB 4, SCANTYPE.
    let prep: &[u8] = &[0xb8, 0x01, 0xff, 0x85, 0xb0, 0x04, 0x8d];
    refused(&unhinted(&[(b"prep", prep)]), &["no hint programs", "pass a hinted font"]);
    refused(&sans_with(&[], &[(b"Nfrt", b"models")]), &["'Nfrt'", "already"]);
}

#[test]
fn a_collection_index_must_exist() {
    let directory = Directory::new();
    let input = directory.write("in.ttc", &collection(&sans()));
    convert(&directory, &input, &["--index", "1"]).fails_with(&[
        "in.ttc",
        "index 1",
        "file of 1 font",
        "use index 0",
    ]);
    convert(&directory, SANS, &["--index", "2"]).fails_with(&["index 2", "use index 0"]);
    convert(&directory, SANS, &["--index", "one"]).rejects_usage(&["--index"]);
}

#[test]
fn what_is_not_in_the_font_is_named() {
    let directory = Directory::new();
    let refused = |args: &[&str], parts: &[&str]| {
        let output = directory.name("out.ttf");
        nfr_convert(&[&[SANS, &output], args].concat()).fails_with(parts);
    };
    refused(&["--text", "a一", "--strict"], &["'一' (U+4E00)", "--text"]);
    refused(&["--unicodes", "U+61,U+10FFFF", "--strict"], &["U+10FFFF", "--unicodes"]);
    refused(&["--unicodes", "U+4e0?"], &["16 characters are not in the font", "U+4E00", "and 11 more"]);
    refused(&["--gids", "3,2620"], &["glyph 2620", "0-2619", "--gids"]);
    refused(&["--glyphs", "a,nosuch"], &["'nosuch'", "--glyphs"]);
    refused(&["--text", ""], &["selection is empty"]);
    let text = directory.write("text", b"a\xff");
    refused(&["--text-file", &text], &["text", "UTF-8 at byte 1"]);
}

#[test]
fn options_that_make_no_sense_are_wrong_usage() {
    let directory = Directory::new();
    let refused = |args: &[&str], parts: &[&str]| {
        let output = directory.name("out.ttf");
        nfr_convert(&[&[SANS, &output], args].concat()).rejects_usage(parts);
    };
    refused(&["--ppem", "8-"], &["--ppem", "8-64"]);
    refused(&["--ppem", "0"], &["outside 1-1024"]);
    refused(&["--ppem", "20-10"], &["backwards"]);
    refused(&["--ppem", "8,10,11"], &["8,10-11", "one range"]);
    refused(&["--train-ppem", "8,10,11"], &["--train-ppem 8,10-11", "one range"]);
    refused(&["--target", "sharp"], &["smooth, mono or lcd"]);
    refused(&["--jobs", "0"], &["--jobs", "1 or more"]);
    refused(&["--seed", "x"], &["--seed"]);
    refused(&["--gids", "5-3"], &["--gids", "5-9"]);
    refused(&["--unicodes", "U+XYZ"], &["--unicodes", "U+20-7E"]);
    refused(&["--glyphs", ","], &["list is empty"]);
    refused(&["--quiet", "--verbose"], &["--quiet", "--verbose"]);
    refused(&["--nosuch"], &["--nosuch"]);
    for quality in ["-1", "100.1", "best", "NaN"] {
        refused(&[&format!("--quality={quality}")], &["--quality", "0 to 100"]);
    }
    nfr_convert(&[SANS]).rejects_usage(&["<OUTPUT>"]);
    nfr(&["nosuch"]).rejects_usage(&["nosuch"]);
    nfr(&["render", SANS]).rejects_usage(&["--json", "--png"]);
    nfr(&["render", SANS, "--json", "--zoom", "0"]).rejects_usage(&["--zoom"]);
    nfr(&["diff", SANS]).rejects_usage(&["<NEURAL>"]);
    for expression in ["mae", "mae>", "mea>1", "mae=1", "mae>1 or max>1", ""] {
        nfr(&["diff", SANS, SANS, "--fail-on", expression]).rejects_usage(&["--fail-on", "mae>0.006"]);
    }
}

#[test]
fn a_font_without_models_is_refused_with_advice() {
    for run in [nfr(&["info", SANS]), nfr(&["render", SANS, "--json"]), nfr(&["diff", SANS, SANS])] {
        run.fails_with(&["LiberationSans-Regular.ttf", "no 'Nfrt' table", "nfr-convert"]);
    }
    let directory = Directory::new();
    let damaged = directory.write("damaged.ttf", &sans_with(&[], &[(b"Nfrt", &[0; 10])]));
    for run in
        [nfr(&["info", &damaged]), nfr(&["render", &damaged, "--json"]), nfr(&["diff", SANS, &damaged])]
    {
        run.fails_with(&["damaged.ttf"]);
    }
}

#[test]
fn an_output_that_cannot_be_written_is_found_out_before_training() {
    // Training would show in a line for the glyph, before the error's.
    let directory = Directory::new();
    let (out, missing, here) =
        (directory.name("out.ttf"), directory.name("no/such/out.ttf"), directory.name("."));
    let convert =
        |more: &[&str]| nfr_convert(&[&["--gids", "36", "--ppem", "12", "--verbose", SANS], more].concat());
    convert(&[&missing]).fails_with(&["cannot write", "no/such/out.ttf"]);
    convert(&[&here]).fails_with(&["cannot write", "directory"]);
    convert(&[&out, "--report", &missing]).fails_with(&["cannot write", "no/such/out.ttf"]);
    assert!(directory.files().is_empty());
}

#[test]
fn the_input_is_never_overwritten() {
    let directory = Directory::new();
    let input = directory.write("in.ttf", &sans());
    let convert = |more: &[&str]| nfr_convert(&[&["--gids", "36", "--ppem", "12", &input], more].concat());
    convert(&[&input]).rejects_usage(&["the output is the input"]);
    convert(&[&directory.name("./in.ttf")]).rejects_usage(&["the output is the input"]);
    let output = directory.name("out.ttf");
    convert(&[&output, "--report", &input]).rejects_usage(&["the report is the input"]);
    convert(&[&output, "--report", &output]).rejects_usage(&["the report is the output"]);
    assert_eq!(std::fs::read(input).unwrap(), sans());
}

#[test]
fn a_failure_leaves_an_existing_output_as_it_was() {
    let directory = Directory::new();
    let output = directory.write("out.ttf", b"precious");
    nfr_convert(&[SANS, &output, "--text", "一"]).fails_with(&["U+4E00"]);
    let unhinted = directory.write("in.ttf", &unhinted(&[]));
    nfr_convert(&[&unhinted, &output, "--gids", "36", "--ppem", "12"]).fails_with(&["no hint programs"]);
    assert_eq!(std::fs::read(&output).unwrap(), b"precious");
    assert_eq!(directory.files(), ["in.ttf", "out.ttf"]);
}

#[test]
fn a_subset_without_python_or_a_selection_says_what_is_needed() {
    let directory = Directory::new();
    let converted = directory.name("converted.ttf");
    nfr_convert(&["--text", "a", "--ppem", "12", "--quiet", SANS, &converted]).succeeds();
    let output = directory.write("out.ttf", b"precious");
    let subset = |more: &[&str]| nfr(&[&["subset", &converted, &output], more].concat());
    subset(&[]).rejects_usage(&["nothing is selected", "--unicodes"]);
    nfr(&["subset", &converted, &converted, "--text", "a"]).rejects_usage(&["the output is the input"]);
    subset(&["--text", "a", "--python", "/no/such/python"])
        .fails_with(&["/no/such/python", "pip install fonttools"]);
    nfr(&["subset", SANS, &output, "--text", "a"]).fails_with(&["no 'Nfrt' table"]);
    assert_eq!(std::fs::read(&output).unwrap(), b"precious");
}
