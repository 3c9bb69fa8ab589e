//! The hinted points of a glyph, for whoever compares them with those of an interpreter.

use alloc::vec::Vec;

use super::Glyph;
use crate::error::Error;
use crate::model::outline::{OutlineModel, hint, in_64ths};
use crate::model::sizes::HintedSize;
use crate::options::DrawOptions;
use crate::render::outline::check_reach;

/// A glyph's outline at a size: the points that are filled, those of all parts one after the other.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct HintedOutline {
    /// Positions along x and y in 1/64 pixel from the glyph's origin, y up.
    pub points: [Vec<i32>; 2],
    /// Whether each point is on the curve; the others are control points of quadratic curves.
    pub on_curve: Vec<bool>,
    /// Where each contour ends.
    pub ends: Vec<usize>,
}

impl HintedOutline {
    /// Removes all points, and keeps their memory.
    pub(crate) fn clear(&mut self) {
        self.points.iter_mut().for_each(Vec::clear);
        self.on_curve.clear();
        self.ends.clear();
    }

    /// Adds a model's points at a size, moved by an offset in 1/64 pixel. `points` is working memory.
    ///
    /// # Errors
    ///
    /// `BitmapTooLarge` for points that are too far away to compute with.
    pub(crate) fn add(
        &mut self,
        model: &OutlineModel,
        size: &HintedSize,
        offset: [i32; 2],
        points: &mut [Vec<i32>; 2],
    ) -> Result<(), Error> {
        hint(model, size, points);
        check_reach(points, offset)?;
        let start = self.on_curve.len();
        for ((all, part), offset) in self.points.iter_mut().zip(points).zip(offset) {
            all.extend(part.iter().map(|v| in_64ths(*v) + offset));
        }
        self.on_curve.extend(&model.points.on_curve);
        self.ends.extend(model.points.ends.iter().map(|end| start + usize::from(*end)));
        Ok(())
    }
}

impl Glyph {
    /// The hinted outline at a size in pixels per em. None for a glyph that a field or a network draws, which has no points, and for
    /// one whose points are too far away to compute with.
    pub fn hinted_outline(&self, ppem: f32) -> Option<HintedOutline> {
        let (mut outline, mut points) = (HintedOutline::default(), [Vec::new(), Vec::new()]);
        self.outline_at(DrawOptions::new(ppem), &mut outline, &mut points).ok()?.map(|_| outline)
    }

    /// Adds the points at a size, and says how they are hinted. None for a glyph that a field or a network draws. `points` is working
    /// memory.
    ///
    /// # Errors
    ///
    /// `BitmapTooLarge` for points that are too far away to compute with.
    pub(crate) fn outline_at(
        &self,
        options: DrawOptions,
        outline: &mut HintedOutline,
        points: &mut [Vec<i32>; 2],
    ) -> Result<Option<HintedSize>, Error> {
        let Some(outlines) = self.outlines() else { return Ok(None) };
        let Some((size, parts)) = outlines.at(options) else {
            return Ok(Some(HintedSize::plain(options.ppem())));
        };
        for (model, offset) in parts {
            outline.add(model, &size, offset, points)?;
        }
        Ok(Some(size))
    }
}
