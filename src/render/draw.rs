//! Drawing models: their outlines are put where hinting puts them at a size, and filled.

use wide::f32x8;

use super::Placement;
use super::area::{Area, UNIT, rounded};
use super::glyph::buffer_for;
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
    pub fn draw(&self, ppem: f32, placement: Placement, scratch: &mut Scratch, pixels: &mut [u8]) {
        draw(&std::iter::once((self, [0.0; 2])), ppem, placement, scratch, pixels);
    }
}

/// Draws models, each at a place of its own (pixels), into one bitmap that has room for all of them: its pixels are
/// what they cover together.
pub fn draw<'a>(
    models: &(impl Iterator<Item = (&'a GridFit, [f32; 2])> + Clone),
    ppem: f32,
    placement: Placement,
    scratch: &mut Scratch,
    pixels: &mut [u8],
) {
    draw_in_strips::<STRIP>(models, ppem, placement, scratch, pixels);
}

/// Draws in strips of columns, each of which has up to so many pixels, but one column at least.
fn draw_in_strips<'a, const MOST: usize>(
    models: &(impl Iterator<Item = (&'a GridFit, [f32; 2])> + Clone),
    ppem: f32,
    placement: Placement,
    scratch: &mut Scratch,
    pixels: &mut [u8],
) {
    let (width, height) = (placement.width as usize, placement.height as usize);
    if width == 0 || height == 0 {
        return;
    }
    let strip = (MOST / height).clamp(1, width);
    for column in (0..width).step_by(strip) {
        scratch.area.start(strip.min(width - column), height);
        for (model, origin) in models.clone() {
            if !model.is_empty() {
                let corner = [placement.left + column as i32, placement.top];
                if strip == width {
                    add::<false>(model, ppem, origin, corner, scratch);
                } else {
                    add::<true>(model, ppem, origin, corner, scratch);
                }
            }
        }
        scratch.area.finish(width, &mut pixels[column..]);
    }
}

/// Draws one model at a place of its own (pixels) into the beginning of `pixels`.
///
/// # Errors
///
/// As [`GridFit::placement_at`], and `InvalidParameter` for a buffer that is too small.
pub(super) fn draw_one(
    model: &GridFit,
    ppem: f32,
    origin: [f32; 2],
    scratch: &mut Scratch,
    pixels: &mut [u8],
) -> Result<Placement, Error> {
    if model.is_empty() {
        return model.placement_at(ppem, origin);
    }
    check_ppem(ppem)?;
    let own = aim(model, ppem, origin, &mut scratch.warps);
    let placement = placement_of(own, ppem)?;
    let pixels = buffer_for(placement, pixels)?;
    if placement.area() > STRIP {
        draw(&std::iter::once((model, origin)), ppem, placement, scratch, pixels);
    } else {
        scratch.area.start(placement.width as usize, placement.height as usize);
        fill::<false>(model, ppem, [0; 2], scratch);
        scratch.area.finish(placement.width as usize, pixels);
    }
    Ok(placement)
}

/// Adds a model that stands at `origin` to a bitmap with its upper left corner at `corner`, both in pixels.
fn add<const CLIP: bool>(
    model: &GridFit,
    ppem: f32,
    origin: [f32; 2],
    corner: [i32; 2],
    scratch: &mut Scratch,
) {
    let [(left, _), (_, top)] = aim(model, ppem, origin, &mut scratch.warps);
    let offset = [left.saturating_sub(corner[0]), corner[1].saturating_sub(top)];
    fill::<CLIP>(model, ppem, offset.map(|pixels| pixels.saturating_mul(UNIT)), scratch);
}

/// Sets the warps for a model that stands at `origin`. Returns its box: from which pixel to which, along each axis.
fn aim(model: &GridFit, ppem: f32, origin: [f32; 2], [across, along]: &mut [Warp; 2]) -> [(i32, i32); 2] {
    [across.set(model, 0, ppem, origin[0]), along.set(model, 1, ppem, origin[1])]
}

/// Adds the model that the warps are set for, whose box begins `offset` units after the bitmap.
fn fill<const CLIP: bool>(model: &GridFit, ppem: f32, offset: [i32; 2], scratch: &mut Scratch) {
    let polygons = model.polygons(ppem, &mut scratch.tracer, &mut scratch.fresh);
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
                f32x8::new(std::array::from_fn(place))
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
