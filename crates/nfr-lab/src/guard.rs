//! Failures of devices as errors: burn and its threads panic when a device is lost or its memory is full.

use std::any::Any;
use std::cell::Cell;
use std::io::{self, Write};
use std::panic::{self, AssertUnwindSafe, PanicHookInfo, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, Once, PoisonError};
use std::thread;
use std::time::Duration;

use super::tensors::device_failed;
use nfr_convert::error::Error;

/// How long work may go on after a thread of the device has failed. What waits for that thread would wait for ever.
const GRACE: Duration = Duration::from_secs(3);

/// Does work on a device. A device that fails (it is lost, or its memory is full) makes burn panic: that becomes an error, and nothing
/// is printed.
///
/// # Errors
///
/// `Device` after a panic; those of the work.
pub fn guarded<R>(work: impl FnOnce() -> Result<R, Error>) -> Result<R, Error> {
    silence_guarded();
    let outer = GUARDED.replace(true);
    RUNNING.fetch_add(1, Ordering::SeqCst);
    // After a failure nothing of what the work used is used again.
    let done = catch_unwind(AssertUnwindSafe(work));
    RUNNING.fetch_sub(1, Ordering::SeqCst);
    GUARDED.set(outer);
    match done {
        Ok(Err(error @ Error::Device(_))) => {
            Err(first_failure().map_or(error, |first| device_failed(&first)))
        }
        Ok(done) => done,
        Err(panic) => Err(device_failed(&first_failure().unwrap_or_else(|| text_of(panic.as_ref())))),
    }
}

thread_local! {
    /// Whether a panic of this thread becomes an error.
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Guarded work that is being done.
static RUNNING: AtomicUsize = AtomicUsize::new(0);

/// What the first panic of a device's thread said: its cause, of which the work sees only that the thread is gone.
static FIRST_FAILURE: Mutex<Option<String>> = Mutex::new(None);

fn first_failure() -> Option<String> {
    FIRST_FAILURE.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Leaves panics that become errors out of what the program prints.
fn silence_guarded() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let others = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if is_device_thread() {
                failed(info);
            } else if !GUARDED.get() {
                others(info);
            }
        }));
    });
}

/// Whether this thread is one of cubecl's, which do a device's work: they are called `DSU-` or `DSD-` and numbers.
fn is_device_thread() -> bool {
    thread::current().name().is_some_and(|name| name.starts_with("DSU") || name.starts_with("DSD"))
}

/// Remembers the failure of a device's thread, and ends the program if the work that waits for the thread does not end by itself.
fn failed(info: &PanicHookInfo<'_>) {
    let mut first = FIRST_FAILURE.lock().unwrap_or_else(PoisonError::into_inner);
    if first.is_some() {
        return;
    }
    let text = text_of(info.payload());
    *first = Some(text.clone());
    thread::spawn(move || {
        thread::sleep(GRACE);
        if RUNNING.load(Ordering::SeqCst) > 0 {
            // A closed stderr leaves only the exit code.
            let _ = writeln!(io::stderr(), "error: {}", device_failed(&text));
            std::process::exit(1);
        }
    });
}

fn text_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason is given").to_owned()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_fails_is_an_error_of_one_line() {
        let lost = guarded(|| -> Result<(), Error> { panic!("device {} lost\nat line 7", 3) });
        let text = lost.unwrap_err().to_string();
        assert!(
            text.contains("(device 3 lost)") && text.contains("--resume") && text.lines().count() == 1,
            "{text}"
        );
        assert_eq!(guarded(|| Ok(7)), Ok(7));
        let full = guarded(|| Err::<(), _>(Error::Io("the disk is full".into())));
        assert_eq!(full, Err(Error::Io("the disk is full".into())));
    }
}
