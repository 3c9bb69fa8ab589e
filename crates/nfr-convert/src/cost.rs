//! What weights cost, and what the priors are learnt from.

use nfr::internals::model::gridfit::{Scale, Weights};
use nfr::internals::table::codec::{self, Section};
use nfr::internals::table::contexts::{MIXTURES, Model, SLOTS};
use nfr::internals::table::priors::{DIGIT, PRIOR, Prior, odds};
use nfr::internals::table::range::{Coder, ONE};

/// What a glyph's weights take in the table, in bits.
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
    /// All of it.
    pub fn total(&self) -> f64 {
        self.header + self.warp + self.field + self.patterns + self.embedding
    }
}

/// Adds up bits.
#[derive(Default)]
struct Meter {
    bits: f64,
}

impl Coder for Meter {
    const WRITES: bool = true;

    fn bit(&mut self, odds: u32, bit: bool) -> bool {
        let odds = if bit { odds } else { ONE - odds };
        self.bits -= (f64::from(odds) / f64::from(ONE)).log2();
        bit
    }
}

/// What weights would take in the table. Their lengths fit each other and the limits of [`codec`].
pub fn cost(weights: &Weights, scale: Scale) -> Cost {
    let mut cost = Cost::default();
    let mut model = Model::new(Meter::default(), &PRIOR);
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
    // A coder that writes finds nothing wrong with weights within the limits.
    let _ = codec::code(&mut model, &mut weights.clone(), scale, charge);
    cost
}

/// Rounds of learning; later ones change nothing any more.
const ROUNDS: usize = 4;
/// How far a mixture's weights move for a decision: per unit of what a context said and of the error in odds.
const MIXING_RATE: f64 = 4e-9;
/// Ones and zeros that every slot has seen beforehand.
const UNSEEN: f64 = 0.4;
/// Digits in a line of the table.
const LINE: usize = 96;

/// Counts decisions by slot and the mixtures' errors.
struct Learner {
    ones: Vec<f64>,
    all: Vec<f64>,
    moves: Vec<[f64; 3]>,
}

impl Coder for Learner {
    const WRITES: bool = true;

    fn bit(&mut self, _odds: u32, bit: bool) -> bool {
        bit
    }

    fn watch(&mut self, slots: [usize; 3], said: [i32; 3], mix: usize, odds: u32, bit: bool) {
        let mixed = mix < MIXTURES;
        for slot in &slots[..if mixed { 3 } else { 1 }] {
            self.all[*slot] += 1.0;
            self.ones[*slot] += f64::from(u8::from(bit));
        }
        if mixed {
            let error = f64::from(if bit { ONE } else { 0 }) - f64::from(odds);
            for (to, said) in self.moves[mix].iter_mut().zip(said) {
                *to += MIXING_RATE * error * f64::from(said);
            }
        }
    }
}

/// Learns the table of priors, as `spec/priors.txt` has it, from fonts: for each its scale and its glyphs' weights.
/// `examples/priors.rs` calls it.
pub fn learn_priors(fonts: &[(Scale, Vec<Weights>)]) -> String {
    let mut prior = Prior { slots: [1 << 15; SLOTS], weights: [[0; 3]; MIXTURES] };
    let mut digits = [32; SLOTS];
    let mut weights = [[0.4; 3]; MIXTURES];
    for _ in 0..ROUNDS {
        let (mut ones, mut all) = (vec![0.0; SLOTS], vec![0.0; SLOTS]);
        for (scale, glyph) in fonts.iter().flat_map(|(scale, glyphs)| glyphs.iter().map(move |g| (*scale, g)))
        {
            prior.weights = weights.map(|mix| mix.map(weight_digit));
            let learner = Learner { ones, all, moves: vec![[0.0; 3]; MIXTURES] };
            let mut model = Model::new(learner, &prior);
            let _ = codec::code(&mut model, &mut glyph.clone(), scale, |_, _| ());
            let Learner { ones: seen_ones, all: seen, moves } = model.coder;
            (ones, all) = (seen_ones, seen);
            for (weight, by) in weights.iter_mut().flatten().zip(moves.iter().flatten()) {
                *weight += by;
            }
        }
        for (slot, digit) in digits.iter_mut().enumerate() {
            let odds_of_one = (ones[slot] + UNSEEN) / (all[slot] + 2.0 * UNSEEN);
            *digit = odds_digit(odds_of_one);
            prior.slots[slot] = odds(*digit);
        }
    }
    let weights = weights.into_iter().flatten().map(weight_digit);
    let text: Vec<char> = digits.into_iter().chain(weights).map(|digit| char::from(DIGIT + digit)).collect();
    text.chunks(LINE).map(|line| line.iter().chain(&['\n']).collect::<String>()).collect()
}

fn weight_digit(weight: f64) -> u8 {
    (weight * 32.0).round().clamp(0.0, 63.0) as u8
}

fn odds_digit(odds: f64) -> u8 {
    let said = (odds / (1.0 - odds)).ln() * 256.0;
    (((said - 32.0) / 64.0).round() + 32.0).clamp(0.0, 63.0) as u8
}
