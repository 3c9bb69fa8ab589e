//! fontTools' instancer as a process. The font goes in and the instance comes out through pipes, so that no file is left whatever
//! happens.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use read_fonts::FontRef;
use write_fonts::FontBuilder;

use crate::failure::Failure;
use nfr_convert::open::open;
use nfr_convert::variable::{AxisValue, Variations};

/// What Python runs.
const SCRIPT: &str = include_str!("instancer.py");
/// The exit code of the script for a Python without fontTools.
const NOT_INSTALLED: i32 = 3;
/// How often the process is looked at.
const TICK: Duration = Duration::from_millis(20);
/// The most bytes that are read of what it writes: as for web fonts, a few times the largest fonts there are.
const MAX_BYTES: u64 = 1 << 30;

/// fontTools under one Python.
pub(super) struct Instancer<'a> {
    pub(super) python: &'a Path,
    /// After this time the process is ended.
    pub(super) timeout: Duration,
    /// The font's file, for messages.
    pub(super) path: &'a Path,
    /// The font's index, if the file is a collection.
    pub(super) index: Option<u32>,
}

/// A process that has ended.
struct Ended {
    status: ExitStatus,
    stdout: Vec<u8>,
    stderr: Vec<u8>,
}

impl Instancer<'_> {
    /// The static font at a place of a variable one.
    pub(super) fn instance(&self, font: &FontRef<'_>, place: &[AxisValue]) -> Result<Vec<u8>, Failure> {
        let mut builder = FontBuilder::new();
        builder.copy_missing_tables(font.clone());
        let python = self.python.display();
        let child = Command::new(self.python)
            .args(["-c", SCRIPT])
            .args(place.iter().map(ToString::to_string))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        let child =
            child.map_err(|e| self.unavailable(&format!("cannot run {python} ({})", e.kind()), place))?;
        let ended = self.communicate(child, builder.build())?;
        let told = String::from_utf8_lossy(&ended.stderr);
        let last = told.lines().map(str::trim).rfind(|line| !line.is_empty()).unwrap_or("it says nothing");
        match ended.status.code() {
            Some(0) => self.checked(ended.stdout),
            Some(NOT_INSTALLED) => {
                Err(self.unavailable(&format!("{python} has no fontTools ({last})"), place))
            }
            _ => Err(Failure::failed(format!("fontTools' instancer fails under {python}: {last}"))),
        }
    }

    /// What it has written, if that is a static font.
    fn checked(&self, data: Vec<u8>) -> Result<Vec<u8>, Failure> {
        let wrong = |what: &str| {
            Failure::failed(format!("fontTools' instancer under {} writes {what}", self.python.display()))
        };
        match open(&data, 0) {
            Ok(font) if Variations::of(&font).is_none() => Ok(data),
            Ok(_) => Err(wrong("a font that is variable still; use a newer fontTools")),
            Err(e) => Err(wrong(&format!("no font ({e})"))),
        }
    }

    /// Feeds the process and waits for its end, or ends it after the time that it has.
    fn communicate(&self, mut child: Child, input: Vec<u8>) -> Result<Ended, Failure> {
        let (stdin, stdout, stderr) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        // A process that ends early closes its pipes, and its exit code tells more than that.
        thread::spawn(move || stdin.map(|mut stdin| stdin.write_all(&input)));
        let (stdout, stderr) = (collect(stdout), collect(stderr));
        let end = Instant::now() + self.timeout;
        let status = loop {
            match child.try_wait() {
                Ok(Some(status)) => break status,
                Ok(None) if Instant::now() < end => thread::sleep(TICK),
                waited => {
                    // Whether or not that works, the failure is the same.
                    let _ = child.kill().and_then(|()| child.wait());
                    let python = self.python.display();
                    return Err(Failure::failed(match waited {
                        Err(e) => format!("cannot wait for {python} ({})", e.kind()),
                        _ => format!(
                            "fontTools' instancer has not ended after {} seconds under {python} and is stopped; give it more with \
                             --instancer-timeout",
                            self.timeout.as_secs()
                        ),
                    }));
                }
            }
        };
        Ok(Ended { status, stdout: joined(stdout), stderr: joined(stderr) })
    }

    /// The failure without Python or fontTools, with the command that makes the instance elsewhere.
    fn unavailable(&self, what: &str, place: &[AxisValue]) -> Failure {
        let place: Vec<String> = place.iter().map(ToString::to_string).collect();
        let (file, place) = (self.path.display(), place.join(" "));
        // The instancer's command takes no collections.
        let (first, file) = match self.index {
            Some(index) => {
                (format!("fonttools ttLib '{file}' -y {index} -o font.ttf && "), "font.ttf".into())
            }
            None => (String::new(), file.to_string()),
        };
        Failure::failed(format!(
            "{what}, which makes the instance; install it (pip install fonttools), or name a Python that has it with --python, or \
             make the instance elsewhere and pass that: {first}fonttools varLib.instancer '{file}' {place} -o instance.ttf"
        ))
    }
}

type Collected = thread::JoinHandle<Vec<u8>>;

/// Reads a pipe to its end on a thread of its own, so that no pipe fills up.
fn collect(pipe: Option<impl Read + Send + 'static>) -> Collected {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(pipe) = pipe {
            // What was read before an error is what there is.
            let _ = pipe.take(MAX_BYTES).read_to_end(&mut bytes);
        }
        bytes
    })
}

fn joined(collected: Collected) -> Vec<u8> {
    collected.join().unwrap_or_default()
}
