//! From a network's numbers to the pixels of a box.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use wide::f32x8;

use super::dense::{LANES, Layer, relu};
use super::encoding::{encode, tanh};
use super::layout::{
    Architecture, CLASSES, CONDITIONED, NORMALISED, NORMS, NetworkSize, NetworkWeights, Norm, OUT, REPLACING,
    TRUNK_LAYERS, coverage_of,
};
use super::norm::norm;
use crate::error::Damage;

/// Tiles of eight pixels that a stage evaluates together, so that the features of the widest layers stay in a cache.
const BLOCK: usize = 8;
/// The trunk's layers, in stages: a batch norm stands behind each but the last, and needs all pixels.
const STAGES: [Range<usize>; NORMS + 1] = {
    let [a, b, c] = NORMALISED;
    [0..a + 1, a + 1..b + 1, b + 1..c + 1, c + 1..OUT]
};

/// The coordinate of pixel `index` of `side` pixels along an axis, from −1 to 1.
pub fn coordinate(index: usize, side: usize) -> f64 {
    -1.0 + (2 * index + 1) as f64 / side as f64
}

/// A coordinate, or the condition, with its frequencies if the architecture has them.
fn with_frequencies(architecture: &Architecture, value: f64) -> Vec<f32> {
    let mut numbers = vec![value as f32];
    if architecture.frequencies {
        numbers.extend(encode(value).map(|wave| wave as f32));
    }
    numbers
}

/// The inputs of a network for the pixel in a row (from the top) and a column of a box of `side` pixels:
/// [`Architecture::positions`] numbers, y and x and then their sines and cosines.
pub fn positions(architecture: &Architecture, row: usize, column: usize, side: usize) -> Vec<f32> {
    let [y, x] = [row, column].map(|index| with_frequencies(architecture, coordinate(index, side)));
    position(&y, &x).collect()
}

fn position<'a>(y: &'a [f32], x: &'a [f32]) -> impl Iterator<Item = f32> + 'a {
    [y[0], x[0]].into_iter().chain(y[1..].iter().copied()).chain(x[1..].iter().copied())
}

/// The inputs of the encoder for the size number `index` of `count`: [`Architecture::condition`] numbers.
pub fn condition(architecture: &Architecture, index: usize, count: usize) -> Vec<f32> {
    with_frequencies(architecture, index as f64 / count as f64)
}

/// A network, ready to evaluate.
#[derive(Debug, Clone)]
pub struct Network {
    architecture: Architecture,
    sizes: Vec<NetworkSize>,
    encoder: Vec<Layer>,
    trunk: Vec<Layer>,
    norms: Vec<Norm>,
}

impl Network {
    /// Makes a network of its numbers.
    ///
    /// # Errors
    ///
    /// As [`NetworkWeights::check`].
    pub fn new(weights: NetworkWeights) -> Result<Self, Damage> {
        weights.check()?;
        let NetworkWeights { architecture, sizes, dense, norms } = weights;
        let encoders = dense.len() - TRUNK_LAYERS;
        let latent =
            |layer: usize| if CONDITIONED.contains(&layer) { usize::from(architecture.latent) } else { 0 };
        // One layer after the other, so that only one layer's weights are in memory twice.
        let mut dense = dense.into_iter();
        let encoder = dense.by_ref().take(encoders).map(|dense| Layer::new(dense, 0)).collect();
        let trunk = dense.enumerate().map(|(k, dense)| Layer::new(dense, latent(k))).collect();
        Ok(Self { architecture, sizes, encoder, trunk, norms })
    }

    /// How it is built.
    pub fn architecture(&self) -> Architecture {
        self.architecture
    }

    /// The sizes that it was trained for.
    pub fn sizes(&self) -> &[NetworkSize] {
        &self.sizes
    }

    /// The multiplications of drawing one box of `side` pixels.
    pub fn work(&self, side: u8) -> u64 {
        self.trunk.iter().map(Layer::weights).sum::<u64>() * u64::from(side) * u64::from(side)
    }

    /// The memory that the network takes, in bytes.
    pub fn memory(&self) -> usize {
        let layers = self.encoder.iter().chain(&self.trunk).map(Layer::memory).sum::<usize>();
        let norms =
            self.norms.iter().flat_map(|norm| [&norm.gamma, &norm.beta]).map(Vec::capacity).sum::<usize>();
        size_of::<Self>() + layers + norms * size_of::<f32>() + size_of_val(self.sizes.as_slice())
    }

    /// The coverage, 0–255, of all `side`² pixels of the box at the size number `index` of [`Self::sizes`], top row
    /// first. `None` for a size that the network does not have.
    pub fn coverage(&self, index: usize) -> Option<Vec<u8>> {
        Some(self.scores(index)?.iter().map(coverage).collect())
    }

    /// The scores of the classes of coverage, of which the highest is drawn, for all `side`² pixels of the box at the
    /// size number `index`, top row first. `None` for a size that the network does not have.
    pub fn scores(&self, index: usize) -> Option<Vec<[f32; CLASSES]>> {
        let size = self.sizes.get(index)?;
        let latent = self.latent(index);
        let bases: Vec<_> = self.trunk.iter().map(|layer| layer.base(&latent)).collect();
        let side = usize::from(size.side);
        let coordinates: Vec<_> =
            (0..side).map(|k| with_frequencies(&self.architecture, coordinate(k, side))).collect();
        let (pixels, width) = (side * side, usize::from(self.architecture.width));
        let mut features = vec![f32x8::ZERO; pixels.div_ceil(LANES) * width];
        let mut scores = Vec::with_capacity(pixels);
        for (stage, layers) in STAGES.iter().enumerate() {
            for (block, features) in features.chunks_mut(BLOCK * width).enumerate() {
                let tiles = features.len() / width;
                let mut x = if stage == 0 {
                    self.inputs(&coordinates, block * BLOCK, tiles)
                } else {
                    features.to_vec()
                };
                for layer in layers.clone() {
                    x = self.layer(layer, &bases[layer], &x, tiles);
                }
                if stage < NORMS {
                    features.copy_from_slice(&x);
                } else {
                    collect(&self.layer(OUT, &bases[OUT], &x, tiles), pixels, &mut scores);
                }
            }
            if let Some(parameters) = self.norms.get(stage) {
                norm(parameters, &mut features, pixels);
            }
        }
        Some(scores)
    }

    /// The latent vector of a size, the same in all lanes; empty without an encoder.
    fn latent(&self, index: usize) -> Vec<f32x8> {
        let Some(last) = self.encoder.len().checked_sub(1) else { return Vec::new() };
        let numbers = condition(&self.architecture, index, self.sizes.len());
        let mut x: Vec<f32x8> = numbers.into_iter().map(f32x8::splat).collect();
        for (k, layer) in self.encoder.iter().enumerate() {
            let mut y = vec![f32x8::ZERO; layer.outputs()];
            let base = layer.base(&[]);
            if k < last {
                layer.apply(&base, &x, &mut y, |sum, _| relu(sum));
            } else {
                layer.apply(&base, &x, &mut y, |sum, _| {
                    f32x8::splat(tanh(f64::from(sum.to_array()[0])) as f32)
                });
            }
            x = y;
        }
        x
    }

    /// The trunk's inputs for some tiles. The last tile is filled up with the last pixel.
    fn inputs(&self, coordinates: &[Vec<f32>], first: usize, tiles: usize) -> Vec<f32x8> {
        let side = coordinates.len();
        let mut x = Vec::with_capacity(tiles * self.architecture.positions());
        for tile in first..first + tiles {
            let at: [[&[f32]; 2]; LANES] = core::array::from_fn(|lane| {
                let pixel = (tile * LANES + lane).min(side * side - 1);
                [pixel / side, pixel % side].map(|k| coordinates[k].as_slice())
            });
            let mut numbers = at.map(|[y, x]| position(y, x));
            let rows = (0..self.architecture.positions())
                .map(|_| f32x8::new(core::array::from_fn(|lane| numbers[lane].next().unwrap_or(0.0))));
            x.extend(rows);
        }
        x
    }

    /// One of the trunk's layers, for some tiles.
    fn layer(&self, number: usize, base: &[f32], x: &[f32x8], tiles: usize) -> Vec<f32x8> {
        let layer = &self.trunk[number];
        let mut y = vec![f32x8::ZERO; tiles * layer.outputs()];
        let residual = self.architecture.residual && !REPLACING.contains(&number);
        if number == OUT {
            layer.apply(base, x, &mut y, |sum, _| sum);
        } else if residual {
            layer.apply(base, x, &mut y, |sum, at| x[at] + relu(sum));
        } else {
            layer.apply(base, x, &mut y, |sum, _| relu(sum));
        }
        y
    }
}

/// Appends the scores of the pixels of some tiles, up to the last pixel.
fn collect(tiles: &[f32x8], pixels: usize, scores: &mut Vec<[f32; CLASSES]>) {
    for tile in tiles.chunks_exact(CLASSES) {
        for lane in 0..LANES.min(pixels - scores.len()) {
            scores.push(core::array::from_fn(|class| tile[class].to_array()[lane]));
        }
    }
}

/// The coverage of the first class with the highest score.
fn coverage(scores: &[f32; CLASSES]) -> u8 {
    let mut class = 0;
    for (other, score) in scores.iter().enumerate() {
        if *score > scores[class] {
            class = other;
        }
    }
    coverage_of(class)
}
