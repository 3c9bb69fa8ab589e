//! Predictions of weights: values that take few bits.

use nfr::internals::model::gridfit::{AxisWarp, Scale, WARP_STEPS};

/// Bits of a residual: two more for each doubling, as in an Exponential-Golomb code.
fn residual_bits(residual: i32) -> f64 {
    match residual.unsigned_abs() {
        0 => 0.7,
        1 => 3.0,
        r => 2.6 + 2.0 * f64::from(r).log2(),
    }
}

fn round(knot: i16, scale: Scale, s: usize, steps: i32) -> i32 {
    let units = i64::from(scale.units_per_em());
    let product = i64::from(knot) * scale.ppem_of(s) as i64 * i64::from(steps);
    (2 * product + units).div_euclid(2 * units) as i32
}

/// The predictor of each knot of an axis.
pub(super) struct WarpPrediction {
    knots: Vec<i16>,
    scale: Scale,
    predictors: Vec<u8>,
}

impl WarpPrediction {
    pub(super) fn new(warp: &AxisWarp, scale: Scale) -> Self {
        let mut prediction = Self { knots: warp.knots.clone(), scale, predictors: vec![0; warp.knots.len()] };
        for k in 0..warp.knots.len() {
            let mut cost = |predictor: u8| {
                prediction.predictors[k] = predictor;
                (0..scale.sizes()).map(|s| prediction.residual_bits_at(&warp.hinted, s, k)).sum::<f64>()
            };
            let costs = [0, 1, 2, 3].map(|predictor| (cost(predictor), predictor));
            prediction.predictors[k] =
                costs.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |best| best.1);
        }
        prediction
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
}
