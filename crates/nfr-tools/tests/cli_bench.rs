//! `nfr bench` as a person calls it. Nothing here looks at how long anything took.

use std::sync::OnceLock;

use crate::common::{Directory, SANS, collection, nfr, nfr_convert, sans};
use serde_json::Value;

/// Every field of a line but `ppem`.
const TIMES: [&str; 10] = [
    "nfr",
    "nfr_new_size",
    "nfr_next",
    "nfr_cold",
    "nfr_open",
    "skrifa_zeno",
    "skrifa_cold",
    "swash",
    "freetype",
    "fontdue",
];

/// A font of Liberation Sans with models of two letters and an accented one.
fn neural() -> &'static str {
    static CONVERTED: OnceLock<(Directory, String)> = OnceLock::new();
    let converted = CONVERTED.get_or_init(|| {
        let directory = Directory::new();
        let font = directory.name("neural.ttf");
        nfr_convert(&["--quiet", "--no-closure", "--text", "agé", "--ppem", "12", SANS, &font]).succeeds();
        (directory, font)
    });
    &converted.1
}

/// Times the drawing for one round.
fn bench(original: &str, more: &[&str]) -> crate::common::Run {
    nfr(&[&["bench", original, neural(), "--rounds", "1"], more].concat())
}

/// Asserts a line for each of these sizes, with positive times, and gives the lines.
#[track_caller]
fn assert_lines(run: crate::common::Run, sizes: &[u64]) {
    let lines: Vec<Value> =
        run.succeeds().stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let ppem: Vec<u64> = lines.iter().map(|line| line["ppem"].as_u64().unwrap()).collect();
    assert_eq!(ppem, sizes);
    for line in lines {
        assert_eq!(line.as_object().unwrap().len(), 1 + TIMES.len(), "{line}");
        for name in TIMES {
            assert!(line[name].as_f64().is_some_and(|time| time > 0.0), "{name} in {line}");
        }
    }
}

#[test]
fn json_has_a_line_with_every_time_for_each_size() {
    assert_lines(bench(SANS, &["--json"]), &[12, 16, 24, 40, 63]);
    assert_lines(bench(SANS, &["--json", "--ppem", "13,30-31"]), &[13, 30, 31]);
}

#[test]
fn a_single_glyph_can_be_timed() {
    assert_lines(bench(SANS, &["--json", "--ppem", "12", "--text", "é"]), &[12]);
}

#[test]
fn a_font_with_a_single_model_can_be_timed() {
    let directory = Directory::new();
    let font = directory.name("neural.ttf");
    nfr_convert(&["--quiet", "--no-closure", "--text", "i", "--ppem", "12", SANS, &font]).succeeds();
    assert_lines(nfr(&["bench", SANS, &font, "--rounds", "1", "--ppem", "12", "--json"]), &[12]);
}

#[test]
fn a_font_of_a_collection_can_be_the_original() {
    let directory = Directory::new();
    let original = directory.write("in.ttc", &collection(&sans()));
    assert_lines(bench(&original, &["--json", "--ppem", "12", "--index", "0"]), &[12]);
    bench(&original, &["--index", "1"]).fails_with(&["index 1", "use index 0"]);
}

#[test]
fn the_table_has_a_row_for_each_time_and_ratio() {
    let table = bench(SANS, &["--ppem", "12,16"]).succeeds().stdout;
    // 'é' is not ASCII.
    assert!(table.starts_with("2 glyphs, "), "{table}");
    let ratios = ["nfr / fontdue", "nfr / skrifa_zeno", "nfr_open / skrifa_cold", "nfr_next / skrifa_zeno"];
    for name in TIMES.iter().chain(&ratios) {
        let row = table.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix("  "));
        let row = row.unwrap_or_else(|| panic!("no row {name:?} in {table}"));
        let mut columns = row.split_whitespace();
        assert!(columns.by_ref().take(2).all(|column| column.parse::<f64>().is_ok()), "{table}");
    }
}

#[test]
fn what_cannot_be_timed_is_refused_with_advice() {
    bench(SANS, &["--text", "b"]).fails_with(&["glyph 69", "no model", "convert the font"]);
    nfr(&["bench", SANS, SANS]).fails_with(&["LiberationSans-Regular.ttf", "no 'Nfrt' table", "nfr-convert"]);
    let directory = Directory::new();
    let accented = directory.name("accented.ttf");
    nfr_convert(&["--quiet", "--no-closure", "--text", "ø", "--ppem", "12", SANS, &accented]).succeeds();
    nfr(&["bench", SANS, &accented]).fails_with(&["printable ASCII", "--unicodes"]);
}

#[test]
fn wrong_usage_is_refused() {
    assert!(nfr(&["bench", "--help"]).succeeds().stdout.contains("Usage: nfr bench "));
    nfr(&["bench"]).rejects_usage(&["<ORIGINAL>", "<NEURAL>"]);
    nfr(&["bench", SANS]).rejects_usage(&["<NEURAL>"]);
    nfr(&["bench", SANS, SANS, "--ppem", "0"]).rejects_usage(&["--ppem", "outside 1-1024"]);
    nfr(&["bench", SANS, SANS, "--rounds", "0"]).rejects_usage(&["--rounds"]);
    nfr(&["bench", SANS, SANS, "--index", "one"]).rejects_usage(&["--index"]);
    nfr(&["bench", SANS, SANS, "--nosuch"]).rejects_usage(&["--nosuch"]);
}
