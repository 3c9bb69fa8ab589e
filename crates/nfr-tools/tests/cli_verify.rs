//! `nfr verify` as a person calls it, and what `nfr-convert --quality 100` says where it is not exact.

use std::sync::OnceLock;

use serde_json::Value;

use crate::common::{Directory, SANS, collection, font, nfr, nfr_convert, sans};
use crate::samples::{gid, with_changed_outline, with_flipped_points};

const TEXT: &str = "aRé%";

struct Converted {
    directory: Directory,
    /// Of quality 100.
    exact: String,
    /// Of the default quality.
    default: String,
}

/// Two conversions that several tests look at.
fn converted() -> &'static Converted {
    static CONVERTED: OnceLock<Converted> = OnceLock::new();
    CONVERTED.get_or_init(|| {
        let directory = Directory::new();
        let (exact, default) = (directory.name("exact.ttf"), directory.name("default.ttf"));
        let run = nfr_convert(&["--no-closure", "--text", TEXT, "--quality", "100", SANS, &exact]).succeeds();
        assert!(!run.stderr.contains("warning"), "{}", run.stderr);
        nfr_convert(&["--no-closure", "--text", TEXT, SANS, &default]).succeeds();
        Converted { directory, exact, default }
    })
}

/// The lines of a conversion's stderr that warn.
fn warnings(args: &[&str]) -> Vec<String> {
    let stderr = nfr_convert(args).succeeds().stderr;
    stderr.lines().filter(|line| line.starts_with("warning: ")).map(str::to_owned).collect()
}

#[test]
fn a_font_of_quality_100_is_equal_and_the_exit_code_is_0() {
    let directory = Directory::new();
    for name in ["LiberationSans-Regular", "LiberationSerif-Regular", "DejaVuSans"] {
        let (original, output) = (SANS.replace("LiberationSans-Regular", name), directory.name("out.ttf"));
        for target in ["smooth", "mono"] {
            let args =
                ["--no-closure", "--text", TEXT, "--quality", "100", "--target", target, &original, &output];
            assert_eq!(warnings(&args), Vec::<String>::new());
            let run = nfr(&["verify", &original, &output]).succeeds();
            let holds = "certificate   holds: the errors of 4 glyphs";
            for part in ["4 glyphs, 8-64 ppem, target ", target, "compared, 0 differ\n", "0/64 pixel", holds]
            {
                assert!(run.stdout.contains(part), "{part:?} is not in {}", run.stdout);
            }
            assert!(run.stderr.is_empty() && !run.stdout.contains("worst"), "{}", run.stdout);
        }
    }
}

#[test]
fn a_difference_is_told_with_the_worst_glyphs_and_exits_with_1() {
    // The certificate of the default quality promises no points.
    let run = nfr(&["verify", SANS, &converted().default]).succeeds();
    assert!(
        run.stdout.contains("certificate   holds") && run.stdout.contains("worst glyphs"),
        "{}",
        run.stdout
    );
    let run = nfr(&["verify", SANS, &converted().default, "--at-most", "0"]);
    assert_eq!(run.code, 1);
    assert!(run.stderr.starts_with("error: ") && run.stderr.contains("points differ, by up to "));
    assert_eq!(run.stderr.lines().count(), 1);
    for part in ["228 compared, all points equal at ", "worst glyphs", "8 percent (%)", " ppem\n"] {
        assert!(run.stdout.contains(part), "{part:?} is not in {}", run.stdout);
    }
    nfr(&["verify", SANS, &converted().default, "--at-most", "64"]).succeeds();
    assert_eq!(nfr(&["verify", SANS, &converted().default, "--at-most", "1"]).code, 1);
}

#[test]
fn json_has_totals_sizes_and_glyphs() {
    let parsed = |args: &[&str]| {
        let run = nfr(&[&["verify", "--json", SANS], args].concat());
        assert_eq!(run.stdout.lines().count(), 1);
        (run.code, serde_json::from_str::<Value>(&run.stdout).unwrap())
    };
    let (code, json) = parsed(&[&converted().default]);
    assert_eq!((code, &json["certificate"]["glyphs"]), (0, &4.into()));
    assert_eq!(json["certificate"]["exceeded"], serde_json::json!([]));
    assert!(json["certificate"]["teacher"].as_str().unwrap().starts_with("skrifa "));
    let (code, json) = parsed(&[&converted().default, "--at-most", "0"]);
    assert_eq!((code, &json["target"], &json["ppem"]), (1, &"smooth".into(), &"8-64".into()));
    assert_eq!((&json["glyphs"], &json["glyph_sizes"]), (&4.into(), &228.into()));
    let number =
        |value: &Value, name: &str| value[name].as_u64().unwrap_or_else(|| panic!("{name} in {value}"));
    let sum = |list: &str, name: &str| -> u64 {
        json[list].as_array().unwrap().iter().map(|entry| number(entry, name)).sum()
    };
    let counts = [
        "glyph_sizes",
        "equal_glyph_sizes",
        "changed_contours",
        "points",
        "differing_points",
        "advances",
        "differing_advances",
        "bearings",
        "differing_bearings",
    ];
    for name in counts {
        assert_eq!(sum("by_glyph", name), number(&json, name), "{name}");
        assert_eq!(sum("by_ppem", name), number(&json, name), "{name}");
    }
    let worst = &json["by_glyph"][0];
    assert_eq!(worst["largest_difference"], json["largest_difference"]);
    assert!(worst["name"].is_string() && worst["character"].is_string() && worst["worst_ppem"].is_u64());
    let (code, json) = parsed(&[&converted().exact, "--text", "ab", "--ppem", "9,12"]);
    assert_eq!((code, &json["glyph_sizes"], &json["differing_points"]), (1, &2.into(), &0.into()));
    assert_eq!(json["not_compared"], serde_json::json!([{ "gid": 69, "reason": "no_model" }]));
    assert_eq!(parsed(&[&converted().exact, "--text", "a"]).0, 0);
}

#[test]
fn a_certificate_that_does_not_hold_exits_with_1_and_one_is_asked_for() {
    let directory = Directory::new();
    let default = std::fs::read(&converted().default).unwrap();
    // The hints are others.
    let mut cvt = crate::samples::table(&sans(), b"cvt ");
    cvt.iter_mut().skip(1).step_by(2).for_each(|byte| *byte = byte.wrapping_add(90));
    let original = directory.write("original.ttf", &crate::samples::with_tables(&sans(), &[(b"cvt ", cvt)]));
    let run = nfr(&["verify", &original, &converted().default]);
    assert_eq!(run.code, 1);
    assert!(run.stderr.starts_with("error: the certificate does not hold: the errors of "), "{}", run.stderr);
    assert!(run.stdout.contains("certificate   does not hold for ") && run.stdout.contains(", max "));
    // Bit 3 of the flags.
    let mut nfrt = crate::samples::table(&default, b"Nfrt");
    nfrt[5] &= !8;
    let without = directory.write("without.ttf", &crate::samples::with_tables(&default, &[(b"Nfrt", nfrt)]));
    let run = nfr(&["verify", SANS, &without]);
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("no certificate") && run.stderr.contains("--at-most"), "{}", run.stderr);
    nfr(&["verify", SANS, &without, "--at-most", "64"]).succeeds();
    assert!(nfr(&["info", &without]).succeeds().stdout.contains("certificate     none"));
}

#[test]
fn glyphs_that_cannot_be_compared_are_told_with_the_reason() {
    let directory = Directory::new();
    let exact = std::fs::read(&converted().exact).unwrap();
    let stale = directory.write("stale.ttf", &with_changed_outline(&exact, gid(&exact, 'a')));
    let run = nfr(&["verify", SANS, &stale, "--text", "aRb"]);
    assert_eq!((run.code, run.stderr.as_str()), (1, "error: 2 glyphs cannot be compared\n"));
    for part in [
        "1 glyph without a model",
        "1 glyph whose outline or advance width was changed",
        "57 compared, all points",
    ] {
        assert!(run.stdout.contains(part), "{part:?} is not in {}", run.stdout);
    }
    if cfg!(feature = "train") {
        let dropped = directory.name("dropped.ttf");
        let args = ["--no-closure", "--text", "i", "--ppem", "12", "--drop-outlines", SANS, &dropped];
        nfr_convert(&args).succeeds();
        let run = nfr(&["verify", SANS, &dropped]).succeeds();
        assert!(run.stdout.contains("1 glyph drawn from a field"), "{}", run.stdout);
        assert_eq!(nfr(&["verify", SANS, &dropped, "--at-most", "64"]).code, 1);
    }
}

#[test]
fn what_keeps_it_from_comparing_exits_with_2_and_says_what_to_do() {
    let Converted { directory, exact, .. } = converted();
    let fails = |original: &str, neural: &str, parts: &[&str]| {
        let run = nfr(&["verify", original, neural]).rejects_usage(parts);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    };
    fails(exact, SANS, &["arguments are swapped", &format!("nfr verify {SANS} {exact}")]);
    fails(exact, exact, &["exact.ttf", "converted itself", "pass the hinted font"]);
    fails(SANS, SANS, &["LiberationSans-Regular.ttf", "no 'Nfrt' table", "nfr-convert"]);
    fails(&SANS.replace("Sans-", "Serif-"), exact, &["2602 glyphs", "2620", "converted from"]);
    fails(SANS, &directory.name("missing.ttf"), &["cannot read", "missing.ttf", "check the path"]);
    fails(&directory.name("missing.ttf"), exact, &["cannot read", "missing.ttf", "check the path"]);
    let text = directory.write("text.ttf", b"hello");
    fails(&text, exact, &["text.ttf", "pass a .ttf"]);
    fails(SANS, &text, &["text.ttf", "pass a .ttf"]);
    // The same number of glyphs, one of them with another outline.
    let changed = directory.write("changed.ttf", &with_changed_outline(&sans(), gid(&sans(), 'R')));
    fails(&changed, exact, &[&format!("glyph {} ", gid(&sans(), 'R')), "not the same", "converted from"]);
    nfr(&["verify", SANS, exact, "--ppem", "0"]).rejects_usage(&["--ppem", "outside 1-1024"]);
    nfr(&["verify", SANS, exact, "--at-most=-1"]).rejects_usage(&["--at-most"]);
    nfr(&["verify", SANS, exact, "--text", "一"]).rejects_usage(&["U+4E00"]);
    nfr(&["verify", SANS]).rejects_usage(&["<NEURAL>"]);
    assert!(nfr(&["verify", "--help"]).succeeds().stdout.contains("Usage: nfr verify "));
}

#[test]
fn a_font_of_a_collection_is_verified() {
    let directory = Directory::new();
    let original = directory.write("in.ttc", &collection(&sans()));
    nfr(&["verify", &original, &converted().exact, "--index", "0"]).succeeds();
    nfr(&["verify", &original, &converted().exact, "--index", "1"])
        .rejects_usage(&["index 1", "use index 0"]);
}

#[test]
fn quality_100_warns_in_one_line_of_what_is_not_exact() {
    let directory = Directory::new();
    let output = directory.name("out.ttf");
    let told = |more: &[&str], parts: &[&str]| {
        let args = [&["--quality", "100", SANS, &output], more].concat();
        let warnings = warnings(&args);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        for part in [&["--quality 100 is not exact for "], parts].concat() {
            assert!(warnings[0].contains(part), "{part:?} is not in {warnings:?}");
        }
    };
    let (predicted, outside) =
        ("5 sizes whose hinting is predicted", "46 sizes outside of the trained 10-20 ppem");
    told(&["--text", "ag", "--train-ppem", "10-20:2"], &[predicted, outside]);
    if cfg!(feature = "train") {
        told(
            &["--no-closure", "--text", "i", "--ppem", "12", "--shape", "field"],
            &["1 glyph drawn from a field"],
        );
    }
    let args = ["--text", "ag", "--train-ppem", "10-20:2", SANS, &output];
    assert!(warnings(&args).is_empty(), "the default quality does not claim to be exact");
    let args = [&["--quality", "100", "--quiet"], &args[..]].concat();
    assert_eq!(nfr_convert(&args).succeeds().stderr, "");
}

#[test]
fn a_glyph_whose_contours_hinting_changes_does_not_stop_a_conversion() {
    let directory = Directory::new();
    let data = font("LiberationSans-Regular");
    let input = directory.write("in.ttf", &with_flipped_points(&data, gid(&data, 'e'), [3, 6, 12]));
    let (output, report) = (directory.name("out.ttf"), directory.name("report.json"));
    let outline = [
        "--no-closure",
        "--text",
        "aeo",
        "--ppem",
        "11-12",
        "--shape",
        "outline",
        "--quality",
        "100",
        "--report",
        &report,
        &input,
        &output,
    ];
    let warnings = warnings(&outline);
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(warnings[0].contains("contours of 1 glyph (72)") && warnings[0].contains("without a model"));
    assert!(warnings[1].contains("not exact for 1 glyph without a model"), "{warnings:?}");
    let report: Value = serde_json::from_str(&std::fs::read_to_string(&report).unwrap()).unwrap();
    assert_eq!((&report["left_out"], &report["comparison"]["glyphs"]), (&serde_json::json!([72]), &2.into()));
    nfr_convert(&[&outline[..], &["--strict", "--quiet"]].concat()).fails_with(&[
        "1 glyph cannot be converted",
        "glyph 72",
        "--strict",
    ]);
    nfr(&["verify", &input, &output]).succeeds();
    assert!(nfr(&["info", &output]).succeeds().stdout.contains("2 of 2620 have models"));
    let run = nfr_convert(&["--no-closure", "--text", "aeo", "--ppem", "11-12", &input, &output]).succeeds();
    let info = nfr(&["info", &output]).succeeds().stdout;
    let verified = nfr(&["verify", &input, &output, "--text", "aeo"]).stdout;
    let (told, models, reason) = if cfg!(feature = "train") {
        ("trained fields", "3 of 2620 have models", "1 glyph drawn from a field")
    } else {
        (
            "--shape auto trains fields for them in a program that is built with --features train",
            "2 of 2620 have models",
            "1 glyph without a model",
        )
    };
    assert!(run.stderr.contains("1 glyph (72)") && run.stderr.contains(told), "{}", run.stderr);
    assert!(info.contains(models) && verified.contains(reason), "{info}{verified}");
}
