//! How well a rule explains where hinting put a level at the known sizes, and where it puts it at another one.

/// Known sizes this far from the wanted one count half, in pixels per em and as a share of the wanted size.
const REACH: (f64, f64) = (2.0, 0.05);
/// What a rule loses that fails at a size next to the wanted one (natural logarithm).
const MISS: f64 = 8.0;
/// Positions this close to a whole pixel (pixels) are on it: hinted points lie on a grid of 1/64 pixel.
const WHOLE: f64 = 0.02;
/// Interpreters round to 1/64 pixel on the way; so much (pixels) is no failure of a rule that does not snap.
const NOISE: f64 = 0.03;
/// Failures of rules that do not snap grow up to this distance (pixels).
const FAILED: f64 = 0.25;
/// How far from the plain position a font rounds: the spread of a Laplace distribution in pixels, and the share
/// of fonts' levels that are rounded from the plain position exactly.
const BIAS: (f64, f64) = (0.3, 0.1);
/// Shares below this are nothing.
const NOTHING: f64 = 1e-12;
/// Positions this close (pixels) are the same vote.
const SAME: f64 = 0.015;

/// A position at the wanted size (pixels) and the logarithm of what speaks for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Vote {
    pub(super) at: f64,
    pub(super) evidence: f64,
}

/// The known sizes as the wanted one sees them.
#[derive(Debug, Clone)]
pub(super) struct View {
    pub(super) sizes: Vec<f64>,
    pub(super) wanted: f64,
    /// The nearest known sizes below and above, by index.
    pub(super) near: [usize; 2],
    /// What a rule loses that fails at each size.
    misses: Vec<f64>,
}

impl View {
    /// `known` is ascending and not empty.
    pub(super) fn new(known: &[u16], wanted: u16) -> Self {
        let sizes: Vec<f64> = known.iter().map(|s| f64::from(*s)).collect();
        let wanted = f64::from(wanted);
        let reach = REACH.0 + REACH.1 * wanted;
        let misses = sizes.iter().map(|s| MISS / (1.0 + ((s - wanted) / reach).powi(2))).collect();
        let above = sizes.partition_point(|s| *s < wanted).min(sizes.len().saturating_sub(1));
        Self { near: [above.saturating_sub(1), above], sizes, wanted, misses }
    }

    /// The evidence for a rule that says `guess(size)` where hinting went to `truth`.
    pub(super) fn evidence(&self, truth: &[f64], guess: impl Fn(usize) -> f64) -> f64 {
        let lost = |(k, miss): (usize, &f64)| {
            miss * (((truth[k] - guess(k)).abs() - NOISE) / FAILED).clamp(0.0, 1.0)
        };
        -self.misses.iter().enumerate().map(lost).sum::<f64>()
    }

    /// The votes of the rule `floor(plain · size + bias + ½)` for the sequence `hinted`, over all biases.
    pub(super) fn snapped(&self, hinted: &[f64], plain: f64, votes: &mut Vec<Vote>) {
        votes.clear();
        let mut edges: Vec<(f64, f64)> = Vec::with_capacity(2 * hinted.len() + 4);
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for ((at, size), miss) in hinted.iter().zip(&self.sizes).zip(&self.misses) {
            let whole = at.round();
            if (at - whole).abs() > WHOLE {
                continue;
            }
            // The biases with which the rule says so at this size.
            let (low, high) = (whole - 0.5 - plain * size, whole + 0.5 - plain * size);
            (from, to) = (from.min(low), to.max(high));
            edges.extend([(low, *miss), (high, -miss)]);
        }
        let pixel = |bias: f64| (plain * self.wanted + bias + 0.5).floor();
        let mut cut = pixel(from) + 0.5 - plain * self.wanted;
        while cut < to {
            edges.push((cut, 0.0));
            cut += 1.0;
        }
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut lost: f64 = self.misses.iter().sum();
        for pair in edges.windows(2) {
            let ((low, miss), (high, _)) = (pair[0], pair[1]);
            lost -= miss;
            let share = prior(low, high);
            if share > NOTHING {
                add(votes, pixel(0.5 * (low + high)), share * (-lost).exp());
            }
        }
        votes.iter_mut().for_each(|vote| vote.evidence = vote.evidence.max(f64::MIN_POSITIVE).ln());
    }
}

/// The probability of a bias in `low..high`.
fn prior(low: f64, high: f64) -> f64 {
    let below = |bias: f64| {
        let tail = 0.5 * (-bias.abs() / BIAS.0).exp();
        if bias < 0.0 { tail } else { 1.0 - tail }
    };
    let none = if low <= 0.0 && 0.0 < high { BIAS.1 } else { 0.0 };
    (1.0 - BIAS.1) * (below(high) - below(low)) + none
}

fn add(votes: &mut Vec<Vote>, at: f64, share: f64) {
    match votes.iter_mut().find(|vote| vote.at == at) {
        Some(vote) => vote.evidence += share,
        None => votes.push(Vote { at, evidence: share }),
    }
}

/// Counts a vote. Rules that agree do not add up: most of them are variants of each other.
pub(super) fn offer(votes: &mut Vec<Vote>, at: f64, evidence: f64) {
    match votes.iter_mut().find(|vote| (vote.at - at).abs() < SAME) {
        Some(vote) => vote.evidence = vote.evidence.max(evidence),
        None => votes.push(Vote { at, evidence }),
    }
}

/// The vote that most speaks for, and the logarithm of its share of all votes.
pub(super) fn best(votes: &[Vote]) -> (Vote, f64) {
    let nothing = Vote { at: 0.0, evidence: f64::NEG_INFINITY };
    let top = votes.iter().copied().max_by(|a, b| a.evidence.total_cmp(&b.evidence)).unwrap_or(nothing);
    (top, -votes.iter().map(|vote| (vote.evidence - top.evidence).exp()).sum::<f64>().ln())
}
