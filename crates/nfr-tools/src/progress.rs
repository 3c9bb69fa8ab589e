//! The progress of a conversion, on stderr.

use std::collections::HashMap;
use std::io::{self, IsTerminal, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use nfr_convert::Progress;
use nfr_convert::compare::report::glyph_count_text;

/// Without a terminal, a line this often.
const LINE_INTERVAL: Duration = Duration::from_secs(10);
/// The bar is drawn again this often, so that the time moves while glyphs train.
const TICK: Duration = Duration::from_millis(250);
const STYLE: &str = "{bar:32} {pos}/{len} glyphs  {msg}  {elapsed}, {eta} left";

/// How much is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verbosity {
    Quiet,
    Normal,
    /// A line for each glyph.
    Verbose,
}

/// A bar on a terminal, elsewhere a line every ten seconds. Dropping it stops both.
pub(super) struct Reporter {
    verbosity: Verbosity,
    names: HashMap<u16, String>,
    bar: Option<ProgressBar>,
    state: Arc<Mutex<State>>,
    /// Dropping it stops the thread that prints lines.
    _lines: Option<Sender<()>>,
}

#[derive(Debug, Clone, Copy)]
struct State {
    total: usize,
    done: usize,
    mae_sum: f64,
    start: Instant,
}

impl Reporter {
    /// `names` are those of the glyphs to come, where they have one.
    pub(super) fn new(verbosity: Verbosity, total: usize, names: HashMap<u16, String>) -> Self {
        let state = State { total, done: 0, mae_sum: 0.0, start: Instant::now() };
        let mut reporter =
            Self { verbosity, names, bar: None, state: Arc::new(Mutex::new(state)), _lines: None };
        if verbosity == Verbosity::Quiet {
            return reporter;
        }
        if io::stderr().is_terminal() {
            let bar = ProgressBar::new(total as u64);
            if let Ok(style) = ProgressStyle::with_template(STYLE) {
                bar.set_style(style);
            }
            bar.enable_steady_tick(TICK);
            reporter.bar = Some(bar);
        } else {
            let (sender, receiver) = channel();
            let state = reporter.state.clone();
            // Glyphs come in groups, so lines are printed by the clock and not for so many glyphs.
            thread::spawn(move || print_lines(&receiver, &state));
            reporter._lines = Some(sender);
        }
        reporter
    }

    /// The time since the start.
    pub(super) fn elapsed(&self) -> Duration {
        lock(&self.state).start.elapsed()
    }

    /// Prints a line, unless `--quiet` is given.
    pub(super) fn note(&self, text: &str) {
        if self.verbosity != Verbosity::Quiet {
            self.line(text);
        }
    }

    fn line(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => print_line(text),
        }
    }
}

impl Drop for Reporter {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Progress for Reporter {
    fn planned(&self, glyphs: usize) {
        lock(&self.state).total = glyphs;
        if let Some(bar) = &self.bar {
            bar.set_length(glyphs as u64);
        }
    }

    fn glyph_done(&self, gid: u16, mae: f64) {
        let state = {
            let mut state = lock(&self.state);
            state.done += 1;
            state.mae_sum += mae;
            *state
        };
        if self.verbosity == Verbosity::Verbose {
            let name = self.names.get(&gid).map_or(String::new(), |name| format!(" {name}"));
            self.line(&format!("glyph {gid}{name}: mae {mae:.5}"));
        }
        if let Some(bar) = &self.bar {
            bar.set_message(format!("mae {:.4}", state.mae()));
            bar.inc(1);
        }
    }

    fn warn(&self, message: &str) {
        self.note(&format!("warning: {message}"));
    }
}

fn print_lines(stop: &Receiver<()>, state: &Mutex<State>) {
    while stop.recv_timeout(LINE_INTERVAL) == Err(RecvTimeoutError::Timeout) {
        let state = *lock(state);
        print_line(&state.line(state.start.elapsed()));
    }
}

/// Prints a line to stderr.
pub(super) fn print_line(text: &str) {
    // Progress that nobody reads must not stop the work.
    drop(writeln!(io::stderr(), "{text}"));
}

fn lock(state: &Mutex<State>) -> MutexGuard<'_, State> {
    // The numbers are valid at any moment, so a panic elsewhere does not spoil them.
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

impl State {
    fn mae(&self) -> f64 {
        self.mae_sum / self.done.max(1) as f64
    }

    fn line(&self, elapsed: Duration) -> String {
        let Self { total, done, .. } = *self;
        if done == 0 {
            return format!("0 of {} after {}", glyph_count_text(total), duration(elapsed));
        }
        let left = elapsed.mul_f64(total.saturating_sub(done) as f64 / done as f64);
        format!(
            "{done} of {}, mae {:.4} so far, about {} left",
            glyph_count_text(total),
            self.mae(),
            duration(left)
        )
    }
}

/// A time for people.
fn duration(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..=119 => format!("{seconds} s"),
        seconds @ 120..=7199 => format!("{} min", (seconds + 30) / 60),
        seconds => format!("{:.1} h", seconds as f64 / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plain_line_says_what_is_done_and_what_is_left() {
        let state = |done, mae_sum| State { total: 40, done, mae_sum, start: Instant::now() };
        let line = state(10, 0.0213).line(Duration::from_secs(100));
        assert_eq!(line, "10 of 40 glyphs, mae 0.0021 so far, about 5 min left");
        assert_eq!(state(0, 0.0).line(Duration::from_secs(10)), "0 of 40 glyphs after 10 s");
    }
}
