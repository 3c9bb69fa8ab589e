//! Points that follow the tracks of the levels beside theirs, as PostScript's hints move them.
//!
//! The stems of a glyph make a piecewise-linear map of heights (FreeType's `pshints.c`, `cf2_hintmap_map`), and the points of cubic
//! curves are moved by it. The quadratic curves that stand for a cubic one are moved as it is: the moves of their control points are
//! the same linear combinations of its points' moves that the control points are of its points.

use core::ops::Range;

use super::iup::interpolated;
use super::places::in_units;
use super::weights::{AxisHints, UNTOUCHED};
use crate::number::mul_fixed;

/// The most control points between two points on the curve that stand for one cubic curve.
const MAX_CONTROLS: usize = 8;
/// Levels between font units are counted in so many parts of one.
const PARTS: i32 = 16;

/// The points of a contour whose tracks move levels. Places are in units of 1/256 pixel.
pub(super) struct Contour<'a> {
    pub(super) hints: &'a AxisHints,
    /// How far each track is moved from its scaled level, in 1/64 pixel.
    pub(super) moves: &'a [i16],
    /// Whether each point is on the curve.
    pub(super) on_curve: &'a [bool],
    /// The coordinates of all points, in font units.
    pub(super) units: &'a [i16],
    /// From font units to 1/64 pixel, in 1/65536.
    pub(super) scale: i32,
}

/// Where a track is: its level in parts of a font unit, its plain place and its hinted place.
type Knot = (i32, i32, i32);

impl Contour<'_> {
    /// Puts the points of a contour, which `units` and `out` have, in their places.
    pub(super) fn place(&self, contour: Range<usize>, out: &mut [i32]) {
        for at in contour.clone() {
            out[at] = self.track(at).map_or_else(|| self.moved(self.level(at)), |(_, _, hinted)| hinted);
        }
        let on_curve = |at: usize| self.on_curve.get(at).copied().unwrap_or(true);
        let Some(first) = contour.clone().find(|at| on_curve(*at)) else { return };
        let (start, count) = (contour.start, contour.len());
        let point = |step: usize| start + (first - start + step) % count;
        let mut from = 0;
        for to in (1..=count).filter(|step| on_curve(point(*step))) {
            if (1..=MAX_CONTROLS).contains(&(to - from - 1)) {
                self.place_curve([from, to], point, out);
            }
            from = to;
        }
    }

    /// A point's level.
    fn level(&self, point: usize) -> i32 {
        i32::from(self.units[point]) * PARTS
    }

    /// The track of a point, if one moves it.
    fn track(&self, point: usize) -> Option<Knot> {
        let track = self.hints.track_of.get(point).filter(|track| **track != UNTOUCHED)?;
        self.knot(usize::from(*track))
    }

    fn knot(&self, track: usize) -> Option<Knot> {
        let (units, moved) = (i32::from(*self.hints.levels.get(track)?), *self.moves.get(track)?);
        let hinted = in_units(mul_fixed(units, self.scale).wrapping_add(moved.into()));
        Some((units * PARTS, self.plain(units * PARTS), hinted))
    }

    /// The scaled place of a level.
    fn plain(&self, level: i32) -> i32 {
        let scaled = i64::from(level) * i64::from(in_units(self.scale)) / i64::from(PARTS);
        ((scaled + 0x8000) >> 16) as i32
    }

    /// Where the tracks below and above a level move it.
    fn moved(&self, level: i32) -> i32 {
        let plain = self.plain(level);
        let above = self.hints.levels.partition_point(|other| i32::from(*other) * PARTS <= level);
        let is_knot = |track: &usize| !self.hints.is_local.get(*track).is_some_and(|is_local| *is_local);
        let lower = (0..above).rev().find(is_knot).and_then(|track| self.knot(track));
        let upper = (above..self.hints.levels.len()).find(is_knot).and_then(|track| self.knot(track));
        match (lower, upper) {
            (Some(a), _) if a.0 == level => a.2,
            (Some(a), Some(b)) => interpolated([a, b], level, plain),
            (Some(a), None) | (None, Some(a)) => plain.wrapping_add(a.2.wrapping_sub(a.1)),
            (None, None) => plain,
        }
    }

    /// Moves the control points that stand for a cubic curve between two points on the curve, which are in their places.
    fn place_curve(&self, ends: [usize; 2], point: impl Fn(usize) -> usize, out: &mut [i32]) {
        let count = ends[1] - ends[0] - 1;
        let [a, b] = ends.map(&point);
        // The control points of the cubic curve, from the tangents at its ends.
        let control = |end: usize, next: usize| {
            let (end, next) = (self.level(end), self.level(next));
            end + (next - end) * 2 * count as i32 / 3
        };
        let levels = [control(a, point(ends[0] + 1)), control(b, point(ends[1] - 1))];
        let moved = levels.map(|level| self.moved(level).wrapping_sub(self.plain(level)));
        let [from, to] = [a, b].map(|at| out[at].wrapping_sub(self.plain(self.level(at))));
        let moves = [from, moved[0], moved[1], to].map(i64::from);
        for index in 0..count {
            let at = point(ends[0] + 1 + index);
            if self.track(at).is_none() {
                let moved = control_of(&moves, count as i64, index as i64);
                out[at] = self.plain(self.level(at)).wrapping_add(moved as i32);
            }
        }
    }
}

/// One control point of `count` quadratic curves that stand for a cubic one (fontTools' `cu2qu`, `cubic_approx_spline`): the cubic curve is
/// cut into equal parts of its parameter, and each part has a control point between those that the tangents at its ends give. Halves
/// are rounded up.
fn control_of([a, b, c, d]: &[i64; 4], count: i64, index: i64) -> i64 {
    // A point at k / count and the way to the next one along the tangent, times count³.
    let at = |k: i64| {
        let rest = count - k;
        rest * rest * rest * a + 3 * rest * rest * k * b + 3 * rest * k * k * c + k * k * k * d
    };
    let step = |k: i64| {
        let rest = count - k;
        3 * (rest * rest * (b - a) + 2 * rest * k * (c - b) + k * k * (d - c))
    };
    let after = 2 * at(index) + step(index);
    let before = 2 * at(index + 1) - step(index + 1);
    let (share, of) = if count > 1 { (index, count - 1) } else { (1, 2) };
    let divisor = 2 * count * count * count * of;
    (after * (of - share) + before * share + divisor / 2).div_euclid(divisor)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
