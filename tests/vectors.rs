//! The renderer draws what is written in `spec/vectors`, and a difference does not go unnoticed. If whole bitmaps differ,
//! a picture shows them; with `REPLACE=1` in the environment, the vectors are written again, and the test still fails.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use crate::suite::{BITMAPS, FONTS, File, check, compare, draw, write};

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

/// The bitmaps of a text as `bitmaps.txt` has it: the line above each, and its rows.
fn bitmaps(text: &str) -> Vec<(String, Vec<Vec<u8>>)> {
    let blocks = text.split("\n\n").skip(1);
    let row = |line: &str| line.split(' ').filter_map(|pixel| u8::from_str_radix(pixel, 16).ok()).collect();
    let bitmap = |block: &str| {
        let mut lines = block.lines();
        (lines.next().unwrap_or_default().to_owned(), lines.map(row).collect())
    };
    blocks.map(bitmap).collect()
}

/// Writes a picture of the whole bitmaps that differ from those written down, and says where it is.
fn show(written: &str) -> String {
    let drawn = DRAWN.iter().find(|(name, _)| name == BITMAPS).map_or("", |(_, text)| text);
    let pairs = bitmaps(written).into_iter().zip(bitmaps(drawn)).filter(|(written, drawn)| written != drawn);
    let pairs: Vec<_> = pairs.map(|(written, drawn)| [written.1, drawn.1]).collect();
    if pairs.is_empty() {
        return "no whole bitmap differs".to_owned();
    }
    let path = crate::picture::write("vectors.png", &pairs);
    format!("expected | difference | actual: {}", path.display())
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
    if !outcome.differences.is_empty() {
        let shown = show(&fs::read_to_string(Path::new(FOLDER).join(BITMAPS)).unwrap());
        let replaced = std::env::var_os("REPLACE").map(|_| write(Path::new(FOLDER)));
        panic!("{}\n{shown}, REPLACE=1: {replaced:?}", outcome.differences.join("\n"));
    }
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
fn bitmaps_that_differ_are_shown_as_expected_difference_and_actual() {
    let written = fs::read_to_string(Path::new(FOLDER).join(BITMAPS)).unwrap();
    assert_eq!(show(&written), "no whole bitmap differs");
    let changed = written.replacen("\n00 ", "\nff ", 1);
    let shown = show(&changed);
    let picture = image::open(shown.rsplit(": ").next().unwrap()).unwrap().to_luma8();
    let black = picture.pixels().filter(|pixel| pixel.0 == [0]).count();
    let (_, bitmap) = &bitmaps(&changed)[0];
    let full = bitmap.iter().flatten().filter(|level| **level == 255).count();
    assert_eq!(
        black,
        64 * (2 * full),
        "the full pixels, one of which is expected and a difference, the others twice"
    );
    assert_eq!(picture.width(), 3 * 8 * (bitmap[0].len() as u32 + 1));
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
