//! Rate–distortion refinement: coordinate descent on the stored integers, with the renderer's own bitmaps in the loop.
//!
//! Gradient descent ends near an optimum, and rounding moves the weights away from it. Every weight is tried one step up,
//! one step down and at its prediction; it takes the value with the least error + λ · bits. Weights are drawn again only
//! at the sizes that they influence.

mod distortion;
mod prediction;

use crate::cost::section_bits;
use crate::error::Error;
use crate::options::Refinement;
use crate::training_samples::GlyphSamples;
use distortion::{Distortion, SizeSubset};
use nfr::internals::model::gridfit::{DEFORM_NODES, FIELD_LIMIT, FIELD_STEPS, GridFit, Scale, Weights};
use nfr::internals::table::codec::Section;
use prediction::{Plane, WarpPrediction};

/// The largest change of a weight in one round, in quantisation steps.
const MAX_CHANGE: i32 = 8;
/// A hinted position is tried at a prediction up to this far away, in quantisation steps.
const MAX_PREDICTED_CHANGE: i32 = 24;
/// Coefficients of this size are at the field's limit, and no edge lies within the support of their B-splines.
const CLIPPED: i32 = (FIELD_LIMIT * FIELD_STEPS) as i32;
/// The largest absolute value of a weight that is stored in a byte.
const MAX_BYTE: i32 = 127;
const NODES: usize = DEFORM_NODES * DEFORM_NODES;

/// Refines the weights of one glyph. The result depends on the arguments alone.
///
/// # Errors
///
/// `Malformed` for weights that contradict each other.
pub fn refine(
    weights: &mut Weights,
    samples: &GlyphSamples,
    scale: Scale,
    options: Refinement,
) -> Result<(), Error> {
    if weights.field.is_empty() {
        return Ok(());
    }
    let model = GridFit::new(weights, scale)?;
    let mut descent = CoordinateDescent {
        weights: std::mem::take(weights),
        model,
        distortion: Distortion::new(samples)?,
        scale,
        options,
        round: 0,
    };
    let result = (0..options.rounds).try_for_each(|round| {
        descent.round = round;
        descent.warp(0)?;
        descent.warp(1)?;
        descent.field()?;
        descent.patterns()?;
        descent.embedding()
    });
    *weights = descent.weights;
    result
}

/// A glyph whose weights are refined. `weights` and `model` are the same weights, as stored and as drawn.
struct CoordinateDescent {
    weights: Weights,
    model: GridFit,
    distortion: Distortion,
    scale: Scale,
    options: Refinement,
    round: usize,
}

impl CoordinateDescent {
    /// Sets a weight, `current`, to the value of `candidates` with the least error + λ · bits over the sizes of `subset`.
    /// Where a candidate is better, the value a step beyond it becomes a candidate too. `set` stores a value. The bits are
    /// those of the coder for the section that the weight belongs to.
    fn descend(
        &mut self,
        current: i32,
        candidates: &mut Vec<i32>,
        subset: &SizeSubset,
        section: Section,
        set: impl Fn(&mut Weights, &mut GridFit, i32),
    ) -> Result<(), Error> {
        let mut least = self.distortion.error(&self.model, subset, f64::INFINITY)? + self.rate(section)?;
        let mut chosen = current;
        let mut k = 0;
        while let Some(&value) = candidates.get(k) {
            k += 1;
            // One direction is better: the other one is not tried.
            if (value - current).signum() * (chosen - current).signum() < 0 {
                continue;
            }
            set(&mut self.weights, &mut self.model, value);
            let rate = self.rate(section)?;
            let total = self.distortion.error(&self.model, subset, least - rate)? + rate;
            if total < least {
                least = total;
                let next = value + (value - chosen).signum();
                if !candidates.contains(&next) && (next - current).abs() <= MAX_CHANGE {
                    candidates.push(next);
                }
                chosen = value;
            }
        }
        set(&mut self.weights, &mut self.model, chosen);
        Ok(())
    }

    /// λ · bits of a section.
    fn rate(&mut self, section: Section) -> Result<f64, Error> {
        let bits = section_bits(&mut self.weights, self.scale, section)?;
        Ok(self.options.error_per_bit * bits)
    }

    /// Hinted positions of one axis, size by size.
    fn warp(&mut self, axis: usize) -> Result<(), Error> {
        let warp = |weights: &Weights| match axis {
            0 => weights.warp_x.clone(),
            _ => weights.warp_y.clone(),
        };
        let start = warp(&self.weights);
        let count = start.knots.len();
        let prediction = WarpPrediction::new(&start, self.scale);
        for (s, k) in (0..self.scale.sizes()).flat_map(|s| (0..count).map(move |k| (s, k))) {
            let hinted = if axis == 0 { &self.weights.warp_x.hinted } else { &self.weights.warp_y.hinted };
            let at = s * count + k;
            let current = hinted[at];
            let low = if k > 0 { hinted[at - 1] } else { i32::MIN };
            let high = if k + 1 < count { hinted[at + 1] } else { i32::MAX };
            let mut candidates = vec![current - 1, current + 1];
            candidates.extend(prediction.candidates(hinted, s, k));
            candidates.retain(|t| {
                *t != current && *t > low && *t < high && (*t - current).abs() <= MAX_PREDICTED_CHANGE
            });
            candidates.sort_unstable();
            candidates.dedup();
            if candidates.is_empty() {
                continue;
            }
            let set = |weights: &mut Weights, model: &mut GridFit, value: i32| {
                let hinted = if axis == 0 { &mut weights.warp_x.hinted } else { &mut weights.warp_y.hinted };
                hinted[at] = value;
                model.set_hinted(axis, s, k, value);
            };
            self.descend(current, &mut candidates, &SizeSubset::one(s), Section::Warp, set)?;
        }
        Ok(())
    }

    /// The field's spline coefficients.
    fn field(&mut self) -> Result<(), Error> {
        let stride = usize::from(self.weights.cells[0]) + 2;
        for at in 0..self.weights.field.len() {
            let plane = Plane { values: &self.weights.field, stride };
            let (current, predicted) = (i32::from(self.weights.field[at]), plane.prediction(at));
            if current == predicted && current.abs() >= CLIPPED {
                continue;
            }
            let subset = self.distortion.subset(self.round, |_| true);
            let set = |weights: &mut Weights, model: &mut GridFit, value: i32| {
                weights.field[at] = value as i8;
                model.set_field(at, value as i8);
            };
            let candidates = &mut byte_candidates(current, predicted);
            self.descend(current, candidates, &subset, Section::Field, set)?;
        }
        Ok(())
    }

    /// The nodes of the patterns.
    fn patterns(&mut self) -> Result<(), Error> {
        let rank = usize::from(self.weights.rank);
        for at in 0..self.weights.patterns.len() {
            let (r, node) = (at / NODES, at % NODES);
            let own = r * NODES..(r + 1) * NODES;
            let plane = Plane { values: &self.weights.patterns[own], stride: DEFORM_NODES };
            let (current, predicted) = (i32::from(self.weights.patterns[at]), plane.prediction(node));
            let embedding = &self.weights.embedding;
            let is_used = |s: usize| embedding.get(s * rank + r).is_some_and(|weight| *weight != 0);
            let subset = self.distortion.subset(self.round, is_used);
            let set = |weights: &mut Weights, model: &mut GridFit, value: i32| {
                weights.patterns[at] = value as i8;
                model.set_pattern(at, value as i8);
            };
            let candidates = &mut byte_candidates(current, predicted);
            self.descend(current, candidates, &subset, Section::Patterns, set)?;
        }
        Ok(())
    }

    /// The weights of the patterns at each size.
    fn embedding(&mut self) -> Result<(), Error> {
        let rank = usize::from(self.weights.rank);
        for at in 0..self.weights.embedding.len() {
            let current = i32::from(self.weights.embedding[at]);
            let set = |weights: &mut Weights, model: &mut GridFit, value: i32| {
                weights.embedding[at] = value as i8;
                model.set_embedding(at / rank, at % rank, value as i8);
            };
            let subset = SizeSubset::one(at / rank);
            self.descend(current, &mut byte_candidates(current, 0), &subset, Section::Embedding, set)?;
        }
        Ok(())
    }
}

/// A step down and up, and the prediction if it is near.
fn byte_candidates(current: i32, predicted: i32) -> Vec<i32> {
    let mut candidates = vec![current - 1, current + 1, predicted];
    candidates.retain(|t| *t != current && t.abs() <= MAX_BYTE && (t - current).abs() <= MAX_CHANGE);
    candidates.sort_unstable();
    candidates.dedup();
    candidates
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
