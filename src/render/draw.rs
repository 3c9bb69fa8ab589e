//! Drawing fields: their outlines are hinted at a size, and filled.

use super::scratch::Scratch;
use super::strips::{STRIP, in_strips};
use crate::bitmap::Canvas;
use crate::error::Error;
use crate::limits::Budget;
use crate::model::gridfit::{GridFit, placement_of};
use crate::model::sizes::HintedSize;
use crate::number::UNIT;
use crate::placement::{Placement, union};

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
        draw(
            &models,
            &self.scale().at(ppem),
            [1; 2],
            placement,
            scratch,
            &mut canvas,
            &mut Budget::unlimited(),
        )
    }
}

/// Draws models, each with its origin (pixels), into one bitmap that has room for all of them, with so many columns and rows
/// a pixel: what they cover together.
///
/// # Errors
///
/// `TooMuchWork`.
pub(super) fn draw<'a>(
    models: &(impl Iterator<Item = (&'a GridFit, [f32; 2])> + Clone),
    size: &HintedSize,
    stretch: [i32; 2],
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    budget: &mut Budget,
) -> Result<(), Error> {
    draw_in_strips::<STRIP>(models, size, stretch, placement, scratch, canvas, budget)
}

fn draw_in_strips<'a, const MOST: usize>(
    models: &(impl Iterator<Item = (&'a GridFit, [f32; 2])> + Clone),
    size: &HintedSize,
    stretch: [i32; 2],
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    budget: &mut Budget,
) -> Result<(), Error> {
    in_strips::<MOST>(placement, scratch, canvas, |strip, scratch| {
        for (model, origin) in models.clone().filter(|(model, _)| !model.is_empty()) {
            let [(left, _), (_, top)] = scratch.hinting.set(model, size, origin);
            let [left, top] = [left.saturating_mul(stretch[0]), top.saturating_mul(stretch[1])];
            let offset = [left.saturating_sub(strip.left), strip.top.saturating_sub(top)];
            let offset = offset.map(|pixels| pixels.saturating_mul(UNIT));
            if strip.is_whole {
                fill::<false>(model, size.ppem, offset, stretch, scratch, budget)?;
            } else {
                fill::<true>(model, size.ppem, offset, stretch, scratch, budget)?;
            }
        }
        Ok(())
    })
}

/// Draws one model, its origin at `origin` (pixels), into the canvas that `room` gives for its placement, if it gives one, with
/// so many columns and rows a pixel.
///
/// # Errors
///
/// As [`GridFit::placement_at`] and `room`, and `TooMuchWork`.
pub(super) fn draw_one<'b>(
    model: &GridFit,
    size: &HintedSize,
    stretch: [i32; 2],
    origin: [f32; 2],
    scratch: &mut Scratch,
    budget: &mut Budget,
    room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
) -> Result<Option<Placement>, Error> {
    let placement = placement_of(scratch.hinting.set(model, size, origin))?.stretched(stretch);
    let Some(mut canvas) = room(placement)? else { return Ok(None) };
    budget.spend(placement.area() as u64)?;
    if placement.area() > STRIP {
        draw(&core::iter::once((model, origin)), size, stretch, placement, scratch, &mut canvas, budget)?;
    } else {
        scratch.area.start(placement.width as usize, placement.height as usize);
        let filled = fill::<false>(model, size.ppem, [0; 2], stretch, scratch, budget);
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
    stretch: [i32; 2],
    scratch: &mut Scratch,
    budget: &mut Budget,
) -> Result<(), Error> {
    let Scratch { hinting, points, tracer, fresh, area, .. } = scratch;
    let samples = stretch[0].max(stretch[1]) as f32;
    let polygons = model.polygons(ppem * samples, tracer, fresh);
    budget.spend(area.most_steps(polygons.at[0].len()))?;
    if stretch == [1; 2] {
        hinting.vertices(polygons, offset, points);
    } else {
        hinting.vertices(polygons, [0; 2], points);
        for axis in [0, 1] {
            points[axis].iter_mut().for_each(|v| *v = *v * stretch[axis] + offset[axis]);
        }
    }
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
