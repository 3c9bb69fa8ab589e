//! How far a comparison is.

use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Is told how many glyphs, or glyphs at a size, are compared, and of how many; from several threads.
pub type Watch = Box<dyn Fn(usize, usize) + Send + Sync>;

/// Counts what is compared, and tells it.
#[derive(Default)]
pub(super) struct Watched {
    watch: Option<Watch>,
    done: AtomicUsize,
    total: AtomicUsize,
}

impl Watched {
    pub(super) fn by(watch: Watch) -> Self {
        Self { watch: Some(watch), ..Self::default() }
    }

    /// A comparison of so many begins.
    pub(super) fn begin(&self, total: usize) {
        self.done.store(0, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
    }

    /// So many more are compared.
    pub(super) fn done(&self, count: usize) {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        if let Some(watch) = &self.watch {
            watch(done, self.total.load(Ordering::Relaxed));
        }
    }
}

impl fmt::Debug for Watched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} of {:?}", self.done, self.total)
    }
}
