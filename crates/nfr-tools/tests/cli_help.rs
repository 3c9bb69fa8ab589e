//! What users read before they run a command: help, completions, man pages.

use std::path::Path;
use std::process::Command;

use crate::common::{Directory, SANS, nfr, nfr_convert};
use assert_cmd::cargo::cargo_bin;

/// The commands that a help begins with.
fn examples(help: &str) -> Vec<String> {
    let (before, _) = help.split_once("\nUsage: ").unwrap();
    let (_, examples) = before.split_once("Examples:\n").unwrap();
    examples.lines().map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect()
}

#[cfg(unix)]
#[test]
fn the_examples_of_the_help_work_as_printed() {
    let directory = Directory::new();
    std::fs::copy(SANS, directory.path("in.ttf")).unwrap();
    let programs = cargo_bin("nfr").parent().unwrap().to_owned();
    let path = std::env::join_paths([programs.as_path(), Path::new("/usr/bin"), Path::new("/bin")]).unwrap();
    let helps = [nfr_convert(&["--help"]), nfr(&["--help"])].map(|run| examples(&run.succeeds().stdout));
    for example in helps.iter().flat_map(|examples| {
        assert_eq!(examples.len(), 2);
        examples
    }) {
        let mut shell = Command::new("sh");
        let run =
            shell.args(["-c", example]).current_dir(directory.path("")).env("PATH", &path).output().unwrap();
        assert!(run.status.success(), "{example}: {}", String::from_utf8_lossy(&run.stderr));
    }
    let written = ["in.ttf", "magic.png", "out.png", "out.ttf", "report.json", "sizes.ttf"];
    assert_eq!(directory.files(), written);
}

#[test]
fn every_shell_gets_completions_of_both_programs() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = nfr(&["completions", shell]).succeeds().stdout;
        assert!(script.contains("verify") && script.contains("at-most"), "{shell}");
        let script = nfr(&["completions", shell, "nfr-convert"]).succeeds().stdout;
        assert!(script.contains("nfr-convert") && script.contains("drop-outlines"), "{shell}");
    }
    nfr(&["completions", "tcsh"]).rejects_usage(&["tcsh", "bash", "zsh"]);
}

#[cfg(unix)]
#[test]
fn the_completions_for_bash_are_loaded_by_bash() {
    let directory = Directory::new();
    let script = directory.write("nfr", nfr(&["completions", "bash"]).succeeds().stdout.as_bytes());
    let test = format!(
        "source {script}; COMP_WORDS=(nfr ver); COMP_CWORD=1; _nfr nfr ver nfr; echo \"${{COMPREPLY[@]}}\""
    );
    // Machines without bash have no use for the script.
    if let Ok(run) = Command::new("bash").args(["-c", &test]).output() {
        let told = String::from_utf8_lossy(&run.stdout);
        assert_eq!(told.trim(), "verify", "{}", String::from_utf8_lossy(&run.stderr));
    }
}

#[test]
fn man_pages_are_written_for_both_programs_and_every_command() {
    let directory = Directory::new();
    nfr(&["man", &directory.name("man1")]).succeeds();
    let page = |name: &str| std::fs::read_to_string(directory.path("man1").join(name)).unwrap();
    for (name, option) in [
        ("nfr-convert.1", "dry"),
        ("nfr.1", "nfr\\-verify"),
        ("nfr-verify.1", "most"),
        ("nfr-bake.1", "bits"),
    ] {
        let page = page(name);
        assert!(page.contains(".TH") && page.contains(option), "{name}: {page}");
    }
    nfr(&["man", "/dev/null/man1"]).fails_with(&["/dev/null/man1", "choose a place"]);
}
