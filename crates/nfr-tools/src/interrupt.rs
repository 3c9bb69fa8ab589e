//! Ctrl-C and the signal to terminate: the program ends at once, but never within a write, so that no file is half-written.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// The exit code of a program that Ctrl-C ended (128 and the number of SIGINT).
const INTERRUPTED: i32 = 130;
/// A signal is noticed within this time.
const POLL: Duration = Duration::from_millis(20);

type Callback<T> = Box<dyn FnOnce() -> T + Send>;

/// What has to be done at the end.
struct State {
    /// Writes that are going on.
    writes: usize,
    /// The program is about to end: nothing more is written.
    ends: bool,
    /// Clears what progress has drawn.
    clear: Option<Callback<()>>,
    /// Says how to go on.
    last_words: Option<Callback<String>>,
    /// Directories to delete.
    temporary: Vec<PathBuf>,
}

static STATE: Mutex<State> =
    Mutex::new(State { writes: 0, ends: false, clear: None, last_words: None, temporary: Vec::new() });
static CHANGED: Condvar = Condvar::new();

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends the program at the first Ctrl-C or signal to terminate, with a line that says how to go on, and at the second one even if that
/// has to wait for a write. The exit code is 130.
pub fn watch() {
    let interrupted = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // Where a signal cannot be caught, it ends the program as it does by default. The first registration acts on the second signal:
        // the flag is set after it.
        let second = flag::register_conditional_shutdown(signal, INTERRUPTED, interrupted.clone());
        drop(second.and_then(|_| flag::register(signal, interrupted.clone())));
    }
    thread::spawn(move || {
        while !interrupted.load(Ordering::SeqCst) {
            thread::sleep(POLL);
        }
        end()
    });
}

fn end() -> ! {
    let mut state = state();
    while state.writes > 0 {
        state = CHANGED.wait(state).unwrap_or_else(PoisonError::into_inner);
    }
    state.ends = true;
    let (clear, last_words) = (state.clear.take(), state.last_words.take());
    let temporary = std::mem::take(&mut state.temporary);
    drop(state);
    if let Some(clear) = clear {
        clear();
    }
    let line = last_words
        .map_or_else(|| "interrupted: run the same command again".into(), |last_words| last_words());
    // Nobody may be there to read it.
    drop(writeln!(io::stderr(), "{line}"));
    temporary.iter().for_each(|path| drop(std::fs::remove_dir_all(path)));
    std::process::exit(INTERRUPTED)
}

/// While one of these is there, no signal ends the program, but for a second one.
pub(super) struct Uninterrupted;

/// Begins a write that has to come to its end. If the program is about to end, it does so here.
pub(super) fn uninterrupted() -> Uninterrupted {
    let mut state = state();
    while state.ends {
        state = CHANGED.wait(state).unwrap_or_else(PoisonError::into_inner);
    }
    state.writes += 1;
    Uninterrupted
}

impl Drop for Uninterrupted {
    fn drop(&mut self) {
        state().writes -= 1;
        CHANGED.notify_all();
    }
}

/// Sets what is said when a signal ends the program.
pub(super) fn last_words(words: impl FnOnce() -> String + Send + 'static) {
    state().last_words = Some(Box::new(words));
}

/// Sets what clears the screen before that.
pub(super) fn clear_screen(clear: impl FnOnce() + Send + 'static) {
    state().clear = Some(Box::new(clear));
}

/// Has a directory deleted when a signal ends the program.
pub(super) fn delete_at_end(directory: &Path) {
    state().temporary.push(directory.to_owned());
}
