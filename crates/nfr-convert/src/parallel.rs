//! Work on several threads.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use crate::error::Error;

/// Applies `work` to each item, on at most `jobs` threads, and returns the results in the items' order. After a
/// failure no item behind the failed one is started.
pub(crate) fn map<T: Sync, R: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> Result<R, Error> + Sync,
) -> Result<Vec<R>, Error> {
    let pool = ThreadPoolBuilder::new().num_threads(jobs.min(items.len()).max(1)).build();
    let pool = pool.map_err(|e| Error::Io(format!("cannot start {jobs} threads ({e}); use fewer --jobs")))?;
    // All items before the first one that fails are worked on, so that the lowest index is always found.
    let failed = AtomicUsize::new(usize::MAX);
    let run = |(index, item): (usize, &T)| {
        (index < failed.load(Ordering::Relaxed)).then(|| {
            work(item).inspect_err(|_| {
                failed.fetch_min(index, Ordering::Relaxed);
            })
        })
    };
    let results: Vec<_> =
        pool.install(|| items.par_iter().enumerate().with_max_len(1).map(run).collect::<Vec<_>>());
    results.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Barrier;

    use super::*;

    #[test]
    fn results_are_in_order_whichever_thread_they_come_from() {
        let items: Vec<u32> = (0..100).collect();
        for jobs in [1, 3, 1000] {
            assert_eq!(map(&items, jobs, |k| Ok(k * k)), Ok(items.iter().map(|k| k * k).collect()));
        }
        assert_eq!(map(&[] as &[u32], 2, |k| Ok(*k)), Ok(Vec::new()));
    }

    #[test]
    fn as_many_threads_work_as_are_asked_for() {
        // With fewer threads than the barrier waits for, this test does not end.
        let barrier = Barrier::new(3);
        let result = map(&[1, 2, 3], 3, |_| {
            barrier.wait();
            Ok(())
        });
        assert_eq!(result, Ok(vec![(); 3]));
    }

    #[test]
    fn the_first_items_failure_is_returned() {
        let items: Vec<u16> = (0..100).collect();
        let barrier = Barrier::new(2);
        let result = map(&items, 2, |k| {
            // Both threads have an item before either fails.
            if *k < 2 {
                barrier.wait();
            }
            Err::<(), _>(Error::MissingGlyph(*k))
        });
        assert_eq!(result, Err(Error::MissingGlyph(0)));
    }
}
