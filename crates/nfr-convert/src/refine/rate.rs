//! The rate: an estimate of the bits that the coder needs for a weight and for those that are predicted from it.

use nfr::internals::model::gridfit::{AxisWarp, Scale, WARP_STEPS};

/// Bits of a residual: two more for each doubling, as in an Exponential-Golomb code.
fn residual_bits(residual: i32) -> f64 {
    match residual.unsigned_abs() {
        0 => 0.7,
        1 => 3.0,
        r => 2.6 + 2.0 * f64::from(r).log2(),
    }
}

/// Bits of a pattern's weight at one size.
pub(super) fn embedding_bits(weight: i8) -> f64 {
    residual_bits(i32::from(weight))
}

fn round(knot: i16, scale: Scale, s: usize, steps: i32) -> i32 {
    let units = i64::from(scale.units_per_em());
    let product = i64::from(knot) * scale.ppem_of(s) as i64 * i64::from(steps);
    (2 * product + units).div_euclid(2 * units) as i32
}

/// The bits of an axis's hinted positions, with the predictor of each knot.
pub(super) struct WarpRate {
    knots: Vec<i16>,
    scale: Scale,
    predictors: Vec<u8>,
}

impl WarpRate {
    pub(super) fn new(warp: &AxisWarp, scale: Scale) -> Self {
        let mut rate = Self { knots: warp.knots.clone(), scale, predictors: vec![0; warp.knots.len()] };
        for k in 0..warp.knots.len() {
            let mut cost = |predictor: u8| {
                rate.predictors[k] = predictor;
                (0..scale.sizes()).map(|s| rate.residual_bits_at(&warp.hinted, s, k)).sum::<f64>()
            };
            let costs = [0, 1, 2, 3].map(|predictor| (cost(predictor), predictor));
            rate.predictors[k] =
                costs.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |best| best.1);
        }
        rate
    }

    fn predict(&self, hinted: &[i32], s: usize, k: usize) -> i32 {
        let n = self.knots.len();
        let w = WARP_STEPS as i32;
        let whole = |s: usize| round(self.knots[k], self.scale, s, 1) * w;
        let exact = |s: usize| round(self.knots[k], self.scale, s, w);
        match self.predictors[k] {
            1 if s > 0 => whole(s) + hinted[(s - 1) * n + k] - whole(s - 1),
            2 if s > 0 => exact(s) + hinted[(s - 1) * n + k] - exact(s - 1),
            3 if k > 0 => hinted[s * n + k - 1] + round(self.knots[k] - self.knots[k - 1], self.scale, s, w),
            _ => whole(s),
        }
    }

    fn residual_bits_at(&self, hinted: &[i32], s: usize, k: usize) -> f64 {
        residual_bits(hinted[s * self.knots.len() + k] - self.predict(hinted, s, k))
    }

    /// Bits of a position and of those that are predicted from it.
    pub(super) fn bits(&self, hinted: &[i32], s: usize, k: usize) -> f64 {
        let mut sum = self.residual_bits_at(hinted, s, k);
        if self.is_base_of_next_size(s, k) {
            sum += self.residual_bits_at(hinted, s + 1, k);
        }
        if self.predictors.get(k + 1) == Some(&3) {
            sum += self.residual_bits_at(hinted, s, k + 1);
        }
        sum
    }

    fn is_base_of_next_size(&self, s: usize, k: usize) -> bool {
        s + 1 < self.scale.sizes() && (self.predictors[k] == 1 || self.predictors[k] == 2)
    }

    /// Positions with few bits: the prediction, and the position that makes the next size's prediction right.
    pub(super) fn candidates(&self, hinted: &[i32], s: usize, k: usize) -> impl Iterator<Item = i32> {
        let n = self.knots.len();
        let for_next_size = self
            .is_base_of_next_size(s, k)
            .then(|| hinted[s * n + k] + hinted[(s + 1) * n + k] - self.predict(hinted, s + 1, k));
        [Some(self.predict(hinted, s, k)), for_next_size].into_iter().flatten()
    }
}

/// Weights on a grid, predicted from their neighbours to the left and below.
pub(super) struct Plane<'a> {
    pub(super) values: &'a [i8],
    pub(super) stride: usize,
}

/// The columns and rows, relative to a value, of the residuals that depend on it or whose spread does.
const DEPENDENT: [(i32, usize); 9] =
    [(0, 0), (1, 0), (2, 0), (-1, 1), (0, 1), (1, 1), (2, 1), (0, 2), (1, 2)];

impl Plane<'_> {
    /// The prediction of a value from its neighbours (median edge detector of LOCO-I).
    pub(super) fn prediction(&self, at: usize) -> i32 {
        let (column, row) = (at % self.stride, at / self.stride);
        let value = |at: usize| i32::from(self.values[at]);
        let left = if column > 0 { value(at - 1) } else { 0 };
        let below = if row > 0 { value(at - self.stride) } else { left };
        let left = if column > 0 { left } else { below };
        let corner = if column > 0 && row > 0 { value(at - self.stride - 1) } else { left };
        (left + below - corner).clamp(left.min(below), left.max(below))
    }

    fn residual(&self, at: usize) -> u32 {
        (i32::from(self.values[at]) - self.prediction(at)).unsigned_abs()
    }

    /// Bits of a residual with a discrete Laplace distribution, whose spread follows from the neighbours' residuals.
    fn residual_bits_at(&self, at: usize) -> f64 {
        let (column, row) = (at % self.stride, at / self.stride);
        let mut around = 0;
        if column > 0 {
            around += 2 * self.residual(at - 1);
        }
        if row > 0 {
            around += 2 * self.residual(at - self.stride);
            around += if column > 0 { self.residual(at - self.stride - 1) } else { 0 };
            around += if column + 1 < self.stride { self.residual(at - self.stride + 1) } else { 0 };
        }
        let spread = 0.35 + 0.15 * f64::from(around);
        let decay = (-1.0 / spread).exp();
        let none = (1.0 - decay) / (1.0 + decay);
        f64::from(self.residual(at)) / spread * std::f64::consts::LOG2_E - none.log2()
    }

    /// Bits of everything that depends on a value.
    pub(super) fn bits(&self, at: usize) -> f64 {
        let column = (at % self.stride) as i32;
        let dependent = DEPENDENT.iter().filter_map(|(across, up)| {
            let within = (0..self.stride as i32).contains(&(column + across));
            let to = at + up * self.stride;
            within.then(|| to.wrapping_add_signed(*across as isize)).filter(|to| *to < self.values.len())
        });
        dependent.map(|at| self.residual_bits_at(at)).sum()
    }
}
