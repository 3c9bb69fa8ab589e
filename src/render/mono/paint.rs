//! From the points of an outline to bits.

use alloc::vec::Vec;

use super::grid::Grid;
use super::profiles::{Point, Profiles};
use super::sweep::{Bits, Pass, Sweep};
use crate::constants::MAX_SIDE;
use crate::error::Error;
use crate::limits::{Budget, Limits};
use crate::mono::{MonoBitmap, row_bytes};
use crate::placement::Placement;
use crate::render::glyph::HintedOutline;
use crate::render::outline::check_reach;
use crate::table::Dropout;

/// Working memory of drawing in black and white.
#[derive(Debug, Clone, Default)]
pub(in crate::render) struct Mono {
    pub(super) outline: HintedOutline,
    /// The points of one part.
    pub(super) points: [Vec<i32>; 2],
    profiles: Profiles,
    sweep: Sweep,
    pub(super) bits: Vec<u8>,
}

impl Mono {
    /// Draws the outline, moved by `offset` in 1/64 pixel.
    pub(super) fn draw(
        &mut self,
        ppem: f32,
        mode: Dropout,
        offset: Point,
        glyph: u32,
        limits: &Limits,
    ) -> Result<Placement, Error> {
        let (grid, mut budget) = (Grid::for_size(ppem), Budget::new(glyph, limits));
        let placement = place(&self.outline, offset)?;
        limits.check_sides(placement.width, placement.height)?;
        let Self { outline, profiles, sweep, bits, .. } = self;
        bits.resize(row_bytes(placement.width) * placement.height as usize, 0);
        budget.spend(placement.area() as u64)?;
        let corner = [placement.left, placement.top.saturating_sub(placement.height as i32)];
        let moved = [0, 1].map(|axis| offset[axis] - corner[axis] * 64);
        let mut bits = Bits::new(placement, bits);
        for (pass, [along, across], lines) in
            [(Pass::Rows, [0, 1], placement.height), (Pass::Columns, [1, 0], placement.width)]
        {
            profiles.start(grid, lines);
            let mut start = 0;
            for &end in &outline.ends {
                profiles.contour(end - start, |k| {
                    let at = |axis: usize| grid.position(outline.points[axis][start + k] + moved[axis]);
                    ([at(along), at(across)], outline.on_curve[start + k])
                });
                start = end;
            }
            budget.spend((outline.on_curve.len() + profiles.crossings()) as u64)?;
            if profiles.are_too_many() {
                budget.spend(u64::MAX)?;
            }
            sweep.draw(profiles, mode, pass, &mut bits, &mut budget)?;
        }
        Ok(placement)
    }
}

impl HintedOutline {
    /// Draws it in black and white as an outline of this size in pixels per em.
    ///
    /// # Errors
    ///
    /// `BitmapTooLarge`, `TooMuchWork`.
    pub fn black_and_white(&self, ppem: f32, mode: Dropout) -> Result<MonoBitmap, Error> {
        check_reach(&self.points, [0; 2])?;
        let mut mono = Mono { outline: self.clone(), ..Mono::default() };
        let placement = mono.draw(ppem, mode, [0; 2], 0, &Limits::default())?;
        Ok(MonoBitmap { placement, bits: mono.bits })
    }
}

/// The box that FreeType gives an outline, moved by `offset` in 1/64 pixel: every pixel whose centre lies within the bounds of its
/// points, and one pixel at least (`ft_glyphslot_preset_bitmap`).
fn place(outline: &HintedOutline, offset: Point) -> Result<Placement, Error> {
    if outline.on_curve.is_empty() {
        return Ok(Placement::default());
    }
    let [(left, right), (bottom, top)] = [0, 1].map(|axis| {
        let points = outline.points[axis].iter();
        let [low, high] = points.fold([i32::MAX, i32::MIN], |[low, high], v| [low.min(*v), high.max(*v)]);
        // A centre on a border is inside.
        let [low, high] = [low + offset[axis] + 31, high + offset[axis] + 32];
        match [low >> 6, high >> 6] {
            [first, end] if first < end => (first, end),
            // The pixel with more of what lies between.
            [first, _] if (low & 63) + (high & 63) < 63 => (first - 1, first),
            [first, _] => (first, first + 1),
        }
    });
    let (width, height) = (right.abs_diff(left), top.abs_diff(bottom));
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(Error::BitmapTooLarge { width, height, limit: MAX_SIDE });
    }
    Ok(Placement { left, top, width, height })
}
