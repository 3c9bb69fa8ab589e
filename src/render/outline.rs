//! Drawing outlines, with hints or without: they are hinted at a size, flattened and filled.

use alloc::vec::Vec;

use read_fonts::model::glyph::outline::DrawMemory;
use read_fonts::types::GlyphId;

use super::area::Area;

use super::flatten::Polygons;
use super::font::Font;
use super::scratch::Scratch;
use super::strips::{STRIP, in_strips};
use crate::bitmap::Canvas;
use crate::constants::MAX_SIDE;
use crate::error::Error;
use crate::limits::{Budget, Limits};
use crate::model::outline::{OutlineModel, OutlinePoints, OutlineWeights, hint};
use crate::model::sizes::HintedSize;
use crate::number::{UNIT, UNIT_BITS, round};
use crate::options::DrawOptions;
use crate::placement::Placement;

/// The outline of a glyph of a font.
///
/// # Errors
///
/// `NoSuchGlyph`, `MalformedOutline`.
pub(super) fn outline_points(font: &Font, glyph: u32) -> Result<OutlinePoints, Error> {
    if glyph >= font.glyph_count() {
        return Err(Error::NoSuchGlyph(glyph));
    }
    // A blank glyph has an entry, too: no entry means that the outline cannot be read.
    let outline = font.model().outline_glyphs().get(GlyphId::new(glyph));
    let outline = outline.ok_or(Error::MalformedOutline(glyph))?;
    let mut points = OutlinePoints::default();
    outline.draw_unscaled(DrawMemory::default(), &mut points).map_err(|_| Error::MalformedOutline(glyph))?;
    if points.is_unfit { Err(Error::MalformedOutline(glyph)) } else { Ok(points) }
}

/// Draws a glyph's plain outline into the canvas that `room` gives for its placement, if it gives one.
pub(super) fn draw_plain<'b>(
    font: &Font,
    glyph: u32,
    options: DrawOptions,
    limits: &Limits,
    scratch: &mut Scratch,
    room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
) -> Result<Option<Placement>, Error> {
    let options = options.checked()?;
    let points = outline_points(font, glyph)?;
    let model = OutlineModel::new(points, OutlineWeights::default(), font.scale(), 0);
    let model = model.map_err(|damage| damage.of(glyph))?;
    let size = HintedSize { strength: 0.0, ..font.scale().at(options.ppem) };
    let room = |placement: Placement| {
        limits.check_sides(placement.width, placement.height)?;
        room(placement)
    };
    let mut budget = Budget::new(glyph, limits);
    draw_outlines(core::iter::once((&model, [0; 2])), &size, options, scratch, &mut budget, room)
}

/// Draws outlines, each moved by an offset in 1/64 pixel, into the canvas that `room` gives for the placement of all of them,
/// if it gives one. Pixels are what they cover together.
///
/// # Errors
///
/// As `room`, `BitmapTooLarge`, and `TooMuchWork`.
pub(super) fn draw_outlines<'m, 'b>(
    models: impl Iterator<Item = (&'m OutlineModel, [i32; 2])>,
    size: &HintedSize,
    options: DrawOptions,
    scratch: &mut Scratch,
    budget: &mut Budget,
    room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
) -> Result<Option<Placement>, Error> {
    let Scratch { outline: points, polygons, .. } = scratch;
    polygons.clear();
    for (model, offset) in models {
        hint(model, size, points);
        check_reach(points, offset)?;
        polygons.add(&model.points, points, offset);
        if polygons.are_too_many() {
            budget.spend(u64::MAX)?;
        }
    }
    let offset = options.offset.map(|pixels| round(pixels * UNIT as f32));
    let placement = place(polygons, offset)?;
    let Some(mut canvas) = room(placement)? else { return Ok(None) };
    budget.spend(placement.area() as u64)?;
    to_corner(polygons, placement, offset);
    in_strips::<STRIP>(placement, scratch, &mut canvas, |strip, scratch| {
        let Scratch { area, polygons, .. } = scratch;
        budget.spend(area.most_steps(polygons.vertices[0].len()))?;
        if strip.is_whole {
            fill::<false>(area, polygons);
        } else {
            let shift = strip.left.saturating_sub(placement.left).saturating_mul(UNIT);
            polygons.vertices[0].iter_mut().for_each(|x| *x -= shift);
            fill::<true>(area, polygons);
            polygons.vertices[0].iter_mut().for_each(|x| *x += shift);
        }
        Ok(())
    })?;
    Ok(Some(placement))
}

/// Points reach so far from the origin at most, in 1/64 pixel: 262144 pixels.
const MAX_REACH: u32 = 1 << 24;

/// Checks that polygons can be computed in 32 bits.
fn check_reach(points: &[Vec<i32>; 2], offset: [i32; 2]) -> Result<(), Error> {
    let reach = |axis: usize| {
        let points = points[axis].iter().fold(0, |reach, v| reach.max(v.unsigned_abs()));
        points.saturating_add(offset[axis].unsigned_abs())
    };
    let [width, height] = [reach(0), reach(1)];
    if width.max(height) <= MAX_REACH {
        return Ok(());
    }
    Err(Error::BitmapTooLarge { width: width / 64, height: height / 64, limit: MAX_SIDE })
}

fn fill<const CLIP: bool>(area: &mut Area, polygons: &Polygons) {
    let [x, y] = &polygons.vertices;
    let mut start = 0;
    for &end in &polygons.ends {
        area.polygon::<CLIP>(&x[start..end], &y[start..end]);
        start = end;
    }
}

/// The whole pixels that polygons span if they are moved by `offset` units.
fn place(polygons: &Polygons, offset: [i32; 2]) -> Result<Placement, Error> {
    let range = |axis: usize| {
        let vertices = &polygons.vertices[axis];
        let (low, high) =
            vertices.iter().fold((i32::MAX, i32::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        let (low, high) = (low.saturating_add(offset[axis]), high.saturating_add(offset[axis]));
        (low >> UNIT_BITS, high.saturating_add(UNIT - 1) >> UNIT_BITS)
    };
    if polygons.vertices[0].is_empty() {
        return Ok(Placement::default());
    }
    let [(left, right), (bottom, top)] = [range(0), range(1)];
    if left == right || bottom == top {
        return Ok(Placement::default());
    }
    let (width, height) = (right.abs_diff(left), top.abs_diff(bottom));
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(Error::BitmapTooLarge { width, height, limit: MAX_SIDE });
    }
    Ok(Placement { left, top, width, height })
}

/// Makes coordinates those from the placement's upper left corner, y down.
fn to_corner(polygons: &mut Polygons, placement: Placement, offset: [i32; 2]) {
    let (left, top) = (placement.left * UNIT - offset[0], placement.top * UNIT - offset[1]);
    let [x, y] = &mut polygons.vertices;
    x.iter_mut().for_each(|x| *x -= left);
    y.iter_mut().for_each(|y| *y = top - *y);
}
