//! The grid-fit field: a warp in each axis, a low-rank deformation, and a spline whose zero level is the
//! outline.
//!
//! Every operation in here and in drawing is an IEEE 754 addition, subtraction, multiplication, division, square root,
//! comparison or conversion in a fixed order, so that the pixels are the same on every machine.

mod adjust;

use alloc::vec::Vec;

use super::contour::{FINEST, Frame, LEVELS, Polygons, Tracer};
use crate::error::{Damage, Error};
use crate::render::Placement;

/// Hinted knot positions are stored in this fraction of a pixel.
pub const WARP_STEPS: f32 = 32.0;
/// Field coefficients are stored in this fraction of an em.
pub const FIELD_STEPS: f32 = 1536.0;
/// Deformation patterns are stored in this fraction of one.
pub const PATTERN_STEPS: f32 = 16.0;
/// The size embedding is stored in this fraction of a pixel.
pub const EMBEDDING_STEPS: f32 = 32.0;
/// The field is clipped to this distance from the outline (em): farther coefficients cost no bits.
pub const FIELD_LIMIT: f32 = 0.06;
/// How far the field's grid reaches beyond the outline's box (em).
pub const PADDING: f32 = 0.03;
/// Nodes of the deformation's grid along each axis.
pub const DEFORM_NODES: usize = 8;
/// The most knots of an axis.
pub const MAX_KNOTS: usize = 32;
/// Knots keep at least this distance in pixels, so that the warp can be inverted.
pub const MIN_KNOT_GAP: f32 = 1.0 / 256.0;
/// A hinted box may reach this far (pixels) into a pixel without claiming it: half a step of the warp.
pub const BOX_SLACK: f32 = 1.0 / 64.0;
/// The largest trained size, in pixels per em.
pub const MAX_TRAINED_PPEM: u16 = 1024;
/// The largest size that is drawn, in pixels per em.
pub const MAX_PPEM: f32 = 2048.0;
/// The longest side of a bitmap in pixels.
pub const MAX_SIDE: u32 = 8192;

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

/// What is the same for all glyphs of a font. Every whole size from the first to the last is a trained one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scale {
    units_per_em: u16,
    first_ppem: u16,
    last_ppem: u16,
}

impl Scale {
    /// Font units in an em, 16 to 16384, and the smallest and the largest trained size in pixels per em, 1 to
    /// [`MAX_TRAINED_PPEM`]. `None` for anything else.
    pub const fn new(units_per_em: u16, first_ppem: u16, last_ppem: u16) -> Option<Self> {
        let units_fit = units_per_em >= 16 && units_per_em <= 16384;
        let sizes_fit = first_ppem >= 1 && first_ppem <= last_ppem && last_ppem <= MAX_TRAINED_PPEM;
        if units_fit && sizes_fit { Some(Self { units_per_em, first_ppem, last_ppem }) } else { None }
    }

    /// Font units in an em.
    pub fn units_per_em(&self) -> u16 {
        self.units_per_em
    }

    /// The smallest trained size in pixels per em.
    pub fn first_ppem(&self) -> u16 {
        self.first_ppem
    }

    /// The largest trained size in pixels per em.
    pub fn last_ppem(&self) -> u16 {
        self.last_ppem
    }

    /// The number of trained sizes.
    pub fn sizes(&self) -> usize {
        usize::from(self.last_ppem - self.first_ppem) + 1
    }

    /// A trained size in pixels per em, by its index.
    pub fn ppem_of(&self, size: usize) -> usize {
        usize::from(self.first_ppem) + size
    }

    /// How a size is fitted: as the nearest whole one, halves upwards, whose pixel positions stay as they are, so that
    /// edges are as crisp. If that is no trained size, nothing is moved.
    pub fn fit(&self, ppem: f32) -> Fit {
        let whole = (ppem + 0.5) as usize;
        if (usize::from(self.first_ppem)..=usize::from(self.last_ppem)).contains(&whole) {
            Fit { size: whole - usize::from(self.first_ppem), grid: whole as f32, strength: 1.0 }
        } else {
            Fit { size: 0, grid: ppem, strength: 0.0 }
        }
    }
}

/// How a size is fitted to the pixel grid.
#[derive(Debug, Clone, Copy)]
pub struct Fit {
    /// The trained size whose displacements count, by its index.
    pub size: usize,
    /// The size in pixels per em that they belong to.
    pub grid: f32,
    /// What displacements are multiplied with: 1, or 0 where they do not count.
    pub strength: f32,
}

/// Checks that a size is drawn at all.
///
/// # Errors
///
/// `InvalidSize` for one that is not.
pub fn check_ppem(ppem: f32) -> Result<(), Error> {
    if ppem > 0.0 && ppem <= MAX_PPEM {
        return Ok(());
    }
    Err(Error::InvalidSize(ppem))
}

/// The grid's geometry along one axis, in em.
#[derive(Debug, Clone, Copy)]
pub struct GridAxis {
    /// Where the first cell begins.
    pub origin: f32,
    /// Cells per em.
    pub cells_per_em: f32,
    /// The number of cells.
    pub cells: usize,
}

impl GridAxis {
    /// The grid over `low..high` (em) and `PADDING` beyond.
    pub fn new(low: f32, high: f32, cells: usize) -> Self {
        let span = (high - low) + 2.0 * PADDING;
        Self { origin: low - PADDING, cells_per_em: cells as f32 / span, cells }
    }

    /// Where a deformation node lies (em).
    pub fn node(&self, node: usize) -> f32 {
        self.origin + node as f32 / (DEFORM_NODES - 1) as f32 * self.cells as f32 / self.cells_per_em
    }

    /// The deformation node at or below `q` (em), and how far `q` lies towards the next, 0..1.
    #[inline]
    pub fn locate_node(&self, q: f32) -> (usize, f32) {
        let share = (q - self.origin) * self.cells_per_em / self.cells as f32;
        let u = (share * (DEFORM_NODES - 1) as f32).clamp(0.0, (DEFORM_NODES - 1) as f32);
        let node = (u as usize).min(DEFORM_NODES - 2);
        (node, u - node as f32)
    }
}

/// Quadratic B-spline weights of the three coefficients around position `t` (0..1) of a cell.
#[inline]
pub fn spline(t: f32) -> [f32; 3] {
    let s = 1.0 - t;
    [0.5 * s * s, 0.5 + t * s, 0.5 * t * t]
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
    /// The outline, for each of `LEVELS`.
    levels: [Polygons; LEVELS.len()],
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
        let em = |v: i16| f32::from(v) / f32::from(scale.units_per_em);
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
            levels: Default::default(),
        };
        model.trace();
        Ok(model)
    }

    /// Traces the outline.
    fn trace(&mut self) {
        let mut levels = core::mem::take(&mut self.levels);
        if !self.field.is_empty() {
            Tracer::default().trace(&self.frame(), &mut levels, &LEVELS.map(|(_, tolerance)| tolerance));
            levels.iter_mut().for_each(Polygons::shrink);
        }
        self.levels = levels;
    }

    /// Finds out anew how the patterns move the outline.
    fn locate(&mut self) {
        let mut levels = core::mem::take(&mut self.levels);
        levels.iter_mut().for_each(|polygons| polygons.locate(&self.frame()));
        self.levels = levels;
    }

    fn frame(&self) -> Frame<'_> {
        Frame {
            field: &self.field,
            grid: self.grid,
            knots: [&self.knots[0], &self.knots[1]],
            patterns: &self.patterns,
        }
    }

    /// The outline for a size. It is traced into `fresh` if it is not at hand.
    pub fn polygons<'a>(&'a self, ppem: f32, tracer: &mut Tracer, fresh: &'a mut Polygons) -> &'a Polygons {
        if let Some(level) = LEVELS.iter().position(|(below, _)| ppem < *below) {
            return &self.levels[level];
        }
        tracer.trace(&self.frame(), core::slice::from_mut(fresh), &[FINEST]);
        fresh
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
        let polygons = self.levels.iter().map(Polygons::memory).sum::<usize>();
        size_of::<Self>() + floats * size_of::<f32>() + polygons
    }

    /// Hinted positions in pixels of an axis's knots, ascending.
    pub fn hinted_knots(&self, axis: usize, ppem: f32) -> impl Iterator<Item = f32> + '_ {
        let fit = self.scale.fit(ppem);
        let knots = &self.knots[axis];
        let moves = &self.moves[axis][fit.size * knots.len()..];
        let mut floor = f32::NEG_INFINITY;
        knots.iter().zip(moves).map(move |(knot, moved)| {
            let hinted = (knot * fit.grid + moved * fit.strength).max(floor);
            floor = hinted + MIN_KNOT_GAP;
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
        self.placement_at(ppem, [0.0; 2])
    }

    /// Where the bitmap lies at a size if the glyph stands at `origin` (pixels).
    ///
    /// # Errors
    ///
    /// As `placement`.
    pub fn placement_at(&self, ppem: f32, origin: [f32; 2]) -> Result<Placement, Error> {
        check_ppem(ppem)?;
        if self.field.is_empty() {
            return Ok(Placement::default());
        }
        let range = |axis: usize| {
            let mut hinted = self.hinted_knots(axis, ppem);
            let low = hinted.next();
            self.pixels(axis, ppem, [low, hinted.last()], origin[axis])
        };
        placement_of([range(0), range(1)])
    }

    /// The whole pixels that hinted knots, the first and the last, span along an axis; `None` where there is none.
    pub fn pixels(&self, axis: usize, ppem: f32, ends: [Option<f32>; 2], origin: f32) -> (i32, i32) {
        let low = ends[0].unwrap_or(self.bounds[axis] * ppem);
        let high = ends[1].unwrap_or(self.bounds[axis + 2] * ppem);
        let first = floor(low + origin + BOX_SLACK);
        (first, floor(-(high + origin - BOX_SLACK)).saturating_neg().max(first.saturating_add(1)))
    }

    /// The weight of each pattern at a size, in pixels; nothing where nothing is moved.
    pub fn strengths(&self, ppem: f32) -> impl Iterator<Item = f32> + '_ {
        let fit = self.scale.fit(ppem);
        self.embedding[fit.size * self.rank..][..self.rank].iter().map(move |weight| weight * fit.strength)
    }
}

/// The placement of a box, from its first pixel to behind its last one along each axis.
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

/// The largest integer that is not above `v`; f32's own is slow where the instruction is not in the baseline.
pub fn floor(v: f32) -> i32 {
    let whole = v as i32;
    whole.saturating_sub(i32::from(whole as f32 > v))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
