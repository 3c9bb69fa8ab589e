//! The implicit network of the paper "Neural Font Rendering" (Anderson, Shamir, Fried): a function from a pixel's
//! place, and the number of a size, to the pixel's coverage, for one glyph at some sizes.
//!
//! [`NetworkWeights`] are plain numbers, as training makes them and the table stores them; [`Network`] evaluates them.
//! `spec/nfrt.md` describes the evaluation. Every operation in here is an IEEE 754 one in a fixed order, so that the
//! pixels are the same on every machine.

mod dense;
mod encoding;
mod eval;
mod norm;

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

use crate::error::Error;
use crate::table::MAX_TRAINED_PPEM;

pub use encoding::{ENCODED, WAVES, encode};
pub use eval::{Network, condition, coordinate, positions};
pub use norm::EPSILON as NORM_EPSILON;

/// The levels of coverage that a network tells apart: its outputs.
pub const CLASSES: usize = 21;
/// The most features of a layer.
pub const MAX_WIDTH: u16 = 1024;
/// The most numbers that stand for a size.
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
const OUT: usize = TRUNK_LAYERS - 1;
/// Batch norms of the trunk.
pub const NORMS: usize = NORMALISED.len();
/// The layers of the trunk, counted from 0, behind which a batch norm stands.
pub const NORMALISED: [usize; 3] = [1, 4, 8];
/// The layers of the trunk to which the numbers that stand for a size come beside those of the pixel.
pub const CONDITIONED: [usize; 2] = [0, 5];
/// The hidden layers of the trunk whose output replaces their input; the others add theirs, see [`Shape::residual`].
pub const REPLACING: [usize; 3] = [0, 1, 5];

/// The level of coverage, 0–255, that a class stands for: its multiple of 5 %.
pub fn coverage_of(class: usize) -> u8 {
    ((class * 255 + (CLASSES - 1) / 2) / (CLASSES - 1)) as u8
}

/// How a network is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Features of the trunk's layers, 1 to [`MAX_WIDTH`].
    pub width: u16,
    /// How many numbers stand for a size, up to [`MAX_LATENT`]. 0: the size is no input, and there is no encoder.
    pub latent: u16,
    /// Features of the encoder's layers, up to [`MAX_ENCODER`], and at least 1 if there is an encoder.
    pub encoder: u16,
    /// Whether coordinates come with their waves, see [`encode`].
    pub frequencies: bool,
    /// Whether the trunk's layers 2–4 and 6–10 add to what they are given.
    pub residual: bool,
}

impl Shape {
    /// The numbers that stand for a pixel's place: 130, or 2 without frequencies.
    pub fn positions(&self) -> usize {
        2 * self.condition()
    }

    /// The numbers that the encoder is given for a size: 65, or 1 without frequencies.
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
    /// `LimitExceeded`.
    pub fn check(&self) -> Result<(), Error> {
        let least = u16::from(self.latent > 0);
        if (1..=MAX_WIDTH).contains(&self.width)
            && self.latent <= MAX_LATENT
            && (least..=MAX_ENCODER).contains(&self.encoder)
        {
            return Ok(());
        }
        Err(Error::LimitExceeded(format!(
            "a network of width {}, latent {} and encoder {}; 1–{MAX_WIDTH}, 0–{MAX_LATENT} and {least}–{MAX_ENCODER} \
             are allowed",
            self.width, self.latent, self.encoder
        )))
    }
}

/// A size that a network was trained for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NetworkSize {
    /// The size in pixels per em, 1 to 1024.
    pub ppem: u16,
    /// Pixels along a side of the box that the network fills, 1 to [`MAX_BOX`].
    pub side: u8,
    /// Where the pen is, in pixels: columns of the box left of it, and rows of the box above the baseline.
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
    pub shape: Shape,
    /// The sizes that it was trained for, by ascending side. Their numbers in this list are what the network is given.
    /// Where several have the same ppem, the first is drawn.
    pub sizes: Vec<NetworkSize>,
    /// Dense layers, as [`Shape::layers`] lists them.
    pub dense: Vec<Dense>,
    /// Three batch norms.
    pub norms: Vec<Norm>,
}

impl NetworkWeights {
    /// Checks that lengths, sizes and numbers are those of a network.
    ///
    /// # Errors
    ///
    /// `LimitExceeded` for a network that is too large, `InvalidParameter` for one that contradicts itself.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |what: String| Err(Error::InvalidParameter(format!("a network has {what}")));
        self.shape.check()?;
        if let Some(problem) = sizes_problem(&self.sizes) {
            return wrong(problem);
        }
        let layers = self.shape.layers();
        if self.dense.len() != layers.len() || self.norms.len() != NORMS {
            let (dense, norms) = (self.dense.len(), self.norms.len());
            return wrong(format!(
                "{dense} layers and {norms} norms instead of {} and {NORMS}",
                layers.len()
            ));
        }
        for (k, (dense, (inputs, outputs))) in self.dense.iter().zip(layers).enumerate() {
            if (dense.inputs, dense.outputs) != (inputs, outputs)
                || dense.weights.len() != inputs * outputs
                || dense.bias.len() != outputs
            {
                return wrong(format!("a layer {k} that is not {inputs} to {outputs}"));
            }
        }
        let width = usize::from(self.shape.width);
        if self.norms.iter().any(|norm| norm.gamma.len() != width || norm.beta.len() != width) {
            return wrong(format!("a norm that has not {width} features"));
        }
        let dense = self.dense.iter().flat_map(|dense| [&dense.weights, &dense.bias]);
        let norms = self.norms.iter().flat_map(|norm| [&norm.gamma, &norm.beta]);
        if dense.chain(norms).flatten().any(|number| !number.is_finite()) {
            return wrong("weights that are not finite; train it again with a lower learning rate".into());
        }
        Ok(())
    }
}

/// What is wrong with a list of sizes, if anything is.
pub fn sizes_problem(sizes: &[NetworkSize]) -> Option<String> {
    let count = sizes.len();
    if !(1..=MAX_SIZES).contains(&count) {
        return Some(format!("{count} sizes, 1–{MAX_SIZES} are allowed"));
    }
    if !sizes.is_sorted_by_key(|size| size.side) {
        return Some("sizes that are not in the order of their boxes".into());
    }
    sizes.iter().find_map(|size| {
        let [left, top, width, height] = size.crop.map(u16::from);
        let side = u16::from(size.side);
        if !(1..=MAX_TRAINED_PPEM).contains(&size.ppem) {
            return Some(format!("a size of {} ppem, 1–{MAX_TRAINED_PPEM} are allowed", size.ppem));
        }
        if !(1..=u16::from(MAX_BOX)).contains(&side) {
            return Some(format!("a box of {side} pixels, 1–{MAX_BOX} are allowed"));
        }
        (left + width > side || top + height > side)
            .then(|| format!("a glyph at {} ppem that leaves its box of {side} pixels", size.ppem))
    })
}
