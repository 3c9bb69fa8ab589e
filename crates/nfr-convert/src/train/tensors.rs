//! A chunk's parameters as tensors, and their rounding in the loop.

use burn::tensor::{Device, Tensor, TensorData};

use super::batch::Extent;
use super::larger_sizes::TrainedMask;
use crate::fit::Parameters;
use nfr::internals::model::gridfit::{
    DEFORM_NODES, EMBEDDING_STEPS, FIELD_STEPS, MIN_KNOT_GAP, PATTERN_STEPS, WARP_STEPS,
};

/// The trained weights of a chunk of glyphs.
#[derive(Clone)]
pub(super) struct ParameterTensors {
    /// Spline coefficients in em `[glyphs, along x, along y]`.
    pub(super) field: Tensor<3>,
    /// Hinted knot positions in pixels for x and y `[glyphs · sizes · knots]`.
    pub(super) hinted: [Tensor<1>; 2],
    /// Deformation patterns `[glyphs, nodes along x, rank · nodes along y]`.
    pub(super) patterns: Tensor<3>,
    /// The size embedding in pixels `[glyphs · sizes, rank]`.
    pub(super) embedding: Tensor<2>,
}

pub(super) fn tensor<const D: usize>(values: Vec<f32>, shape: [usize; D], device: &Device) -> Tensor<D> {
    Tensor::from_data(TensorData::new(values, shape), device)
}

pub(super) fn values<const D: usize>(tensor: &Tensor<D>) -> Vec<f32> {
    tensor.clone().into_data().iter::<f32>().collect()
}

/// Values for each knot at each size, laid out as `ParameterTensors::hinted`; `fill` where a glyph has fewer knots.
pub(super) fn hinted_tensors(
    each: &[&[Vec<f32>; 2]],
    parameters: &[Parameters],
    extent: Extent,
    fill: f32,
    device: &Device,
) -> [Tensor<1>; 2] {
    [0, 1].map(|axis| {
        let knots = extent.knots[axis];
        let mut all = vec![fill; (extent.glyphs * extent.sizes * knots).max(1)];
        for (g, (values, glyph)) in each.iter().zip(parameters).enumerate() {
            let own = glyph.knots[axis].len();
            for (k, v) in values[axis].iter().enumerate() {
                all[(g * extent.sizes + k / own) * knots + k % own] = *v;
            }
        }
        let count = all.len();
        tensor(all, [count], device)
    })
}

impl ParameterTensors {
    pub(super) fn from_parameters(parameters: &[Parameters], extent: Extent, device: &Device) -> Self {
        let [nx, ny] = extent.coefficients;
        let nodes = DEFORM_NODES;
        let mut field = vec![0.0; extent.glyphs * nx * ny];
        let mut patterns = vec![0.0; extent.glyphs * nodes * extent.rank * nodes];
        let mut embedding = vec![0.0; extent.glyphs * extent.sizes * extent.rank];
        for (g, glyph) in parameters.iter().enumerate() {
            let stride = glyph.cells[0] + 2;
            for (k, v) in glyph.field.iter().enumerate() {
                field[(g * nx + k % stride) * ny + k / stride] = *v;
            }
            for (k, v) in glyph.patterns.iter().enumerate() {
                let (r, y, x) = (k / (nodes * nodes), k / nodes % nodes, k % nodes);
                patterns[((g * nodes + x) * extent.rank + r) * nodes + y] = *v;
            }
            for (k, v) in glyph.embedding.iter().enumerate() {
                embedding[(g * extent.sizes + k / glyph.rank) * extent.rank + k % glyph.rank] = *v;
            }
        }
        let hinted = parameters.iter().map(|glyph| &glyph.hinted).collect::<Vec<_>>();
        let hinted = hinted_tensors(&hinted, parameters, extent, 0.0, device);
        Self {
            field: tensor(field, [extent.glyphs, nx, ny], device),
            hinted,
            patterns: tensor(patterns, [extent.glyphs, nodes, extent.rank * nodes], device),
            embedding: tensor(embedding, [extent.glyphs * extent.sizes, extent.rank], device),
        }
    }

    /// Writes the weights back.
    pub(super) fn store(&self, parameters: &mut [Parameters], extent: Extent) {
        let [nx, ny] = extent.coefficients;
        let nodes = DEFORM_NODES;
        let field = values(&self.field);
        let hinted = [values(&self.hinted[0]), values(&self.hinted[1])];
        let (patterns, embedding) = (values(&self.patterns), values(&self.embedding));
        for (g, glyph) in parameters.iter_mut().enumerate() {
            let stride = glyph.cells[0] + 2;
            for (k, v) in glyph.field.iter_mut().enumerate() {
                *v = field[(g * nx + k % stride) * ny + k / stride];
            }
            for (axis, hinted) in hinted.iter().enumerate() {
                let own = glyph.knots[axis].len();
                for (k, v) in glyph.hinted[axis].iter_mut().enumerate() {
                    *v = hinted[(g * extent.sizes + k / own) * extent.knots[axis] + k % own];
                }
            }
            for (k, v) in glyph.patterns.iter_mut().enumerate() {
                let (r, y, x) = (k / (nodes * nodes), k / nodes % nodes, k % nodes);
                *v = patterns[((g * nodes + x) * extent.rank + r) * nodes + y];
            }
            let rank = glyph.rank;
            for (k, v) in glyph.embedding.iter_mut().enumerate() {
                *v = embedding[(g * extent.sizes + k / rank) * extent.rank + k % rank];
            }
        }
    }

    /// The weights rounded as in the table, with the gradient of the unrounded ones (straight-through estimator). Fixed
    /// hinted positions are not stored, and stay unrounded.
    pub(super) fn rounded(&self, mask: &TrainedMask) -> Self {
        let hinted = |axis: usize| {
            let unrounded = &self.hinted[axis];
            let moved = (straight_through(unrounded, WARP_STEPS) - unrounded.clone()).detach();
            unrounded.clone() + moved * mask.hinted[axis].clone()
        };
        Self {
            field: straight_through(&self.field, FIELD_STEPS),
            hinted: [0, 1].map(hinted),
            patterns: straight_through(&self.patterns, PATTERN_STEPS),
            embedding: straight_through(&self.embedding, EMBEDDING_STEPS),
        }
    }

    /// The weights with ascending knots, as in the renderer: a knot below the one before it is moved to just above that
    /// one.
    pub(super) fn ordered(self, extent: Extent) -> Self {
        let [x, y] = self.hinted;
        let hinted = [ascending(x, extent.knots[0]), ascending(y, extent.knots[1])];
        Self { hinted, ..self }
    }
}

/// The gradient is that of the unmoved position (straight-through estimator), so that a moved knot can come free.
fn ascending(hinted: Tensor<1>, knots: usize) -> Tensor<1> {
    if knots < 2 {
        return hinted;
    }
    let [count] = hinted.dims();
    let rows = hinted.clone().detach().reshape([count / knots, knots]);
    let mut columns = vec![rows.clone().narrow(1, 0, 1)];
    for k in 1..knots {
        let least = columns[k - 1].clone().add_scalar(MIN_KNOT_GAP);
        columns.push(rows.clone().narrow(1, k, 1).max_pair(least));
    }
    let moved = Tensor::cat(columns, 1).reshape([count]) - hinted.clone().detach();
    hinted + moved
}

fn straight_through<const D: usize>(weights: &Tensor<D>, steps: f32) -> Tensor<D> {
    let unrounded = weights.clone().detach();
    let error = unrounded.clone().mul_scalar(steps).round().div_scalar(steps) - unrounded;
    weights.clone() + error
}
