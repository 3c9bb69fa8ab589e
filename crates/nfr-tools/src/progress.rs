//! The progress of long commands, on stderr.

use std::collections::HashMap;
use std::io::{self, IsTerminal, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::interrupt;
use super::pace::{Pace, Part};
use nfr_convert::compare::Watch;
use nfr_convert::{Progress, Stage};

/// Without a terminal, a line this often.
const LINE_INTERVAL: Duration = Duration::from_secs(10);
/// On a terminal, nothing is drawn before this time: most commands end sooner.
const PATIENCE: Duration = Duration::from_secs(1);
/// The bar is drawn again this often.
const TICK: Duration = Duration::from_millis(250);
const STYLE: &str = "{bar:32} {msg}";
/// The bar's steps.
const STEPS: u64 = 1000;

/// How much is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verbosity {
    Quiet,
    Normal,
    /// A line for each glyph.
    Verbose,
}

/// A bar on a terminal, elsewhere a line every ten seconds. Dropping it stops both.
pub(super) struct Meter {
    verbosity: Verbosity,
    bar: ProgressBar,
    pace: Arc<Mutex<Pace>>,
    /// Dropping it stops the thread that prints.
    _ends: Option<Sender<()>>,
}

impl Meter {
    pub(super) fn new(verbosity: Verbosity) -> Self {
        let pace = Arc::new(Mutex::new(Pace::new()));
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::hidden());
        if verbosity == Verbosity::Quiet {
            return Self { verbosity, bar, pace, _ends: None };
        }
        let (sender, receiver) = channel();
        let (shown, shared) = (bar.clone(), pace.clone());
        if io::stderr().is_terminal() {
            if let Ok(style) = ProgressStyle::with_template(STYLE) {
                bar.set_style(style);
            }
            let cleared = bar.clone();
            interrupt::clear_screen(move || cleared.finish_and_clear());
            thread::spawn(move || draw_bar(&receiver, &shown, &shared));
        } else {
            thread::spawn(move || print_lines(&receiver, &shared));
        }
        Self { verbosity, bar, pace, _ends: Some(sender) }
    }

    /// The time since the start.
    pub(super) fn elapsed(&self) -> Duration {
        lock(&self.pace).elapsed()
    }

    /// Parts of the work, of so many glyphs each.
    pub(super) fn plan(&self, parts: &[Part], glyphs: usize) {
        parts.iter().for_each(|part| lock(&self.pace).plan(*part, glyphs));
    }

    /// What a comparison tells how far it is.
    pub(super) fn watch(&self, part: impl Fn() -> Part + Send + Sync + 'static) -> Watch {
        let pace = self.pace.clone();
        Box::new(move |done, of| lock(&pace).reach(part(), done, of))
    }

    /// Prints a line, unless `--quiet` is given.
    pub(super) fn note(&self, text: &str) {
        if self.verbosity != Verbosity::Quiet {
            self.bar.suspend(|| print_line(text));
        }
    }
}

impl Drop for Meter {
    fn drop(&mut self) {
        self._ends = None;
        self.bar.finish_and_clear();
    }
}

/// The progress of a conversion.
pub(super) struct Reporter {
    pub(super) meter: Meter,
    names: HashMap<u16, String>,
}

impl Reporter {
    /// `names` are those of the glyphs to come, where they have one.
    pub(super) fn new(verbosity: Verbosity, glyphs: usize, names: HashMap<u16, String>) -> Self {
        let meter = Meter::new(verbosity);
        meter.plan(&[Part::Comparing], glyphs);
        Self { meter, names }
    }
}

impl Progress for Reporter {
    fn work(&self, stages: &[(Stage, usize)]) {
        let mut pace = lock(&self.meter.pace);
        stages.iter().for_each(|(stage, glyphs)| pace.plan(Part::Converting(*stage), *glyphs));
    }

    fn worked(&self, stage: Stage) {
        lock(&self.meter.pace).advance(Part::Converting(stage));
    }

    fn glyph_done(&self, gid: u16, mae: f64) {
        if self.meter.verbosity == Verbosity::Verbose {
            let name = self.names.get(&gid).map_or(String::new(), |name| format!(" {name}"));
            self.meter.note(&format!("glyph {gid}{name}: mae {mae:.5}"));
        }
    }

    fn warn(&self, message: &str) {
        self.meter.note(&format!("warning: {message}"));
    }
}

fn draw_bar(ends: &Receiver<()>, bar: &ProgressBar, pace: &Mutex<Pace>) {
    let mut wait = PATIENCE;
    while ends.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
        if bar.is_hidden() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        let pace = lock(pace).clone();
        bar.set_message(pace.text(pace.elapsed()));
        bar.set_position((pace.share() * STEPS as f64) as u64);
        wait = TICK;
    }
    bar.finish_and_clear();
}

fn print_lines(ends: &Receiver<()>, pace: &Mutex<Pace>) {
    while ends.recv_timeout(LINE_INTERVAL) == Err(RecvTimeoutError::Timeout) {
        let pace = lock(pace).clone();
        print_line(&pace.text(pace.elapsed()));
    }
}

/// Prints a line to stderr.
pub(super) fn print_line(text: &str) {
    // Progress that nobody reads must not stop the work.
    drop(writeln!(io::stderr(), "{text}"));
}

fn lock(pace: &Mutex<Pace>) -> MutexGuard<'_, Pace> {
    // The numbers are valid at any moment, so a panic elsewhere does not spoil them.
    pace.lock().unwrap_or_else(PoisonError::into_inner)
}
