//! Corrections of single points, coded after the positions of a size.

use alloc::vec::Vec;

use crate::error::Damage;
use crate::model::outline::{AxisHints, Correction, UNTOUCHED};
use crate::table::context_model::ContextModel;
use crate::table::elements::{CORRECTED, CORRECTED_SIZE, CORRECTION};
use crate::table::range::Coder;

/// The corrections of an axis while they are coded.
pub(super) struct Corrections {
    pub(super) axis: usize,
    pub(super) is_used: bool,
    /// How far each point is corrected at the size before.
    before: Vec<i16>,
    /// Whether any was.
    any_before: bool,
    /// Those that were read.
    pub(super) list: Vec<Correction>,
    points: usize,
}

impl Corrections {
    pub(super) fn new(axis: usize, hints: &AxisHints, points: usize, writes: bool) -> Self {
        let is_used = writes && !hints.corrections.is_empty();
        Self { axis, is_used, before: Vec::new(), any_before: false, list: Vec::new(), points }
    }

    /// Forgets the size before.
    pub(super) fn restart(&mut self) {
        self.any_before = false;
        self.before.fill(0);
    }

    pub(super) fn code<C: Coder>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        size: usize,
        hints: &mut AxisHints,
    ) -> Result<(), Damage> {
        self.before.resize(self.points, 0);
        let wanted = if C::WRITES { hints.corrections_at(size) } else { &[] };
        let any = model.flag(
            CORRECTED_SIZE,
            [self.axis * 2 + usize::from(self.any_before), 0, 0],
            !wanted.is_empty(),
        );
        self.any_before = any;
        if !any {
            self.before.fill(0);
            return Ok(());
        }
        model.check()?;
        // Those of the point before at this size, and at the size before.
        let (mut last, mut last_before) = (0, 0);
        for point in 0..self.points {
            let by = wanted.iter().find(|c| usize::from(c.point) == point).map_or(0, |c| i32::from(c.by));
            let is_touched = hints.track_of.get(point).is_some_and(|track| *track != UNTOUCHED);
            let before = self.before[point];
            let context = usize::from(before != 0) * 4 + usize::from(is_touched) * 2 + usize::from(last != 0);
            let by = if model.flag(CORRECTED, [context, 0, 0], by != 0) {
                let (predicted, context) = predicted(before.into(), last, last_before);
                let by = model.signed(CORRECTION, [context, 0, 0], by - predicted);
                predicted.wrapping_add(by).clamp(i16::MIN.into(), i16::MAX.into())
            } else {
                0
            };
            (last, last_before) = (by, before.into());
            self.before[point] = by as i16;
            if by != 0 && !C::WRITES {
                self.list.push(Correction { size: size as u16, point: point as u16, by: by as i16 });
            }
        }
        Ok(())
    }
}

/// What a correction is like, and the context of the rest: that of the point before, changed as from size to size, or that of the size
/// before. Those that are 0 are none.
fn predicted(before: i32, last: i32, last_before: i32) -> (i32, usize) {
    let predicted = match (before, last, last_before) {
        (_, 0, _) => before,
        (0, ..) | (.., 0) => last,
        _ => last + before - last_before,
    };
    (predicted, 2 * usize::from(last != 0) + usize::from(before != 0))
}
