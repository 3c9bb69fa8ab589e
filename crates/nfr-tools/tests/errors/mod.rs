//! The error messages in the sources.

#![allow(clippy::unwrap_used)]

use std::path::Path;

/// Messages that the table of `cli_errors.rs` does not provoke, and why: a part of each.
pub(crate) const ELSEWHERE: [(&str, &[&str]); 8] = [
    (
        "they need a machine that is out of room, memory or threads, or a file that changes meanwhile",
        &[
            "cannot write a temporary file (",
            "); use fewer --jobs",
            ", which keeps the glyphs that are ready (",
            "ppem cannot be encoded (",
            "cannot be written (",
            "and 16–16384 are allowed; choose other sizes with --ppem",
        ],
    ),
    (
        "tests/cli_interrupt.rs and tests/whole.rs",
        &["holds an unfinished conversion", "is being written by another conversion", "); delete it"],
    ),
    (
        "tests/cli.rs",
        &["the font's glyphs have no hint programs", "the font is variable", "`; build it with `cargo build"],
    ),
    (
        "tests/cli_bake_errors.rs, tests/cli_bake.rs",
        &[
            "are the most; choose fewer glyphs or smaller sizes",
            ": no glyph has a model; select glyphs",
            ": the description is written beside the picture",
            "no glyph that is selected stands for a character",
            "at most; choose fewer with --text or --unicodes",
        ],
    ),
    (
        "tests of nfr-convert, with fonts that are made for them: teacher.rs, changed_contours.rs, twin.rs, strip.rs, assemble.rs, combine.rs, outlines.rs, unusual_hints.rs, hostile.rs",
        &[
            "; leave out --strict to convert the rest",
            "' is missing or reaches beyond the file",
            "); repair the font",
            "the font's outlines are not TrueType ('glyf')",
            "its tables overlap or are damaged",
            "outside 'glyf'; repair the font",
            "in 'glyf' end inside its",
            "does not fit 16 bits; leave the glyph out",
            "hinting changes the contours of all selected glyphs",
            "; leave it out, or repair the font",
            "skrifa cannot read the font's table directory",
            "FreeType calls such fonts tricky",
            "skrifa does not run the font's hint programs at",
            "an outline has the coordinate",
            "are allowed; choose a smaller size",
            "a side are allowed; choose a smaller size",
            "the neural font's outlines were changed",
            "the outlines of the original font are not those",
            "is not the same in the two fonts",
            "has other contours in its model",
            "outline models that are too large to store",
            "the two fonts are not conversions of the same font",
            "is too large to store; train fewer sizes",
            "are allowed; leave it out",
            "lists of parts' offsets",
        ],
    ),
    (
        "tests/cli_inputs.rs, tests/cli_variable.rs (with fontTools, where that is installed), web_fonts.rs of nfr-convert",
        &[
            "are not converted (index",
            "fontTools' instancer",
            "cannot wait for",
            ", which makes the instance; install it",
            "a font that is variable still",
            "no font (",
            ", which is its default, or another value",
            ": the file is damaged; get it again",
            "the web font says that it unpacks to",
            "this is a compressed web font (WOFF)",
        ],
    ),
    (
        "fonts and pictures at limits that no test's file reaches",
        &[
            "a glyph is too large for the page; choose smaller sizes",
            "the font has no TrueType copy that can be read (",
            "skrifa does not hint the font as asked for (",
            "; leave the glyph out",
            "); leave some out of the font",
        ],
    ),
    (
        "only programs that call the library can make them: the tools' options are checked before",
        &[
            "em; use 0.0001 to 6.5535",
            "knots; use 2 to",
            "patterns; use 1 to",
            "of the moves; use 0 or more",
            "no glyphs are selected",
            "the glyphs are not in ascending order",
            "ppem; use a range within 1–",
            "0 ppem from size to size",
            "0 threads; use 1 or more",
            "use a finite number, 0 or more",
            "training steps; use 0 to",
            "of the steps on; use 0 to 1",
            "already carries an 'Nfrt' table and has no hints left",
            "there is no teacher for the target",
            "; choose other sizes",
            "points for an outline of",
            "networks of more than 4 GiB",
            "lacks grid-fitted offsets",
            "as a part, which has no model",
            "is out of order, or the glyph is in the table already",
            "cannot write",
        ],
    ),
];

/// The first text of each error that a source file makes, outside of its tests: its longest part without a parameter.
pub(crate) fn messages(source: &str) -> Vec<String> {
    const MADE_BY: [&str; 9] = [
        "Failure::failed(",
        "Failure::usage(",
        "Error::Malformed(",
        "Error::Unsupported(",
        "Error::LimitExceeded(",
        "Error::InvalidParameter(",
        "Error::Io(",
        "wrong(",
        "give_up(",
    ];
    let code = source.split("#[cfg(test)]").next().unwrap();
    let mut found = Vec::new();
    for made_by in MADE_BY {
        for (at, _) in code.match_indices(made_by) {
            let after = &code[at + made_by.len()..];
            let Some(start) = after.find('"').filter(|start| *start < 60 && !after[..*start].contains(';'))
            else {
                continue;
            };
            let text = &after[start + 1..];
            let text = &text[..text.find('"').unwrap()];
            let parts = text.split(['{', '}']).step_by(2).flat_map(|part| part.split("\\\n")).map(str::trim);
            found
                .extend(parts.max_by_key(|part| part.len()).filter(|part| part.len() > 8).map(str::to_owned));
        }
    }
    found
}

/// The source files of a directory and those in it.
pub(crate) fn sources(directory: &Path, out: &mut Vec<String>) {
    let mut entries: Vec<_> =
        std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        // The lab and the benchmark have tests of their own, and other features.
        let skipped = ["lab", "bench", "tests.rs", "train"].iter().any(|name| path.ends_with(name));
        if path.is_dir() && !skipped {
            sources(&path, out);
        } else if path.extension().is_some_and(|extension| extension == "rs") && !skipped {
            out.push(std::fs::read_to_string(&path).unwrap());
        }
    }
}
