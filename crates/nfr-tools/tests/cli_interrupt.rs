//! Ctrl-C ends a conversion at any moment, and what was there before is untouched.

#![cfg(unix)]

use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::common::{Directory, SANS, nfr_convert};
use assert_cmd::cargo::cargo_bin;

/// More glyphs than are ready within the longest wait.
const ARGS: [&str; 7] = ["--gids", "0-2600", "--no-closure", "--ppem", "8-64", "--quality", "75"];

fn start(more: &[&str]) -> Child {
    let mut command = Command::new(cargo_bin("nfr-convert"));
    command.args(ARGS).args(more).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Sends a signal, as `kill` of the shell does.
fn signal(child: &Child, name: &str) {
    let kill = format!("kill -{name} {}", child.id());
    Command::new("sh").args(["-c", &kill]).status().unwrap();
}

/// The exit code, none if the signal ended it before it was caught, and what it said.
fn end(mut child: Child) -> (Option<i32>, String) {
    let mut told = String::new();
    child.stderr.take().unwrap().read_to_string(&mut told).unwrap();
    (child.wait().unwrap().code(), told)
}

/// Waits until a file is there; too long a wait fails what follows.
fn wait_for(directory: &Directory, name: &str) {
    for _ in 0..6000 {
        if directory.path(name).exists() {
            return;
        }
        sleep(Duration::from_millis(10));
    }
}

#[test]
fn an_interruption_at_any_moment_leaves_what_was_there_and_a_file_to_go_on_with() {
    let directory = Directory::new();
    let output = directory.write("out.ttf", b"precious");
    let mut resumable = 0;
    // The last one comes when something is kept.
    for (k, milliseconds) in [1u64, 30, 120, 400, 900, 0].into_iter().enumerate() {
        let resume: &[&str] = if resumable > 0 { &["--resume"] } else { &[] };
        let child = start(&[&[SANS, output.as_str()], resume].concat());
        match milliseconds {
            0 => wait_for(&directory, "out.ttf.partial"),
            milliseconds => sleep(Duration::from_millis(milliseconds)),
        }
        // A shell starts what it runs in the background with INT ignored, until the program catches it.
        signal(&child, if milliseconds == 0 || milliseconds > 30 { ["INT", "TERM"][k % 2] } else { "TERM" });
        let (code, told) = end(child);
        assert!(std::fs::read(&output).unwrap() == b"precious", "after {milliseconds} ms");
        let files = directory.files();
        let is_resumable = files.contains(&"out.ttf.partial".to_owned());
        assert_eq!(files.len(), 1 + usize::from(is_resumable), "{files:?}");
        if code.is_none() {
            assert!((1..=30).contains(&milliseconds) && told.is_empty(), "{told}");
            continue;
        }
        assert_eq!(code, Some(130), "{told}");
        let last = told.lines().last().unwrap();
        let advice = if is_resumable {
            "the same command with --resume goes on"
        } else {
            "run the same command again"
        };
        // Before it has opened the work file, it says what is right whether there is one or not.
        let is_early = !resume.is_empty() && last.ends_with("run the same command again");
        assert!(last.starts_with("interrupted") && (last.ends_with(advice) || is_early), "{told}");
        resumable += usize::from(is_resumable);
    }
    assert!(resumable > 0, "no interruption kept anything");
    // A small part of the glyphs would be another conversion: the work file is that of all of them.
    nfr_convert(&[&ARGS[..], &[SANS, &output]].concat()).fails_with(&["--resume"]);
}

#[test]
fn a_resumed_conversion_of_outlines_writes_the_same_font() {
    let directory = Directory::new();
    let (whole, output) = (directory.name("whole.ttf"), directory.name("out.ttf"));
    let args = ["--quiet", "--gids", "0-300", "--ppem", "8-24", SANS];
    nfr_convert(&[&args[..], &[&whole]].concat()).succeeds();
    let child = Command::new(cargo_bin("nfr-convert"))
        .args(args)
        .arg(&output)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Until it has kept something, or is ready on a fast machine.
    let kept = || directory.files().contains(&"out.ttf.partial".to_owned());
    for _ in 0..400 {
        if kept() || directory.files().contains(&"out.ttf".to_owned()) {
            break;
        }
        sleep(Duration::from_millis(10));
    }
    signal(&child, "INT");
    let (code, told) = end(child);
    if code == Some(130) && kept() {
        assert!(told.contains("--resume"), "{told}");
        let args: Vec<&str> = args.iter().copied().filter(|arg| *arg != "--quiet").collect();
        let run = nfr_convert(&[&args[..], &["--resume", &output]].concat()).succeeds();
        assert!(run.stderr.contains("going on after"), "{}", run.stderr);
    } else {
        nfr_convert(&[&args[..], &[&output]].concat()).succeeds();
    }
    assert!(std::fs::read(&output).unwrap() == std::fs::read(&whole).unwrap());
    assert_eq!(directory.files(), ["out.ttf", "whole.ttf"]);
}

#[test]
fn a_dry_run_writes_nothing_and_tells_time_and_bytes() {
    let directory = Directory::new();
    let output = directory.write("out.ttf", b"precious");
    let run = nfr_convert(&["--dry-run", "--gids", "36-120", "--ppem", "8-16", SANS, &output]).succeeds();
    for part in ["nothing is written", "table   about ", "file    about ", "time    about "] {
        assert!(run.stdout.contains(part), "{part:?} is not in {}", run.stdout);
    }
    assert_eq!(
        (directory.files(), std::fs::read(&output).unwrap()),
        (vec!["out.ttf".into()], b"precious".to_vec())
    );
    let bytes = |text: &str, before: &str| -> f64 {
        let (_, after) = text.split_once(before).unwrap();
        after.split_whitespace().next().unwrap().parse().unwrap()
    };
    let estimate = bytes(&run.stdout, "table   about ");
    let actual = nfr_convert(&["--gids", "36-120", "--ppem", "8-16", SANS, &output]).succeeds().stdout;
    let ratio = estimate / bytes(&actual, "table   ");
    assert!((0.7..1.3).contains(&ratio), "{ratio}");
}
