//! Hinted points of models against those of the interpreter, in 26.6: whole numbers of 1/64 pixel.

use serde::Serialize;

use crate::error::Error;
use crate::path_points::places;
use crate::teacher::{Outline, Teacher, TeacherAt};
use nfr::internals::{Glyph, HintedOutline};
use nfr::{Font, Limits, Rasterizer};

/// What was compared, and how much of it differs. Counts are of glyphs at a size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct PointTally {
    /// Glyphs at a size.
    pub glyph_sizes: u64,
    /// Those of them whose points are all equal.
    pub equal_glyph_sizes: u64,
    /// Those of them whose contours hinting changes, so that points do not correspond. Their points are not counted.
    pub changed_contours: u64,
    /// Points, on the curve or off it.
    pub points: u64,
    /// Points that differ along x or y.
    pub differing_points: u64,
    /// The largest difference of a point along x or y, or of a side bearing, in 1/64 pixel.
    pub largest_difference: u32,
    /// Hinted advance widths.
    pub advances: u64,
    /// Hinted advance widths that differ.
    pub differing_advances: u64,
    /// Hinted left side bearings, of glyphs that have points.
    pub bearings: u64,
    /// Hinted left side bearings that differ.
    pub differing_bearings: u64,
}

impl PointTally {
    /// Adds another tally to this one.
    pub fn merge(&mut self, other: &Self) {
        self.glyph_sizes += other.glyph_sizes;
        self.equal_glyph_sizes += other.equal_glyph_sizes;
        self.changed_contours += other.changed_contours;
        self.points += other.points;
        self.differing_points += other.differing_points;
        self.largest_difference = self.largest_difference.max(other.largest_difference);
        self.advances += other.advances;
        self.differing_advances += other.differing_advances;
        self.bearings += other.bearings;
        self.differing_bearings += other.differing_bearings;
    }

    /// Whether all points, advance widths and side bearings are equal.
    pub fn is_equal(&self) -> bool {
        let differing = self.differing_advances + self.differing_bearings;
        self.equal_glyph_sizes == self.glyph_sizes && differing == 0
    }
}

/// One glyph, compared at some sizes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct GlyphTally {
    pub(super) gid: u16,
    /// Each size in pixels per em, ascending.
    pub(super) sizes: Vec<(u16, PointTally)>,
}

/// The hinted original and its neural font.
#[derive(Clone, Copy)]
pub(super) struct Compared<'c> {
    pub(super) teacher: &'c Teacher,
    /// The sizes to compare, ascending.
    pub(super) sizes: &'c [TeacherAt],
    pub(super) font: &'c Font,
    pub(super) limits: Limits,
}

impl Compared<'_> {
    /// Compares a glyph that has outlines.
    pub(super) fn glyph(&self, gid: u16, glyph: &Glyph) -> Result<GlyphTally, Error> {
        let unhinted = self.teacher.unhinted_em(gid)?;
        let mut rasterizer = Rasterizer::new(self.font).with_limits(self.limits);
        let mut sizes = Vec::with_capacity(self.sizes.len());
        for at in self.sizes {
            let (hinted, ppem) = (at.hinted(gid)?, f32::from(at.ppem()));
            let model = glyph.hinted_outline(ppem).ok_or(Error::MissingGlyph(gid))?;
            let mut tally = if hinted.has_contours_of(&unhinted) {
                compare(&model, &hinted).ok_or_else(|| contours_differ(gid))?
            } else {
                PointTally { glyph_sizes: 1, changed_contours: 1, ..PointTally::default() }
            };
            if let Some(advance) = hinted.advance {
                tally.advances = 1;
                let differs = in_64ths(advance) != in_64ths(rasterizer.hinted_advance(gid.into(), ppem)?);
                tally.differing_advances = differs.into();
            }
            if let Some(left) = hinted.points.iter().map(|point| in_64ths(point[0])).min() {
                let bearing = in_64ths(rasterizer.hinted_side_bearing(gid.into(), ppem)?);
                tally.bearings = 1;
                tally.differing_bearings = (left != bearing).into();
                tally.largest_difference = tally.largest_difference.max(left.abs_diff(bearing));
            }
            sizes.push((at.ppem(), tally));
        }
        Ok(GlyphTally { gid, sizes })
    }
}

/// Compares a model's points at a size with the hinted outline. None if their contours differ.
pub(super) fn compare(model: &HintedOutline, hinted: &Outline) -> Option<PointTally> {
    let mut start = 0;
    let contours: Vec<_> = model.ends.iter().map(|&end| std::mem::replace(&mut start, end)..end).collect();
    let places = places(&model.on_curve, &contours, hinted.points.len())?;
    let mut tally = PointTally { glyph_sizes: 1, ..PointTally::default() };
    for (point, place) in places.into_iter().enumerate() {
        let Some(place) = place else { continue };
        let off = |axis: usize| model.points[axis][point].abs_diff(in_64ths(hinted.points[place][axis]));
        let difference = off(0).max(off(1));
        tally.points += 1;
        tally.differing_points += u64::from(difference > 0);
        tally.largest_difference = tally.largest_difference.max(difference);
    }
    tally.equal_glyph_sizes = (tally.differing_points == 0).into();
    Some(tally)
}

/// Pixels in 26.6, which the interpreter computes with.
fn in_64ths(pixels: f32) -> i32 {
    (pixels * 64.0).round() as i32
}

fn contours_differ(gid: u16) -> Error {
    Error::InvalidParameter(format!(
        "glyph {gid} has other contours in its model than in the original font; pass the font that the neural one was \
         converted from"
    ))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use skrifa::PathSink;

    use super::*;

    /// A contour of a line and a curve with an implied point.
    fn model() -> HintedOutline {
        let points = [vec![0, 64, 128, 96], vec![0, 0, 64, 128]];
        HintedOutline { points, on_curve: vec![true, true, false, false], ends: vec![4] }
    }

    fn path() -> Outline {
        let mut path = Outline::default();
        path.move_to(0.0, 0.0);
        path.line_to(1.0, 0.0);
        path.quad_to(2.0, 1.0, 1.75, 1.5);
        path.quad_to(1.5, 2.0, 0.0, 0.0);
        path
    }

    #[test]
    fn equal_points_are_equal_and_implied_ones_are_not_counted() {
        let tally = compare(&model(), &path()).unwrap();
        let equal = PointTally { glyph_sizes: 1, equal_glyph_sizes: 1, points: 4, ..PointTally::default() };
        assert_eq!(tally, equal);
    }

    #[test]
    fn a_point_that_is_off_along_either_axis_differs_on_and_off_the_curve() {
        for (axis, point, by) in [(0, 1, 1), (1, 1, -1), (0, 2, 5), (1, 3, -70)] {
            let mut model = model();
            model.points[axis][point] += by;
            let tally = compare(&model, &path()).unwrap();
            assert_eq!((tally.differing_points, tally.largest_difference), (1, by.unsigned_abs()));
            assert_eq!(tally.equal_glyph_sizes, 0);
        }
    }

    #[test]
    fn other_contours_are_not_compared_point_by_point() {
        let mut model = model();
        model.on_curve[2] = true;
        assert_eq!(compare(&model, &path()), None);
    }
}
