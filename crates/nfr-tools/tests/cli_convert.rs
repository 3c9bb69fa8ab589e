//! A font is converted with the tools and used with them, as a person would.

use std::sync::OnceLock;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

use crate::common::{Directory, SANS, collection, nfr, nfr_convert, sans};
use nfr::Font;
use nfr::internals::decode;

/// A font with ligatures.
const DEJAVU: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/DejaVuSans.ttf");
/// 'a' and 'g' of Liberation Sans.
const GIDS: [u64; 2] = [68, 74];
const SIZES: std::ops::RangeInclusive<u64> = 10..=14;

/// Fields, where they can be trained.
const SHAPE: &str = if cfg!(feature = "train") { "field" } else { "outline" };
/// Few glyphs at few sizes, so that training takes seconds.
const QUICK: [&str; 7] = ["--no-closure", "--text", "ag", "--ppem", "10-14", "--shape", SHAPE];
/// For what needs any font that is converted.
const QUICKEST: [&str; 5] = ["--no-closure", "--text", "i", "--ppem", "12"];

struct Converted {
    directory: Directory,
    font: String,
    stdout: String,
}

/// One conversion that several tests look at.
fn converted() -> &'static Converted {
    static CONVERTED: OnceLock<Converted> = OnceLock::new();
    CONVERTED.get_or_init(|| {
        let directory = Directory::new();
        let (font, report) = (directory.name("out.ttf"), directory.name("report.json"));
        let args = [&QUICK[..], &["--report", &report, "--jobs", "1", SANS, &font]].concat();
        let stdout = nfr_convert(&args).succeeds().stdout;
        Converted { directory, font, stdout }
    })
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn a_conversion_prints_a_summary_and_writes_a_report() {
    let converted = converted();
    for part in ["2 glyphs", "10-14 ppem", "bytes", "per glyph", "mae", "bad16", " s\n"] {
        assert!(converted.stdout.contains(part), "{part:?} is not in {}", converted.stdout);
    }
    let report = json(&std::fs::read_to_string(converted.directory.path("report.json")).unwrap());
    assert_eq!((&report["target"], &report["ppem"]), (&"smooth".into(), &"10-14".into()));
    let gids: Vec<_> =
        report["glyphs"].as_array().unwrap().iter().map(|g| g["gid"].as_u64().unwrap()).collect();
    assert_eq!(gids, GIDS);
    assert_eq!(number(&report["bytes_per_glyph"]), number(&report["table_bytes"]) / 2.0);
    assert_eq!(report["output_bytes"], std::fs::metadata(&converted.font).unwrap().len());
    assert_eq!(report["mae"], report["comparison"]["totals"]["neural"]["mae"]);
    assert_eq!(converted.directory.files(), ["out.ttf", "report.json"]);
}

#[test]
fn render_prints_every_field_of_every_glyph_and_size() {
    let out = nfr(&["render", &converted().font, "--ppem", "10-14", "--json"]).succeeds().stdout;
    let font = Font::new(std::fs::read(&converted().font).unwrap()).unwrap();
    let cells: Vec<_> = GIDS.iter().flat_map(|gid| SIZES.map(move |ppem| (*gid, ppem))).collect();
    assert_eq!(out.lines().count(), cells.len());
    for (line, (gid, ppem)) in out.lines().zip(cells) {
        let line = json(line);
        let fields: Vec<_> = line.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(fields.len(), 10, "{fields:?}");
        assert_eq!((line["gid"].as_u64(), line["ppem"].as_u64()), (Some(gid), Some(ppem)));
        let bitmap = decode(&font, gid as u32).unwrap().render(ppem as f32).unwrap();
        let place = bitmap.placement;
        assert_eq!(line["left"].as_i64(), Some(place.left.into()));
        assert_eq!(line["top"].as_i64(), Some(place.top.into()));
        assert_eq!(line["width"].as_u64(), Some(place.width.into()));
        assert_eq!(line["height"].as_u64(), Some(place.height.into()));
        assert_eq!(STANDARD.decode(line["pixels"].as_str().unwrap()).unwrap(), bitmap.pixels);
        // Both letters are 1139/2048 em wide.
        assert!((number(&line["advance"]) - 1139.0 / 2048.0 * ppem as f64).abs() < 1e-4, "{line}");
        // Both stand on or below the baseline and are about half an em high.
        assert!((place.top - (ppem as f64 * 0.53).round() as i32).abs() <= 1, "{line}");
    }
}

#[test]
fn render_draws_sheets() {
    let converted = converted();
    let directory = Directory::new();
    let size = |args: &[&str]| {
        let png = directory.name("sheet.png");
        let all = [&["render", &converted.font, "--ppem", "12", "--png", &png], args].concat();
        assert_eq!(nfr(&all).succeeds().stdout, "");
        image::image_dimensions(&png).unwrap()
    };
    let (once, gag) = (size(&["--text", "ag"]), size(&["--text", "gagag"]));
    assert!(gag.0 > once.0, "a longer text is not wider: {once:?}, {gag:?}");
    let zoomed = size(&["--text", "ag", "--zoom", "4"]);
    // The two letters are at least 12 pixels wide and 6 high.
    assert!(zoomed.0 >= once.0 + 3 * 12 && zoomed.1 >= once.1 + 3 * 6, "{once:?}, {zoomed:?}");
    assert!(size(&[]).0 > 12);
}

#[test]
fn a_glyph_without_a_model_is_an_error_that_says_so() {
    let font = &converted().font;
    nfr(&["render", font, "--text", "b", "--json"]).fails_with(&["glyph 69 has no model"]);
    nfr(&["diff", SANS, font, "--text", "b"]).fails_with(&["glyph 69 has no model"]);
}

#[test]
fn info_describes_the_font() {
    let converted = converted();
    let info = json(&nfr(&["info", &converted.font, "--json"]).succeeds().stdout);
    assert_eq!(info["target"], "smooth");
    assert_eq!((info["first_ppem"].as_u64(), info["last_ppem"].as_u64()), (Some(10), Some(14)));
    assert_eq!(info["glyphs_with_models"], 2);
    assert_eq!(info["glyphs"], 2620);
    assert_eq!(info["outlines_match"], true);
    assert_eq!(info["file_bytes"], std::fs::metadata(&converted.font).unwrap().len());
    assert_eq!(number(&info["bytes_per_glyph"]), number(&info["table_bytes"]) / 2.0);
    assert!(info["version"].as_str().unwrap().starts_with("2."));
    let text = nfr(&["info", &converted.font]).succeeds().stdout;
    for part in ["smooth", "10-14 ppem", "2 of 2620 have models"] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn diff_reports_both_sides_by_size_and_glyph() {
    let font = &converted().font;
    let args = ["diff", SANS, font, "--ppem", "10-14", "--json", "-"];
    let run = nfr(&[&args[..], &["--jobs", "1"]].concat()).succeeds();
    assert_eq!(run.stdout, nfr(&[&args[..], &["--jobs", "3"]].concat()).succeeds().stdout);
    let report = json(&run.stdout);
    assert_eq!(report["glyphs"], 2);
    assert_eq!(report["by_ppem"].as_array().unwrap().len(), 5);
    assert_eq!(report["by_glyph"].as_array().unwrap().len(), 2);
    assert_eq!(report["bands"].as_array().unwrap().len(), 1);
    for who in ["neural", "unhinted"] {
        let figures = &report["totals"][who];
        for metric in ["mae", "rmse", "max", "bad16", "exact"] {
            assert!((0.0..=1.0).contains(&number(&figures[metric])), "{who} {metric}: {figures}");
        }
        assert!(GIDS.contains(&figures["max_at"]["gid"].as_u64().unwrap()));
        assert!(SIZES.contains(&figures["max_at"]["ppem"].as_u64().unwrap()));
    }
    // The models are there to be nearer to the hinted bitmaps than the outline is.
    let mae = |who: &str| number(&report["totals"][who]["mae"]);
    assert!(mae("neural") < mae("unhinted") / 2.0, "{} against {}", mae("neural"), mae("unhinted"));
    let worst: Vec<_> =
        report["by_glyph"].as_array().unwrap().iter().map(|g| number(&g["neural"]["mae"])).collect();
    assert!(worst[0] >= worst[1]);
    let table = nfr(&["diff", SANS, font, "--ppem", "10-14"]).succeeds().stdout;
    assert!(table.contains("unhinted") && table.contains("worst glyphs"), "{table}");
}

#[test]
fn diff_writes_a_page_and_a_picture_that_need_nothing_else() {
    let directory = Directory::new();
    let (page, png, report) =
        (directory.name("page/here"), directory.name("picture.png"), directory.name("report"));
    let font = &converted().font;
    let args = ["diff", SANS, font, "--ppem", "10-14", "--html", &page, "--png", &png, "--json", &report];
    assert!(nfr(&args).succeeds().stdout.contains("worst glyphs"));
    let html = std::fs::read_to_string(directory.path("page/here/index.html")).unwrap();
    for part in ["id=\"explorer\"", "<svg", "polyline", "data:image/png;base64,", "68 a", "74 g", "</html>"] {
        assert!(html.contains(part), "{part}");
    }
    assert!(!html.contains("http"), "the page loads something");
    assert!(image::image_dimensions(&png).unwrap().0 > 100);
    assert_eq!(json(&std::fs::read_to_string(&report).unwrap())["glyphs"], 2);
    assert_eq!(directory.files(), ["page", "picture.png", "report"]);
}

#[test]
fn a_missed_threshold_exits_with_1_and_a_kept_one_with_0() {
    let diff = |expression: &str| {
        nfr(&["diff", SANS, &converted().font, "--ppem", "10-14", "--fail-on", expression])
    };
    diff("mae>0.9 || bytes_per_glyph>100000, exact<0").succeeds();
    let missed = diff("mae>0.9 || bytes_per_glyph>1");
    assert_eq!(missed.code, 1);
    assert!(missed.stderr.starts_with("error: bytes_per_glyph is "), "{}", missed.stderr);
    assert!(missed.stdout.contains("worst glyphs"), "the report is missing");
    assert_eq!(diff("exact>=0").code, 1);
}

#[test]
fn diff_refuses_a_font_that_is_not_the_original() {
    let serif = SANS.replace("Sans-", "Serif-");
    nfr(&["diff", &serif, &converted().font]).fails_with(&["2602 glyphs", "2620", "converted from"]);
}

#[test]
fn at_quality_100_the_font_draws_what_the_hints_draw() {
    let directory = Directory::new();
    let font = directory.name("exact.ttf");
    for target in ["smooth", "mono"] {
        let args = ["--text", "Ag%eé", "--quality", "100", "--target", target, SANS, &font];
        nfr_convert(&args).succeeds();
        nfr(&["diff", SANS, &font, "--fail-on", "mae>0 || exact<1"]).succeeds();
    }
}

#[test]
fn outlines_cannot_be_both_dropped_and_drawn() {
    let directory = Directory::new();
    let output = directory.name("out.ttf");
    let args = [&QUICKEST[..], &["--shape", "outline", "--drop-outlines", SANS, &output]].concat();
    nfr_convert(&args).fails_with(&["need them"]);
    assert!(directory.files().is_empty());
    let args = [&QUICKEST[..], &["--shape", "curve", SANS, &output]].concat();
    nfr_convert(&args).rejects_usage(&["use auto, outline or field"]);
}

#[cfg(feature = "train")]
#[test]
fn dropped_outlines_are_told_of_and_the_font_is_compared_all_the_same() {
    let directory = Directory::new();
    let output = directory.name("out.ttf");
    let summary =
        nfr_convert(&["--text", "i", "--ppem", "12", "--drop-outlines", SANS, &output]).succeeds().stdout;
    for part in ["glyph programs", "fpgm", "prep", "cvt", "% of the original's 410712"] {
        assert!(summary.contains(part), "{part:?} is not in {summary}");
    }
    assert!(nfr(&["info", &output]).succeeds().stdout.contains("dropped"));
    assert!(nfr(&["info", &output, "--json"]).succeeds().stdout.contains("\"outlines_dropped\":true"));
    nfr(&["diff", SANS, &output, "--ppem", "12"]).succeeds();
}

#[test]
fn the_number_of_threads_does_not_change_the_font() {
    let directory = Directory::new();
    let other = directory.name("other.ttf");
    let args = [&QUICK[..], &["--jobs", "2", "--quiet", SANS, &other]].concat();
    let run = nfr_convert(&args).succeeds();
    assert_eq!((run.stdout, run.stderr), (String::new(), String::new()));
    assert!(std::fs::read(other).unwrap() == std::fs::read(&converted().font).unwrap());
}

#[test]
fn a_converted_font_is_not_converted_again() {
    let directory = Directory::new();
    let output = directory.name("out.ttf");
    nfr_convert(&[&QUICKEST[..], &[&converted().font, &output]].concat()).fails_with(&["'Nfrt'", "already"]);
    assert!(directory.files().is_empty());
}

#[test]
fn a_failed_conversion_leaves_an_existing_output_as_it_was() {
    let directory = Directory::new();
    let output = directory.write("out.ttf", b"precious");
    // The report cannot be written, which must be known before the output is replaced.
    let run = nfr_convert(&[&QUICKEST[..], &[SANS, &output, "--report", "/no/such/report"]].concat());
    run.fails_with(&["cannot write /no/such/report"]);
    assert_eq!(std::fs::read(&output).unwrap(), b"precious");
    nfr_convert(&[&QUICKEST[..], &[SANS, &output]].concat()).succeeds();
    assert_eq!(&std::fs::read(&output).unwrap()[..4], [0, 1, 0, 0]);
    assert_eq!(directory.files(), ["out.ttf"]);
}

#[test]
fn a_font_of_a_collection_is_converted_and_compared() {
    let directory = Directory::new();
    let input = directory.write("in.ttc", &collection(&sans()));
    let output = directory.name("out.ttf");
    let run =
        nfr_convert(&[&QUICKEST[..], &["--index", "0", "--verbose", &input, &output]].concat()).succeeds();
    assert!(run.stderr.contains("glyph 76 i: mae 0.0"), "{}", run.stderr);
    nfr(&["diff", &input, &output, "--ppem", "12"]).succeeds();
}

#[test]
fn what_layout_makes_of_a_text_is_converted_with_it() {
    let directory = Directory::new();
    let converted = |more: &[&str]| {
        let output = directory.name("out.ttf");
        let args = [&["--text", "fi", "--ppem", "12", DEJAVU, &output], more].concat();
        (nfr_convert(&args).succeeds().stdout, Font::new(std::fs::read(&output).unwrap()).unwrap())
    };
    let has = |font: &Font, character: char| font.has_model(font.glyph_for_char(character).unwrap());
    let (told, font) = converted(&[]);
    assert!(told.contains("of them for layout"), "{told}");
    assert!(has(&font, 'ﬁ') && has(&font, ' ') && font.has_model(0));
    let (_, font) = converted(&["--layout-features", "none"]);
    assert!(!has(&font, 'ﬁ') && has(&font, ' ') && font.has_model(0));
    let (told, font) = converted(&["--no-closure"]);
    assert!(!told.contains("of them"), "{told}");
    assert_eq!(font.modelled_glyphs().len(), 2);
    let output = directory.name("out.ttf");
    nfr_convert(&["--text", "f", "--layout-features", "ligatures", DEJAVU, &output])
        .rejects_usage(&["ligatures", "smcp"]);
}

#[test]
fn characters_that_the_font_lacks_are_told_in_one_line() {
    let directory = Directory::new();
    let output = directory.name("out.ttf");
    let told = nfr_convert(&["--unicodes", "U+61, U+4E0?", "--ppem", "12", SANS, &output]).succeeds().stderr;
    assert_eq!(
        told.lines().filter(|line| line.contains("16 characters are not in the font")).count(),
        1,
        "{told}"
    );
    let told = nfr(&["diff", SANS, &output, "--text", "a一", "--ppem", "12"]).succeeds().stderr;
    assert!(told.contains("'一' (U+4E00)"), "{told}");
    nfr(&["diff", SANS, &output, "--text", "a一", "--ppem", "12", "--strict"]).fails_with(&["U+4E00"]);
}

#[test]
fn a_font_that_misses_a_threshold_is_not_written() {
    let directory = Directory::new();
    let output = directory.write("out.ttf", b"precious");
    let args = [&QUICKEST[..], &[SANS, &output, "--quiet", "--fail-on"]].concat();
    nfr_convert(&[&args[..], &["bytes_per_glyph>1"]].concat())
        .fails_with(&["bytes_per_glyph is", "no font is written"]);
    assert_eq!(std::fs::read(&output).unwrap(), b"precious");
    nfr_convert(&[&args[..], &["mae>0.5"]].concat()).succeeds();
    assert_eq!(directory.files(), ["out.ttf"]);
    nfr_convert(&[&args[..], &["beauty<1"]].concat()).rejects_usage(&["beauty"]);
}

#[test]
fn what_shapers_put_in_the_place_of_characters_is_converted() {
    let directory = Directory::new();
    let output = directory.name("out.ttf");
    let has = |font: &Font, character: char| font.has_model(font.glyph_for_char(character).unwrap());
    // An accent after its letter becomes one glyph where the font has it. A thin space is missing: the space stands for it.
    let run = nfr_convert(&["--text", "e\u{301}\u{2009}", "--ppem", "12", SANS, &output]).succeeds();
    assert_eq!(run.stderr, "");
    let font = Font::new(std::fs::read(&output).unwrap()).unwrap();
    assert!(has(&font, 'é') && has(&font, ' ') && has(&font, '\u{301}'));
}

#[test]
fn models_are_added_to_a_font_that_has_some() {
    let directory = Directory::new();
    let (first, second) = (directory.name("first.ttf"), directory.name("second.ttf"));
    nfr_convert(&["-q", "--text", "aé", "--ppem", "9-20", SANS, &first]).succeeds();
    let added = ["--text", "agé", "--into", &first, SANS, &second];
    let run = nfr_convert(&added).succeeds();
    assert!(run.stdout.contains(&format!("1 glyph beside those of {first} at 9-20 ppem")), "{}", run.stdout);
    let info = nfr(&["info", "--glyphs", &second]).succeeds().stdout;
    // .notdef, the space, a, e, g, the accent, é.
    assert!(info.contains("7 of 2620 have models") && info.contains("9-20 ppem"), "{info}");
    assert_eq!(info.lines().count(), info.lines().position(|line| line.contains("bytes ")).unwrap() + 1 + 7);
    nfr(&["verify", SANS, &second]).succeeds();
    // The font itself may be the output, and a second time there is nothing to add.
    nfr_convert(&["-q", "--text", "agé", "--into", &first, SANS, &first]).succeeds();
    let [first_bytes, second_bytes] = [&first, &second].map(|name| std::fs::read(name).unwrap());
    assert_eq!(first_bytes, second_bytes);
    let run = nfr_convert(&["--text", "agé", "--into", &first, SANS, &first]).succeeds();
    assert!(run.stderr.contains("has models of all selected glyphs already"), "{}", run.stderr);
    assert_eq!(std::fs::read(&first).unwrap(), first_bytes);
    // What does not fit is refused, and nothing is lost.
    let refused = |more: &[&str], part: &str| {
        let args = [&["--text", "x", "--into", &first], more, &[SANS, &second]].concat();
        nfr_convert(&args).rejects_usage(&["first.ttf", part]);
    };
    refused(&["--ppem", "8-20"], "for 9-20 ppem");
    refused(&["--target", "mono"], "for smooth");
    refused(&["--drop-outlines"], "beside the outlines");
    let serif = SANS.replace("Sans-", "Serif-");
    nfr_convert(&["--text", "x", "--into", &first, &serif, &second])
        .fails_with(&["first.ttf", "2602 glyphs"]);
    nfr_convert(&["--text", "x", "--into", SANS, SANS, &second]).fails_with(&["no 'Nfrt' table"]);
    assert_eq!(std::fs::read(&second).unwrap(), second_bytes);
}

#[test]
fn a_variation_selector_that_the_font_lacks_draws_nothing_and_is_no_error() {
    let directory = Directory::new();
    let [output, sheet] = ["out.ttf", "sheet.png"].map(|name| directory.name(name));
    let text = "A\u{fe0f}\u{2060}g";
    let run = nfr_convert(&["--text", text, "--strict", "--ppem", "12", SANS, &output]).succeeds();
    assert_eq!(run.stderr, "");
    let arguments = ["render", &output, "--ppem", "12", "--strict", "--text"];
    let run = nfr(&[&arguments[..], &[text, "--json", "--png", &sheet]].concat()).succeeds();
    assert_eq!(run.stderr, "");
    assert_eq!(run.stdout, nfr(&[&arguments[..], &["Ag", "--json"]].concat()).succeeds().stdout);
}
