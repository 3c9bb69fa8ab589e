//! An outline at a size: scaled, and grid-fitted.

use alloc::vec::Vec;
use core::ops::Range;

use super::levels::Contour;
use super::weights::{AxisHints, Correction, OutlineModel, UNTOUCHED};
use crate::model::sizes::{HintedSize, Scale};
use crate::number::{UNIT_BITS, div_fixed, mul_fixed, round};

/// The factor from font units to 1/64 pixel, in 1/65536, as FreeType computes it. Sizes are rounded to 1/64 pixel.
pub fn scale_of(ppem: f32, units_per_em: u16) -> i32 {
    div_fixed(round(ppem * 64.0), units_per_em.into())
}

/// The points of a model at a size, in units of 1/256 pixel from the glyph's origin, y up.
pub fn hint(model: &OutlineModel, size: &HintedSize, points: &mut [Vec<i32>; 2]) {
    let units_per_em = model.scale.units_per_em();
    let is_hinted = size.strength > 0.0 && model.has_size(size.index);
    for (axis, (hints, out)) in model.weights.axes.iter().zip(points).enumerate() {
        // An axis that hinting does not touch follows the size itself.
        let moves_axis = is_hinted && (axis == 1 || hints.is_hinted);
        let scale = scale_of(if moves_axis { size.trained_ppem } else { size.ppem }, units_per_em);
        let units = &model.points.coordinates[axis];
        out.clear();
        if is_hinted && !hints.is_hinted && model.scale.is_postscript() {
            out.extend(units.iter().map(|v| in_units(rounded_down((*v).into(), scale))));
        } else if moves_axis {
            out.resize(units.len(), 0);
            let interpolation = Interpolation::of(axis, &model.scale);
            let tracks =
                Tracks::new(hints, hints.moves_at(size.index), &model.points.on_curve, interpolation);
            for contour in model.points.contours() {
                tracks.place(units, contour, scale, out);
            }
            correct(hints.corrections_at(size.index), out);
        } else {
            out.extend(units.iter().map(|v| in_units(mul_fixed((*v).into(), scale))));
        }
    }
}

/// Units in 1/64 pixel, as a shift.
const FRACTION_BITS: i32 = UNIT_BITS - 6;

/// From 1/64 pixel to units of 1/256 pixel.
pub fn in_units(position: i32) -> i32 {
    position.wrapping_shl(FRACTION_BITS as u32)
}

/// From units of 1/256 pixel to 1/64 pixel, to the nearest, halves up.
pub fn in_64ths(position: i32) -> i32 {
    position.wrapping_add(1 << (FRACTION_BITS - 1)) >> FRACTION_BITS
}

fn correct(corrections: &[Correction], out: &mut [i32]) {
    for correction in corrections {
        if let Some(at) = out.get_mut(usize::from(correction.point)) {
            *at = in_units(in_64ths(*at).wrapping_add(correction.by.into()));
        }
    }
}

/// A coordinate in 1/64 pixel, rounded down as FreeType does it where it hints PostScript outlines: the scale becomes one of whole
/// pixels first (`cf2_getScaleAndHintFlag` and `cf2_builder_lineTo`).
pub fn rounded_down(units: i32, scale: i32) -> i32 {
    ((i64::from(units) * ((i64::from(scale) + 32) / 64)) >> 10) as i32
}

/// What moves the points that no track moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// The two points of tracks beside them on their contour, as `IUP` does (OpenType 1.9, "TrueType instruction set", IUP; with
    /// FreeType's roundings).
    Contour,
    /// The two tracks whose levels are beside theirs, on whichever contour, as PostScript's hints do: a glyph's stems make a
    /// piecewise-linear map of heights (Adobe Technical Note #5177, "The Type 2 charstring format"; FreeType's `pshints.c`).
    Level,
}

impl Interpolation {
    /// That of an axis of a font's models.
    pub fn of(axis: usize, scale: &Scale) -> Self {
        if axis == 1 && scale.is_postscript() { Self::Level } else { Self::Contour }
    }
}

/// Tracks at a size.
#[derive(Debug, Clone, Copy)]
pub struct Tracks<'a> {
    pub(super) levels: &'a [i16],
    pub(super) track_of: &'a [u8],
    pub(super) moves: &'a [i16],
    pub(super) is_local: &'a [bool],
    pub(super) on_curve: &'a [bool],
    interpolation: Interpolation,
}

impl<'a> Tracks<'a> {
    /// Tracks that are moved so far from their scaled levels, in 1/64 pixel.
    pub fn new(
        hints: &'a AxisHints,
        moves: &'a [i16],
        on_curve: &'a [bool],
        interpolation: Interpolation,
    ) -> Self {
        Self {
            levels: &hints.levels,
            track_of: &hints.track_of,
            is_local: &hints.is_local,
            moves,
            on_curve,
            interpolation,
        }
    }

    /// Puts the points of a contour in their places, in units of 1/256 pixel. `scale` leads from font units to 1/64 pixel, in 1/65536.
    pub fn place(&self, units: &[i16], contour: Range<usize>, scale: i32, out: &mut [i32]) {
        let (Some(own), Some(places)) = (units.get(contour.clone()), out.get_mut(contour.clone())) else {
            return;
        };
        match self.interpolation {
            Interpolation::Contour => {
                for (place, units) in places.iter_mut().zip(own) {
                    *place = mul_fixed((*units).into(), scale);
                }
                if !self.moves.is_empty() {
                    move_contour(units, contour.clone(), self.track_of, self.moves, out);
                }
                out[contour].iter_mut().for_each(|place| *place = in_units(*place));
            }
            Interpolation::Level => Contour { tracks: self, units, scale }.place(contour, out),
        }
    }
}

/// A point that a track has moved: its coordinate in font units, and its plain and its hinted position.
type Touched = (i32, i32, i32);

/// Moves the points of a contour: those of tracks by their tracks' moves, the others as `IUP` does.
fn move_contour(units: &[i16], contour: Range<usize>, track_of: &[u8], moves: &[i16], out: &mut [i32]) {
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
