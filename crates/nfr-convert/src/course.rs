//! Training and judging all glyphs of a plan, chunk by chunk, so that only a few lessons are in memory at a time.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

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
use nfr::internals::model::compose::{Composed, Origin};
use nfr::internals::model::gridfit::{GridFit, Scale, Weights};
use nfr::internals::render::Glyph;
use nfr::internals::table::GlyphModel;

/// Glyphs that are trained together. The result depends on it in the last digits, so that it is fixed.
const CHUNK: usize = 2;

/// What all chunks of a conversion share.
pub(super) struct Course<'c, 't, 'a> {
    pub(super) teacher: &'c Teacher<'a>,
    /// The sizes that the teacher shows.
    pub(super) sizes: &'c [TeacherAt<'t, 'a>],
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

/// Where a thread leaves a chunk's result.
type Slot = Mutex<Option<Result<Vec<Trained>, Error>>>;

impl Course<'_, '_, '_> {
    /// Trains chunk after chunk, on `options.jobs` threads. The first failure stops them all.
    pub(super) fn train_all(&self, gids: &[u16]) -> Result<Vec<Trained>, Error> {
        let chunks: Vec<&[u16]> = gids.chunks(CHUNK).collect();
        let done: Vec<Slot> = chunks.iter().map(|_| Mutex::default()).collect();
        let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
        std::thread::scope(|scope| {
            for _ in 0..self.options.jobs.min(chunks.len()).max(1) {
                scope.spawn(|| {
                    while !failed.load(Ordering::Relaxed) {
                        let k = next.fetch_add(1, Ordering::Relaxed);
                        let Some(gids) = chunks.get(k) else { break };
                        let result = self.train_chunk(gids);
                        failed.fetch_or(result.is_err(), Ordering::Relaxed);
                        if let Ok(mut slot) = done[k].lock() {
                            *slot = Some(result);
                        }
                    }
                });
            }
        });
        let mut trained = Vec::with_capacity(gids.len());
        let mut results: Vec<_> =
            done.into_iter().filter_map(|slot| slot.into_inner().ok().flatten()).collect();
        // Of several failures the first glyph's is told, whichever thread met it.
        if let Some(k) = results.iter().position(Result::is_err) {
            results.swap(0, k);
        }
        for result in results {
            trained.extend(result?);
        }
        Ok(trained)
    }

    fn train_chunk(&self, gids: &[u16]) -> Result<Vec<Trained>, Error> {
        let lessons = gids.iter().map(|gid| self.lesson(*gid)).collect::<Result<Vec<_>, _>>()?;
        let weights = match self.partial.and_then(|partial| partial.weights(gids, self.scale)) {
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
            let sums = self.judge(lesson, &Glyph::of_model(model, self.scale))?;
            Ok(Trained { gid: lesson.gid, weights, sums })
        });
        judged.collect()
    }

    fn lesson(&self, gid: u16) -> Result<Lesson, Error> {
        let mut lesson = lesson(self.teacher, self.sizes, gid)?;
        self.predictor.complete(&mut lesson);
        if let Some(complaint) = &lesson.complaint {
            self.progress.warn(complaint);
        }
        Ok(lesson)
    }

    /// Trains the models of a chunk.
    fn weights(&self, lessons: &[Lesson]) -> Result<Vec<Weights>, Error> {
        let options = self.options;
        let blank = |lesson: &Lesson| lesson.outline.points.is_empty();
        let draft = |lesson: &Lesson| {
            Draft::from_lesson(lesson, self.scale, options.target, options.capacity, options.seed)
        };
        let (inked, mut drafts): (Vec<&Lesson>, Vec<Draft>) =
            lessons.iter().filter(|lesson| !blank(lesson)).map(|lesson| (lesson, draft(lesson))).unzip();
        if !inked.is_empty() {
            train(&inked, &mut drafts, self.scale, options.schedule, options.backend)?;
        }
        let mut drafts = drafts.into_iter();
        let finished = |lesson: &Lesson| {
            let draft = if blank(lesson) { None } else { drafts.next() };
            let mut weights = draft.unwrap_or_default().quantise();
            polish(&mut weights, lesson, self.scale, options.polish)?;
            Ok(weights)
        };
        lessons.iter().map(finished).collect()
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

    /// Draws the glyphs that are put together from models and compares them with their own lessons.
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
        let judged = composed.iter().map(|glyph| {
            let placed = glyph.parts.iter().map(|part| {
                let model = parts.get(&part.gid).ok_or(Error::MissingGlyph(part.gid))?;
                Ok((model.clone(), Origin::new(part, self.scale)?))
            });
            let drawn = Glyph::of_parts(placed.collect::<Result<_, Error>>()?);
            Ok((glyph.gid, self.judge(&self.lesson(glyph.gid)?, &drawn)?))
        });
        judged.collect()
    }
}
