//! The context of every experiment: settings, a device, and a directory for its files.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use burn::tensor::Device;

use super::accelerator::Accelerator;
use super::guard::guarded;
use super::samples::TrainingSample;
use super::settings::Settings;
use super::train::checkpoint::Checkpoint;
use super::train::files::TrainingFiles;
use super::train::result::TrainingResult;
use nfr_convert::error::Error;

/// The context of experiments.
#[derive(Clone)]
pub struct Experiment<'b> {
    /// The hyperparameters.
    pub settings: Settings,
    /// The device of the trainings.
    pub accelerator: Accelerator,
    /// Trainings that run in parallel.
    pub jobs: usize,
    /// Implicit networks that a queue trains in [lockstep](super::lockstep), where they can be; 1 for none.
    pub together: usize,
    /// Where trainings are kept, each in a directory of its own; nowhere without one.
    pub directory: Option<PathBuf>,
    /// Whether trainings that are found there are resumed.
    pub resume: bool,
    /// Directories of other runs, on other machines perhaps, whose results are used.
    pub merged: Vec<PathBuf>,
    /// When trainings have to stop.
    pub deadline: Option<Instant>,
    /// Whether what unfinished trainings have come to is taken for their result when the time is up.
    pub unfinished: bool,
    /// Whether networks of finished trainings are kept beside their results.
    pub keep_networks: bool,
    /// Called with the name of a training, its finished epochs and all its epochs.
    pub on_progress: &'b (dyn Fn(&str, usize, usize) + Sync),
}

impl Experiment<'_> {
    /// Where tensors of trainings live, with autodiff.
    pub fn device(&self) -> Device {
        self.accelerator.device.clone().autodiff()
    }

    /// The same, with networks kept or not.
    pub fn keeping_networks(&self, keep: bool) -> Experiment<'_> {
        Experiment { keep_networks: keep, ..self.clone() }
    }

    /// The directory of a training.
    pub fn directory_of(&self, path: &[&str]) -> Option<PathBuf> {
        let directory = self.directory.as_ref()?;
        Some(path.iter().fold(directory.clone(), |path, part| path.join(slug(part))))
    }

    /// The files of a training that `description` and the bitmaps determine.
    ///
    /// # Errors
    ///
    /// As [`TrainingFiles::new`].
    pub fn files(
        &self,
        path: &[&str],
        description: &str,
        samples: &[TrainingSample],
    ) -> Result<Option<TrainingFiles>, Error> {
        let Some(directory) = self.directory_of(path) else { return Ok(None) };
        let mut key = description.as_bytes().to_vec();
        for sample in samples {
            key.extend(format!("{} {:?} {}", sample.size, sample.weight, sample.truth.side).into_bytes());
            key.extend_from_slice(&sample.truth.pixels);
        }
        TrainingFiles::new(directory, &key, self.resume).map(Some)
    }

    /// The result of a training of so many epochs: the one that is kept, here or in a merged directory, or that of `train`. If
    /// the time is up before, what it has come to by then is kept.
    ///
    /// # Errors
    ///
    /// As the files' and the training's; `TimeLimit`; `Device` for a device that fails.
    pub fn result(
        &self,
        path: &[&str],
        files: Option<&TrainingFiles>,
        epochs: usize,
        train: impl FnOnce(Option<&Checkpoint>) -> Result<TrainingResult, Error>,
    ) -> Result<TrainingResult, Error> {
        if let Some(result) = self.finished(path, files)? {
            return Ok(result);
        }
        if self.is_late() {
            let unfinished = match files {
                Some(files) if self.unfinished => files.unfinished(&self.elsewhere(path))?,
                _ => None,
            };
            return unfinished.ok_or(Error::TimeLimit);
        }
        let checkpoint = files.map(TrainingFiles::checkpoint);
        let result = guarded(|| train(checkpoint.as_ref()))?;
        let finished = self.keep(files, epochs, &result)?;
        if finished || self.unfinished { Ok(result) } else { Err(Error::TimeLimit) }
    }

    /// The result of a training that is finished, here or in a merged directory.
    ///
    /// # Errors
    ///
    /// As the files'.
    pub fn finished(
        &self,
        path: &[&str],
        files: Option<&TrainingFiles>,
    ) -> Result<Option<TrainingResult>, Error> {
        files.map_or(Ok(None), |files| files.finished(&self.elsewhere(path)))
    }

    /// Keeps what a training has come to, and says whether it has all of its epochs.
    ///
    /// # Errors
    ///
    /// As the files'.
    pub fn keep(
        &self,
        files: Option<&TrainingFiles>,
        epochs: usize,
        result: &TrainingResult,
    ) -> Result<bool, Error> {
        let finished = result.history.len() >= epochs;
        match files {
            Some(files) if finished => files.finish(result, self.keep_networks)?,
            Some(files) => files.leave(result)?,
            None => (),
        }
        Ok(finished)
    }

    /// Whether trainings have to stop.
    pub fn is_late(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// The merged directories of a training.
    fn elsewhere(&self, path: &[&str]) -> Vec<PathBuf> {
        let place =
            |directory: &PathBuf| path.iter().fold(directory.clone(), |path, part| path.join(slug(part)));
        self.merged.iter().map(place).collect()
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
        let (next, failed) = (AtomicUsize::new(0), AtomicUsize::new(usize::MAX));
        let results = Mutex::new(Vec::new());
        // Begins with the first item, as the most important come first.
        let worker = || {
            loop {
                let k = next.fetch_add(1, Ordering::Relaxed);
                // A failure at an earlier item decides the result.
                if k >= items.len() || k > failed.load(Ordering::Relaxed) {
                    return;
                }
                let result = work(&items[k]);
                if result.is_err() {
                    failed.fetch_min(k, Ordering::Relaxed);
                }
                results.lock().unwrap_or_else(PoisonError::into_inner).push((k, result));
            }
        };
        std::thread::scope(|scope| {
            for _ in 1..self.jobs.min(items.len()) {
                scope.spawn(worker);
            }
            worker();
        });
        let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
        results.sort_by_key(|(k, _)| *k);
        results.into_iter().map(|(_, result)| result).collect()
    }
}

/// A name as a part of a path.
fn slug(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || c == '-' || c == '+' { c } else { '-' }).collect()
}
