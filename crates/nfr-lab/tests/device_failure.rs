//! Failures of a device's own threads, which cubecl names after the device. They last for the rest of the program: each test starts one.

#![allow(clippy::unwrap_used)]

use std::env;
use std::process::{Command, Output};
use std::thread;
use std::time::Duration;

use nfr_convert::error::Error;
use nfr_lab::guard::guarded;

const WORK: &str = "NFR_TEST_WORK";

/// A thread of a device that panics.
fn failing_thread() {
    let thread = thread::Builder::new().name("DSD-0-0".into());
    assert!(thread.spawn(|| panic!("wgpu error: Out of Memory\nin a buffer")).unwrap().join().is_err());
}

/// Runs a test of this program by itself.
fn alone(test: &str) -> Output {
    let mut command = Command::new(env::current_exe().unwrap());
    command.args([test, "--exact", "--nocapture", "--test-threads=1"]).env(WORK, "1").output().unwrap()
}

fn text(output: &[u8]) -> String {
    String::from_utf8_lossy(output).into_owned()
}

#[test]
fn what_a_devices_thread_says_is_the_cause_and_printed_nowhere() {
    if env::var_os(WORK).is_none() {
        let output = alone("what_a_devices_thread_says_is_the_cause_and_printed_nowhere");
        assert!(output.status.success(), "{}{}", text(&output.stdout), text(&output.stderr));
        assert_eq!(text(&output.stderr), "");
        return;
    }
    let panicking = guarded(|| -> Result<(), Error> {
        failing_thread();
        panic!("the other end has hung up")
    });
    let failing = guarded(|| Err::<(), _>(Error::Device("a channel is closed".into())));
    for found in [panicking, failing] {
        let found = found.unwrap_err().to_string();
        assert!(found.contains("wgpu error: Out of Memory") && found.lines().count() == 1, "{found}");
    }
    let full = guarded(|| Err::<(), _>(Error::Io("the disk is full".into())));
    assert_eq!(full, Err(Error::Io("the disk is full".into())));
}

#[test]
fn work_that_waits_for_a_devices_thread_in_vain_is_ended() {
    if env::var_os(WORK).is_none() {
        let output = alone("work_that_waits_for_a_devices_thread_in_vain_is_ended");
        let told = text(&output.stderr);
        assert_eq!((output.status.code(), told.lines().count()), (Some(1), 1), "{told}");
        assert!(told.starts_with("error: ") && told.contains("Out of Memory"), "{told}");
        return;
    }
    let _ = guarded(|| -> Result<(), Error> {
        failing_thread();
        loop {
            thread::sleep(Duration::from_secs(60));
        }
    });
}
