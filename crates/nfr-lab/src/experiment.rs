//! The context of every experiment: settings, a device, and a directory for its files.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use burn::tensor::Device;
use rayon::prelude::*;

use super::samples::TrainingSample;
use super::settings::Settings;
use super::train::checkpoint::Checkpoint;
use nfr_convert::error::Error;

/// The context of experiments.
pub struct Experiment<'b> {
    /// The hyperparameters.
    pub settings: Settings,
    /// Where tensors live, with autodiff.
    pub device: Device,
    /// Trainings that run in parallel.
    pub jobs: usize,
    /// Where trainings are kept, each in a directory of its own; nowhere without one.
    pub directory: Option<PathBuf>,
    /// Whether trainings that are found there are resumed.
    pub resume: bool,
    /// Called with the name of a training, its finished epochs and all its epochs.
    pub on_progress: &'b (dyn Fn(&str, usize, usize) + Sync),
}

impl Experiment<'_> {
    /// The directory of a training.
    pub fn directory_of(&self, path: &[&str]) -> Option<PathBuf> {
        let directory = self.directory.as_ref()?;
        Some(path.iter().fold(directory.clone(), |path, part| path.join(slug(part))))
    }

    /// The checkpoint of a training that `description` and the bitmaps determine.
    ///
    /// # Errors
    ///
    /// As [`Checkpoint::new`].
    pub fn checkpoint(
        &self,
        path: &[&str],
        description: &str,
        samples: &[TrainingSample],
    ) -> Result<Option<Checkpoint>, Error> {
        let Some(directory) = self.directory_of(path) else { return Ok(None) };
        let mut key = description.as_bytes().to_vec();
        for sample in samples {
            key.extend(format!("{} {:?} {}", sample.size, sample.weight, sample.truth.side).into_bytes());
            key.extend_from_slice(&sample.truth.pixels);
        }
        Checkpoint::new(directory.join("checkpoint"), &key, self.resume).map(Some)
    }

    /// Applies `work` to each item on `jobs` threads; the results are in the order of the items. A failure ends the work.
    ///
    /// # Errors
    ///
    /// Of several failures the first item's.
    pub fn each<T: Sync, R: Send>(
        &self,
        items: &[T],
        work: impl Fn(&T) -> Result<R, Error> + Sync,
    ) -> Result<Vec<R>, Error> {
        let failed = AtomicUsize::new(usize::MAX);
        let run = |(k, item): (usize, &T)| {
            // A failure at an earlier item decides the result.
            if k > failed.load(Ordering::Relaxed) {
                return None;
            }
            let result = work(item);
            if result.is_err() {
                failed.fetch_min(k, Ordering::Relaxed);
            }
            Some(result)
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.jobs).build();
        let pool = pool.map_err(|e| Error::Io(format!("threads cannot be started ({e})")))?;
        let results: Vec<_> =
            pool.install(|| items.par_iter().enumerate().with_max_len(1).map(run).collect());
        results.into_iter().flatten().collect()
    }
}

/// A name as a part of a path.
fn slug(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || c == '-' || c == '+' { c } else { '-' }).collect()
}
