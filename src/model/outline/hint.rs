//! An outline at a size: scaled, and grid-fitted.

use alloc::vec::Vec;
use core::ops::Range;

use super::iup::move_contour;
use super::levels::Contour;
use super::places::{in_64ths, in_units, rounded_down, scale_of};
use super::weights::{AxisHints, Correction, OutlineModel};
use crate::model::sizes::{HintedSize, Scale};
use crate::number::mul_fixed;

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

fn correct(corrections: &[Correction], out: &mut [i32]) {
    for correction in corrections {
        if let Some(at) = out.get_mut(usize::from(correction.point)) {
            *at = in_units(in_64ths(*at).wrapping_add(correction.by.into()));
        }
    }
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
    hints: &'a AxisHints,
    moves: &'a [i16],
    on_curve: &'a [bool],
    interpolation: Interpolation,
}

impl<'a> Tracks<'a> {
    /// Tracks that are moved so far from their scaled levels, in 1/64 pixel, and which points are on the curve.
    pub fn new(
        hints: &'a AxisHints,
        moves: &'a [i16],
        on_curve: &'a [bool],
        interpolation: Interpolation,
    ) -> Self {
        Self { hints, moves, on_curve, interpolation }
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
                    move_contour(units, contour.clone(), &self.hints.track_of, self.moves, out);
                }
                out[contour].iter_mut().for_each(|place| *place = in_units(*place));
            }
            Interpolation::Level => {
                let Self { hints, moves, on_curve, .. } = *self;
                Contour { hints, moves, on_curve, units, scale }.place(contour, out);
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
