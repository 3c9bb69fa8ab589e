//! The training of fields, which a build has with the feature `train` and lacks without it.

use crate::error::Error;
use crate::fit::Parameters;
use crate::options::{Options, Shape};
use crate::training_samples::GlyphSamples;
use nfr::internals::model::gridfit::Scale;

/// How glyphs that cannot have an outline model get a field.
pub(super) const ADVICE: &str = if cfg!(feature = "train") {
    "--shape auto trains fields for them"
} else {
    "--shape auto trains fields for them in a program that is built with --features train"
};

/// Whether this build can train what the options ask for.
pub(super) fn is_possible(options: &Options) -> bool {
    cfg!(feature = "train") || options.schedule.steps == 0
}

/// Fails if the options ask for training and this build has none.
pub(super) fn check(gid: u16, options: &Options) -> Result<(), Error> {
    if is_possible(options) {
        return Ok(());
    }
    Err(Error::TrainingNotBuilt { gid, outlines_dropped: options.shape != Shape::Field })
}

/// Trains a chunk of glyphs.
#[cfg(feature = "train")]
pub(super) fn train(
    glyphs: &[&GlyphSamples],
    parameters: &mut [Parameters],
    scale: Scale,
    options: &Options,
) -> Result<(), Error> {
    crate::train::train(glyphs, parameters, scale, options.schedule, options.backend)
}

/// Leaves the initial fits as they are, which is what training without any step does.
#[cfg(not(feature = "train"))]
pub(super) fn train(
    glyphs: &[&GlyphSamples],
    _parameters: &mut [Parameters],
    _scale: Scale,
    options: &Options,
) -> Result<(), Error> {
    glyphs.iter().try_for_each(|samples| check(samples.gid, options))
}
