//! The tests of the renderer, but for those that count allocations.
//! One program, since linking one for each file takes minutes.
#![allow(clippy::unwrap_used)]

mod charmaps;
mod door;
mod lcd;
mod mono;
mod opening;
mod outline;
#[path = "samples/picture.rs"]
mod picture;
mod samples;
mod specification;
#[path = "../examples/vectors/suite.rs"]
mod suite;
mod unhinted;
mod vectors;

#[test]
fn every_file_is_declared() {
    let declared = include_str!("all.rs");
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let file = path.extension().is_some_and(|extension| extension == "rs");
        let apart = ["all", "memory"].contains(&name);
        assert!(
            !file || apart || declared.contains(&format!("mod {name};")),
            "declare {name} in tests/all.rs"
        );
    }
}
