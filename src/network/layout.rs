//! How a network is built, and its numbers.

use alloc::vec::Vec;

use super::encoding::ENCODED;
use crate::constants::MAX_TRAINED_PPEM;
use crate::error::Damage;

/// The classes of coverage: the network's outputs.
pub const CLASSES: usize = 21;
/// The most features of a layer.
pub const MAX_WIDTH: u16 = 1024;
/// The longest latent vector of a size.
pub const MAX_LATENT: u16 = 2048;
/// The most features of the encoder's layers.
pub const MAX_ENCODER: u16 = 512;
/// The longest side of a box, in pixels.
pub const MAX_BOX: u8 = 128;
/// The most sizes of a network.
pub const MAX_SIZES: usize = 64;
/// Dense layers of the encoder, if there is one.
pub const ENCODER_LAYERS: usize = 6;
/// Dense layers of the trunk, the last of which gives the classes.
pub const TRUNK_LAYERS: usize = 12;
/// The trunk's last layer.
pub(super) const OUT: usize = TRUNK_LAYERS - 1;
/// Batch norms of the trunk.
pub const NORMS: usize = NORMALISED.len();
/// The layers of the trunk, counted from 0, that a batch norm follows.
pub const NORMALISED: [usize; 3] = [1, 4, 8];
/// The layers of the trunk whose input is extended by the latent vector of the size.
pub const CONDITIONED: [usize; 2] = [0, 5];
/// The hidden layers of the trunk whose output replaces their input; the others add theirs, see [`Architecture::residual`].
pub const REPLACING: [usize; 3] = [0, 1, 5];

/// The coverage, 0–255, of a class: its multiple of 5 %.
pub fn coverage_of(class: usize) -> u8 {
    ((class * 255 + (CLASSES - 1) / 2) / (CLASSES - 1)) as u8
}

/// How a network is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Architecture {
    /// Features of the trunk's layers, 1 to [`MAX_WIDTH`].
    pub width: u16,
    /// The length of a size's latent vector, up to [`MAX_LATENT`]. 0: the size is no input, and there is no encoder.
    pub latent: u16,
    /// Features of the encoder's layers, up to [`MAX_ENCODER`], and at least 1 if there is an encoder.
    pub encoder: u16,
    /// Whether inputs are extended by their encoding, see [`encode`](super::encoding::encode).
    pub frequencies: bool,
    /// Whether the trunk's layers 2–4 and 6–10 add to what they are given.
    pub residual: bool,
}

impl Architecture {
    /// The inputs for a pixel's position: 130, or 2 without frequencies.
    pub fn positions(&self) -> usize {
        2 * self.condition()
    }

    /// The inputs of the encoder for a size: 65, or 1 without frequencies.
    pub fn condition(&self) -> usize {
        if self.frequencies { 1 + ENCODED } else { 1 }
    }

    /// Inputs and outputs of every dense layer in the order of [`NetworkWeights::dense`]: those of the encoder, if there
    /// is one, then the trunk's.
    pub fn layers(&self) -> Vec<(usize, usize)> {
        let [width, latent, encoder] = [self.width, self.latent, self.encoder].map(usize::from);
        let mut layers = Vec::with_capacity(ENCODER_LAYERS + TRUNK_LAYERS);
        if latent > 0 {
            layers.push((self.condition(), encoder));
            layers.extend([(encoder, encoder); ENCODER_LAYERS - 2]);
            layers.push((encoder, latent));
        }
        layers.extend((0..TRUNK_LAYERS).map(|layer| {
            let inputs = if layer == 0 { self.positions() } else { width };
            let outputs = if layer == OUT { CLASSES } else { width };
            (inputs + if CONDITIONED.contains(&layer) { latent } else { 0 }, outputs)
        }));
        layers
    }

    /// Checks the limits.
    ///
    /// # Errors
    ///
    /// `TooLarge`, or `Malformed` for a network without any feature.
    pub fn check(&self) -> Result<(), Damage> {
        for (what, count, limit) in [
            ("features of the trunk", self.width, MAX_WIDTH),
            ("numbers for a size", self.latent, MAX_LATENT),
            ("features of the encoder", self.encoder, MAX_ENCODER),
        ] {
            if count > limit {
                return Err(Damage::TooLarge { what, count: count.into(), limit: limit.into() });
            }
        }
        if self.width == 0 || self.latent > 0 && self.encoder == 0 {
            return Err(Damage::Malformed("has a network without features"));
        }
        Ok(())
    }
}

/// A size that a network was trained for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NetworkSize {
    /// The size in pixels per em, 1 to 1024.
    pub ppem: u16,
    /// Pixels along a side of the box that the network fills, 1 to [`MAX_BOX`].
    pub side: u8,
    /// The glyph's origin in pixels: columns of the box to the left of it, and rows of the box above the baseline.
    pub origin: [i16; 2],
    /// The part of the box that is drawn: left column, top row, width and height.
    pub crop: [u8; 4],
}

/// A dense layer: `outputs` sums over `inputs`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Dense {
    /// Numbers that come in.
    pub inputs: usize,
    /// Numbers that come out.
    pub outputs: usize,
    /// The weight of input i for output o, at `i * outputs + o`.
    pub weights: Vec<f32>,
    /// What is added to each output.
    pub bias: Vec<f32>,
}

/// A batch norm: each feature is centred and scaled over the pixels of one bitmap, then multiplied and shifted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Norm {
    /// What each feature is multiplied with.
    pub gamma: Vec<f32>,
    /// What is added to each feature.
    pub beta: Vec<f32>,
}

/// A network's numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct NetworkWeights {
    /// How it is built.
    pub architecture: Architecture,
    /// The sizes that it was trained for, by ascending side. A size's index in this list is the network's input. The first
    /// of several with the same ppem is drawn.
    pub sizes: Vec<NetworkSize>,
    /// Dense layers, as [`Architecture::layers`] lists them.
    pub dense: Vec<Dense>,
    /// Three batch norms.
    pub norms: Vec<Norm>,
}

impl NetworkWeights {
    /// Checks that lengths, sizes and numbers are those of a network.
    ///
    /// # Errors
    ///
    /// `TooLarge` for a network that is too large, `Malformed` for one that contradicts itself.
    pub fn check(&self) -> Result<(), Damage> {
        self.architecture.check()?;
        check_sizes(&self.sizes)?;
        let layers = self.architecture.layers();
        let fits = |(dense, (inputs, outputs)): (&Dense, &(usize, usize))| {
            (dense.inputs, dense.outputs) == (*inputs, *outputs)
                && dense.weights.len() == inputs * outputs
                && dense.bias.len() == *outputs
        };
        if self.dense.len() != layers.len() || !self.dense.iter().zip(&layers).all(fits) {
            return Err(Damage::Malformed("has layers that do not fit its architecture"));
        }
        let width = usize::from(self.architecture.width);
        let fits = |norm: &Norm| norm.gamma.len() == width && norm.beta.len() == width;
        if self.norms.len() != NORMS || !self.norms.iter().all(fits) {
            return Err(Damage::Malformed("has batch norms that do not fit its architecture"));
        }
        let dense = self.dense.iter().flat_map(|dense| [&dense.weights, &dense.bias]);
        let norms = self.norms.iter().flat_map(|norm| [&norm.gamma, &norm.beta]);
        if dense.chain(norms).flatten().any(|number| !number.is_finite()) {
            return Err(Damage::Malformed("has weights that are not finite"));
        }
        Ok(())
    }
}

/// Checks a list of sizes.
///
/// # Errors
///
/// `Malformed`, saying what is wrong.
pub fn check_sizes(sizes: &[NetworkSize]) -> Result<(), Damage> {
    if !(1..=MAX_SIZES).contains(&sizes.len()) {
        return Err(Damage::Malformed("has no sizes, or too many"));
    }
    if !sizes.is_sorted_by_key(|size| size.side) {
        return Err(Damage::Malformed("has sizes that are not in the order of their boxes"));
    }
    for size in sizes {
        let [left, top, width, height] = size.crop.map(u16::from);
        let side = u16::from(size.side);
        if !(1..=MAX_TRAINED_PPEM).contains(&size.ppem) {
            return Err(Damage::Malformed("has a size outside 1–1024 ppem"));
        }
        if !(1..=u16::from(MAX_BOX)).contains(&side) {
            return Err(Damage::Malformed("has a box with too many pixels, or none"));
        }
        if left + width > side || top + height > side {
            return Err(Damage::Malformed("has a glyph that leaves its box"));
        }
    }
    Ok(())
}
