//! The hinted points of a glyph, for whoever compares them with those of an interpreter.

use alloc::vec::Vec;

use super::Glyph;
use crate::model::outline::hint;

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

impl Glyph {
    /// The hinted outline at a size in pixels per em. None for a glyph that a field or a network draws, which has no points.
    pub fn hinted_outline(&self, ppem: f32) -> Option<HintedOutline> {
        let outlines = self.outlines()?;
        let mut whole = HintedOutline::default();
        let mut points = [Vec::new(), Vec::new()];
        for (model, part) in &outlines.parts {
            let size = model.scale.at(ppem);
            hint(model, &size, &mut points);
            let offset = part.offset_at(&size, model.scale.units_per_em());
            let start = whole.on_curve.len();
            for ((all, part), offset) in whole.points.iter_mut().zip(&points).zip(offset) {
                all.extend(part.iter().map(|v| v.saturating_add(offset)));
            }
            whole.on_curve.extend(&model.points.on_curve);
            whole.ends.extend(model.points.ends.iter().map(|end| start + usize::from(*end)));
        }
        Some(whole)
    }
}
