//! The grid-fit field: a warp in each axis, a low-rank deformation, and a spline whose zero level is the
//! outline.
//!
//! Every operation in here and in drawing is an IEEE 754 addition, subtraction, multiplication, division, square root,
//! comparison or conversion in a fixed order, so that the pixels are the same on every machine.

mod adjust;

use alloc::vec::Vec;

use super::contour::{FINEST, Frame, LEVELS_OF_DETAIL, Polygons, Tracer};
use super::grid::{DEFORM_NODES, GridAxis};
use super::sizes::{HintedSize, Scale};
use crate::constants::MAX_SIDE;
use crate::error::{Damage, Error};
use crate::number::floor;
use crate::options::check_ppem;
use crate::placement::Placement;

/// Hinted knot positions are stored in this fraction of a pixel.
pub const WARP_STEPS: f32 = 32.0;
/// Field coefficients are stored in this fraction of an em.
pub const FIELD_STEPS: f32 = 1536.0;
/// Deformation patterns are stored in this fraction of one.
pub const PATTERN_STEPS: f32 = 16.0;
/// The size embedding is stored in this fraction of a pixel.
pub const EMBEDDING_STEPS: f32 = 32.0;
/// The field is clipped to this distance from the outline (em): coefficients farther away cost no bits.
pub const FIELD_LIMIT: f32 = 0.06;
/// The most knots of an axis.
pub const MAX_KNOTS: usize = 32;
/// The least distance of hinted knots in pixels, so that the warp can be inverted.
pub const MIN_KNOT_GAP: f32 = 1.0 / 256.0;
/// A hinted box may reach this far (pixels) into a pixel that is not drawn: half a step of the warp.
pub const BOX_SLACK: f32 = 1.0 / 64.0;

/// One axis of the warp: knots in font units and their hinted positions.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct AxisWarp {
    /// Ascending positions in font units. Empty: the axis is not warped.
    pub knots: Vec<i16>,
    /// For each size, for each knot: the hinted position in 1/`WARP_STEPS` pixel.
    pub hinted: Vec<i32>,
}

/// A glyph's weights as they are stored. A glyph without ink has an empty `field`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Weights {
    /// The plain outline's box in font units: x min, y min, x max, y max.
    pub bounds: [i16; 4],
    /// Cells of the field along x and y. It has two more coefficients than cells on each axis.
    pub cells: [u8; 2],
    /// Spline coefficients, bottom row first, in 1/`FIELD_STEPS` em.
    pub field: Vec<i8>,
    /// The warp in x; no knots for targets that do not move points in x.
    pub warp_x: AxisWarp,
    /// The warp in y.
    pub warp_y: AxisWarp,
    /// The number of deformation patterns.
    pub rank: u8,
    /// `rank` patterns of `DEFORM_NODES`² values, bottom row first, in 1/`PATTERN_STEPS`.
    pub patterns: Vec<i8>,
    /// For each size, the weight of each pattern in 1/`EMBEDDING_STEPS` pixel.
    pub embedding: Vec<i8>,
}

/// A glyph's model, ready to evaluate.
#[derive(Debug, Clone)]
pub struct GridFit {
    scale: Scale,
    bounds: [f32; 4],
    grid: [GridAxis; 2],
    field: Vec<f32>,
    knots: [Vec<f32>; 2],
    /// Displacement of each knot in pixels, by size and knot.
    moves: [Vec<f32>; 2],
    rank: usize,
    patterns: Vec<f32>,
    embedding: Vec<f32>,
    /// The outline, for each of `LEVELS_OF_DETAIL`.
    outlines: [Polygons; LEVELS_OF_DETAIL.len()],
}

impl GridFit {
    /// Turns stored weights into a model.
    ///
    /// # Errors
    ///
    /// `Malformed` if their lengths contradict each other.
    pub fn new(weights: &Weights, scale: Scale) -> Result<Self, Damage> {
        let wrong = |what: &'static str| Err(Damage::Malformed(what));
        let sizes = scale.sizes();
        let coefficients = (usize::from(weights.cells[0]) + 2) * (usize::from(weights.cells[1]) + 2);
        let rank = usize::from(weights.rank);
        if !weights.field.is_empty()
            && (weights.cells.contains(&0)
                || weights.field.len() != coefficients
                || weights.warp_y.knots.is_empty())
        {
            return wrong("has a field of the wrong size");
        }
        for warp in [&weights.warp_x, &weights.warp_y] {
            if warp.hinted.len() != warp.knots.len() * sizes || !warp.knots.is_sorted_by(|a, b| a < b) {
                return wrong("has a warp that does not fit its knots");
            }
            if warp.knots.len() > MAX_KNOTS {
                return wrong("has too many knots");
            }
        }
        if weights.patterns.len() != rank * DEFORM_NODES * DEFORM_NODES
            || weights.embedding.len() != rank * sizes
        {
            return wrong("has a deformation that does not fit its rank");
        }
        if weights.bounds[0] > weights.bounds[2] || weights.bounds[1] > weights.bounds[3] {
            return wrong("has a box with its corners swapped");
        }
        let em = |v: i16| f32::from(v) / f32::from(scale.units_per_em());
        let bounds = weights.bounds.map(em);
        let moves = |warp: &AxisWarp| {
            let plain = |size: usize, knot: usize| em(warp.knots[knot]) * scale.ppem_of(size) as f32;
            let knots = warp.knots.len().max(1);
            let moved = |(at, h): (usize, &i32)| *h as f32 / WARP_STEPS - plain(at / knots, at % knots);
            warp.hinted.iter().enumerate().map(moved).collect::<Vec<f32>>()
        };
        let steps =
            |values: &[i8], steps: f32| values.iter().map(|v| f32::from(*v) / steps).collect::<Vec<_>>();
        let mut model = Self {
            scale,
            bounds,
            grid: [0, 1].map(|k| GridAxis::new(bounds[k], bounds[k + 2], usize::from(weights.cells[k]))),
            field: steps(&weights.field, FIELD_STEPS),
            knots: [&weights.warp_x, &weights.warp_y].map(|w| w.knots.iter().map(|k| em(*k)).collect()),
            moves: [moves(&weights.warp_x), moves(&weights.warp_y)],
            rank,
            patterns: steps(&weights.patterns, PATTERN_STEPS),
            embedding: steps(&weights.embedding, EMBEDDING_STEPS),
            outlines: Default::default(),
        };
        model.trace();
        Ok(model)
    }

    /// Traces the outline.
    fn trace(&mut self) {
        let mut outlines = core::mem::take(&mut self.outlines);
        if !self.field.is_empty() {
            let tolerances = LEVELS_OF_DETAIL.map(|(_, tolerance)| tolerance);
            Tracer::default().trace(&self.frame(), &mut outlines, &tolerances);
            outlines.iter_mut().for_each(Polygons::shrink);
        }
        self.outlines = outlines;
    }

    /// Evaluates the patterns at the outline's vertices again.
    fn evaluate_patterns(&mut self) {
        let mut outlines = core::mem::take(&mut self.outlines);
        outlines.iter_mut().for_each(|polygons| polygons.locate(&self.frame()));
        self.outlines = outlines;
    }

    fn frame(&self) -> Frame<'_> {
        Frame {
            field: &self.field,
            grid: self.grid,
            knots: [&self.knots[0], &self.knots[1]],
            patterns: &self.patterns,
        }
    }

    /// The outline in the detail that a size needs. It is traced into `fresh` if it is not kept.
    pub fn polygons<'a>(&'a self, ppem: f32, tracer: &mut Tracer, fresh: &'a mut Polygons) -> &'a Polygons {
        if let Some(level) = LEVELS_OF_DETAIL.iter().position(|(below, _)| ppem < *below) {
            return &self.outlines[level];
        }
        tracer.trace(&self.frame(), core::slice::from_mut(fresh), &[FINEST]);
        fresh
    }

    /// Units and sizes of the model.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.field.is_empty()
    }

    /// Knots of an axis in em.
    pub fn knots(&self, axis: usize) -> &[f32] {
        &self.knots[axis]
    }

    /// The memory that the model takes, in bytes.
    pub fn memory(&self) -> usize {
        let floats = [&self.field, &self.patterns, &self.embedding].map(Vec::len).iter().sum::<usize>()
            + self.knots.iter().chain(&self.moves).map(Vec::len).sum::<usize>();
        let polygons = self.outlines.iter().map(Polygons::memory).sum::<usize>();
        size_of::<Self>() + floats * size_of::<f32>() + polygons
    }

    /// Hinted positions in pixels of an axis's knots, ascending.
    pub fn hinted_knots(&self, axis: usize, size: &HintedSize) -> impl Iterator<Item = f32> + '_ {
        let HintedSize { index, trained_ppem, strength, .. } = *size;
        let knots = &self.knots[axis];
        let moves = &self.moves[axis][index * knots.len()..];
        let mut lowest = f32::NEG_INFINITY;
        knots.iter().zip(moves).map(move |(knot, moved)| {
            let hinted = (knot * trained_ppem + moved * strength).max(lowest);
            lowest = hinted + MIN_KNOT_GAP;
            hinted
        })
    }

    /// Where the bitmap lies at a size.
    ///
    /// # Errors
    ///
    /// `InvalidSize` for a size that is not in `0..=MAX_PPEM`, `BitmapTooLarge` for a bitmap that is larger
    /// than `MAX_SIDE` on a side.
    pub fn placement(&self, ppem: f32) -> Result<Placement, Error> {
        check_ppem(ppem)?;
        self.placement_at(&self.scale.at(ppem), [0.0; 2])
    }

    /// Where the bitmap lies at a valid size if the glyph's origin is at `origin` (pixels).
    ///
    /// # Errors
    ///
    /// `BitmapTooLarge` for a bitmap that is larger than `MAX_SIDE` on a side.
    pub fn placement_at(&self, size: &HintedSize, origin: [f32; 2]) -> Result<Placement, Error> {
        if self.field.is_empty() {
            return Ok(Placement::default());
        }
        let range = |axis: usize| {
            let mut hinted = self.hinted_knots(axis, size);
            let low = hinted.next();
            self.pixels(axis, size.ppem, [low, hinted.last()], origin[axis])
        };
        placement_of([range(0), range(1)])
    }

    /// The first pixel and the end of the pixels that the glyph covers along an axis. `ends` are its first and last hinted
    /// knot; the plain box takes the place of a knot that is missing.
    pub(super) fn pixels(&self, axis: usize, ppem: f32, ends: [Option<f32>; 2], origin: f32) -> (i32, i32) {
        let low = ends[0].unwrap_or(self.bounds[axis] * ppem);
        let high = ends[1].unwrap_or(self.bounds[axis + 2] * ppem);
        let first = floor(low + origin + BOX_SLACK);
        (first, floor(-(high + origin - BOX_SLACK)).saturating_neg().max(first.saturating_add(1)))
    }

    /// The weight of each pattern at a size, in pixels; 0 where nothing is hinted.
    pub(super) fn pattern_weights(&self, size: &HintedSize) -> impl Iterator<Item = f32> + '_ {
        let strength = size.strength;
        self.embedding[size.index * self.rank..][..self.rank].iter().map(move |weight| weight * strength)
    }
}

/// The placement of a box, given along each axis by its first pixel and the end of its pixels.
///
/// # Errors
///
/// `BitmapTooLarge` for one that is larger than `MAX_SIDE` on a side.
pub fn placement_of(pixels: [(i32, i32); 2]) -> Result<Placement, Error> {
    let [(left, right), (bottom, top)] = pixels;
    let (width, height) = (right.abs_diff(left), top.abs_diff(bottom));
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(Error::BitmapTooLarge { width, height, limit: MAX_SIDE });
    }
    Ok(Placement { left, top, width, height })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
