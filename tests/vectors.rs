//! The renderer draws what is written in `spec/vectors`, and a difference does not go unnoticed.
#![allow(clippy::unwrap_used)]

#[path = "../examples/vectors/suite.rs"]
mod suite;

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

#[cfg(feature = "networks")]
use suite::write;
use suite::{FONTS, File, check, compare, draw};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/spec/vectors");

/// What one thread draws.
static DRAWN: LazyLock<Vec<File>> = LazyLock::new(|| draw(Path::new(FOLDER), 1).unwrap());

/// A folder with the fonts and vectors, which goes away.
fn copied() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let names = FONTS.iter().flat_map(|font| [format!("{font}.ttf"), format!("{font}.txt")]);
    for name in names.chain(["bitmaps.txt".to_owned(), "sweeps.txt".to_owned()]) {
        fs::copy(Path::new(FOLDER).join(&name), folder.path().join(name)).unwrap();
    }
    folder
}

/// What a check finds when a file's lines are changed.
fn found(name: &str, change: impl Fn(&mut Vec<String>)) -> Vec<String> {
    let folder = copied();
    let path = folder.path().join(name);
    let mut lines: Vec<String> = fs::read_to_string(&path).unwrap().lines().map(String::from).collect();
    change(&mut lines);
    fs::write(&path, lines.join("\n") + "\n").unwrap();
    compare(folder.path(), &DRAWN).unwrap().differences
}

#[test]
fn everything_is_drawn_as_it_is_written_down() {
    let outcome = compare(Path::new(FOLDER), &DRAWN).unwrap();
    assert_eq!(outcome.differences, [""; 0]);
    assert!(outcome.compared > 6000, "{} lines", outcome.compared);
}

#[test]
fn threads_that_share_glyphs_draw_the_same() {
    let outcome = check(Path::new(FOLDER), 3).unwrap();
    assert_eq!(outcome, compare(Path::new(FOLDER), &DRAWN).unwrap());
}

#[cfg(feature = "networks")]
#[test]
fn writing_again_changes_no_file() {
    let folder = copied();
    write(folder.path()).unwrap();
    for file in fs::read_dir(folder.path()).unwrap() {
        let file = file.unwrap();
        let before = fs::read(Path::new(FOLDER).join(file.file_name())).unwrap();
        assert!(fs::read(file.path()).unwrap() == before, "{:?}", file.file_name());
    }
}

#[test]
fn a_changed_hash_is_named_with_its_line() {
    let differences = found("serif.txt", |lines| {
        let hash = lines[99].len() - 16;
        lines[99].replace_range(hash.., &"0".repeat(16));
    });
    assert_eq!(differences.len(), 1);
    assert!(differences[0].starts_with("serif.txt:100: written "), "{differences:?}");
    assert!(differences[0].contains(" 0000000000000000, drawn "), "{differences:?}");
}

#[test]
fn a_changed_pixel_is_named_with_its_row() {
    let differences = found("bitmaps.txt", |lines| lines[3].replace_range(..1, "x"));
    assert!(
        differences.len() == 1 && differences[0].starts_with("bitmaps.txt:4: written x"),
        "{differences:?}"
    );
}

#[test]
fn lines_that_lack_or_that_nobody_draws_are_differences() {
    let differences = found("mono.txt", |lines| drop(lines.pop()));
    assert!(
        differences.len() == 1 && differences[0].contains(": written nothing, drawn "),
        "{differences:?}"
    );
    let differences = found("sans.txt", |lines| lines.push("1 2 3".into()));
    assert!(
        differences.len() == 1 && differences[0].ends_with(": written 1 2 3, drawn nothing"),
        "{differences:?}"
    );
}

#[test]
fn after_some_differences_of_a_file_the_others_are_counted() {
    let differences = found("sans.txt", |lines| lines.iter_mut().take(20).for_each(|line| line.push('!')));
    assert_eq!(differences.len(), 6);
    assert_eq!(differences[5], "sans.txt: 15 more lines differ");
}
