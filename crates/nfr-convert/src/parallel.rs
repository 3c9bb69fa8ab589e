//! Work on several threads.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use crate::error::Error;

/// Does `work` on each item, on at most `jobs` threads, and gives the results in the items' order. The first failure
/// stops all threads.
///
/// # Errors
///
/// Of several failures the first item's, whichever thread met it.
pub(crate) fn each<T: Sync, R: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> Result<R, Error> + Sync,
) -> Result<Vec<R>, Error> {
    let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
    let run = || {
        let mut done = Vec::new();
        while !failed.load(Ordering::Relaxed) {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { break };
            let result = work(item);
            failed.fetch_or(result.is_err(), Ordering::Relaxed);
            done.push((index, result));
        }
        done
    };
    let mut done: Vec<(usize, Result<R, Error>)> = thread::scope(|scope| {
        let threads: Vec<_> = (0..jobs.min(items.len()).max(1)).map(|_| scope.spawn(run)).collect();
        threads.into_iter().flat_map(|t| t.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    });
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Barrier;

    use super::*;

    #[test]
    fn results_are_in_order_whichever_thread_they_come_from() {
        let items: Vec<u32> = (0..100).collect();
        for jobs in [1, 3, 1000] {
            assert_eq!(each(&items, jobs, |k| Ok(k * k)), Ok(items.iter().map(|k| k * k).collect()));
        }
        assert_eq!(each(&[] as &[u32], 2, |k| Ok(*k)), Ok(Vec::new()));
    }

    #[test]
    fn as_many_threads_work_as_are_asked_for() {
        // With fewer threads than the barrier waits for, this test does not end.
        let barrier = Barrier::new(3);
        let result = each(&[1, 2, 3], 3, |_| {
            barrier.wait();
            Ok(())
        });
        assert_eq!(result, Ok(vec![(); 3]));
    }

    #[test]
    fn the_first_items_failure_is_told() {
        let items: Vec<u16> = (0..100).collect();
        let barrier = Barrier::new(2);
        let result = each(&items, 2, |k| {
            // Both threads have an item before either fails.
            if *k < 2 {
                barrier.wait();
            }
            Err::<(), _>(Error::MissingGlyph(*k))
        });
        assert_eq!(result, Err(Error::MissingGlyph(0)));
    }
}
