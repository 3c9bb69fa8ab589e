//! A warp's hinted positions: each knot is predicted from its plain position, from the sizes before and from the
//! knots on both sides of it.

use alloc::vec;
use alloc::vec::Vec;

use super::codec;
use super::contexts::{FRACTION, JUMP, Model, PREDICTOR, class};
use super::range::Coder;
use crate::error::Damage;
use crate::model::gridfit::{AxisWarp, Scale, WARP_STEPS};

/// Hinted positions in a pixel, as a power of two.
const PIXEL: u32 = (WARP_STEPS as u32).ilog2();
/// The predictors to choose from, as a power of two.
const PREDICTOR_BITS: u32 = 3;
const PREDICTORS: usize = 1 << PREDICTOR_BITS;
/// A predictor that averages looks back over this many sizes.
const WINDOW: usize = 4;
/// Which predictions a residual's contexts look at.
const SNAP_AGAIN: usize = 0;
const MOVE_AGAIN: usize = 1;
const BETWEEN: usize = 3;
const BETWEEN_AGAIN: usize = 4;

/// A knot and those on both sides of it that are coded before it.
#[derive(Debug, Clone, Copy)]
struct Place {
    knot: usize,
    lower: Option<usize>,
    upper: Option<usize>,
}

/// The order of the knots: the lowest, the highest, then the middle of each gap, wide gaps first.
fn order(count: usize) -> Vec<Place> {
    let mut places = Vec::with_capacity(count);
    if count > 0 {
        places.push(Place { knot: 0, lower: None, upper: None });
    }
    if count > 1 {
        places.push(Place { knot: count - 1, lower: Some(0), upper: None });
    }
    let mut gaps = vec![(0, count.saturating_sub(1))];
    let mut next = 0;
    while let Some(&(lower, upper)) = gaps.get(next) {
        next += 1;
        if upper - lower > 1 {
            let knot = (lower + upper) / 2;
            places.push(Place { knot, lower: Some(lower), upper: Some(upper) });
            gaps.extend([(lower, knot), (knot, upper)]);
        }
    }
    places
}

/// A quotient to the nearest whole number, a half upwards.
fn divide(value: i64, by: i64) -> i32 {
    (2 * value + by).div_euclid(2 * by) as i32
}

/// To the nearest whole pixel.
fn pixels(position: i32) -> i32 {
    position.wrapping_add(1 << (PIXEL - 1)) >> PIXEL
}

/// How far a position is from the nearest whole pixel.
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

/// For each size, the farthest that a knot's displacement is from the one at the size before.
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

/// What the predictors look at.
struct View<'a> {
    knots: &'a [i16],
    hinted: &'a [i32],
    plain: &'a [i32],
    place: Place,
}

/// How far a knot was from where each rule put it, at the last sizes.
#[derive(Default)]
struct Past {
    seen: usize,
    missed: [[i32; WINDOW]; 5],
}

/// The rules: on the nearest whole pixel, at the plain position, as far from the upper knot as in the plain outline,
/// as far from the lower one, in proportion between the two.
const SNAP: usize = 0;
const PLAIN: usize = 1;
const UPPER: usize = 2;
const LOWER: usize = 3;
const MIDDLE: usize = 4;

impl View<'_> {
    /// Where each rule puts the knot at a size. A rule that lacks a knot does as the one that needs less.
    fn rules(&self, s: usize) -> [i32; 5] {
        let (count, knot) = (self.knots.len(), self.place.knot);
        let hinted = |k: usize| self.hinted[s * count + k];
        let plain = |k: usize| self.plain[s * count + k];
        let units = |k: usize| i64::from(self.knots[k]);
        let snap = pixels(plain(knot)) << PIXEL;
        let beside = |k: usize| hinted(k).wrapping_add(plain(knot) - plain(k));
        let lower = self.place.lower.map_or(snap, beside);
        let upper = self.place.upper.map_or(lower, beside);
        let middle = match (self.place.lower, self.place.upper) {
            (Some(a), Some(b)) => {
                let span = i64::from(hinted(b).wrapping_sub(hinted(a)));
                hinted(a).wrapping_add(divide(span * (units(knot) - units(a)), units(b) - units(a)))
            }
            _ => lower,
        };
        [snap, plain(knot), upper, lower, middle]
    }
}

impl Past {
    /// By how much a rule missed at the size before.
    fn last(&self, rule: usize) -> i32 {
        if self.seen > 0 { self.missed[rule][(self.seen - 1) % WINDOW] } else { 0 }
    }

    /// By how much it missed lately, on average, rounded down from a half upwards.
    fn mean(&self, rule: usize) -> i32 {
        let count = self.seen.min(WINDOW) as i32;
        let sum = self.missed[rule].iter().fold(0i32, |sum, missed| sum.wrapping_add(*missed));
        if count == 0 { 0 } else { sum.wrapping_add(count / 2).div_euclid(count) }
    }

    fn push(&mut self, rules: [i32; 5], hinted: i32) {
        for (missed, rule) in self.missed.iter_mut().zip(rules) {
            missed[self.seen % WINDOW] = hinted.wrapping_sub(rule);
        }
        self.seen += 1;
    }

    /// What each predictor says.
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
    model: &mut Model<'_, C>,
    warp: &mut AxisWarp,
    scale: Scale,
) -> Result<(), Damage> {
    let (count, sizes) = (warp.knots.len(), scale.sizes());
    warp.hinted.resize(count * sizes, 0);
    let plain = plain(&warp.knots, scale);
    for place in order(count) {
        codec::check(&model.coder)?;
        let AxisWarp { knots, hinted } = &mut *warp;
        let best = if C::WRITES { best(&View { knots, hinted, plain: &plain, place }, sizes) } else { 0 };
        let around = usize::from(place.lower.is_some()) + usize::from(place.upper.is_some());
        let how = model.bits(PREDICTOR, around, PREDICTOR_BITS, best);
        let mut run = Run::new(how);
        let mut past = Past::default();
        for s in 0..sizes {
            let view = View { knots, hinted, plain: &plain, place };
            let rules = view.rules(s);
            let at = s * count + place.knot;
            let position = run.code(model, past.predict(rules), rules[SNAP], plain[at], hinted[at]);
            past.push(rules, position);
            hinted[at] = position;
        }
    }
    Ok(())
}

/// The predictor whose residuals take the fewest bits, as a rough count has it.
fn best(view: &View<'_>, sizes: usize) -> usize {
    let mut bits = [0u64; PREDICTORS];
    let mut past = Past::default();
    for s in 0..sizes {
        let rules = view.rules(s);
        let hinted = view.hinted[s * view.knots.len() + view.place.knot];
        for (bits, predicted) in bits.iter_mut().zip(past.predict(rules)) {
            let missed = hinted.wrapping_sub(predicted);
            let fraction = off_pixel(missed).unsigned_abs();
            // A whole pixel takes about four bits, a fraction twice its length and no more than eight.
            let jump = if pixels(missed) == 0 { 0 } else { 4 };
            *bits += u64::from(jump + if fraction == 0 { 0 } else { (4 + fraction.ilog2()).min(8) });
        }
        past.push(rules, hinted);
    }
    (0..PREDICTORS).min_by_key(|how| bits[*how]).unwrap_or(0)
}

/// One knot from size to size.
struct Run {
    how: usize,
    /// The last whole pixels and fractions by which the prediction missed.
    jump: i32,
    fractions: [i32; 2],
    /// The running mean of a fraction's size, in 1/16 step.
    mean: i32,
}

impl Run {
    fn new(how: usize) -> Self {
        Self { how, jump: 0, fractions: [0; 2], mean: 32 }
    }

    fn code<C: Coder>(
        &mut self,
        model: &mut Model<'_, C>,
        predictions: [i32; PREDICTORS],
        snap: i32,
        plain: i32,
        position: i32,
    ) -> i32 {
        let predicted = predictions[self.how];
        let missed = position.wrapping_sub(predicted);
        let beyond = |other: i32| class(other.wrapping_sub(predicted), [-24, -8, 9, 25]);
        let eighth = (plain & 31) as usize / 4;
        let family = match self.how {
            SNAP_AGAIN => 1,
            MOVE_AGAIN => 2,
            _ => 3,
        };
        let again = if self.how == MOVE_AGAIN { SNAP_AGAIN } else { MOVE_AGAIN };
        let contexts = [
            beyond(predictions[BETWEEN]) * 9
                + class(self.jump, [0, 1]) * 3
                + class(snap.wrapping_sub(predicted), [-15, 16]),
            eighth + 8 * family,
            beyond(predictions[again]) * 8 + eighth,
        ];
        let jump = model.signed(JUMP, contexts, pixels(missed));
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
        // Only damage makes a fraction larger than a pixel.
        let fraction = model.signed(FRACTION, contexts, off_pixel(missed)).clamp(-32, 32);
        self.mean += (fraction.abs() * 16 - self.mean) / 4;
        self.fractions = [fraction, last];
        self.jump = jump;
        near.wrapping_add(fraction)
    }
}
