//! Training: gradient descent on the error of the bitmaps, with rounding in the loop for the last steps.

mod batch;
mod bounds;
mod coverage;
mod field;
mod larger_sizes;
mod smoothness;
mod tensors;

use burn::optim::{Adam, AdamConfig, AdamState, Optimizer};
use burn::tensor::{Device, Tensor};

use crate::error::Error;
use crate::fit::Parameters;
use crate::options::{Backend, Schedule};
use crate::training_samples::GlyphSamples;
use batch::{Extent, GROUPS, SizeGroup};
use bounds::{box_bounds, clamped};
use field::{ColumnBasis, column_basis, loss};
use larger_sizes::{TrainedMask, with_larger_sizes, without_larger_sizes};
use nfr::internals::model::gridfit::{GridFit, Scale};
use smoothness::{roughness, squares};
use tensors::ParameterTensors;

/// The last learning rate as a share of the first.
const FINAL_RATE: f64 = 0.02;
/// Adam's epsilon. burn's default of 1e-5 is as large as the gradients here.
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

/// Where burn computes.
fn device(backend: Backend) -> Device {
    match backend {
        Backend::Flex => Device::flex(),
        #[cfg(feature = "ndarray")]
        #[allow(deprecated)]
        Backend::Ndarray => Device::ndarray(),
    }
}

/// Trains a chunk of glyphs together. They do not influence each other.
///
/// # Errors
///
/// `Malformed` if initial parameters contradict each other, `InvalidParameter` if the training diverges, and as
/// [`Outline::rasterize`](crate::teacher::Outline::rasterize).
pub fn train(
    glyphs: &[&GlyphSamples],
    parameters: &mut [Parameters],
    scale: Scale,
    schedule: Schedule,
    backend: Backend,
) -> Result<(), Error> {
    let device = device(backend).autodiff();
    let models =
        parameters.iter().map(|p| GridFit::new(&p.quantise(), scale)).collect::<Result<Vec<_>, _>>()?;
    let units = f32::from(scale.units_per_em());
    let all_sizes = glyphs.iter().zip(parameters.iter()).map(|(s, p)| with_larger_sizes(s, p, units));
    let (glyphs, mut all_sizes): (Vec<_>, Vec<_>) =
        all_sizes.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    let extent = Extent::of(&all_sizes, glyphs.first().map_or(0, |samples| samples.sizes.len()));
    let mut groups = (0..GROUPS)
        .map(|k| SizeGroup::new(&glyphs, &all_sizes, &models, units, extent, k, &device))
        .collect::<Result<Vec<_>, _>>()?;
    // With fewer sizes than groups some groups are empty.
    groups.retain(|group| !group.samples.runs.is_empty());
    if groups.is_empty() {
        return Ok(());
    }
    // Coprime to the number of groups, so that every group has its turn and neighbouring sizes are not consecutive steps.
    let stride = if groups.len().is_multiple_of(3) { 1 } else { 3 };
    let mut weights = ParameterTensors::from_parameters(&all_sizes, extent, &device);
    weights.field = weights.field.require_grad();
    weights.hinted = weights.hinted.map(Tensor::require_grad);
    weights.patterns = weights.patterns.require_grad();
    weights.embedding = weights.embedding.require_grad();
    let squares = squares(parameters, extent, &device);
    let bounds = box_bounds(&glyphs, &all_sizes, scale.sizes(), extent, &device);
    let mask = TrainedMask::new(scale.sizes(), extent, &device);
    // Without a warp in x, the columns' basis functions are constant.
    let unwarped: Option<Vec<ColumnBasis>> = (extent.knots[0] == 0)
        .then(|| groups.iter().map(|g| column_basis(&g.columns, &weights.hinted[0], extent)).collect());
    let adam = AdamConfig::new().with_beta_2(0.99).with_epsilon(EPSILON).build();
    let (mut field, mut hinted_x, mut hinted_y) = (Moments(None), Moments(None), Moments(None));
    let (mut patterns, mut embedding) = (Moments(None), Moments(None));
    for step in 0..schedule.steps {
        let done = step as f64 / schedule.steps as f64;
        let decay = FINAL_RATE + (1.0 - FINAL_RATE) * 0.5 * (1.0 + (std::f64::consts::PI * done).cos());
        let k = step * stride % groups.len();
        let drawn_weights =
            if done as f32 >= schedule.rounded_from { weights.rounded(&mask) } else { weights.clone() };
        let drawn_weights = drawn_weights.ordered(extent);
        let pixels = groups[k].samples.target.dims()[0] as f64;
        let loss = loss(&groups[k], unwarped.as_ref().map(|s| &s[k]), &drawn_weights, extent)
            + roughness(&weights.field, &squares).mul_scalar(schedule.smoothness / pixels);
        let mut gradients = loss.backward();
        let [x, y] = weights.hinted.clone();
        let (gx, gy) = (x.grad_remove(&mut gradients), y.grad_remove(&mut gradients));
        let gradient = weights.field.grad_remove(&mut gradients);
        weights.field = field.step(&adam, schedule.field_rate * decay, weights.field, gradient);
        let [low, high] = bounds.clone();
        let rate = schedule.warp_rate * decay;
        let stepped = [hinted_x.step(&adam, rate, x, gx), hinted_y.step(&adam, rate, y, gy)];
        weights.hinted = clamped(stepped, low, high);
        let gradient = weights.patterns.grad_remove(&mut gradients);
        weights.patterns = patterns.step(&adam, schedule.pattern_rate * decay, weights.patterns, gradient);
        let gradient = weights.embedding.grad_remove(&mut gradients);
        let stepped = embedding.step(&adam, schedule.embedding_rate * decay, weights.embedding, gradient);
        weights.embedding = Tensor::from_inner((stepped * mask.embedding.clone()).inner()).require_grad();
    }
    weights.store(&mut all_sizes, extent);
    for (parameters, mut trained) in parameters.iter_mut().zip(all_sizes) {
        without_larger_sizes(&mut trained, scale.sizes());
        // Rounding turns NaN into zero, and the glyph would be blank.
        if !is_finite(&trained) {
            return Err(Error::InvalidParameter(
                "the training came to numbers that are not finite; use lower learning rates".into(),
            ));
        }
        *parameters = trained;
    }
    Ok(())
}

/// Whether all trained numbers are finite.
fn is_finite(trained: &Parameters) -> bool {
    let Parameters { field, hinted: [x, y], patterns, embedding, .. } = trained;
    [field, x, y, patterns, embedding].into_iter().flatten().all(|v| v.is_finite())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
