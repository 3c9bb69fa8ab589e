//! Training and measuring all glyphs, chunk by chunk, so that only a few glyphs' training samples are in memory at a time.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};

use super::training;
use crate::compare::metrics::Sums;
use crate::conversion::{Progress, Stage};
use crate::error::Error;
use crate::fit::{Parameters, initial_fit};
use crate::options::Options;
use crate::parallel;
use crate::partial::Partial;
use crate::predict::Predictor;
use crate::refine::refine;
use crate::teacher::{Teacher, TeacherAt};
use crate::training_samples::GlyphSamples;
use crate::writer::GlyphModel;
use nfr::internals::Glyph;
use nfr::internals::model::compose::{Composed, Origin};
use nfr::internals::model::gridfit::{GridFit, Scale, Weights};
use nfr::internals::table::Dropout;

/// Glyphs that are trained together. The number is fixed, because the last digits of the result depend on it.
const CHUNK: usize = 2;
/// A model with this much more error than the unhinted outline, in levels of 255 for a mean pixel, looks worse; less is not seen.
const VISIBLE_LEVELS: f64 = 0.125;

/// What the stages of one conversion share.
#[derive(Clone, Copy)]
pub(super) struct Stages<'c> {
    pub(super) teacher: &'c Teacher,
    /// The sizes that are learnt.
    pub(super) sizes: &'c [TeacherAt],
    /// The sizes between them, at which hinting is predicted.
    pub(super) between: &'c [TeacherAt],
    /// The sizes of the models.
    pub(super) scale: Scale,
    /// Predicts the sizes of the models that the teacher does not draw.
    pub(super) predictor: &'c Predictor,
    pub(super) options: &'c Options,
    pub(super) progress: &'c dyn Progress,
    /// The glyphs whose hint programs are told to fail: samples are drawn to learn a glyph, and again to measure it.
    pub(super) failures: &'c Mutex<BTreeSet<u16>>,
}

impl Stages<'_> {
    /// The samples of a glyph.
    pub(super) fn samples(&self, gid: u16) -> Result<GlyphSamples, Error> {
        let mut samples = GlyphSamples::draw(self.teacher, self.sizes, gid)?;
        self.predictor.add_predicted_sizes(&mut samples)?;
        if let Some(error) = &samples.hint_error {
            let mut told = self.failures.lock().unwrap_or_else(PoisonError::into_inner);
            if told.insert(gid) {
                self.progress.warn(error);
            }
        }
        Ok(samples)
    }

    /// Draws the stored model and compares it with the teacher at all sizes of the models.
    pub(super) fn measure(&self, samples: &GlyphSamples, glyph: &Glyph) -> Result<Measured, Error> {
        let (mut learnt, mut dropout) = (Sums::default(), BTreeMap::new());
        for sample in samples.sizes.iter().filter(|size| !size.predicted) {
            learnt.add(&sample.bitmap, &glyph.render(f32::from(sample.ppem))?);
            dropout.insert(sample.ppem, sample.dropout);
        }
        let mut all = learnt;
        for at in self.between {
            let hinted = at.hinted(samples.gid)?;
            all.add(&hinted.rasterize()?, &glyph.render(f32::from(at.ppem()))?);
            dropout.insert(at.ppem(), hinted.dropout);
        }
        if samples.outline.points.is_empty() {
            dropout.clear();
        }
        self.progress.glyph_done(samples.gid, learnt.figures().mae);
        let is_worse_than_unhinted = self.unhinted_is_nearer(samples, learnt);
        Ok(Measured { learnt, all, dropout, is_worse_than_unhinted })
    }

    /// Whether the unhinted outline has an error that is visibly smaller than `sums`. Outline models are nearer than that to the
    /// teacher, so that nothing is drawn; for most fields the largest size alone decides.
    fn unhinted_is_nearer(&self, samples: &GlyphSamples, sums: Sums) -> bool {
        let pixels = sums.figures().pixels as f64;
        let least = sums.absolute() as f64 - VISIBLE_LEVELS * pixels;
        let mut unhinted = Sums::default();
        for sample in samples.sizes.iter().rev().filter(|size| !size.predicted) {
            if unhinted.absolute() as f64 >= least {
                return false;
            }
            let plain = self.teacher.unhinted(samples.gid, f32::from(sample.ppem));
            // An outline that cannot be drawn is no better.
            let Ok(plain) = plain.and_then(|outline| outline.rasterize()) else { return false };
            unhinted.add(&sample.bitmap, &plain);
        }
        (unhinted.absolute() as f64) < least
    }
}

/// The errors of a glyph against the teacher.
#[derive(Debug, Clone)]
pub(super) struct Measured {
    /// At the sizes that were learnt.
    pub(super) learnt: Sums,
    /// At all sizes of the models.
    pub(super) all: Sums,
    /// What the hints ask of a renderer in black and white, by size; empty for a blank glyph.
    pub(super) dropout: BTreeMap<u16, Dropout>,
    /// Whether the glyph's unhinted outline is visibly nearer to the teacher.
    pub(super) is_worse_than_unhinted: bool,
}

/// Trains and measures the fields of one conversion.
pub(super) struct GlyphTrainer<'c> {
    pub(super) stages: Stages<'c>,
    /// The work file, with the glyphs of an earlier conversion.
    pub(super) partial: Option<&'c Partial>,
}

/// A trained glyph and its error.
pub(super) struct TrainedGlyph {
    pub(super) gid: u16,
    pub(super) weights: Weights,
    pub(super) measured: Measured,
}

impl GlyphTrainer<'_> {
    /// Trains all chunks, on `options.jobs` threads.
    pub(super) fn train_all(&self, gids: &[u16]) -> Result<Vec<TrainedGlyph>, Error> {
        let chunks: Vec<&[u16]> = gids.chunks(CHUNK).collect();
        let is_new = |chunk: &&&[u16]| !matches!(self.found(chunk), Ok(Some(_)));
        let new = chunks.iter().filter(is_new).map(|chunk| chunk.len()).sum();
        self.stages.progress.work(&[(Stage::Training, new)]);
        chunks.iter().try_for_each(|gids| self.check_training(gids))?;
        let trained = parallel::map(&chunks, self.stages.options.jobs, |gids| self.train_chunk(gids))?;
        Ok(trained.into_iter().flatten().collect())
    }

    /// Fails if a chunk has to be trained and this build cannot do it.
    fn check_training(&self, gids: &[u16]) -> Result<(), Error> {
        if self.found(gids)?.is_some() {
            return Ok(());
        }
        for gid in gids {
            if !self.stages.teacher.unhinted_em(*gid)?.points.is_empty() {
                training::check(*gid, self.stages.options)?;
            }
        }
        Ok(())
    }

    /// The weights of a chunk in the work file.
    fn found(&self, gids: &[u16]) -> Result<Option<Vec<Weights>>, Error> {
        self.partial.map_or(Ok(None), |partial| partial.weights(gids, self.stages.scale))
    }

    fn train_chunk(&self, gids: &[u16]) -> Result<Vec<TrainedGlyph>, Error> {
        let glyphs = gids.iter().map(|gid| self.stages.samples(*gid)).collect::<Result<Vec<_>, _>>()?;
        let weights = match self.found(gids)? {
            Some(weights) => weights,
            None => {
                let weights = self.weights(&glyphs)?;
                if let Some(partial) = self.partial {
                    partial.append(gids.iter().copied().zip(&weights), self.stages.scale)?;
                }
                gids.iter().for_each(|_| self.stages.progress.worked(Stage::Training));
                weights
            }
        };
        let measured = glyphs.iter().zip(weights).map(|(samples, weights)| {
            let model = Arc::new(GridFit::new(&weights, self.stages.scale)?);
            let glyph = Glyph::of_models(vec![(model, Origin::default())]);
            Ok(TrainedGlyph { gid: samples.gid, weights, measured: self.stages.measure(samples, &glyph)? })
        });
        measured.collect()
    }

    /// Trains the models of a chunk. A blank glyph needs no training.
    fn weights(&self, glyphs: &[GlyphSamples]) -> Result<Vec<Weights>, Error> {
        let options = self.stages.options;
        let mut weights = vec![Weights::default(); glyphs.len()];
        let (inked, slots): (Vec<&GlyphSamples>, Vec<&mut Weights>) =
            glyphs.iter().zip(&mut weights).filter(|(samples, _)| !samples.outline.points.is_empty()).unzip();
        if inked.is_empty() {
            return Ok(weights);
        }
        let fit = |samples: &&GlyphSamples| {
            initial_fit(samples, self.stages.scale, options.target, options.capacity, options.seed)
        };
        let mut parameters: Vec<Parameters> = inked.iter().map(fit).collect();
        training::train(&inked, &mut parameters, self.stages.scale, options)?;
        for ((slot, parameters), samples) in slots.into_iter().zip(&parameters).zip(inked) {
            *slot = parameters.quantise();
            refine(slot, samples, self.stages.scale, options.refinement)?;
        }
        Ok(weights)
    }

    /// Compares composed glyphs with the teacher, on `options.jobs` threads.
    pub(super) fn measure_composed(
        &self,
        models: &[GlyphModel],
        composed: &[Composed],
    ) -> Result<Vec<(u16, Measured)>, Error> {
        let parts: BTreeSet<u16> = composed.iter().flat_map(|glyph| &glyph.parts).map(|p| p.gid).collect();
        let parts = models
            .iter()
            .filter(|model| parts.contains(&model.gid))
            .map(|model| Ok((model.gid, Arc::new(GridFit::new(&model.weights, self.stages.scale)?))))
            .collect::<Result<BTreeMap<_, _>, Error>>()?;
        parallel::map(composed, self.stages.options.jobs, |glyph| {
            let placed = glyph.parts.iter().map(|part| {
                let model = parts.get(&part.gid).ok_or(Error::MissingGlyph(part.gid))?;
                Ok((model.clone(), Origin::new(part, self.stages.scale)?))
            });
            let drawn = Glyph::of_models(placed.collect::<Result<_, Error>>()?);
            Ok((glyph.gid, self.stages.measure(&self.stages.samples(glyph.gid)?, &drawn)?))
        })
    }
}
