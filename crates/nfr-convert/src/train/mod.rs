//! Training: gradient descent on the bitmaps, with rounding in the loop for the last part.

mod batch;
mod beyond;
mod bounds;
mod coverage;
mod field;
mod smooth;

use burn::optim::{Adam, AdamConfig, AdamState, Optimizer};
use burn::tensor::{Device, Tensor};

use crate::error::Error;
use crate::start::Draft;
use crate::teach::Lesson;
use batch::{Extent, GROUPS, Group};
use beyond::{Learnt, extended};
use bounds::{box_bounds, within};
use field::{ColumnBasis, Parameters, column_basis, loss};
use nfr::internals::model::gridfit::{GridFit, Scale};
use smooth::{roughness, squares};

/// How long and how fast to train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Optimiser steps; each sees one eighth of the sizes.
    pub steps: usize,
    /// The share of the steps after which weights are rounded in the loop.
    pub rounded_from: f32,
    /// First learning rates; all decay along a cosine to `FINAL_RATE` of themselves. Field in em.
    pub field_rate: f64,
    /// Hinted knot positions, in pixels.
    pub warp_rate: f64,
    /// Deformation patterns.
    pub pattern_rate: f64,
    /// Size embedding, in pixels.
    pub embedding_rate: f64,
    /// What it costs a coefficient of the field to be off the plane through its neighbours: errors of a pixel
    /// for an em.
    pub smoothness: f64,
}

impl Default for Schedule {
    fn default() -> Self {
        Self {
            steps: 400,
            rounded_from: 0.7,
            field_rate: 1.5e-3,
            warp_rate: 0.008,
            pattern_rate: 0.015,
            embedding_rate: 0.015,
            smoothness: 0.2,
        }
    }
}

impl Schedule {
    /// Checks that a training can follow the schedule.
    ///
    /// # Errors
    ///
    /// `InvalidParameter`, naming the first number that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |what: String| Err(Error::InvalidParameter(what));
        if self.steps > MAX_STEPS {
            return wrong(format!("{} training steps; use 0 to {MAX_STEPS}", self.steps));
        }
        if !(0.0..=1.0).contains(&self.rounded_from) {
            return wrong(format!("rounding from {} of the steps on; use 0 to 1", self.rounded_from));
        }
        for (value, of) in [
            (self.field_rate, "the field's learning rate"),
            (self.warp_rate, "the warp's learning rate"),
            (self.pattern_rate, "the patterns' learning rate"),
            (self.embedding_rate, "the embedding's learning rate"),
            (self.smoothness, "the field's smoothness"),
        ] {
            if !value.is_finite() || value < 0.0 {
                return wrong(format!("{of} is {value}; use a finite number, 0 or more"));
            }
        }
        Ok(())
    }
}

/// The table tells the steps in 16 bits.
const MAX_STEPS: usize = u16::MAX as usize;

/// burn's backends for the CPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Backend {
    /// burn-flex, the faster one here.
    #[default]
    Flex,
    /// burn-ndarray, which burn 0.22 deprecates.
    #[cfg(feature = "ndarray")]
    Ndarray,
}

impl Backend {
    fn device(self) -> Device {
        match self {
            Self::Flex => Device::flex(),
            #[cfg(feature = "ndarray")]
            #[allow(deprecated)]
            Self::Ndarray => Device::ndarray(),
        }
    }
}

/// What is left of the learning rates at the end.
const FINAL_RATE: f64 = 0.02;
/// Adam's epsilon. burn's default of 1e-5 is as large as our gradients.
const EPSILON: f32 = 1e-10;

struct Moments<const D: usize>(Option<AdamState<D>>);

impl<const D: usize> Moments<D> {
    fn step(&mut self, adam: &Adam, rate: f64, weights: Tensor<D>, gradient: Option<Tensor<D>>) -> Tensor<D> {
        let Some(gradient) = gradient else { return weights };
        let (stepped, state) = adam.step(rate, weights.inner(), gradient, self.0.take());
        self.0 = state;
        Tensor::from_inner(stepped).require_grad()
    }
}

/// Trains a chunk of glyphs together. Glyphs do not influence each other.
///
/// # Errors
///
/// `Malformed` if a first guess contradicts itself, `InvalidParameter` if the training diverges, and as [`Outline::rasterize`](crate::outline::Outline::rasterize).
pub fn train(
    lessons: &[&Lesson],
    drafts: &mut [Draft],
    scale: Scale,
    schedule: Schedule,
    backend: Backend,
) -> Result<(), Error> {
    let device = backend.device().autodiff();
    let models = drafts.iter().map(|d| GridFit::new(&d.quantise(), scale)).collect::<Result<Vec<_>, _>>()?;
    let units = f32::from(scale.units_per_em());
    let longer = lessons.iter().zip(drafts.iter()).map(|(lesson, draft)| extended(lesson, draft, units));
    let (lessons, mut longer): (Vec<_>, Vec<_>) = longer.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    let extent = Extent::of(&longer, lessons.first().map_or(0, |lesson| lesson.sizes.len()));
    let mut groups = (0..GROUPS)
        .map(|k| Group::new(&lessons, &longer, &models, units, extent, k, &device))
        .collect::<Result<Vec<_>, _>>()?;
    // With fewer sizes than groups some have nothing to teach.
    groups.retain(|group| !group.samples.runs.is_empty());
    if groups.is_empty() {
        return Ok(());
    }
    // Coprime to the number of groups: all come by, and neighbouring sizes are not seen one after the other.
    let stride = if groups.len().is_multiple_of(3) { 1 } else { 3 };
    let mut weights = Parameters::from_drafts(&longer, extent, &device);
    weights.field = weights.field.require_grad();
    weights.hinted = weights.hinted.map(Tensor::require_grad);
    weights.patterns = weights.patterns.require_grad();
    weights.embedding = weights.embedding.require_grad();
    let squares = squares(drafts, extent, &device);
    let bounds = box_bounds(&lessons, &longer, scale.sizes(), extent, &device);
    let learnt = Learnt::new(scale.sizes(), extent, &device);
    // Columns that are not warped stay where they are.
    let still: Option<Vec<ColumnBasis>> = (extent.knots[0] == 0)
        .then(|| groups.iter().map(|g| column_basis(&g.columns, &weights.hinted[0], extent)).collect());
    let adam = AdamConfig::new().with_beta_2(0.99).with_epsilon(EPSILON).build();
    let (mut field, mut hinted_x, mut hinted_y) = (Moments(None), Moments(None), Moments(None));
    let (mut patterns, mut embedding) = (Moments(None), Moments(None));
    for step in 0..schedule.steps {
        let done = step as f64 / schedule.steps as f64;
        let decay = FINAL_RATE + (1.0 - FINAL_RATE) * 0.5 * (1.0 + (std::f64::consts::PI * done).cos());
        let k = step * stride % groups.len();
        let used =
            if done as f32 >= schedule.rounded_from { weights.rounded(&learnt) } else { weights.clone() };
        let used = used.ordered(extent);
        let pixels = groups[k].samples.target.dims()[0] as f64;
        let loss = loss(&groups[k], still.as_ref().map(|s| &s[k]), &used, extent)
            + roughness(&weights.field, &squares).mul_scalar(schedule.smoothness / pixels);
        let mut gradients = loss.backward();
        let [x, y] = weights.hinted.clone();
        let (gx, gy) = (x.grad_remove(&mut gradients), y.grad_remove(&mut gradients));
        let gradient = weights.field.grad_remove(&mut gradients);
        weights.field = field.step(&adam, schedule.field_rate * decay, weights.field, gradient);
        let [low, high] = bounds.clone();
        let rate = schedule.warp_rate * decay;
        let stepped = [hinted_x.step(&adam, rate, x, gx), hinted_y.step(&adam, rate, y, gy)];
        weights.hinted = within(stepped, low, high);
        let gradient = weights.patterns.grad_remove(&mut gradients);
        weights.patterns = patterns.step(&adam, schedule.pattern_rate * decay, weights.patterns, gradient);
        let gradient = weights.embedding.grad_remove(&mut gradients);
        let stepped = embedding.step(&adam, schedule.embedding_rate * decay, weights.embedding, gradient);
        weights.embedding = Tensor::from_inner((stepped * learnt.embedding.clone()).inner()).require_grad();
    }
    weights.store(&mut longer, extent);
    for (draft, mut longer) in drafts.iter_mut().zip(longer) {
        beyond::cut(&mut longer, scale.sizes());
        // Rounding would make zeros of such numbers, and a blank glyph of the model.
        if !longer.is_finite() {
            return Err(Error::InvalidParameter(
                "the training came to numbers that are not finite; use lower learning rates".into(),
            ));
        }
        *draft = longer;
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
