//! Every error message of the tools and of the converter: provoked as a person would, it says what is wrong, where, and what to do.

use std::path::Path;

use crate::common::{Directory, FONTS, Run, SANS, collection, nfr, nfr_convert, sans, sans_with};
use crate::errors::{ELSEWHERE, messages, sources};
use read_fonts::FontRef;
use read_fonts::types::Tag;

/// Calls `nfr-convert`, or `nfr` with a command.
struct Case {
    args: Vec<String>,
    code: i32,
    /// What is wrong, where (a file, glyph, size or option), and what to do.
    parts: [&'static str; 3],
}

fn convert(args: &[&str], code: i32, parts: [&'static str; 3]) -> Case {
    let quick = ["nfr-convert", "--ppem", "10-11", "--no-closure"];
    Case { args: quick.iter().chain(args).map(|arg| (*arg).to_owned()).collect(), code, parts }
}

fn tool(args: &[&str], code: i32, parts: [&'static str; 3]) -> Case {
    Case { args: args.iter().map(|arg| (*arg).to_owned()).collect(), code, parts }
}

fn run(case: &Case) -> Run {
    let args: Vec<&str> = case.args.iter().map(String::as_str).collect();
    if args[0] == "nfr-convert" { nfr_convert(&args[1..]) } else { nfr(&args) }
}

/// Liberation Sans with bytes of a table changed.
fn changed(tag: &[u8; 4], at: usize, bytes: &[u8]) -> Vec<u8> {
    let mut data = sans();
    let font = FontRef::new(&data).unwrap();
    let record = font.table_directory().table_records().iter().find(|r| r.tag() == Tag::new(tag)).unwrap();
    let start = record.offset() as usize + at;
    data[start..start + bytes.len()].copy_from_slice(bytes);
    data
}

fn table(tag: &[u8; 4]) -> Vec<u8> {
    let data = sans();
    FontRef::new(&data).unwrap().table_data(Tag::new(tag)).unwrap().as_bytes().to_vec()
}

fn cases(directory: &Directory) -> Vec<Case> {
    let file = |name: &str, bytes: &[u8]| directory.write(name, bytes);
    let out = &directory.name("out.ttf");
    let missing = &directory.name("missing/file");
    let here = &directory.name(".");
    let neural = &directory.name("neural.ttf");
    nfr_convert(&["-q", "--text", "ae", "--ppem", "10-11", SANS, neural]).succeeds();
    let serif = &format!("{FONTS}/LiberationSerif-Regular.ttf");
    let post = {
        // Version 3.0 has no names (OpenType 1.9, "post").
        let mut post = table(b"post")[..32].to_vec();
        post[1] = 3;
        sans_with(&[b"post"], &[(b"post", &post)])
    };
    let no_names = &file("no-names.ttf", &post);
    let no_post = &file("no-post.ttf", &sans_with(&[b"post"], &[]));
    let bad_post = &file("bad-post.ttf", &sans_with(&[b"post"], &[(b"post", &[0, 2])]));
    let no_maxp = &file("no-maxp.ttf", &sans_with(&[b"maxp"], &[]));
    let bad_gsub = &file("bad-gsub.ttf", &sans_with(&[b"GSUB"], &[(b"GSUB", &[0, 1, 0, 0, 0, 9])]));
    let no_glyf = &file("no-glyf.ttf", &sans_with(&[b"glyf"], &[]));
    let short_loca = &file("short-loca.ttf", &sans_with(&[b"loca"], &[(b"loca", &table(b"loca")[..200])]));
    let far = [0x7f; 8];
    let far_loca = &file("far-loca.ttf", &changed(b"loca", 72, &far));
    let format = &file("format.ttf", &changed(b"head", 50, &[0, 7]));
    let units = &file("units.ttf", &changed(b"head", 18, &[0, 1]));
    // PUSHB[1] 1 1, INSTCTRL: hints are off. POP of an empty stack: the program fails.
    let off = &file("off.ttf", &sans_with(&[b"prep"], &[(b"prep", &[0xb1, 1, 1, 0x8e])]));
    let failing = &file("failing.ttf", &sans_with(&[b"fpgm"], &[(b"fpgm", &[0x21])]));
    let no_widths = &file("no-widths.ttf", &changed(b"hhea", 34, &[0, 0]));
    let no_hmtx = &file("no-hmtx.ttf", &sans_with(&[b"hmtx"], &[]));
    let cut = &file("cut.ttf", &sans()[..300_000]);
    let text = &file("text", b"a\xff");
    let not_a_font = &file("page.html", b"<html>");
    let many = &file("many.ttc", &collection(&sans()));
    let own_work = &format!("{}.partial", file("taken.ttf", b""));
    std::fs::write(own_work, b"precious").unwrap();
    let taken = &directory.name("taken.ttf");
    let damaged = &file("damaged.ttf", &sans_with(&[], &[(b"Nfrt", &[0; 10])]));
    let variable = concat!(env!("CARGO_MANIFEST_DIR"), "/../nfr-convert/tests/inputs/variable.ttf");
    let no_stems = concat!(env!("CARGO_MANIFEST_DIR"), "/../nfr-convert/tests/postscript/unhinted.otf");
    let woff = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../nfr-convert/tests/inputs/small.woff"));
    let cut_woff = &file("cut.woff", &woff.unwrap()[..2000]);
    let png = &directory.name("out.png");
    let a = ["--text", "a"];
    vec![
        convert(
            &[no_widths, out, a[0], a[1]],
            1,
            ["'hmtx' has no advance widths", "no-widths.ttf", "repair the font"],
        ),
        convert(
            &[no_hmtx, out, a[0], a[1]],
            1,
            ["'hmtx' or 'hhea' cannot be read", "no-hmtx.ttf", "repair the font"],
        ),
        convert(&[SANS, SANS], 2, ["the output is the input", "output", "write to another file"]),
        convert(
            &[SANS, out, "--report", SANS],
            2,
            ["the report is the input", "report", "write to another file"],
        ),
        convert(
            &[SANS, out, "--report", out],
            2,
            ["the report is the output", "report", "write to another file"],
        ),
        convert(&[missing, out], 1, ["cannot read", "missing/file", "check the path"]),
        convert(&[SANS, missing, a[0], a[1]], 1, ["cannot write", "missing/file", "choose a place"]),
        convert(&[SANS, here], 1, ["is a directory", "cannot write", "name a file"]),
        convert(
            &[SANS, out, "--text-file", text],
            1,
            ["not UTF-8", "text: not UTF-8 at byte 1", "save the text as UTF-8"],
        ),
        convert(
            &[SANS, out, "--train-ppem", "8,10,11"],
            2,
            ["is uneven", "--train-ppem 8,10-11", "as in 8-64"],
        ),
        convert(&[neural, out], 1, ["carries an 'Nfrt' table", "neural.ttf", "convert the hinted font"]),
        convert(
            &[SANS, out, "--shape", "outline", "--drop-outlines"],
            1,
            ["need them", "outlines", "do not drop them"],
        ),
        convert(
            &[SANS, out, "--into", neural, "--ppem", "9"],
            2,
            ["cannot be used multiple times", "--ppem", "--help"],
        ),
        tool(
            &["nfr-convert", SANS, out, "--into", neural, "--ppem", "9"],
            2,
            ["for 10-11 ppem", "neural.ttf", "leave the sizes out"],
        ),
        tool(
            &["nfr-convert", SANS, out, "--into", neural, "--target", "mono"],
            2,
            ["for smooth", "neural.ttf", "leave --target out"],
        ),
        tool(
            &["nfr-convert", SANS, out, "--into", neural, "--drop-outlines"],
            2,
            ["beside the outlines", "neural.ttf", "leave --drop-outlines out"],
        ),
        tool(
            &["nfr-convert", serif, out, "--into", neural, "--text", "x"],
            1,
            ["2602 glyphs", "neural.ttf", "pass the font that"],
        ),
        convert(&[SANS, out, "--gids", "2620"], 1, ["not in the font", "glyph 2620", "correct --gids"]),
        convert(&[SANS, out, "--text", ""], 1, ["the selection is empty", "selection", "give --text"]),
        convert(&[SANS, out, "--glyphs", "nosuch"], 1, ["no glyph is named", "nosuch", "correct --glyphs"]),
        convert(
            &[no_names, out, "--glyphs", "a"],
            1,
            ["no glyph names", "no-names.ttf", "select with --gids"],
        ),
        convert(&[no_post, out, "--glyphs", "a"], 1, ["'post'", "no-post.ttf", "select with --gids"]),
        convert(&[bad_post, out, "--glyphs", "a"], 1, ["'post'", "bad-post.ttf", "select with --gids"]),
        convert(&[no_maxp, out, "--gids", "36"], 1, ["maxp", "no-maxp.ttf", "repair the font"]),
        tool(
            &["nfr-convert", bad_gsub, out, "--text", "a"],
            1,
            ["table 'GSUB' cannot be read", "bad-gsub.ttf", "--layout-features none"],
        ),
        convert(&[SANS, out, "--text", "一", "--strict"], 1, ["not in the font", "U+4E00", "leave them out"]),
        convert(
            &[no_glyf, out, a[0], a[1]],
            1,
            ["no outlines in 'glyf'", "no-glyf.ttf", "pass a hinted TrueType"],
        ),
        convert(&[short_loca, out, a[0], a[1]], 1, ["'loca'", "short-loca.ttf", "repair the font"]),
        convert(&[far_loca, out, a[0], a[1]], 1, ["'loca' puts glyph", "far-loca.ttf", "repair the font"]),
        convert(&[format, out, a[0], a[1]], 1, ["format 7", "'head'", "repair the font"]),
        convert(&[units, out, a[0], a[1]], 1, ["units per em", "units.ttf", "repair the font"]),
        convert(&[off, out, a[0], a[1]], 1, ["switches hinting off", "off.ttf", "choose others with --ppem"]),
        convert(
            &[failing, out, a[0], a[1]],
            1,
            ["'fpgm' or 'prep' program fails", "at 10 ppem", "repair the font"],
        ),
        convert(&[cut, out, a[0], a[1]], 1, ["is truncated", "cut.ttf", "get the file again"]),
        convert(&[not_a_font, out], 1, ["no OpenType font", "page.html", "pass a .ttf"]),
        convert(&[many, out, "--index", "3"], 1, ["index 3", "many.ttc", "use index 0"]),
        convert(
            &[SANS, taken, a[0], a[1]],
            1,
            ["no work file of nfr-convert", "taken.ttf.partial", "move it away"],
        ),
        convert(
            &[SANS, taken, a[0], a[1], "--resume"],
            1,
            ["belongs to a conversion of another font", "taken.ttf.partial", "delete it"],
        ),
        convert(&[SANS, out, "--fail-on", "mae>=0", a[0], a[1]], 1, ["mae is", "mae", "no font is written"]),
        convert(
            &[SANS, out, "--quality", "101"],
            2,
            ["invalid value '101'", "--quality", "a number from 0 to 100"],
        ),
        convert(
            &[SANS, out, "--target", "sharp"],
            2,
            ["unknown target", "--target", "use smooth, mono or lcd"],
        ),
        convert(
            &[SANS, out, "--shape", "round"],
            2,
            ["invalid value 'round'", "--shape", "use auto, outline or field"],
        ),
        convert(&[SANS, out, "--jobs", "0"], 2, ["invalid value '0'", "--jobs", "1 or more"]),
        convert(
            &[SANS, out, "--backend", "abacus"],
            2,
            ["invalid value 'abacus'", "--backend", "use flex or ndarray"],
        ),
        convert(
            &[SANS, out, "--axis", "wght=600"],
            1,
            ["is not variable", "LiberationSans-Regular.ttf", "leave out --axis"],
        ),
        convert(&[variable, out, "--axis", "opsz=50"], 1, ["has no axis 'opsz'", "variable.ttf", "wght"]),
        convert(
            &[variable, out, "--axis", "wght=1000"],
            1,
            ["outside of the axis' range", "variable.ttf", "wght"],
        ),
        convert(
            &[variable, out, "--axis", "wght=500", "--axis", "wght=600"],
            1,
            ["is given twice", "wght", "give it once"],
        ),
        convert(&[variable, out, "--instance", "Heavy"], 1, ["has no instance", "Heavy", "variable.ttf"]),
        convert(
            &[SANS, text, "--all-faces"],
            1,
            ["cannot make the directory", "text", "takes a directory as its output"],
        ),
        convert(&[no_stems, out], 1, ["no horizontal stem hints", "unhinted.otf", "--hinter auto"]),
        convert(&[cut_woff, out], 1, ["truncated", "cut.woff", "get the file again"]),
        tool(&["render", neural], 2, ["nothing to write", "--png", "add --json"]),
        tool(
            &["render", SANS, "--json"],
            1,
            ["no 'Nfrt' table", "LiberationSans-Regular.ttf", "nfr-convert"],
        ),
        tool(
            &["render", neural, "--text", "b", "--json"],
            1,
            ["has no model", "glyph 69", "with it selected"],
        ),
        tool(&["render", damaged, "--json"], 1, ["has version 0", "damaged.ttf", "convert the font again"]),
        tool(
            &["render", neural, "--ppem", "1000", "--zoom", "64", "--text", "aeaeae", "--png", png],
            1,
            ["the picture would have", "pixels", "select fewer glyphs"],
        ),
        tool(&["info", missing], 1, ["cannot read", "missing/file", "check the path"]),
        tool(&["verify", neural, SANS], 2, ["the arguments are swapped", "neural.ttf", "write nfr verify"]),
        tool(&["verify", neural, neural], 2, ["was converted itself", "neural.ttf", "pass the hinted font"]),
        tool(
            &["diff", SANS, neural, "--html", "/dev/null/page"],
            1,
            ["cannot make the directory", "/dev/null/page", "choose a place"],
        ),
        tool(&["diff", serif, neural], 1, ["2602 glyphs", "the original font", "pass the font that"]),
        tool(&["diff", SANS, neural, "--fail-on", "beauty<1"], 2, ["beauty", "--fail-on", "mae>0.006"]),
        tool(
            &["subset", neural, neural, "--text", "a"],
            2,
            ["the output is the input", "output", "write to another file"],
        ),
        tool(&["subset", neural, out], 2, ["nothing is selected", "selected", "give --text"]),
        tool(
            &["subset", neural, out, "--text", "a", "--python", missing],
            1,
            ["cannot run", "missing/file", "install Python"],
        ),
        tool(
            &["bake", neural, out, "--ppem", "12", "--strikes-only", "--format", "bdf"],
            2,
            ["--strikes-only is about fonts", "--strikes-only", "use it with"],
        ),
        tool(
            &["bake", neural, "out.xyz", "--ppem", "12"],
            2,
            ["no format is known", "out.xyz", "pass --format"],
        ),
        tool(
            &["bake", neural, neural, "--ppem", "12"],
            2,
            ["the output is the input", "output", "write to another file"],
        ),
        tool(
            &["bake", neural, out, "--ppem", "12", "--text", "b"],
            1,
            ["no model", "b", "--missing outline"],
        ),
        tool(
            &["bake", neural, out, "--ppem", "300"],
            1,
            ["EBLC holds", "at 300 ppem", "choose smaller sizes"],
        ),
        tool(&["man", "/dev/null/man"], 1, ["cannot make the directory", "/dev/null/man", "choose a place"]),
    ]
}

#[test]
fn every_error_says_what_is_wrong_where_and_what_to_do() {
    let directory = Directory::new();
    let cases = cases(&directory);
    let before = directory.files();
    let mut told = String::new();
    let mut wrong = Vec::new();
    for case in &cases {
        let run = run(case);
        let error =
            run.stderr.lines().filter(|line| !line.starts_with("warning")).collect::<Vec<_>>().join("\n");
        let lacks = case.parts.iter().find(|part| !error.contains(**part));
        if run.code != case.code || !run.stdout.is_empty() || lacks.is_some() || !error.starts_with("error: ")
        {
            wrong.push(format!("{:?}\n  code {}, lacks {lacks:?}: {error}", case.args, run.code));
        }
        told += &error;
    }
    assert_eq!(directory.files(), before, "something was written");
    let mut all = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for directory in ["src", "../nfr-convert/src"] {
        sources(&root.join(directory), &mut all);
    }
    let elsewhere =
        |message: &str| ELSEWHERE.iter().any(|(_, parts)| parts.iter().any(|part| message.contains(part)));
    let mut silent: Vec<String> = all.iter().flat_map(|source| messages(source)).collect();
    silent.retain(|message| !told.contains(message.as_str()) && !elsewhere(message));
    assert!(
        wrong.is_empty() && silent.is_empty(),
        "{}\nthese messages are not provoked; add each to `cases`, or to `ELSEWHERE` with the reason:\n{}",
        wrong.join("\n"),
        silent.join("\n")
    );
}
