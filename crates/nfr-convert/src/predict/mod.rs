//! Where hinting would put an outline at sizes that the teacher is not asked for.
//!
//! Hint programs are made of a few instructions: round a point to the grid, keep a rounded distance from another
//! point, interpolate between two. So the hinted outlines at the known sizes are searched for such rules, level by
//! level, and each level follows the rule that most speaks for. Sizes near the wanted one count more, since fonts
//! change their minds from size to size.

mod motion;
mod rule;
#[cfg(test)]
mod tests;
mod zones;

use self::motion::{Motion, Track, settle};
use self::rule::View;
use self::zones::{Census, Zone, zones};
use super::teach::{HintedGlyph, Lesson};
use super::teacher::{Teacher, TeacherAt};
use crate::error::Error;
use nfr::internals::model::gridfit::Scale;

/// Predicts the sizes of a scale that are not known.
pub(super) struct Predictor {
    known: Vec<u16>,
    wanted: Vec<Wanted>,
}

struct Wanted {
    ppem: u16,
    view: View,
    /// The font's levels along x and y.
    zones: [Vec<Zone>; 2],
}

impl Predictor {
    /// Looks at how the font hints `gids` at the known `sizes`, to predict the other sizes of `scale`.
    ///
    /// # Errors
    ///
    /// As the teacher's.
    pub(super) fn new(
        teacher: &Teacher,
        sizes: &[TeacherAt],
        scale: Scale,
        gids: &[u16],
    ) -> Result<Self, Error> {
        let known: Vec<u16> = sizes.iter().map(TeacherAt::ppem).collect();
        let all = (0..scale.sizes()).map(|size| scale.ppem_of(size) as u16);
        let wanted: Vec<u16> = all.filter(|ppem| !known.contains(ppem)).collect();
        let mut census = [Census::default(), Census::default()];
        for gid in if wanted.is_empty() { &[] } else { gids } {
            let plain = teacher.unhinted_em(*gid)?.points;
            let hinted = sizes.iter().map(|at| Ok(at.hinted_or_complaint(*gid)?.0.points));
            let hinted = hinted.collect::<Result<Vec<_>, Error>>()?;
            // Glyphs whose structure changes are refused when their turn comes.
            if hinted.iter().all(|points| points.len() == plain.len()) {
                let rows: Vec<&[[f32; 2]]> = hinted.iter().map(Vec::as_slice).collect();
                census.iter_mut().zip(motions(&plain, &rows)).for_each(|(census, axis)| census.count(&axis));
            }
        }
        let levels = census.map(Census::levels);
        let wanted = wanted.into_iter().map(|ppem| {
            let view = View::new(&known, ppem);
            let zones = [0, 1].map(|axis| zones(&levels[axis], &view));
            Wanted { ppem, view, zones }
        });
        Ok(Self { wanted: wanted.collect(), known })
    }

    /// Adds the sizes that are not known to a lesson that has the known ones.
    ///
    /// # Errors
    ///
    /// As [`Outline::rasterize`](crate::outline::Outline::rasterize).
    pub(super) fn complete(&self, lesson: &mut Lesson) -> Result<(), Error> {
        if self.wanted.is_empty() {
            return Ok(());
        }
        let rows: Vec<&[[f32; 2]]> = lesson.sizes.iter().map(|size| size.points.as_slice()).collect();
        let axes = motions(&lesson.outline.points, &rows);
        for wanted in &self.wanted {
            let [x, y] = [0, 1].map(|axis| axes[axis].at(&wanted.view, &wanted.zones[axis]));
            let points: Vec<[f32; 2]> = x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
            let bitmap = lesson.outline.with_points(&points)?.rasterize()?;
            lesson.sizes.push(HintedGlyph { ppem: wanted.ppem, points, bitmap, predicted: true });
        }
        lesson.sizes.sort_by_key(|size| size.ppem);
        Ok(())
    }

    /// The sizes that are known.
    pub(super) fn known(&self) -> &[u16] {
        &self.known
    }

    /// The places along an axis of a part that stands on whole pixels (pixels), at all sizes in order: `plain` is
    /// its offset in em, `places` are those at the known sizes.
    pub(super) fn places(&self, axis: usize, plain: f64, places: &[f64]) -> Vec<f64> {
        let track = Track { plain, hinted: places.to_vec() };
        let mut all: Vec<(u16, f64)> = self.known.iter().copied().zip(places.iter().copied()).collect();
        for wanted in &self.wanted {
            let settled = settle(std::slice::from_ref(&track), &wanted.view, &wanted.zones[axis]);
            all.extend(settled.first().map(|place| (wanted.ppem, place.at.round())));
        }
        all.sort_by_key(|(ppem, _)| *ppem);
        all.into_iter().map(|(_, place)| place).collect()
    }
}

/// Both coordinates of an outline's points: plain ones in em, hinted ones in pixels by known size.
fn motions(plain: &[[f32; 2]], hinted: &[&[[f32; 2]]]) -> [Motion; 2] {
    [0, 1].map(|axis| {
        let of = |points: &[[f32; 2]]| points.iter().map(|point| point[axis]).collect::<Vec<f32>>();
        Motion::new(&of(plain), &hinted.iter().map(|points| of(points)).collect::<Vec<_>>())
    })
}
