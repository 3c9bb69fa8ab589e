//! The tests of the commands, but for those that the default build runs, too.
//! One program, since linking one for each file takes minutes.
#![allow(clippy::unwrap_used)]

mod baked;
mod cli_bake;
mod cli_bake_errors;
#[cfg(feature = "bench")]
mod cli_bench;
mod cli_convert;
mod cli_errors;
mod cli_help;
mod cli_inputs;
mod cli_interrupt;
#[cfg(feature = "lab")]
mod cli_lab;
mod cli_postscript;
mod cli_variable;
mod cli_verify;
mod common;
mod errors;
mod fonts;
#[path = "../../nfr-convert/tests/samples/mod.rs"]
mod samples;
mod whole;

#[test]
fn every_file_is_declared() {
    let declared = include_str!("all.rs");
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let file = path.extension().is_some_and(|extension| extension == "rs");
        let apart = ["all", "cli"].contains(&name);
        assert!(
            !file || apart || declared.contains(&format!("mod {name};")),
            "declare {name} in tests/all.rs"
        );
    }
}
