//! The bits that weights take in the table, and the training of the coder's prior probabilities.

use std::sync::LazyLock;

use crate::error::Error;
use nfr::internals::model::gridfit::{Scale, Weights};
use nfr::internals::recode_outlines;
use nfr::internals::table::codec::{self, Section};
use nfr::internals::table::priors::{DIGIT, PRIOR, Prior, probability};
use nfr::internals::table::range::{Coder, ONE};
use nfr::internals::table::{
    context_model::ContextModel,
    elements::{MIXERS, OUTLINE_MIXERS, OUTLINE_SLOTS, SLOTS},
};

/// The bits that a glyph's weights take in the table.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Cost {
    /// Counts, knots and the box.
    pub header: f64,
    /// Hinted positions.
    pub warp: f64,
    /// The field's coefficients.
    pub field: f64,
    /// The deformation's patterns.
    pub patterns: f64,
    /// Their weights at each size.
    pub embedding: f64,
}

impl Cost {
    /// The sum.
    pub fn total(&self) -> f64 {
        self.header + self.warp + self.field + self.patterns + self.embedding
    }
}

/// −log₂ of each probability but 0.
static INFORMATION: LazyLock<[f64; ONE as usize + 1]> =
    LazyLock::new(|| std::array::from_fn(|probability| -(probability as f64 / f64::from(ONE)).log2()));

/// A coder that adds up information content (−log₂ of each decision's probability).
#[derive(Default)]
struct Meter {
    bits: f64,
}

impl Coder for Meter {
    const WRITES: bool = true;

    fn bit(&mut self, probability: u32, bit: bool) -> bool {
        let probability = if bit { probability } else { ONE - probability };
        self.bits += INFORMATION[probability as usize];
        bit
    }
}

/// The bits that weights would take in the table.
///
/// # Errors
///
/// As [`codec::encode`], for weights outside of the limits of the format.
pub fn cost(weights: &Weights, scale: Scale) -> Result<Cost, Error> {
    let mut cost = Cost::default();
    let mut model = ContextModel::new(Meter::default(), &PRIOR);
    let charge = |section: Section, meter: &mut Meter| {
        let to = match section {
            Section::Header => &mut cost.header,
            Section::Warp => &mut cost.warp,
            Section::Field => &mut cost.field,
            Section::Patterns => &mut cost.patterns,
            Section::Embedding => &mut cost.embedding,
        };
        *to = std::mem::take(&mut meter.bits);
    };
    codec::code(&mut model, &mut weights.clone(), scale, charge)?;
    Ok(cost)
}

/// The bits of one section of weights.
///
/// # Errors
///
/// As [`cost`].
pub(crate) fn section_bits(weights: &mut Weights, scale: Scale, section: Section) -> Result<f64, Error> {
    let mut model = ContextModel::new(Meter::default(), &PRIOR);
    // A coder that writes leaves the weights as they are.
    codec::code_section(&mut model, weights, scale, section)?;
    Ok(model.coder.bits)
}

/// Epochs; later ones change nothing.
const EPOCHS: usize = 24;
/// The learning rate of a mixture's weights: per unit of a context's stretched probability and of the error.
const MIXING_RATE: f64 = 4e-9;
/// Where a mixture is used more often than this, the mean of its gradients counts so many times.
const MOST_MIXED: f64 = 1_000.0;
/// The pseudo-count of ones and of zeros in every slot (additive smoothing).
const PSEUDO_COUNT: f64 = 0.4;
/// Digits in a line of the table.
const LINE: usize = 96;

/// Counts the decisions of each slot and accumulates the gradient of the mixtures' weights, as in lpaq.
pub struct Learner {
    ones: Vec<f64>,
    all: Vec<f64>,
    gradients: Vec<[f64; 3]>,
    /// How often each mixer is used.
    mixed: Vec<f64>,
    /// The bits of the section that was begun last.
    bits: f64,
}

impl Coder for Learner {
    const WRITES: bool = true;

    fn bit(&mut self, probability: u32, bit: bool) -> bool {
        self.bits += INFORMATION[if bit { probability } else { ONE - probability } as usize];
        bit
    }

    fn begin_section(&mut self) {
        self.bits = 0.0;
    }

    fn end_section(&mut self) -> usize {
        (self.bits / 8.0).ceil() as usize
    }

    fn observe(&mut self, slots: [usize; 3], stretched: [i32; 3], mix: usize, probability: u32, bit: bool) {
        let mixed = mix < self.gradients.len();
        for slot in &slots[..if mixed { 3 } else { 1 }] {
            self.all[*slot] += 1.0;
            self.ones[*slot] += f64::from(u8::from(bit));
        }
        if mixed {
            self.mixed[mix] += 1.0;
            let error = f64::from(if bit { ONE } else { 0 }) - f64::from(probability);
            for (gradient, stretched) in self.gradients[mix].iter_mut().zip(stretched) {
                *gradient += MIXING_RATE * error * f64::from(stretched);
            }
        }
    }
}

/// Learns the table of priors of fields, in the format of `spec/priors.txt`, from fonts: the scale and the glyphs' weights of
/// each. `examples/priors.rs` calls it.
///
/// # Errors
///
/// As [`cost`].
pub fn learn_priors(fonts: &[(Scale, Vec<Weights>)]) -> Result<String, Error> {
    learn(SLOTS, MIXERS, |model| {
        let glyphs = fonts.iter().flat_map(|(scale, glyphs)| glyphs.iter().map(move |glyph| (*scale, glyph)));
        for (scale, glyph) in glyphs {
            model.forget();
            codec::code(model, &mut glyph.clone(), scale, |_, _| ())?;
        }
        Ok(())
    })
}

/// Learns the table of priors of outlines, `spec/outline-priors.txt`, from converted fonts.
///
/// # Errors
///
/// Those of damaged models.
pub fn learn_outline_priors(fonts: &[nfr::Font]) -> Result<String, Error> {
    learn(OUTLINE_SLOTS, OUTLINE_MIXERS, |model| {
        fonts.iter().try_for_each(|font| Ok(recode_outlines(font, model)?))
    })
}

/// Learns a table of priors from everything that `code` codes; before each message it lets the model forget what it has adapted
/// to.
///
/// # Errors
///
/// Those of `code`.
pub fn learn(
    slots: usize,
    mixers: usize,
    code: impl Fn(&mut ContextModel<'_, Learner>) -> Result<(), Error>,
) -> Result<String, Error> {
    let mut digits = vec![32; slots];
    let mut weights = vec![[0.4; 3]; mixers];
    for _ in 0..EPOCHS {
        let probabilities: Vec<u16> = digits.iter().map(|digit| probability(*digit)).collect();
        let steps: Vec<[u8; 3]> = weights.iter().map(|mix| mix.map(weight_digit)).collect();
        let learner = Learner {
            ones: vec![0.0; slots],
            all: vec![0.0; slots],
            gradients: vec![[0.0; 3]; mixers],
            mixed: vec![0.0; mixers],
            bits: 0.0,
        };
        let mut model = ContextModel::new(learner, &Prior { slots: &probabilities, weights: &steps });
        code(&mut model)?;
        let Learner { ones, all, gradients, mixed, .. } = model.coder;
        for (weights, (gradients, uses)) in weights.iter_mut().zip(gradients.iter().zip(&mixed)) {
            let share = (MOST_MIXED / uses.max(1.0)).min(1.0);
            weights.iter_mut().zip(gradients).for_each(|(weight, by)| *weight += by * share);
        }
        for (digit, (ones, all)) in digits.iter_mut().zip(ones.iter().zip(&all)) {
            *digit = probability_digit((ones + PSEUDO_COUNT) / (all + 2.0 * PSEUDO_COUNT));
        }
    }
    let weights = weights.into_iter().flatten().map(weight_digit);
    let text: Vec<char> = digits.into_iter().chain(weights).map(|digit| char::from(DIGIT + digit)).collect();
    Ok(text.chunks(LINE).map(|line| line.iter().chain(&['\n']).collect::<String>()).collect())
}

fn weight_digit(weight: f64) -> u8 {
    (weight * 32.0).round().clamp(0.0, 63.0) as u8
}

fn probability_digit(probability: f64) -> u8 {
    let stretched = (probability / (1.0 - probability)).ln() * 256.0;
    (((stretched - 32.0) / 64.0).round() + 32.0).clamp(0.0, 63.0) as u8
}
