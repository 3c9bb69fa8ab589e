//! Dense layers, for eight pixels at a time.

use alloc::vec::Vec;

use wide::f32x8;

use super::layout::Dense;

/// Pixels that are evaluated together, one a lane.
pub(super) const LANES: usize = 8;
/// Outputs whose sums are kept in registers together.
const PANEL: usize = 4;

/// A dense layer's weights, in the order in which they are used.
#[derive(Debug, Clone)]
struct Matrix {
    inputs: usize,
    outputs: usize,
    /// For each four outputs, for each input: the four weights. The last four are filled up with 0.
    panels: Vec<[f32; PANEL]>,
}

impl Matrix {
    /// The rows of a layer's weights for some of its inputs.
    fn new(dense: &Dense, inputs: core::ops::Range<usize>) -> Self {
        let mut panels = Vec::with_capacity(inputs.len() * dense.outputs.div_ceil(PANEL));
        for first in (0..dense.outputs).step_by(PANEL) {
            let last = dense.outputs.min(first + PANEL);
            panels.extend(inputs.clone().map(|input| {
                let row = &dense.weights[input * dense.outputs..];
                let mut four = [0.0; PANEL];
                four[..last - first].copy_from_slice(&row[first..last]);
                four
            }));
        }
        Self { inputs: inputs.len(), outputs: dense.outputs, panels }
    }

    /// Calls `done(tile, output, sum)` for every output of every tile of eight pixels: the sum over the inputs in
    /// ascending order, from 0. `x` has the inputs of one tile after the other.
    ///
    /// The weights of four outputs stay in the nearest cache for all tiles.
    fn sums(&self, x: &[f32x8], mut done: impl FnMut(usize, usize, f32x8)) {
        for (k, panel) in self.panels.chunks_exact(self.inputs).enumerate() {
            let first = k * PANEL;
            for (tile, x) in x.chunks_exact(self.inputs).enumerate() {
                let mut sums = [f32x8::ZERO; PANEL];
                for (x, weights) in x.iter().zip(panel) {
                    for (sum, weight) in sums.iter_mut().zip(weights) {
                        *sum += *x * f32x8::splat(*weight);
                    }
                }
                for (output, sum) in (first..self.outputs).zip(sums) {
                    done(tile, output, sum);
                }
            }
        }
    }

    fn memory(&self) -> usize {
        self.panels.capacity() * size_of::<[f32; PANEL]>()
    }
}

/// The value if it is above 0, else 0. NaN gives 0; the maximum of two vectors depends on the machine there.
pub(super) fn relu(value: f32x8) -> f32x8 {
    value & value.simd_gt(f32x8::ZERO)
}

/// A dense layer. Its last inputs may be the latent vector of the size, which is the same for all pixels and summed once.
#[derive(Debug, Clone)]
pub(super) struct Layer {
    matrix: Matrix,
    size: Option<Matrix>,
    bias: Vec<f32>,
}

impl Layer {
    /// A layer whose last `latent` inputs are the latent vector.
    pub(super) fn new(dense: Dense, latent: usize) -> Self {
        let own = dense.inputs - latent;
        Self {
            matrix: Matrix::new(&dense, 0..own),
            size: (latent > 0).then(|| Matrix::new(&dense, own..dense.inputs)),
            bias: dense.bias,
        }
    }

    /// The number of weights of a pixel's own inputs.
    pub(super) fn weights(&self) -> u64 {
        self.matrix.inputs as u64 * self.matrix.outputs as u64
    }

    pub(super) fn outputs(&self) -> usize {
        self.matrix.outputs
    }

    /// The bias and the sums over the latent vector, which is the same in all lanes.
    pub(super) fn base(&self, latent: &[f32x8]) -> Vec<f32> {
        let mut base = self.bias.clone();
        if let Some(size) = &self.size {
            size.sums(latent, |_, output, sum| base[output] += sum.to_array()[0]);
        }
        base
    }

    /// The layer's outputs for the tiles of `x`: `y[at] = activate(sum + base, at)`. `x` and `y` have a vector of eight
    /// pixels for each feature of one tile after the other.
    pub(super) fn apply(
        &self,
        base: &[f32],
        x: &[f32x8],
        y: &mut [f32x8],
        activate: impl Fn(f32x8, usize) -> f32x8,
    ) {
        self.matrix.sums(x, |tile, output, sum| {
            let at = tile * self.outputs() + output;
            y[at] = activate(sum + f32x8::splat(base[output]), at);
        });
    }

    pub(super) fn memory(&self) -> usize {
        let matrices = self.matrix.memory() + self.size.as_ref().map_or(0, Matrix::memory);
        matrices + self.bias.capacity() * size_of::<f32>()
    }
}
