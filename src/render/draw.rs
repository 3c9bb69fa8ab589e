//! Drawing models: their outlines are hinted at a size, and filled.

use alloc::vec::Vec;

use super::area::Area;
use crate::bitmap::Canvas;
use crate::error::Error;
use crate::limits::Budget;
use crate::model::contour::{Polygons, Tracer};
use crate::model::gridfit::{GridFit, placement_of};
use crate::model::hinting::Hinting;
use crate::model::sizes::HintedSize;
use crate::number::{UNIT, round};
use crate::placement::{Placement, union};

/// A bitmap with more pixels than this is drawn in strips, so that working memory is bounded.
const STRIP: usize = 1 << 20;

/// Working memory that drawing reuses.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    hinting: Hinting,
    /// Vertices in units from the bitmap's upper left corner, y down: coordinates along x and y.
    points: [Vec<i32>; 2],
    tracer: Tracer,
    fresh: Polygons,
    area: Area,
}

impl GridFit {
    /// Draws the pixels of `placement` at a size: those of the model's own placement, or more around them. `pixels`
    /// has `placement.area()` bytes, top row first.
    ///
    /// # Errors
    ///
    /// As [`GridFit::placement`], and `BufferTooSmall` for a placement that does not hold the model's own, or fewer
    /// pixels than it has.
    pub fn draw(
        &self,
        ppem: f32,
        placement: Placement,
        scratch: &mut Scratch,
        pixels: &mut [u8],
    ) -> Result<(), Error> {
        let (own, pitch) = (self.placement(ppem)?, placement.width as usize);
        if own.area() > 0 && union(own, placement) != placement {
            return Err(Error::BufferTooSmall { placement: own, pitch, length: pixels.len() });
        }
        let mut canvas = Canvas::new(placement, pixels, pitch)?;
        let models = core::iter::once((self, [0.0; 2]));
        draw(&models, &self.scale().at(ppem), placement, scratch, &mut canvas, &mut Budget::unlimited())
    }
}

/// Draws models, each with its origin (pixels), into one bitmap that has room for all of them: its pixels are
/// what they cover together.
///
/// # Errors
///
/// `TooMuchWork`.
pub(super) fn draw<'a>(
    models: &(impl Iterator<Item = (&'a GridFit, [f32; 2])> + Clone),
    size: &HintedSize,
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    budget: &mut Budget,
) -> Result<(), Error> {
    draw_in_strips::<STRIP>(models, size, placement, scratch, canvas, budget)
}

fn draw_in_strips<'a, const MOST: usize>(
    models: &(impl Iterator<Item = (&'a GridFit, [f32; 2])> + Clone),
    size: &HintedSize,
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    budget: &mut Budget,
) -> Result<(), Error> {
    in_strips::<MOST>(placement, scratch, canvas, |strip, scratch| {
        for (model, origin) in models.clone().filter(|(model, _)| !model.is_empty()) {
            let [(left, _), (_, top)] = scratch.hinting.set(model, size, origin);
            let offset = [left.saturating_sub(strip.left), strip.top.saturating_sub(top)];
            let offset = offset.map(|pixels| pixels.saturating_mul(UNIT));
            if strip.is_whole {
                fill::<false>(model, size.ppem, offset, scratch, budget)?;
            } else {
                fill::<true>(model, size.ppem, offset, scratch, budget)?;
            }
        }
        Ok(())
    })
}

/// Draws closed polygons, given by their vertices in pixels from the bitmap's upper left corner, y down, and by where
/// each of them ends in that list; the inside is on the left as seen with y up. All vertices lie within the bitmap.
///
/// # Errors
///
/// `TooMuchWork`.
pub(super) fn draw_polygons(
    vertices: &[[f32; 2]],
    ends: &[usize],
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    budget: &mut Budget,
) -> Result<(), Error> {
    in_strips::<STRIP>(placement, scratch, canvas, |strip, scratch| {
        let shift = (strip.left - placement.left) * UNIT;
        let Scratch { points: [x, y], area, .. } = scratch;
        x.clear();
        y.clear();
        x.extend(vertices.iter().map(|v| round(v[0] * UNIT as f32) - shift));
        y.extend(vertices.iter().map(|v| round(v[1] * UNIT as f32)));
        budget.spend(area.most_steps(vertices.len()))?;
        let mut start = 0;
        for &end in ends {
            if strip.is_whole {
                area.polygon::<false>(&x[start..end], &y[start..end]);
            } else {
                area.polygon::<true>(&x[start..end], &y[start..end]);
            }
            start = end;
        }
        Ok(())
    })
}

/// Some columns of a bitmap.
struct Strip {
    /// The pixel in the upper left corner.
    left: i32,
    top: i32,
    /// Whether these are all columns.
    is_whole: bool,
}

/// Draws in strips of columns, each of which has up to so many pixels, but one column at least.
fn in_strips<const MOST: usize>(
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    mut add: impl FnMut(&Strip, &mut Scratch) -> Result<(), Error>,
) -> Result<(), Error> {
    let (width, height) = (placement.width as usize, placement.height as usize);
    if width == 0 || height == 0 {
        return Ok(());
    }
    let columns = (MOST / height).clamp(1, width);
    for column in (0..width).step_by(columns) {
        scratch.area.start(columns.min(width - column), height);
        let left = placement.left.saturating_add(column as i32);
        let strip = Strip { left, top: placement.top, is_whole: columns == width };
        let added = add(&strip, scratch);
        // Also after an error, so that nothing is left for the next bitmap.
        scratch.area.finish(canvas.pitch, &mut canvas.pixels[column..]);
        added?;
    }
    Ok(())
}

/// Draws one model, its origin at `origin` (pixels), into the canvas that `room` gives for its placement, if it gives one.
///
/// # Errors
///
/// As [`GridFit::placement_at`] and `room`, and `TooMuchWork`.
pub(super) fn draw_one<'b>(
    model: &GridFit,
    size: &HintedSize,
    origin: [f32; 2],
    scratch: &mut Scratch,
    budget: &mut Budget,
    room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
) -> Result<Option<Placement>, Error> {
    let placement = placement_of(scratch.hinting.set(model, size, origin))?;
    let Some(mut canvas) = room(placement)? else { return Ok(None) };
    budget.spend(placement.area() as u64)?;
    if placement.area() > STRIP {
        draw(&core::iter::once((model, origin)), size, placement, scratch, &mut canvas, budget)?;
    } else {
        scratch.area.start(placement.width as usize, placement.height as usize);
        let filled = fill::<false>(model, size.ppem, [0; 2], scratch, budget);
        scratch.area.finish(canvas.pitch, canvas.pixels);
        filled?;
    }
    Ok(Some(placement))
}

/// Adds a model that is hinted, whose box begins `offset` units after the bitmap.
///
/// # Errors
///
/// `TooMuchWork`.
fn fill<const CLIP: bool>(
    model: &GridFit,
    ppem: f32,
    offset: [i32; 2],
    scratch: &mut Scratch,
    budget: &mut Budget,
) -> Result<(), Error> {
    let Scratch { hinting, points, tracer, fresh, area } = scratch;
    let polygons = model.polygons(ppem, tracer, fresh);
    budget.spend(area.most_steps(polygons.at[0].len()))?;
    hinting.vertices(polygons, offset, points);
    let mut start = 0;
    for &end in &polygons.ends {
        let range = start as usize..end as usize;
        area.polygon::<CLIP>(&points[0][range.clone()], &points[1][range]);
        start = end;
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
