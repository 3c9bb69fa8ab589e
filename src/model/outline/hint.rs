//! An outline at a size: scaled, and grid-fitted.

use alloc::vec::Vec;
use core::ops::Range;

use super::points::OutlinePoints;
use super::weights::{AxisHints, OutlineModel, UNTOUCHED};
use crate::model::sizes::HintedSize;
use crate::number::{div_fixed, mul_fixed, round};

/// The factor from font units to 1/64 pixel, in 1/65536, as FreeType computes it. Sizes are rounded to 1/64 pixel.
pub fn scale_of(ppem: f32, units_per_em: u16) -> i32 {
    div_fixed(round(ppem * 64.0), units_per_em.into())
}

/// The points of a model at a size, in 1/64 pixel from the glyph's origin, y up.
pub fn hint(model: &OutlineModel, size: &HintedSize, points: &mut [Vec<i32>; 2]) {
    let units = model.scale.units_per_em();
    let is_hinted = size.strength > 0.0 && model.has_size(size.index);
    for (axis, (hints, out)) in model.weights.axes.iter().zip(points).enumerate() {
        // An axis that hinting does not touch follows the size itself.
        let moves_axis = is_hinted && (axis == 1 || hints.is_hinted);
        let scale = scale_of(if moves_axis { size.trained_ppem } else { size.ppem }, units);
        let units = &model.points.coordinates[axis];
        if is_hinted && !hints.is_hinted && model.scale.is_postscript() {
            scaled(units, out, |v| rounded_down(v, scale));
        } else {
            scaled(units, out, |v| mul_fixed(v.into(), scale));
        }
        if moves_axis {
            move_points(&model.points, axis, hints, size.index, out);
        }
    }
}

fn scaled(coordinates: &[i16], out: &mut Vec<i32>, to: impl Fn(i16) -> i32) {
    out.clear();
    out.extend(coordinates.iter().map(|v| to(*v)));
}

/// A coordinate in 1/64 pixel, rounded down as FreeType does it where it hints PostScript outlines: the scale becomes one of whole
/// pixels first (`cf2_getScaleAndHintFlag` and `cf2_builder_lineTo`).
pub fn rounded_down(units: i16, scale: i32) -> i32 {
    ((i64::from(units) * ((i64::from(scale) + 32) / 64)) >> 10) as i32
}

/// Moves the points of tracks, interpolates the others, and corrects some.
fn move_points(points: &OutlinePoints, axis: usize, hints: &AxisHints, size: usize, out: &mut [i32]) {
    let moves = hints.moves_at(size);
    if !moves.is_empty() {
        let units = &points.coordinates[axis];
        for contour in points.contours() {
            move_contour(units, contour, &hints.track_of, moves, out);
        }
    }
    for correction in hints.corrections_at(size) {
        if let Some(at) = out.get_mut(usize::from(correction.point)) {
            *at += i32::from(correction.by);
        }
    }
}

/// A point that a track has moved: its coordinate in font units, and its plain and its hinted position.
type Touched = (i32, i32, i32);

/// Moves the points of a contour: those of tracks by their tracks' moves, the others as `IUP` does (OpenType 1.9, "TrueType
/// instruction set", IUP; with FreeType's roundings).
pub fn move_contour(units: &[i16], contour: Range<usize>, track_of: &[u8], moves: &[i16], out: &mut [i32]) {
    let Some(tracks) = track_of.get(contour.clone()) else { return };
    let Some(first) = tracks.iter().position(|track| *track != UNTOUCHED) else { return };
    let touch = |at: usize, out: &mut [i32]| {
        let moved = moves.get(usize::from(track_of[at])).map_or(0, |moved| i32::from(*moved));
        let plain = out[at];
        out[at] += moved;
        (units[at].into(), plain, out[at])
    };
    let first_at = contour.start + first;
    let start = touch(first_at, out);
    let mut last = (first_at, start);
    for (at, track) in (contour.start..).zip(tracks).skip(first + 1) {
        if *track != UNTOUCHED {
            let here = touch(at, out);
            between(units, last.0 + 1..at, [last.1, here], out);
            last = (at, here);
        }
    }
    between(units, last.0 + 1..contour.end, [last.1, start], out);
    between(units, contour.start..first_at, [last.1, start], out);
}

/// Interpolates untouched points between the two touched ones beside them.
fn between(units: &[i16], range: Range<usize>, ends: [Touched; 2], out: &mut [i32]) {
    if range.is_empty() {
        return;
    }
    let gap = Gap::new(ends);
    for at in range {
        out[at] = gap.at(units[at].into(), out[at]);
    }
}

/// The position of what lies at `units` in a gap between two touched points.
pub fn interpolated(ends: [Touched; 2], units: i32, plain: i32) -> i32 {
    Gap::new(ends).at(units, plain)
}

/// Two touched points, the one with the lower coordinate first.
struct Gap {
    a: Touched,
    b: Touched,
    /// 1/64 pixel for a font unit, in 1/65536; 0 where both are at one coordinate or at one position.
    slope: i32,
}

impl Gap {
    fn new([a, b]: [Touched; 2]) -> Self {
        let (a, b) = if a.0 > b.0 { (b, a) } else { (a, b) };
        let is_flat = a.2 == b.2 || a.0 == b.0;
        Self { a, b, slope: if is_flat { 0 } else { div_fixed(b.2.wrapping_sub(a.2), b.0 - a.0) } }
    }

    fn at(&self, units: i32, plain: i32) -> i32 {
        let (a, b) = (self.a, self.b);
        if plain <= a.1 {
            plain.wrapping_add(a.2.wrapping_sub(a.1))
        } else if plain >= b.1 {
            plain.wrapping_add(b.2.wrapping_sub(b.1))
        } else {
            a.2.wrapping_add(mul_fixed(units - a.0, self.slope))
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
