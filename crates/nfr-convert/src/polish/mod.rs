//! After the training: the stored integers move, one at a time, to where the finished bitmaps err least for the
//! bits that they take.
//!
//! Gradient descent ends near the best weights, and rounding puts them somewhere around it. Here every number is
//! tried one step up, one step down and where its prediction is, against the pixels that the renderer itself
//! draws; only those pixels that the number can change are drawn again.

mod judge;
mod rate;

use crate::error::Error;
use crate::teach::Lesson;
use judge::{Judge, Sample};
use nfr::internals::model::gridfit::{DEFORM_NODES, FIELD_LIMIT, FIELD_STEPS, GridFit, Scale, Weights};
use rate::{Plane, WarpRate, embedding_bits};

/// How hard to polish.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polish {
    /// Rounds over all numbers; 0 leaves the weights as they are.
    pub rounds: usize,
    /// What a bit is worth: the error in pixels (full coverage) that may come back for one.
    pub bit_worth: f64,
}

impl Default for Polish {
    fn default() -> Self {
        Self { rounds: 3, bit_worth: 0.006 }
    }
}

impl Polish {
    /// Checks the numbers.
    ///
    /// # Errors
    ///
    /// `InvalidParameter`, naming the first that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        if self.bit_worth.is_finite() && self.bit_worth >= 0.0 {
            return Ok(());
        }
        Err(Error::InvalidParameter(format!(
            "a bit is worth {} pixels; use a finite number, 0 or more",
            self.bit_worth
        )))
    }
}

/// A number goes no farther than this from where a round finds it, in its own steps.
const REACH: i32 = 8;
/// A hinted position may be this far from a prediction that it is tried at, in steps.
const FAR: i32 = 24;
/// Coefficients of this size are at the field's limit, where no edge is within their reach.
const FAR_FROM_EDGES: i32 = (FIELD_LIMIT * FIELD_STEPS) as i32;
/// The values that a byte may have.
const BYTE: i32 = 127;
const NODES: usize = DEFORM_NODES * DEFORM_NODES;

/// Polishes the weights of one glyph. What it does depends on nothing but its arguments.
///
/// # Errors
///
/// `Malformed` for weights that contradict each other.
pub fn polish(weights: &mut Weights, lesson: &Lesson, scale: Scale, options: Polish) -> Result<(), Error> {
    if weights.field.is_empty() {
        return Ok(());
    }
    let model = GridFit::new(weights, scale)?;
    let mut bench = Bench {
        weights: std::mem::take(weights),
        model,
        judge: Judge::new(lesson)?,
        scale,
        options,
        round: 0,
    };
    let result = (0..options.rounds).try_for_each(|round| {
        bench.round = round;
        bench.warp(0)?;
        bench.warp(1)?;
        bench.field()?;
        bench.patterns()?;
        bench.embedding()
    });
    *weights = bench.weights;
    result
}

/// The glyph under work: its weights as they are stored and as they are drawn, always the same ones.
struct Bench {
    weights: Weights,
    model: GridFit,
    judge: Judge,
    scale: Scale,
    options: Polish,
    round: usize,
}

impl Bench {
    /// Gives a number, `now`, the best of the values in `tries` and of those beyond a better one. `put` stores a
    /// value, `bits` tells what the weights cost as far as they depend on it.
    fn settle(
        &mut self,
        now: i32,
        tries: &mut Vec<i32>,
        sample: &Sample,
        put: impl Fn(&mut Weights, &mut GridFit, i32),
        bits: impl Fn(&Weights) -> f64,
    ) -> Result<(), Error> {
        let worth = self.options.bit_worth;
        let mut least = self.judge.error(&self.model, sample, f64::INFINITY)? + worth * bits(&self.weights);
        let mut chosen = now;
        let mut k = 0;
        while let Some(&value) = tries.get(k) {
            k += 1;
            // Where one direction is better the other is not.
            if (value - now).signum() * (chosen - now).signum() < 0 {
                continue;
            }
            put(&mut self.weights, &mut self.model, value);
            let price = worth * bits(&self.weights);
            let total = self.judge.error(&self.model, sample, least - price)? + price;
            if total < least {
                least = total;
                let beyond = value + (value - chosen).signum();
                if !tries.contains(&beyond) && (beyond - now).abs() <= REACH {
                    tries.push(beyond);
                }
                chosen = value;
            }
        }
        put(&mut self.weights, &mut self.model, chosen);
        Ok(())
    }

    /// Hinted positions of one axis, size by size.
    fn warp(&mut self, axis: usize) -> Result<(), Error> {
        let warp = |weights: &Weights| match axis {
            0 => weights.warp_x.clone(),
            _ => weights.warp_y.clone(),
        };
        let start = warp(&self.weights);
        let count = start.knots.len();
        let rate = WarpRate::new(&start, self.scale);
        for (s, k) in (0..self.scale.sizes()).flat_map(|s| (0..count).map(move |k| (s, k))) {
            let hinted = if axis == 0 { &self.weights.warp_x.hinted } else { &self.weights.warp_y.hinted };
            let at = s * count + k;
            let now = hinted[at];
            let low = if k > 0 { hinted[at - 1] } else { i32::MIN };
            let high = if k + 1 < count { hinted[at + 1] } else { i32::MAX };
            let mut tries = vec![now - 1, now + 1];
            tries.extend(rate.wishes(hinted, s, k));
            tries.retain(|t| *t != now && *t > low && *t < high && (*t - now).abs() <= FAR);
            tries.sort_unstable();
            tries.dedup();
            if tries.is_empty() {
                continue;
            }
            let put = |weights: &mut Weights, model: &mut GridFit, value: i32| {
                let hinted = if axis == 0 { &mut weights.warp_x.hinted } else { &mut weights.warp_y.hinted };
                hinted[at] = value;
                model.set_hinted(axis, s, k, value);
            };
            let bits = |weights: &Weights| {
                let hinted = if axis == 0 { &weights.warp_x.hinted } else { &weights.warp_y.hinted };
                rate.bits(hinted, s, k)
            };
            self.settle(now, &mut tries, &Judge::at(s), put, bits)?;
        }
        Ok(())
    }

    /// The coefficients of the field.
    fn field(&mut self) -> Result<(), Error> {
        let stride = usize::from(self.weights.cells[0]) + 2;
        for at in 0..self.weights.field.len() {
            let plane = Plane { values: &self.weights.field, stride };
            let (now, predicted) = (i32::from(self.weights.field[at]), plane.prediction(at));
            if now == predicted && now.abs() >= FAR_FROM_EDGES {
                continue;
            }
            let sample = self.judge.share(self.round, |_| true);
            let put = |weights: &mut Weights, model: &mut GridFit, value: i32| {
                weights.field[at] = value as i8;
                model.set_field(at, value as i8);
            };
            let bits = |weights: &Weights| Plane { values: &weights.field, stride }.bits(at);
            self.settle(now, &mut byte_tries(now, predicted), &sample, put, bits)?;
        }
        Ok(())
    }

    /// The nodes of the patterns.
    fn patterns(&mut self) -> Result<(), Error> {
        let rank = usize::from(self.weights.rank);
        for at in 0..self.weights.patterns.len() {
            let (r, node) = (at / NODES, at % NODES);
            let own = r * NODES..(r + 1) * NODES;
            let plane = Plane { values: &self.weights.patterns[own.clone()], stride: DEFORM_NODES };
            let (now, predicted) = (i32::from(self.weights.patterns[at]), plane.prediction(node));
            let embedding = &self.weights.embedding;
            let moves = |s: usize| embedding.get(s * rank + r).is_some_and(|weight| *weight != 0);
            let sample = self.judge.share(self.round, moves);
            let put = |weights: &mut Weights, model: &mut GridFit, value: i32| {
                weights.patterns[at] = value as i8;
                model.set_pattern(at, value as i8);
            };
            let bits = |weights: &Weights| {
                Plane { values: &weights.patterns[own.clone()], stride: DEFORM_NODES }.bits(node)
            };
            self.settle(now, &mut byte_tries(now, predicted), &sample, put, bits)?;
        }
        Ok(())
    }

    /// The weights of the patterns at each size.
    fn embedding(&mut self) -> Result<(), Error> {
        let rank = usize::from(self.weights.rank);
        for at in 0..self.weights.embedding.len() {
            let now = i32::from(self.weights.embedding[at]);
            let put = |weights: &mut Weights, model: &mut GridFit, value: i32| {
                weights.embedding[at] = value as i8;
                model.set_embedding(at / rank, at % rank, value as i8);
            };
            let bits = |weights: &Weights| embedding_bits(weights.embedding[at]);
            self.settle(now, &mut byte_tries(now, 0), &Judge::at(at / rank), put, bits)?;
        }
        Ok(())
    }
}

/// The neighbours of a value and, where it is not far, what is predicted for it.
fn byte_tries(now: i32, predicted: i32) -> Vec<i32> {
    let mut tries = vec![now - 1, now + 1, predicted];
    tries.retain(|t| *t != now && t.abs() <= BYTE && (t - now).abs() <= REACH);
    tries.sort_unstable();
    tries.dedup();
    tries
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
