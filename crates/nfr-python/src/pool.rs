//! Rasterizers for any number of threads.

use std::sync::{Mutex, PoisonError};

use nfr::{Font, Limits, MissingModel, Rasterizer};

/// How rasterizers are made.
#[derive(Clone, Copy)]
pub(crate) struct Settings {
    pub(crate) missing: MissingModel,
    pub(crate) limits: Limits,
    pub(crate) cache: usize,
}

/// The rasterizers of a font that no thread is using. One that draws takes one out, or makes one: threads do not wait for each other,
/// and a single thread always has the same one, with what it has decoded.
pub(crate) struct Pool {
    settings: Settings,
    idle: Mutex<Vec<Rasterizer>>,
}

impl Pool {
    pub(crate) fn new(settings: Settings) -> Self {
        Self { settings, idle: Mutex::default() }
    }

    /// Does work with a rasterizer of `font`, which is the same in each call.
    pub(crate) fn with<T>(&self, font: &Font, work: impl FnOnce(&mut Rasterizer) -> T) -> T {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = idle().pop();
        let mut rasterizer = taken.unwrap_or_else(|| {
            let Settings { missing, limits, cache } = self.settings;
            Rasterizer::new(font).with_missing_model(missing).with_limits(limits).with_cache(cache)
        });
        let result = work(&mut rasterizer);
        idle().push(rasterizer);
        result
    }

    pub(crate) fn settings(&self) -> &Settings {
        &self.settings
    }
}
