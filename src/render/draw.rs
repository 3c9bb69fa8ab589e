//! Drawing models: their outlines are put where hinting puts them at a size, and filled.

use alloc::vec::Vec;

use wide::f32x8;

use super::Placement;
use super::area::{Area, UNIT, rounded};
use super::bitmap::Canvas;
use super::limits::Budget;
use crate::error::Error;
use crate::model::contour::{LANES, Polygons, Tracer};
use crate::model::gridfit::{GridFit, MAX_KNOTS, check_ppem, placement_of};

/// A bitmap with more pixels than this is drawn in strips, so that working memory is bounded.
const STRIP: usize = 1 << 20;

/// Working memory that drawing reuses.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    warps: [Warp; 2],
    /// The number and the weight (units) of each pattern that counts.
    strengths: Vec<(usize, f32)>,
    /// Vertices in units from the bitmap's upper left corner, y down: places along x and y.
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
        if own.area() > 0 && super::union(own, placement) != placement {
            return Err(Error::BufferTooSmall { placement: own, pitch, length: pixels.len() });
        }
        let mut canvas = Canvas::new(placement, pixels, pitch)?;
        let models = core::iter::once((self, [0.0; 2]));
        draw(&models, ppem, placement, scratch, &mut canvas, &mut Budget::unlimited())
    }
}

/// Draws models, each at a place of its own (pixels), into one bitmap that has room for all of them: its pixels are
/// what they cover together.
///
/// # Errors
///
/// `TooMuchWork`.
pub(super) fn draw<'a>(
    models: &(impl Iterator<Item = (&'a GridFit, [f32; 2])> + Clone),
    ppem: f32,
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    budget: &mut Budget,
) -> Result<(), Error> {
    draw_in_strips::<STRIP>(models, ppem, placement, scratch, canvas, budget)
}

fn draw_in_strips<'a, const MOST: usize>(
    models: &(impl Iterator<Item = (&'a GridFit, [f32; 2])> + Clone),
    ppem: f32,
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    budget: &mut Budget,
) -> Result<(), Error> {
    in_strips::<MOST>(placement, scratch, canvas, |strip, scratch| {
        for (model, origin) in models.clone().filter(|(model, _)| !model.is_empty()) {
            let [(left, _), (_, top)] = aim(model, ppem, origin, &mut scratch.warps);
            let offset = [left.saturating_sub(strip.left), strip.top.saturating_sub(top)];
            let offset = offset.map(|pixels| pixels.saturating_mul(UNIT));
            if strip.is_whole {
                fill::<false>(model, ppem, offset, scratch, budget)?;
            } else {
                fill::<true>(model, ppem, offset, scratch, budget)?;
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
        x.extend(vertices.iter().map(|v| rounded(v[0] * UNIT as f32) - shift));
        y.extend(vertices.iter().map(|v| rounded(v[1] * UNIT as f32)));
        budget.spend(area.most_steps(vertices.len()))?;
        let mut done = 0;
        for &end in ends {
            if strip.is_whole {
                area.polygon::<false>(&x[done..end], &y[done..end]);
            } else {
                area.polygon::<true>(&x[done..end], &y[done..end]);
            }
            done = end;
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

/// Draws one model at a place of its own (pixels) into the canvas that `room` gives for its placement, if it gives one.
///
/// # Errors
///
/// As [`GridFit::placement_at`] and `room`, and `TooMuchWork`.
pub(super) fn draw_one<'b>(
    model: &GridFit,
    ppem: f32,
    origin: [f32; 2],
    scratch: &mut Scratch,
    budget: &mut Budget,
    room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
) -> Result<Option<Placement>, Error> {
    check_ppem(ppem)?;
    let own = aim(model, ppem, origin, &mut scratch.warps);
    let placement = placement_of(own)?;
    let Some(mut canvas) = room(placement)? else { return Ok(None) };
    budget.spend(placement.area() as u64)?;
    if placement.area() > STRIP {
        draw(&core::iter::once((model, origin)), ppem, placement, scratch, &mut canvas, budget)?;
    } else {
        scratch.area.start(placement.width as usize, placement.height as usize);
        let filled = fill::<false>(model, ppem, [0; 2], scratch, budget);
        scratch.area.finish(canvas.pitch, canvas.pixels);
        filled?;
    }
    Ok(Some(placement))
}

/// Sets the warps for a model that stands at `origin`. Returns its box: from which pixel to which, along each axis.
fn aim(model: &GridFit, ppem: f32, origin: [f32; 2], [across, along]: &mut [Warp; 2]) -> [(i32, i32); 2] {
    [across.set(model, 0, ppem, origin[0]), along.set(model, 1, ppem, origin[1])]
}

/// Adds the model that the warps are set for, whose box begins `offset` units after the bitmap.
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
    let polygons = model.polygons(ppem, &mut scratch.tracer, &mut scratch.fresh);
    budget.spend(scratch.area.most_steps(polygons.at[0].len()))?;
    scratch.strengths.clear();
    let strengths = model.strengths(ppem).map(|pixels| pixels * UNIT as f32).enumerate();
    scratch.strengths.extend(strengths.filter(|(_, units)| *units != 0.0));
    let ([across, along], [x, y]) = (&scratch.warps, &mut scratch.points);
    across.place(offset[0], &polygons.at[0], &polygons.knots[0], &[], &[], x);
    along.place(offset[1], &polygons.at[1], &polygons.knots[1], &polygons.patterns, &scratch.strengths, y);
    let mut done = 0;
    for &end in &polygons.ends {
        let range = done as usize..end as usize;
        scratch.area.polygon::<CLIP>(&x[range.clone()], &y[range]);
        done = end;
    }
    Ok(())
}

/// The warp of one axis at a size, from em to units from the corner of the model's own box.
#[derive(Debug, Clone)]
struct Warp {
    /// Where the knots are put, in pixels.
    hinted: [f32; MAX_KNOTS],
    /// Below the first knot, between knots, and above the last one: units per em, and where the origin would be.
    pieces: [[f32; 2]; MAX_KNOTS + 1],
    /// Whether there is only one piece.
    straight: bool,
    /// How long the box is, in units. Nothing is drawn beyond it.
    length: f32,
}

impl Default for Warp {
    fn default() -> Self {
        Self { hinted: [0.0; MAX_KNOTS], pieces: [[0.0; 2]; MAX_KNOTS + 1], straight: true, length: 0.0 }
    }
}

impl Warp {
    /// Sets the warp of a model's axis at a size. The model stands at `origin` (pixels). Returns from which pixel to which
    /// its box goes; units are counted from its left border, or its upper one.
    fn set(&mut self, model: &GridFit, axis: usize, ppem: f32, origin: f32) -> (i32, i32) {
        let knots = model.knots(axis);
        let hinted = &mut self.hinted[..knots.len()];
        hinted.iter_mut().zip(model.hinted_knots(axis, ppem)).for_each(|(out, hinted)| *out = hinted);
        let ends = [hinted.first(), hinted.get(1..).and_then(<[f32]>::last)].map(Option::<&f32>::copied);
        let (first, last) = model.pixels(axis, ppem, ends, origin);
        let (corner, units) = if axis == 0 { (first, UNIT as f32) } else { (last, -(UNIT as f32)) };
        let shift = origin - corner as f32;
        self.length = last.saturating_sub(first) as f32 * UNIT as f32;
        self.straight = knots.is_empty();
        let piece =
            |plain: f32, hinted: f32, scale: f32| [scale * units, (hinted - plain * scale + shift) * units];
        let lowest = knots.first().zip(hinted.first());
        self.pieces[0] = lowest.map_or(piece(0.0, 0.0, ppem), |(plain, hinted)| piece(*plain, *hinted, ppem));
        for k in 0..knots.len() {
            let scale = match knots.get(k + 1) {
                Some(next) => (hinted[k + 1] - hinted[k]) / (next - knots[k]),
                None => ppem,
            };
            self.pieces[k + 1] = piece(knots[k], hinted[k], scale);
        }
        (first, last)
    }

    /// Puts vertices in place, in units from what lies `offset` units before the box.
    fn place(
        &self,
        offset: i32,
        at: &[f32],
        knots: &[u8],
        patterns: &[f32],
        strengths: &[(usize, f32)],
        points: &mut Vec<i32>,
    ) {
        let stride = at.len();
        let (low, high) = (f32x8::ZERO, f32x8::splat(self.length));
        let ((at, _), (knots, _)) = (at.as_chunks::<LANES>(), knots.as_chunks::<LANES>());
        points.clear();
        for (block, (at, knots)) in at.iter().zip(knots).enumerate() {
            let mut sum = if self.straight {
                f32x8::new(*at) * self.pieces[0][0] + self.pieces[0][1]
            } else {
                let place = |k: usize| {
                    let [scale, shift] = self.pieces[usize::from(knots[k]).min(MAX_KNOTS)];
                    at[k] * scale + shift
                };
                f32x8::new(core::array::from_fn(place))
            };
            for &(pattern, strength) in strengths {
                if let Some(values) = patterns[pattern * stride + block * LANES..].first_chunk() {
                    sum += f32x8::new(*values) * strength;
                }
            }
            points.extend(sum.fast_max(low).fast_min(high).to_array().map(|units| rounded(units) + offset));
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
