//! The tables and the JSON.

use std::fmt::Write;
use std::path::Path;

use super::round::Candidate;

/// Caption, our entry, and the entries whose time ours is divided by.
const TABLES: [(&str, &str, &[&str]); 4] = [
    ("at a size drawn before", "nfr", &["skrifa_zeno", "swash", "freetype", "fontdue"]),
    ("the first glyph at a size", "nfr_cold", &["skrifa_cold", "skrifa_reconfigured", "freetype_cold"]),
    ("the first glyph of an open font", "nfr_first", &["skrifa_cold"]),
    ("the first glyph of a file", "nfr_open", &["skrifa_open"]),
];

/// The least width of a column.
const COLUMN: usize = 14;

/// The line above the tables.
pub(crate) fn title(neural: &Path, glyphs: usize, rounds: u32) -> String {
    format!(
        "{}: {glyphs} glyphs, microseconds a glyph, median of {rounds} rounds; in brackets ours / theirs",
        neural.display()
    )
}

/// One line of JSON: the size, and each candidate's microseconds a glyph, to the nanosecond.
pub(crate) fn json(ppem: u16, candidates: &[Candidate<'_>], times: &[f64]) -> String {
    let times =
        candidates.iter().zip(times).map(|(candidate, time)| format!(",\"{}\":{time:.3}", candidate.name()));
    format!("{{\"ppem\":{ppem}{}}}", times.collect::<String>())
}

/// The times of each size as tables with ratios.
pub(crate) fn for_people(names: &[&str], results: &[(u16, Vec<f64>)]) -> String {
    let mut text = String::new();
    for (caption, ours, theirs) in TABLES {
        let _ = write!(text, "{caption}\n  ppem{ours:>COLUMN$}");
        for name in theirs {
            let _ = write!(text, "{name:>width$}", width = width(name));
        }
        text.push('\n');
        for (ppem, times) in results {
            let of = |name: &str| names.iter().position(|n| *n == name).map_or(f64::NAN, |at| times[at]);
            let _ = write!(text, "{ppem:>6}{:>COLUMN$.2}", of(ours));
            for name in theirs {
                let cell = format!("{:.2} ({:.2})", of(name), of(ours) / of(name));
                let _ = write!(text, "{cell:>width$}", width = width(name));
            }
            text.push('\n');
        }
        text.push('\n');
    }
    text
}

fn width(name: &str) -> usize {
    (name.len() + 2).max(COLUMN + 2)
}
