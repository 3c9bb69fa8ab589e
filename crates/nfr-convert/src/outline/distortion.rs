//! The error of the pixels that misplaced points make: the area between the outline and the true one, in pixels.

use super::samples::OutlineSamples;
use crate::options::Fidelity;
use nfr::internals::model::outline::{AxisHints, Interpolation, Tracks, in_64ths, in_units};

/// What a misplaced point costs along one axis, with the hinted positions and what the tracks make of them.
pub(super) struct Distortion<'s> {
    samples: &'s OutlineSamples,
    axis: usize,
    /// For each point: how far its contour goes along the other axis around it, in font units: half the extent of the edges at it.
    extents: Vec<f64>,
    /// The points of each contour.
    contours: Vec<std::ops::Range<usize>>,
    /// A point may be this far from its hinted position at no cost, in 1/64 pixel.
    noise: f64,
}

/// What each point costs at least, in font units for an em of 1000, so that points within straight lines count.
const LEAST_EXTENT: f64 = 4.0;

impl<'s> Distortion<'s> {
    pub(super) fn new(
        samples: &'s OutlineSamples,
        axis: usize,
        units_per_em: u16,
        fidelity: Fidelity,
    ) -> Self {
        let noise = noise(samples, axis, fidelity);
        let other = &samples.points.coordinates[1 - axis];
        let least = LEAST_EXTENT * f64::from(units_per_em) / 1000.0;
        let mut extents = vec![0.0; samples.points.len()];
        for contour in samples.points.contours() {
            let count = contour.len();
            for k in 0..count {
                let [a, b] = [k, (k + 1) % count].map(|k| contour.start + k);
                let extent = f64::from(other[a].abs_diff(other[b])) * 0.5;
                extents[a] += extent;
                extents[b] += extent;
            }
        }
        extents.iter_mut().for_each(|extent| *extent += least);
        Self { samples, axis, extents, contours: samples.points.contours().collect(), noise }
    }

    /// The contours that a track of some points moves. A local track moves these points alone.
    pub(super) fn contours_of(&self, points: &[u16], is_local: bool) -> Vec<usize> {
        if self.samples.interpolation(self.axis) == Interpolation::Level && !is_local {
            return (0..self.contours.len()).collect();
        }
        let holds = |contour: usize| points.iter().any(|p| self.contours[contour].contains(&usize::from(*p)));
        (0..self.contours.len()).filter(|contour| holds(*contour)).collect()
    }

    /// The number of contours.
    pub(super) fn contour_count(&self) -> usize {
        self.contours.len()
    }

    /// The error of a contour over all sizes, in pixels.
    pub(super) fn of_contour(&self, contour: usize, hints: &AxisHints) -> f64 {
        (0..self.samples.sizes()).map(|size| self.at(contour, size, hints, None)).sum()
    }

    /// The error of all contours over all sizes, in pixels.
    pub(super) fn of_all(&self, hints: &AxisHints) -> f64 {
        (0..self.contour_count()).map(|contour| self.of_contour(contour, hints)).sum()
    }

    /// The error of a contour at a size; `moved` is a track, and how much farther it is moved.
    fn at(&self, contour: usize, size: usize, hints: &AxisHints, moved: Option<(usize, i16)>) -> f64 {
        let range = self.contours[contour].clone();
        let mut places = vec![0; self.samples.points.len()];
        let units = &self.samples.points.coordinates[self.axis];
        let mut moves = hints.moves_at(size).to_vec();
        if let Some((track, by)) = moved {
            moves[track] += by;
        }
        let tracks =
            Tracks::new(hints, &moves, &self.samples.points.on_curve, self.samples.interpolation(self.axis));
        tracks.place(units, range.clone(), self.samples.scales[size], &mut places);
        for correction in hints.corrections_at(size) {
            let place = &mut places[usize::from(correction.point)];
            *place = in_units(in_64ths(*place) + i32::from(correction.by));
        }
        let pixels = f64::from(self.samples.scales[size]) / (65536.0 * 64.0);
        let hinted = self.samples.hinted_at(self.axis, size);
        let apart = |p: usize| {
            let units = places[p].abs_diff(in_units(hinted[p]));
            (f64::from(units) / f64::from(in_units(1)) - self.noise).max(0.0)
        };
        let errors = range.map(|p| apart(p) / 64.0 * self.extents[p]);
        errors.sum::<f64>() * pixels
    }

    /// How much error, in pixels, a point that is off by 1/64 pixel makes at a size.
    pub(super) fn of_point(&self, point: usize, size: usize) -> f64 {
        self.extents[point] * f64::from(self.samples.scales[size]) / (65536.0 * 64.0 * 64.0)
    }

    /// How much error, in pixels, a track's move by 1/64 pixel makes at each size, if all points are right.
    pub(super) fn weights(&self, hints: &AxisHints, track: usize) -> Vec<f64> {
        const BY: i16 = 16;
        let own = |p: &usize| usize::from(hints.track_of[*p]) == track;
        let points: Vec<u16> = (0..hints.track_of.len()).filter(own).map(|p| p as u16).collect();
        let is_local = hints.is_local.get(track).is_some_and(|is_local| *is_local);
        let contours = self.contours_of(&points, is_local);
        let weight = |size: usize| {
            let change = |contour: &usize| {
                let there = self.at(*contour, size, hints, Some((track, BY)));
                (there - self.at(*contour, size, hints, None)).max(0.0)
            };
            contours.iter().map(change).sum::<f64>() / f64::from(BY)
        };
        (0..self.samples.sizes()).map(weight).collect()
    }
}

/// Each point of a PostScript outline is rounded down by itself, which moves it by half of 1/64 pixel on average, and by up to this much more or
/// less. Along a curve the difference evens out.
const ROUNDING: f64 = 0.5;

/// How far a point may be from its hinted position along an axis at no cost, in 1/64 pixel.
pub(super) fn noise(samples: &OutlineSamples, axis: usize, fidelity: Fidelity) -> f64 {
    let follows_stems = samples.interpolation(axis) == Interpolation::Level && !fidelity.is_exact();
    if follows_stems { ROUNDING } else { 0.0 }
}
