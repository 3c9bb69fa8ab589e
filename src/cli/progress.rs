//! How a conversion is going, on stderr.

use std::collections::HashMap;
use std::io::{self, IsTerminal, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::convert::Progress;

/// Without a terminal, a line at most this often.
const LINE_INTERVAL: Duration = Duration::from_secs(10);
/// The bar is drawn again this often, so that the time moves while glyphs train.
const TICK: Duration = Duration::from_millis(250);
const STYLE: &str = "{bar:32} {pos}/{len} glyphs  {msg}  {elapsed}, {eta} left";

/// How much to tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verbosity {
    Quiet,
    Normal,
    /// A line for each glyph.
    Verbose,
}

/// A bar on a terminal; elsewhere a plain line now and then.
pub(super) struct Reporter {
    verbosity: Verbosity,
    names: HashMap<u16, String>,
    bar: Option<ProgressBar>,
    total: usize,
    start: Instant,
    state: Mutex<State>,
}

struct State {
    done: usize,
    mae_sum: f64,
    last_line: Instant,
}

impl Reporter {
    /// `names` are those of the glyphs to come, where they have one.
    pub(super) fn new(verbosity: Verbosity, total: usize, names: HashMap<u16, String>) -> Self {
        let terminal = verbosity != Verbosity::Quiet && io::stderr().is_terminal();
        let bar = terminal.then(|| {
            let bar = ProgressBar::new(total as u64);
            if let Ok(style) = ProgressStyle::with_template(STYLE) {
                bar.set_style(style);
            }
            bar.enable_steady_tick(TICK);
            bar
        });
        let start = Instant::now();
        let state = Mutex::new(State { done: 0, mae_sum: 0.0, last_line: start });
        Self { verbosity, names, bar, total, start, state }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// The time since the start.
    pub(super) fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    fn line(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            // Progress that nobody reads must not stop the work.
            None => drop(writeln!(io::stderr(), "{text}")),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // The numbers are valid at any moment, so a panic elsewhere does not spoil them.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress for Reporter {
    fn glyph_done(&self, gid: u16, mae: f64) {
        let mut state = self.state();
        state.done += 1;
        state.mae_sum += mae;
        let (done, mean) = (state.done, state.mae_sum / state.done as f64);
        if self.verbosity == Verbosity::Verbose {
            let name = self.names.get(&gid).map_or(String::new(), |name| format!(" {name}"));
            self.line(&format!("glyph {gid}{name}: mae {mae:.5}"));
        }
        if let Some(bar) = &self.bar {
            bar.set_message(format!("mae {mean:.4}"));
            bar.inc(1);
        } else if self.verbosity != Verbosity::Quiet
            && (state.last_line.elapsed() >= LINE_INTERVAL || done == self.total)
        {
            state.last_line = Instant::now();
            self.line(&status(done, self.total, mean, self.start.elapsed()));
        }
    }
}

/// The plain line.
fn status(done: usize, total: usize, mae: f64, elapsed: Duration) -> String {
    let status = format!("{done} of {total} glyphs, mae {mae:.4} so far");
    if done >= total {
        return format!("{status}, {}", duration(elapsed));
    }
    let left = elapsed.mul_f64((total - done) as f64 / done.max(1) as f64);
    format!("{status}, about {} left", duration(left))
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
        let line = status(10, 40, 0.00213, Duration::from_secs(100));
        assert_eq!(line, "10 of 40 glyphs, mae 0.0021 so far, about 5 min left");
        assert_eq!(status(4, 4, 0.5, Duration::from_secs(9)), "4 of 4 glyphs, mae 0.5000 so far, 9 s");
    }
}
