//! The likelihood of a hinting rule, given the hinted positions at the known sizes, and its position at another size.

/// Known sizes at this distance from the wanted one have half the weight: in pixels per em, plus a share of the wanted size.
const HALF_WEIGHT: (f64, f64) = (2.0, 0.05);
/// The log-likelihood that a rule loses if it fails at the wanted size.
const PENALTY: f64 = 8.0;
/// Positions this close to a whole pixel are on it (pixels): hinted points lie on a grid of 1/64 pixel.
const WHOLE: f64 = 0.02;
/// Deviations up to this are no failure of a rule without rounding (pixels): interpreters round intermediate results to
/// 1/64 pixel.
const NOISE: f64 = 0.03;
/// The deviation beyond `NOISE` at which a rule without rounding has failed entirely (pixels).
const FAILURE: f64 = 0.25;
/// The prior of the bias that is added before rounding: the scale of a Laplace distribution in pixels, and the probability
/// of no bias at all.
const BIAS: (f64, f64) = (0.3, 0.1);
/// Biases less probable than this are ignored.
const NEGLIGIBLE: f64 = 1e-12;
/// Positions this close are the same candidate (pixels).
const SAME: f64 = 0.015;

/// A position at the wanted size (pixels) that a rule predicts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Candidate {
    pub(super) at: f64,
    pub(super) log_likelihood: f64,
}

/// The known sizes, weighted by their distance from the wanted one.
#[derive(Debug, Clone)]
pub(super) struct WeightedSizes {
    /// The known sizes in pixels per em, ascending.
    pub(super) ppem: Vec<f64>,
    /// The wanted size in pixels per em.
    pub(super) wanted: f64,
    /// The nearest known sizes below and above, by index.
    pub(super) near: [usize; 2],
    /// The log-likelihood that a rule loses if it fails at each known size.
    penalties: Vec<f64>,
}

impl WeightedSizes {
    /// `known` is ascending and not empty.
    pub(super) fn new(known: &[u16], wanted: u16) -> Self {
        let ppem: Vec<f64> = known.iter().map(|s| f64::from(*s)).collect();
        let wanted = f64::from(wanted);
        let half_weight = HALF_WEIGHT.0 + HALF_WEIGHT.1 * wanted;
        let penalties = ppem.iter().map(|s| PENALTY / (1.0 + ((s - wanted) / half_weight).powi(2))).collect();
        let above = ppem.partition_point(|s| *s < wanted).min(ppem.len().saturating_sub(1));
        Self { near: [above.saturating_sub(1), above], ppem, wanted, penalties }
    }

    /// The log-likelihood of a rule that predicts `rule(size)` for the hinted positions `truth`.
    pub(super) fn log_likelihood(&self, truth: &[f64], rule: impl Fn(usize) -> f64) -> f64 {
        let loss = |(k, penalty): (usize, &f64)| {
            penalty * (((truth[k] - rule(k)).abs() - NOISE) / FAILURE).clamp(0.0, 1.0)
        };
        -self.penalties.iter().enumerate().map(loss).sum::<f64>()
    }

    /// The candidates of the rule `floor(unhinted · size + bias + ½)` for the sequence `hinted`: the likelihood of each
    /// position is integrated over all biases. The hinted sequence fixes an interval of biases at each size; between the
    /// sorted ends of these intervals, the likelihood is constant.
    pub(super) fn rounded(&self, hinted: &[f64], unhinted: f64, candidates: &mut Vec<Candidate>) {
        candidates.clear();
        let mut edges: Vec<(f64, f64)> = Vec::with_capacity(2 * hinted.len() + 4);
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for ((at, size), penalty) in hinted.iter().zip(&self.ppem).zip(&self.penalties) {
            let whole = at.round();
            if (at - whole).abs() > WHOLE {
                continue;
            }
            // The biases for which the rule gives the hinted position at this size.
            let (low, high) = (whole - 0.5 - unhinted * size, whole + 0.5 - unhinted * size);
            (from, to) = (from.min(low), to.max(high));
            edges.extend([(low, *penalty), (high, -penalty)]);
        }
        let pixel = |bias: f64| (unhinted * self.wanted + bias + 0.5).floor();
        let mut cut = pixel(from) + 0.5 - unhinted * self.wanted;
        while cut < to {
            edges.push((cut, 0.0));
            cut += 1.0;
        }
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut loss: f64 = self.penalties.iter().sum();
        for pair in edges.windows(2) {
            let ((low, penalty), (high, _)) = (pair[0], pair[1]);
            loss -= penalty;
            let probability = prior(low, high);
            if probability > NEGLIGIBLE {
                accumulate(candidates, pixel(0.5 * (low + high)), probability * (-loss).exp());
            }
        }
        for candidate in candidates {
            candidate.log_likelihood = candidate.log_likelihood.max(f64::MIN_POSITIVE).ln();
        }
    }
}

/// The prior probability of a bias in `low..high`.
fn prior(low: f64, high: f64) -> f64 {
    let below = |bias: f64| {
        let tail = 0.5 * (-bias.abs() / BIAS.0).exp();
        if bias < 0.0 { tail } else { 1.0 - tail }
    };
    let none = if low <= 0.0 && 0.0 < high { BIAS.1 } else { 0.0 };
    (1.0 - BIAS.1) * (below(high) - below(low)) + none
}

/// Adds to the likelihood, not yet its logarithm, of a position.
fn accumulate(candidates: &mut Vec<Candidate>, at: f64, likelihood: f64) {
    match candidates.iter_mut().find(|candidate| candidate.at == at) {
        Some(candidate) => candidate.log_likelihood += likelihood,
        None => candidates.push(Candidate { at, log_likelihood: likelihood }),
    }
}

/// Adds a rule's candidate. Of rules that agree the likeliest counts, not their sum: most are variants of each other.
pub(super) fn add_candidate(candidates: &mut Vec<Candidate>, at: f64, log_likelihood: f64) {
    match candidates.iter_mut().find(|candidate| (candidate.at - at).abs() < SAME) {
        Some(candidate) => candidate.log_likelihood = candidate.log_likelihood.max(log_likelihood),
        None => candidates.push(Candidate { at, log_likelihood }),
    }
}

/// The likeliest candidate, and the logarithm of its probability among all candidates.
pub(super) fn likeliest(candidates: &[Candidate]) -> (Candidate, f64) {
    let none = Candidate { at: 0.0, log_likelihood: f64::NEG_INFINITY };
    let best = candidates.iter().copied().max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood));
    let best = best.unwrap_or(none);
    let relative = |candidate: &Candidate| (candidate.log_likelihood - best.log_likelihood).exp();
    (best, -candidates.iter().map(relative).sum::<f64>().ln())
}
