//! The options of a conversion and of its stages, which are checked before any work.

mod capacity;
mod fidelity;
mod hinter;
mod quality;
mod refinement;
mod schedule;

use std::ops::RangeInclusive;

use crate::error::Error;
use nfr::Target;
use nfr::internals::model::gridfit::MAX_TRAINED_PPEM;

pub use capacity::{CELL_UNITS_PER_EM, Capacity};
pub use fidelity::Fidelity;
pub use hinter::Hinter;
pub use quality::Quality;
pub use refinement::Refinement;
pub use schedule::{Backend, Schedule};

/// Where models have their shapes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shape {
    /// The outlines of the font where it keeps them, else fields. Glyphs whose contours hinting changes get fields;
    /// without the feature `train` they are left without a model.
    #[default]
    Auto,
    /// The outlines of the font. Glyphs whose contours hinting changes are left without a model.
    Outline,
    /// Fields of their own, which are trained: it takes the feature `train`.
    Field,
}

/// The options of a conversion.
#[derive(Debug, Clone)]
pub struct Options {
    /// The font's index in a collection file; 0 for a plain font.
    pub index: u32,
    /// The glyphs to convert, in ascending order.
    pub gids: Vec<u16>,
    /// The sizes of the models, in pixels per em, up to the last one that the teacher draws.
    pub ppem: RangeInclusive<u16>,
    /// The step between the sizes that the teacher draws. Hinting at the sizes between is predicted.
    pub ppem_step: u16,
    /// The rendering target of the hints.
    pub target: Target,
    /// Which hints are learnt.
    pub hinter: Hinter,
    /// Seeds whatever the training draws at random.
    pub seed: u64,
    /// Threads. The result does not depend on their number.
    pub jobs: usize,
    /// burn's backend for the training.
    pub backend: Backend,
    /// Where models have their shapes from.
    pub shape: Shape,
    /// The balance of error and bytes of outline models.
    pub fidelity: Fidelity,
    /// Limits on a field's size.
    pub capacity: Capacity,
    /// The training's steps and learning rates.
    pub schedule: Schedule,
    /// The refinement of the trained weights.
    pub refinement: Refinement,
    /// Whether glyphs are composed of others' models where their hints move them in the same way.
    pub compose: bool,
    /// Whether the outlines of the glyphs that have models are left out of the font. Their models are fields then.
    pub drop_outlines: bool,
}

impl Default for Options {
    /// Sizes 8–64 for smooth rendering, one thread, no glyphs.
    fn default() -> Self {
        Self {
            index: 0,
            gids: Vec::new(),
            ppem: 8..=64,
            ppem_step: 1,
            target: Target::default(),
            hinter: Hinter::default(),
            seed: 1,
            jobs: 1,
            backend: Backend::default(),
            shape: Shape::default(),
            fidelity: Fidelity::default(),
            capacity: Capacity::default(),
            schedule: Schedule::default(),
            refinement: Refinement::default(),
            compose: true,
            drop_outlines: false,
        }
    }
}

impl Options {
    /// The same options with another balance of error and bytes.
    pub fn with_quality(self, quality: Quality) -> Self {
        Self {
            fidelity: Fidelity::new(quality),
            capacity: quality.capacity(),
            schedule: Schedule { smoothness: quality.smoothness(), ..self.schedule },
            refinement: quality.refinement(),
            ..self
        }
    }

    /// Whether models move the font's own outlines.
    pub fn uses_outlines(&self) -> bool {
        match self.shape {
            Shape::Auto => !self.drop_outlines,
            Shape::Outline => true,
            Shape::Field => false,
        }
    }

    /// Checks all that can be checked without the font. A conversion begins with it.
    ///
    /// # Errors
    ///
    /// `InvalidParameter`, naming the first option that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |what: String| Err(Error::InvalidParameter(what));
        if self.gids.is_empty() {
            return wrong("no glyphs are selected".into());
        }
        if !self.gids.is_sorted_by(|a, b| a < b) {
            return wrong("the glyphs are not in ascending order".into());
        }
        let (first, last) = (*self.ppem.start(), *self.ppem.end());
        if first == 0 || first > last || last > MAX_TRAINED_PPEM {
            return wrong(format!("sizes {first}–{last} ppem; use a range within 1–{MAX_TRAINED_PPEM}"));
        }
        if self.ppem_step == 0 {
            return wrong("0 ppem from size to size; use 1 or more".into());
        }
        if self.jobs == 0 {
            return wrong("0 threads; use 1 or more".into());
        }
        if self.shape == Shape::Outline && self.drop_outlines {
            return wrong("models of the font's outlines need them; do not drop them, or use fields".into());
        }
        self.capacity.check()?;
        self.schedule.check()?;
        self.refinement.check()
    }
}
