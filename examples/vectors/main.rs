//! Makes and checks the test vectors of `spec/vectors`. It needs the renderer alone:
//!
//! `cargo run --release --no-default-features --features networks --example vectors -- check spec/vectors [THREADS]` draws everything again
//! and fails if a byte differs; `write spec/vectors` writes what is drawn. `spec/vectors/README.md` describes the files.
//! Without the feature `networks` the font of networks is left out.

#![allow(clippy::print_stdout)]

mod suite;

use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: vectors write FOLDER | vectors check FOLDER [THREADS]";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &[&str]) -> Result<(), String> {
    match args {
        ["write", folder] => suite::write(Path::new(folder)),
        ["check", folder] => check(folder, 1),
        ["check", folder, threads] => check(folder, threads.parse().map_err(|_| USAGE)?),
        _ => Err(USAGE.into()),
    }
}

fn check(folder: &str, threads: usize) -> Result<(), String> {
    let outcome = suite::check(Path::new(folder), threads)?;
    if !outcome.differences.is_empty() {
        return Err(outcome.differences.join("\n"));
    }
    println!("{} lines, all the same", outcome.compared);
    Ok(())
}
