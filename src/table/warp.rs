//! Coding of a warp's hinted positions. Each knot is predicted from its plain position, from the previous sizes and from
//! the knots on both sides of it.

use alloc::vec;
use alloc::vec::Vec;

use super::context_model::{ContextModel, class};
use super::elements::{FRACTION, JUMP, PREDICTOR};
use super::range::Coder;
use crate::error::Damage;
use crate::model::gridfit::{AxisWarp, WARP_STEPS};
use crate::model::sizes::Scale;

/// Hinted positions in a pixel, as a power of two.
const PIXEL: u32 = (WARP_STEPS as u32).ilog2();
/// The number of predictors, as a power of two.
const PREDICTOR_BITS: u32 = 3;
const PREDICTORS: usize = 1 << PREDICTOR_BITS;
/// The number of previous sizes over which predictors average.
const WINDOW: usize = 4;
/// Predictors that the contexts of a residual use.
const SNAP_AGAIN: usize = 0;
const MOVE_AGAIN: usize = 1;
const BETWEEN: usize = 3;
const BETWEEN_AGAIN: usize = 4;

/// A knot and its nearest neighbours among the knots that are coded before it.
#[derive(Debug, Clone, Copy)]
struct Neighbours {
    knot: usize,
    lower: Option<usize>,
    upper: Option<usize>,
}

/// The coding order of knots: the lowest, the highest, then the middle of each gap, wide gaps first.
fn coding_order(count: usize) -> Vec<Neighbours> {
    let mut order = Vec::with_capacity(count);
    if count > 0 {
        order.push(Neighbours { knot: 0, lower: None, upper: None });
    }
    if count > 1 {
        order.push(Neighbours { knot: count - 1, lower: Some(0), upper: None });
    }
    let mut gaps = vec![(0, count.saturating_sub(1))];
    let mut next = 0;
    while let Some(&(lower, upper)) = gaps.get(next) {
        next += 1;
        if upper - lower > 1 {
            let knot = (lower + upper) / 2;
            order.push(Neighbours { knot, lower: Some(lower), upper: Some(upper) });
            gaps.extend([(lower, knot), (knot, upper)]);
        }
    }
    order
}

/// A quotient, rounded to the nearest integer, halves upwards.
fn divide(value: i64, by: i64) -> i32 {
    (2 * value + by).div_euclid(2 * by) as i32
}

/// A position, rounded to whole pixels.
fn pixels(position: i32) -> i32 {
    position.wrapping_add(1 << (PIXEL - 1)) >> PIXEL
}

/// The distance of a position from the nearest whole pixel.
fn off_pixel(position: i32) -> i32 {
    position.wrapping_sub(pixels(position) << PIXEL)
}

/// The plain positions of all knots, size by size.
fn plain(knots: &[i16], scale: Scale) -> Vec<i32> {
    let units = i64::from(scale.units_per_em());
    (0..scale.sizes())
        .flat_map(|s| {
            let steps = (scale.ppem_of(s) as i64) << PIXEL;
            knots.iter().map(move |knot| divide(i64::from(*knot) * steps, units))
        })
        .collect()
}

/// For each size, the largest change of a knot's displacement from the previous size.
pub(super) fn jumps(warp: &AxisWarp, scale: Scale) -> Vec<i32> {
    let count = warp.knots.len();
    let moved: Vec<i32> =
        warp.hinted.iter().zip(plain(&warp.knots, scale)).map(|(h, plain)| h.wrapping_sub(plain)).collect();
    let farthest = |s: usize| {
        let jump = |at: usize| moved[at].wrapping_sub(moved[at - count]).saturating_abs();
        (s * count..(s + 1) * count).map(jump).max().unwrap_or(0)
    };
    (0..scale.sizes()).map(|s| if s == 0 { 0 } else { farthest(s) }).collect()
}

/// The input of the predictors.
struct View<'a> {
    knots: &'a [i16],
    hinted: &'a [i32],
    plain: &'a [i32],
    neighbours: Neighbours,
}

/// The errors of each rule at the previous sizes.
#[derive(Default)]
struct Errors {
    seen: usize,
    errors: [[i32; WINDOW]; 5],
}

/// The rules: the plain position rounded to whole pixels, the plain position, the plain distance from the upper knot, the
/// plain distance from the lower knot, interpolation between the two (TrueType's IUP).
const SNAP: usize = 0;
const PLAIN: usize = 1;
const UPPER: usize = 2;
const LOWER: usize = 3;
const MIDDLE: usize = 4;

impl View<'_> {
    /// The position that each rule gives the knot at a size. A rule without its neighbours falls back to a simpler one.
    fn rules(&self, s: usize) -> [i32; 5] {
        let (count, knot) = (self.knots.len(), self.neighbours.knot);
        let hinted = |k: usize| self.hinted[s * count + k];
        let plain = |k: usize| self.plain[s * count + k];
        let units = |k: usize| i64::from(self.knots[k]);
        let snap = pixels(plain(knot)) << PIXEL;
        let beside = |k: usize| hinted(k).wrapping_add(plain(knot) - plain(k));
        let lower = self.neighbours.lower.map_or(snap, beside);
        let upper = self.neighbours.upper.map_or(lower, beside);
        let middle = match (self.neighbours.lower, self.neighbours.upper) {
            (Some(a), Some(b)) => {
                let span = i64::from(hinted(b).wrapping_sub(hinted(a)));
                hinted(a).wrapping_add(divide(span * (units(knot) - units(a)), units(b) - units(a)))
            }
            _ => lower,
        };
        [snap, plain(knot), upper, lower, middle]
    }
}

impl Errors {
    /// The error of a rule at the previous size.
    fn last(&self, rule: usize) -> i32 {
        if self.seen > 0 { self.errors[rule][(self.seen - 1) % WINDOW] } else { 0 }
    }

    /// The mean error of a rule at the previous sizes, rounded to the nearest integer, halves upwards.
    fn mean(&self, rule: usize) -> i32 {
        let count = self.seen.min(WINDOW) as i32;
        let sum = self.errors[rule].iter().fold(0i32, |sum, error| sum.wrapping_add(*error));
        if count == 0 { 0 } else { sum.wrapping_add(count / 2).div_euclid(count) }
    }

    fn push(&mut self, rules: [i32; 5], hinted: i32) {
        for (error, rule) in self.errors.iter_mut().zip(rules) {
            error[self.seen % WINDOW] = hinted.wrapping_sub(rule);
        }
        self.seen += 1;
    }

    /// The prediction of each predictor.
    fn predict(&self, rules: [i32; 5]) -> [i32; PREDICTORS] {
        let again = |rule: usize| rules[rule].wrapping_add(self.last(rule));
        let lately = |rule: usize| rules[rule].wrapping_add(self.mean(rule));
        let between = |a: i32, b: i32| ((i64::from(a) + i64::from(b)) >> 1) as i32;
        let middle = lately(MIDDLE);
        [
            again(SNAP),
            again(PLAIN),
            rules[UPPER],
            rules[MIDDLE],
            again(MIDDLE),
            middle,
            between(middle, lately(PLAIN)),
            between(lately(UPPER), lately(LOWER)),
        ]
    }
}

/// Codes a warp whose knots are known.
pub(super) fn code<C: Coder>(
    model: &mut ContextModel<'_, C>,
    warp: &mut AxisWarp,
    scale: Scale,
) -> Result<(), Damage> {
    let (count, sizes) = (warp.knots.len(), scale.sizes());
    warp.hinted.resize(count * sizes, 0);
    let plain = plain(&warp.knots, scale);
    for neighbours in coding_order(count) {
        model.check()?;
        let AxisWarp { knots, hinted } = &mut *warp;
        let best =
            if C::WRITES { best(&View { knots, hinted, plain: &plain, neighbours }, sizes) } else { 0 };
        let around = usize::from(neighbours.lower.is_some()) + usize::from(neighbours.upper.is_some());
        let how = model.bits(PREDICTOR, around, PREDICTOR_BITS, best);
        let mut run = Run::new(how);
        let mut errors = Errors::default();
        for s in 0..sizes {
            let view = View { knots, hinted, plain: &plain, neighbours };
            let rules = view.rules(s);
            let at = s * count + neighbours.knot;
            let position = run.code(model, errors.predict(rules), rules[SNAP], plain[at], hinted[at]);
            errors.push(rules, position);
            hinted[at] = position;
        }
    }
    Ok(())
}

/// The predictor whose residuals take the fewest bits, by a rough estimate.
fn best(view: &View<'_>, sizes: usize) -> usize {
    let mut bits = [0u64; PREDICTORS];
    let mut errors = Errors::default();
    for s in 0..sizes {
        let rules = view.rules(s);
        let hinted = view.hinted[s * view.knots.len() + view.neighbours.knot];
        for (bits, predicted) in bits.iter_mut().zip(errors.predict(rules)) {
            let error = hinted.wrapping_sub(predicted);
            let fraction = off_pixel(error).unsigned_abs();
            // About four bits for whole pixels, and one for each bit of the fraction, up to eight.
            let jump = if pixels(error) == 0 { 0 } else { 4 };
            *bits += u64::from(jump + if fraction == 0 { 0 } else { (4 + fraction.ilog2()).min(8) });
        }
        errors.push(rules, hinted);
    }
    (0..PREDICTORS).min_by_key(|how| bits[*how]).unwrap_or(0)
}

/// The state of coding one knot from size to size.
struct Run {
    how: usize,
    /// The last errors of the prediction: whole pixels and fractions.
    jump: i32,
    fractions: [i32; 2],
    /// The running mean of absolute fractions, in 1/16 step.
    mean: i32,
}

impl Run {
    fn new(how: usize) -> Self {
        Self { how, jump: 0, fractions: [0; 2], mean: 32 }
    }

    fn code<C: Coder>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        predictions: [i32; PREDICTORS],
        snap: i32,
        plain: i32,
        position: i32,
    ) -> i32 {
        let predicted = predictions[self.how];
        let error = position.wrapping_sub(predicted);
        let offset = |other: i32| class(other.wrapping_sub(predicted), [-24, -8, 9, 25]);
        let eighth = (plain & 31) as usize / 4;
        let group = match self.how {
            SNAP_AGAIN => 1,
            MOVE_AGAIN => 2,
            _ => 3,
        };
        let again = if self.how == MOVE_AGAIN { SNAP_AGAIN } else { MOVE_AGAIN };
        let contexts = [
            offset(predictions[BETWEEN]) * 9
                + class(self.jump, [0, 1]) * 3
                + class(snap.wrapping_sub(predicted), [-15, 16]),
            eighth + 8 * group,
            offset(predictions[again]) * 8 + eighth,
        ];
        let jump = model.signed(JUMP, contexts, pixels(error));
        let near = predicted.wrapping_add(jump.wrapping_shl(PIXEL));
        let [last, earlier] = self.fractions;
        let size = |fraction: i32| class(fraction.abs(), [1, 2, 4, 7]);
        let side = |other: i32| class(off_pixel(other.wrapping_sub(near)), [-3, 0, 1, 4]);
        let contexts = [
            size(last) * 5 + size(earlier),
            class(self.mean, [4, 8, 16, 24, 40, 64, 96]) * 6
                + size(last).min(2) * 2
                + usize::from(jump != self.jump),
            side(predictions[SNAP_AGAIN]) * 25 + side(predictions[BETWEEN_AGAIN]) * 5 + side(snap),
        ];
        // A fraction larger than a pixel comes from damaged bytes.
        let fraction = model.signed(FRACTION, contexts, off_pixel(error)).clamp(-32, 32);
        self.mean += (fraction.abs() * 16 - self.mean) / 4;
        self.fractions = [fraction, last];
        self.jump = jump;
        near.wrapping_add(fraction)
    }
}
