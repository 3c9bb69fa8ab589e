//! Training and judging all glyphs of a plan, chunk by chunk, so that only a few lessons are in memory at a time.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::parallel;
use super::partial::Partial;
use super::pipeline::{Options, Progress};
use super::polish::polish;
use super::predict::Predictor;
use super::start::Draft;
use super::teach::{Lesson, lesson};
use super::teacher::{Teacher, TeacherAt};
use super::train::train;
use crate::compare::metrics::Sums;
use crate::error::Error;
use crate::writer::GlyphModel;
use nfr::internals::Glyph;
use nfr::internals::model::compose::{Composed, Origin};
use nfr::internals::model::gridfit::{GridFit, Scale, Weights};

/// Glyphs that are trained together. The result depends on it in the last digits, so that it is fixed.
const CHUNK: usize = 2;

/// What all chunks of a conversion share.
pub(super) struct Course<'c> {
    pub(super) teacher: &'c Teacher,
    /// The sizes that the teacher shows.
    pub(super) sizes: &'c [TeacherAt],
    /// The sizes that models have.
    pub(super) scale: Scale,
    /// Tells of the sizes that models have and the teacher does not show.
    pub(super) predictor: &'c Predictor,
    pub(super) options: &'c Options,
    pub(super) progress: &'c dyn Progress,
    /// Where glyphs that are ready are kept, and those of an earlier conversion found.
    pub(super) partial: Option<&'c Partial>,
}

/// A trained glyph with what it differs from its teacher by.
pub(super) struct Trained {
    pub(super) gid: u16,
    pub(super) weights: Weights,
    pub(super) sums: Sums,
}

impl Course<'_> {
    /// Trains chunk after chunk, on `options.jobs` threads.
    pub(super) fn train_all(&self, gids: &[u16]) -> Result<Vec<Trained>, Error> {
        let chunks: Vec<&[u16]> = gids.chunks(CHUNK).collect();
        let trained = parallel::each(&chunks, self.options.jobs, |gids| self.train_chunk(gids))?;
        Ok(trained.into_iter().flatten().collect())
    }

    fn train_chunk(&self, gids: &[u16]) -> Result<Vec<Trained>, Error> {
        let lessons = gids.iter().map(|gid| self.lesson(*gid)).collect::<Result<Vec<_>, _>>()?;
        let found = match self.partial {
            Some(partial) => partial.weights(gids, self.scale)?,
            None => None,
        };
        let weights = match found {
            Some(weights) => weights,
            None => {
                let weights = self.weights(&lessons)?;
                if let Some(partial) = self.partial {
                    partial.append(gids.iter().copied().zip(&weights), self.scale)?;
                }
                weights
            }
        };
        let judged = lessons.iter().zip(weights).map(|(lesson, weights)| {
            let model = Arc::new(GridFit::new(&weights, self.scale)?);
            let sums = self.judge(lesson, &Glyph::of_models(vec![(model, Origin::zero(self.scale))]))?;
            Ok(Trained { gid: lesson.gid, weights, sums })
        });
        judged.collect()
    }

    fn lesson(&self, gid: u16) -> Result<Lesson, Error> {
        let mut lesson = lesson(self.teacher, self.sizes, gid)?;
        self.predictor.complete(&mut lesson)?;
        if let Some(complaint) = &lesson.complaint {
            self.progress.warn(complaint);
        }
        Ok(lesson)
    }

    /// Trains the models of a chunk. A blank glyph has nothing to train.
    fn weights(&self, lessons: &[Lesson]) -> Result<Vec<Weights>, Error> {
        let options = self.options;
        let mut weights = vec![Weights::default(); lessons.len()];
        let (inked, slots): (Vec<&Lesson>, Vec<&mut Weights>) =
            lessons.iter().zip(&mut weights).filter(|(lesson, _)| !lesson.outline.points.is_empty()).unzip();
        if inked.is_empty() {
            return Ok(weights);
        }
        let draft = |lesson: &&Lesson| {
            Draft::from_lesson(lesson, self.scale, options.target, options.capacity, options.seed)
        };
        let mut drafts: Vec<Draft> = inked.iter().map(draft).collect();
        train(&inked, &mut drafts, self.scale, options.schedule, options.backend)?;
        for ((slot, draft), lesson) in slots.into_iter().zip(&drafts).zip(inked) {
            *slot = draft.quantise();
            polish(slot, lesson, self.scale, options.polish)?;
        }
        Ok(weights)
    }

    /// Draws what will be stored and compares it with what the teacher has shown.
    fn judge(&self, lesson: &Lesson, glyph: &Glyph) -> Result<Sums, Error> {
        let mut sums = Sums::default();
        for hinted in lesson.sizes.iter().filter(|size| !size.predicted) {
            sums.add(&hinted.bitmap, &glyph.render(f32::from(hinted.ppem))?);
        }
        self.progress.glyph_done(lesson.gid, sums.figures().mae);
        Ok(sums)
    }

    /// Draws the glyphs that are put together from models and compares them with their own lessons, on
    /// `options.jobs` threads.
    pub(super) fn judge_composed(
        &self,
        models: &[GlyphModel],
        composed: &[Composed],
    ) -> Result<Vec<(u16, Sums)>, Error> {
        let parts: BTreeSet<u16> = composed.iter().flat_map(|glyph| &glyph.parts).map(|p| p.gid).collect();
        let parts = models
            .iter()
            .filter(|model| parts.contains(&model.gid))
            .map(|model| Ok((model.gid, Arc::new(GridFit::new(&model.weights, self.scale)?))))
            .collect::<Result<BTreeMap<_, _>, Error>>()?;
        parallel::each(composed, self.options.jobs, |glyph| {
            let placed = glyph.parts.iter().map(|part| {
                let model = parts.get(&part.gid).ok_or(Error::MissingGlyph(part.gid))?;
                Ok((model.clone(), Origin::new(part, self.scale)?))
            });
            let drawn = Glyph::of_models(placed.collect::<Result<_, Error>>()?);
            Ok((glyph.gid, self.judge(&self.lesson(glyph.gid)?, &drawn)?))
        })
    }
}
