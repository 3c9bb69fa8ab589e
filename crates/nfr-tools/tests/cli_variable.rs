//! Variable fonts: which instance is asked for, and how fontTools makes it. Where the Python of `NFR_PYTHON`, or else `python3`, has no
//! fontTools, the advice is tested instead.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{Directory, Run, SANS, collection_of, nfr, nfr_convert};
use read_fonts::FontRef;
use write_fonts::FontBuilder;

/// Axes wght, 400 to 700, and wdth, 75 to 100; instances Regular, Semibold and Condensed Bold.
const VARIABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../nfr-convert/tests/inputs/variable.ttf");
const PLACE: [&str; 4] = ["--axis", "wght=600", "--axis", "wdth=100"];

fn convert(output: &str, args: &[&str]) -> Run {
    nfr_convert(&[&["--ppem", "10-12"], args, &[VARIABLE, output]].concat())
}

#[track_caller]
fn refuse(args: &[&str], parts: &[&str]) {
    let directory = Directory::new();
    convert(&directory.name("out.ttf"), args).fails_with(parts);
    assert_eq!(directory.files(), [""; 0]);
}

fn python() -> String {
    std::env::var("NFR_PYTHON").unwrap_or_else(|_| "python3".into())
}

fn has_font_tools() -> bool {
    let mut run = Command::new(python());
    run.args(["-c", "import fontTools.varLib.instancer"]).stderr(Stdio::null());
    run.status().is_ok_and(|status| status.success())
}

#[test]
fn a_variable_font_without_a_place_is_refused_with_its_axes_and_instances() {
    let parts = ["wght 400–700 (default 400)", "--axis wght=400 --axis wdth=100", "\"Condensed Bold\""];
    refuse(&[], &parts);
    let directory = Directory::new();
    let neural = directory.name("out.ttf");
    nfr_convert(&["--quiet", "--text", "i", "--ppem", "12", SANS, &neural]).succeeds();
    nfr(&["diff", VARIABLE, &neural]).fails_with(&parts);
    nfr(&["verify", VARIABLE, &neural]).rejects_usage(&parts);
}

#[test]
fn a_place_that_the_font_does_not_have_is_refused() {
    refuse(&["--axis", "wght=600"], &["'wdth'", "--axis wdth=100"]);
    refuse(&["--axis", "wght=701", "--axis", "wdth=100"], &["wght=701", "400–700"]);
    refuse(&["--axis", "opsz=12"], &["'opsz'", "wght 400–700"]);
    refuse(&["--instance", "Black"], &["\"Black\"", "\"Semibold\""]);
    let directory = Directory::new();
    let out = directory.name("out.ttf");
    convert(&out, &["--axis", "wght"]).rejects_usage(&["wght=600"]);
    convert(&out, &["--axis", "wght=600", "--instance", "Semibold"]).rejects_usage(&["--instance"]);
    nfr_convert(&[SANS, &out, "--axis", "wght=600"]).fails_with(&["not variable"]);
}

#[test]
fn without_font_tools_the_command_that_makes_the_instance_is_told() {
    let command = format!("fonttools varLib.instancer '{VARIABLE}' wght=600 wdth=100 -o instance.ttf");
    refuse(&[&PLACE[..], &["--python", "no/such/python"]].concat(), &["no/such/python", &command]);
    let directory = Directory::new();
    let font = std::fs::read(VARIABLE).unwrap();
    let collection = directory.write("in.ttc", &collection_of(&[&font, &font]));
    let args = ["--index", "1", "--instance", "Semibold", "--python", "no/such/python"];
    nfr_convert(&[&args[..], &[&collection, &directory.name("out.ttf")]].concat()).fails_with(&[
        &format!("fonttools ttLib '{collection}' -y 1 -o font.ttf && "),
        "varLib.instancer 'font.ttf' wght=600 wdth=100 -o",
    ]);
}

#[cfg(unix)]
#[test]
fn a_python_that_fails_hangs_or_writes_no_font_is_told_in_one_line() {
    use std::os::unix::fs::PermissionsExt;

    let directory = Directory::new();
    let run = |script: &str, parts: &[&str]| {
        let python = directory.write("python", format!("#!/bin/sh\n{script}\n").as_bytes());
        std::fs::set_permissions(&python, std::fs::Permissions::from_mode(0o755)).unwrap();
        let args = [&PLACE[..], &["--python", &python, "--instancer-timeout", "1"]].concat();
        convert(&directory.name("out.ttf"), &args).fails_with(parts);
        assert_eq!(directory.files(), ["python"]);
    };
    run("echo Traceback >&2; echo 'ValueError: no such thing' >&2; exit 1", &["ValueError: no such thing"]);
    run("echo \"No module named 'fontTools'\" >&2; exit 3", &["pip install fonttools", "wght=600 wdth=100"]);
    run("cat >/dev/null; echo this is no font", &["writes no font"]);
    run("cat", &["still"]);
    run("exit 0", &["writes no font"]);
    run("kill -9 $$", &["it says nothing"]);
    let start = Instant::now();
    run("sleep 60", &["1 seconds", "--instancer-timeout"]);
    assert!(start.elapsed() < Duration::from_secs(20));
}

#[test]
fn an_instance_is_converted_with_the_hints_that_its_control_values_give_and_compared() {
    let (directory, python) = (Directory::new(), python());
    let out = directory.name("out.ttf");
    let named = ["--instance", "semibold", "--python", &python];
    let conversion = convert(&out, &[&named[..], &["--quality", "100"]].concat());
    if !has_font_tools() {
        conversion.fails_with(&["pip install fonttools", "fonttools varLib.instancer"]);
        return;
    }
    let summary = conversion.succeeds().stdout;
    assert!(summary.contains("the instance wght=600 wdth=100"), "{summary}");
    let neural = out.clone();
    for place in [&named[..2], &PLACE] {
        let of = |command| [&[command, VARIABLE, &neural], place, &["--python", &python]].concat();
        nfr(&of("verify")).succeeds();
        nfr(&[&of("diff")[..], &["--ppem", "10-12", "--fail-on", "mae>0"]].concat()).succeeds();
    }
    // At another place the outlines are others.
    let other = ["verify", VARIABLE, &neural, "--instance", "Condensed Bold", "--python", &python];
    nfr(&other).rejects_usage(&["not the same"]);
    let instance = |font: &str, place: &[&str], name: &str| {
        let out = directory.name(name);
        nfr_convert(&[&["--ppem", "10-30", "--python", &python], place, &[font, &out]].concat()).succeeds();
        std::fs::read(out).unwrap()
    };
    let place = ["--axis", "wdth=100", "--axis", "wght=600"];
    let semibold = instance(VARIABLE, &place, "semibold.ttf");
    assert!(
        semibold == instance(VARIABLE, &["--instance", "Semibold"], "again.ttf"),
        "the second time it is another font"
    );
    let data = std::fs::read(VARIABLE).unwrap();
    let font = FontRef::new(&data).unwrap();
    let mut builder = FontBuilder::new();
    for record in font.table_directory().table_records().iter().filter(|record| record.tag() != "cvar") {
        builder.add_raw(record.tag(), font.table_data(record.tag()).unwrap().as_bytes().to_vec());
    }
    let without = directory.write("without.ttf", &builder.build());
    assert!(
        semibold != instance(&without, &place, "without.nfr.ttf"),
        "variations of control values are not applied"
    );
}
