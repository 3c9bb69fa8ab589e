//! The tests of the converter, but for those of hostile fonts, which measure the memory of their program, and those that its package runs.
//! One program, since linking one for each file takes minutes.
#![allow(clippy::unwrap_used)]

mod assemble;
mod autohinter;
mod certificate;
mod changed_contours;
mod characters;
mod combine;
mod equivalent_font;
mod fallback;
#[path = "samples/freetype_bitmap.rs"]
mod freetype_bitmap;
#[path = "samples/freetype_mono.rs"]
mod freetype_mono;
mod lcd;
#[path = "samples/model_twin.rs"]
mod model_twin;
mod mono;
mod outlines;
mod postscript;
#[path = "samples/programs.rs"]
mod programs;
#[cfg(feature = "train")]
mod quality;
#[cfg(feature = "train")]
mod render;
mod samples;
mod table_damage;
mod teacher;
mod twin;
mod unusual_hints;
mod verification;
mod web_fonts;

#[test]
fn every_file_is_declared() {
    let declared = include_str!("all.rs");
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let file = path.extension().is_some_and(|extension| extension == "rs");
        let apart = ["all", "hostile", "limits", "strip", "table"].contains(&name);
        assert!(
            !file || apart || declared.contains(&format!("mod {name};")),
            "declare {name} in tests/all.rs"
        );
    }
}
