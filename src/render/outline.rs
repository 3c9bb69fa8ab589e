//! Drawing outlines, with hints or without: they are hinted at a size, flattened and filled.

use alloc::vec::Vec;

use super::area::Area;

use super::flatten::{Polygons, Precision};
use super::font::Font;
use super::scratch::Scratch;
use super::strips::{STRIP, in_strips};
use crate::bitmap::Canvas;
use crate::constants::MAX_SIDE;
use crate::error::Error;
use crate::limits::{Budget, Limits};
use crate::model::outline::{OutlineModel, OutlinePoints, OutlineWeights, hint, in_64ths};
use crate::model::sizes::{HintedSize, Origin};
use crate::number::{UNIT, UNIT_BITS, round};
use crate::options::DrawOptions;
use crate::placement::Placement;

/// Reads the outline of a glyph of a font.
///
/// # Errors
///
/// `NoSuchGlyph`, `MalformedOutline`.
pub(super) fn read_outline(font: &Font, glyph: u32) -> Result<OutlinePoints, Error> {
    if glyph >= font.glyph_count() {
        return Err(Error::NoSuchGlyph(glyph));
    }
    let read = font.outline_tables().and_then(|(outlines, hmtx)| outlines.load(&hmtx, glyph));
    read.filter(|points| !points.is_unfit).ok_or(Error::MalformedOutline(glyph))
}

/// A glyph's plain outline as a model.
///
/// # Errors
///
/// `NoSuchGlyph`, `MalformedOutline`.
pub(super) fn plain_model(font: &Font, glyph: u32) -> Result<OutlineModel, Error> {
    let model = OutlineModel::new(read_outline(font, glyph)?, OutlineWeights::default(), font.scale(), 0..0);
    model.map_err(|damage| damage.of(glyph))
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
    let model = plain_model(font, glyph)?;
    let size = HintedSize::plain(options.ppem);
    let room = |placement: Placement| {
        limits.check_sides(placement.width, placement.height)?;
        room(placement)
    };
    let mut budget = Budget::new(glyph, limits);
    flatten(core::iter::once((&model, [0; 2])), &size, options.sampling.stretch, scratch, &mut budget)?;
    draw_flattened(options, scratch, &mut budget, room)
}

/// Hints outlines at a size, each moved by an offset in 1/64 pixel, and makes them the polygons of `scratch`, so many times as wide
/// and as high.
///
/// # Errors
///
/// `BitmapTooLarge` and `TooMuchWork`.
pub(super) fn flatten<'m>(
    models: impl Iterator<Item = (&'m OutlineModel, [i32; 2])>,
    size: &HintedSize,
    stretch: [i32; 2],
    scratch: &mut Scratch,
    budget: &mut Budget,
) -> Result<(), Error> {
    let Scratch { outline: points, polygons, .. } = scratch;
    polygons.clear();
    for (model, offset) in models {
        hint(model, size, points);
        check_reach(points, offset)?;
        let is_fine = size.strength > 0.0 && model.scale.origin() != Origin::TrueType;
        let precision = if is_fine { Precision::FINE } else { Precision::TRUE_TYPE };
        polygons.add(&model.points, points, offset, stretch, precision);
        if polygons.are_too_many() {
            budget.spend(u64::MAX)?;
        }
    }
    polygons.measure();
    Ok(())
}

/// The leftmost point of outlines at a size, in 1/64 pixel. None if they have no points.
///
/// # Errors
///
/// `BitmapTooLarge`.
pub(super) fn leftmost<'m>(
    models: impl Iterator<Item = (&'m OutlineModel, [i32; 2])>,
    size: &HintedSize,
    scratch: &mut Scratch,
) -> Result<Option<i32>, Error> {
    let mut left = None;
    for (model, offset) in models {
        hint(model, size, &mut scratch.outline);
        check_reach(&scratch.outline, offset)?;
        let own = scratch.outline[0].iter().min().map(|x| in_64ths(*x) + offset[0]);
        left = left.min(own).or(own).or(left);
    }
    Ok(left)
}

/// Draws the polygons of `scratch` into the canvas that `room` gives for their placement, if it gives one. Pixels are what
/// they cover together.
///
/// # Errors
///
/// As `room`, `BitmapTooLarge`, and `TooMuchWork`.
fn draw_flattened<'b>(
    options: DrawOptions,
    scratch: &mut Scratch,
    budget: &mut Budget,
    room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
) -> Result<Option<Placement>, Error> {
    let polygons = core::mem::take(&mut scratch.polygons);
    let drawn = draw_polygons(&polygons, options, scratch, budget, room);
    scratch.polygons = polygons;
    drawn
}

/// Draws polygons into the canvas that `room` gives for their placement, if it gives one. Pixels are what they cover
/// together.
///
/// # Errors
///
/// As `room`, `BitmapTooLarge`, and `TooMuchWork`.
pub(super) fn draw_polygons<'b>(
    polygons: &Polygons,
    options: DrawOptions,
    scratch: &mut Scratch,
    budget: &mut Budget,
    room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
) -> Result<Option<Placement>, Error> {
    let (stretch, moved) = (options.sampling.stretch, options.moved());
    let offset = [0, 1].map(|axis| round(moved[axis] * UNIT as f32) * stretch[axis]);
    let placement = place(polygons, offset)?;
    let Some(mut canvas) = room(placement)? else { return Ok(None) };
    budget.spend(placement.area() as u64)?;
    let bottom = (placement.top - placement.height as i32) * UNIT - offset[1];
    in_strips::<STRIP>(placement, scratch, &mut canvas, |strip, scratch| {
        let area = &mut scratch.area;
        budget.spend(area.most_steps(polygons.vertices[0].len()))?;
        let corner = [strip.left * UNIT - offset[0], bottom];
        if strip.is_whole && !cfg!(feature = "small") {
            fill::<false>(area, polygons, corner);
        } else {
            fill::<true>(area, polygons, corner);
        }
        Ok(())
    })?;
    Ok(Some(placement))
}

/// Points reach so far from the origin at most, in 1/64 pixel: 262144 pixels.
const MAX_REACH: u32 = 1 << 24;

/// Checks that polygons can be computed in 32 bits.
pub(super) fn check_reach(points: &[Vec<i32>; 2], offset: [i32; 2]) -> Result<(), Error> {
    let reach = |axis: usize| {
        let points = points[axis].iter().fold(0, |reach, v| reach.max(in_64ths(*v).unsigned_abs()));
        points.saturating_add(offset[axis].unsigned_abs())
    };
    let [width, height] = [reach(0), reach(1)];
    if width.max(height) <= MAX_REACH {
        return Ok(());
    }
    Err(Error::BitmapTooLarge { width: width / 64, height: height / 64, limit: MAX_SIDE })
}

fn fill<const CLIP: bool>(area: &mut Area, polygons: &Polygons, corner: [i32; 2]) {
    let [x, y] = &polygons.vertices;
    let mut start = 0;
    for &end in &polygons.ends {
        area.polygon_up::<CLIP>(&x[start..end], &y[start..end], corner);
        start = end;
    }
}

/// The whole pixels that polygons span if they are moved by `offset` units.
fn place(polygons: &Polygons, offset: [i32; 2]) -> Result<Placement, Error> {
    if polygons.vertices[0].is_empty() {
        return Ok(Placement::default());
    }
    let [(left, right), (bottom, top)] = [0, 1].map(|axis| {
        let [low, high] = polygons.bounds[axis].map(|v| v.saturating_add(offset[axis]));
        (low >> UNIT_BITS, high.saturating_add(UNIT - 1) >> UNIT_BITS)
    });
    if left == right || bottom == top {
        return Ok(Placement::default());
    }
    let (width, height) = (right.abs_diff(left), top.abs_diff(bottom));
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(Error::BitmapTooLarge { width, height, limit: MAX_SIDE });
    }
    Ok(Placement { left, top, width, height })
}
