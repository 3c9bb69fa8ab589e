//! The grid-fit field: a warp in each axis, a low-rank deformation, and a spline whose zero level is the
//! outline.
//!
//! Every operation here is an IEEE 754 addition, subtraction, multiplication, division, comparison or
//! conversion in a fixed order, so that the pixels are the same on every machine.

#[cfg(feature = "convert")]
mod adjust;

use crate::error::Error;
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
/// Half the distance (in samples) over which the warp's slope is taken.
pub const SLOPE_REACH: f32 = 0.25;
/// Knots keep at least this distance in pixels, so that the warp can be inverted.
pub const MIN_KNOT_GAP: f32 = 1.0 / 256.0;
/// Gradients (em per em) below this are raised to it; it bounds how steep an edge of a flat field can look.
pub const MIN_GRADIENT: f32 = 0.03;
/// The smaller component of the gradient is at least this share of the larger one.
pub const MIN_SKEW: f32 = 0.02;
/// A hinted box may reach this far (pixels) into a pixel without claiming it: half a step of the warp.
pub const BOX_SLACK: f32 = 1.0 / 64.0;
/// The largest size that is drawn, in pixels per em.
pub const MAX_PPEM: f32 = 2048.0;
/// The longest side of a bitmap in pixels.
pub(crate) const MAX_SIDE: u32 = 8192;

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
    /// Font units in an em.
    pub units_per_em: u16,
    /// The smallest trained size in pixels per em.
    pub first_ppem: u16,
    /// The largest trained size.
    pub last_ppem: u16,
}

impl Scale {
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
    pub(crate) fn fit(&self, ppem: f32) -> Fit {
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
pub(crate) struct Fit {
    /// The trained size whose displacements count, by its index.
    pub(crate) size: usize,
    /// The size in pixels per em that they belong to.
    pub(crate) grid: f32,
    /// What displacements are multiplied with: 1, or 0 where they do not count.
    pub(crate) strength: f32,
}

/// Checks that a size is drawn at all.
pub(crate) fn check_ppem(ppem: f32) -> Result<(), Error> {
    if ppem > 0.0 && ppem <= MAX_PPEM {
        return Ok(());
    }
    Err(Error::InvalidParameter(format!("{ppem} ppem is outside 0–{MAX_PPEM}")))
}

/// How many samples a pixel has along each axis: small sizes are supersampled.
pub fn samples_per_pixel(ppem: f32) -> usize {
    match ppem {
        s if s < 11.0 => 6,
        s if s < 16.0 => 4,
        s if s < 24.0 => 3,
        s if s < 96.0 => 2,
        _ => 1,
    }
}

/// Area of a unit pixel on the inner side of a straight edge: `value` is the field at the pixel's centre times
/// the samples per em, `(gx, gy)` its gradient (em per em). Both in the same unit, so no square root is needed.
#[inline]
pub fn half_plane(value: f32, gx: f32, gy: f32) -> f32 {
    let (ax, ay) = (gx.abs(), gy.abs());
    let a = ax.max(ay).max(MIN_GRADIENT);
    let b = ax.min(ay).max(MIN_SKEW * a);
    let m = value.abs();
    let outside = if m <= (a - b) * 0.5 {
        0.5 - m / a
    } else {
        let rest = ((a + b) * 0.5 - m).max(0.0);
        rest * rest / (2.0 * a * b)
    };
    if value > 0.0 { 1.0 - outside } else { outside }
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

    /// The cell that `q` (em) lies in, and how far into it, 0..1. Positions outside count as on the border.
    #[inline]
    pub fn locate(&self, q: f32) -> (usize, f32) {
        let u = ((q - self.origin) * self.cells_per_em).clamp(0.0, self.cells as f32);
        let cell = (u as usize).min(self.cells - 1);
        (cell, u - cell as f32)
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

/// Their derivatives.
#[inline]
pub fn spline_slope(t: f32) -> [f32; 3] {
    [t - 1.0, 1.0 - 2.0 * t, t]
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
}

/// Working memory that evaluation reuses.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    hinted: [Vec<f32>; 2],
    deform: Vec<f32>,
    rows: Vec<[f32; 2]>,
    column: Vec<[f32; 2]>,
    sums: Vec<f32>,
    /// One part of a composed glyph.
    pub(crate) layer: Vec<u8>,
}

impl GridFit {
    /// Turns stored weights into a model.
    ///
    /// # Errors
    ///
    /// `Malformed` if their lengths contradict each other.
    pub fn new(weights: &Weights, scale: Scale) -> Result<Self, Error> {
        let wrong = |what: &str| Err(Error::Malformed(format!("a glyph's model has {what}")));
        let sizes = scale.sizes();
        let coefficients = (usize::from(weights.cells[0]) + 2) * (usize::from(weights.cells[1]) + 2);
        let rank = usize::from(weights.rank);
        if !weights.field.is_empty()
            && (weights.cells.contains(&0)
                || weights.field.len() != coefficients
                || weights.warp_y.knots.is_empty())
        {
            return wrong("a field of the wrong size");
        }
        for warp in [&weights.warp_x, &weights.warp_y] {
            if warp.hinted.len() != warp.knots.len() * sizes || !warp.knots.is_sorted_by(|a, b| a < b) {
                return wrong("a warp that does not fit its knots");
            }
        }
        if weights.patterns.len() != rank * DEFORM_NODES * DEFORM_NODES
            || weights.embedding.len() != rank * sizes
        {
            return wrong("a deformation that does not fit its rank");
        }
        if weights.bounds[0] > weights.bounds[2] || weights.bounds[1] > weights.bounds[3] {
            return wrong("a box with its corners swapped");
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
        Ok(Self {
            scale,
            bounds,
            grid: [0, 1].map(|k| GridAxis::new(bounds[k], bounds[k + 2], usize::from(weights.cells[k]))),
            field: steps(&weights.field, FIELD_STEPS),
            knots: [&weights.warp_x, &weights.warp_y].map(|w| w.knots.iter().map(|k| em(*k)).collect()),
            moves: [moves(&weights.warp_x), moves(&weights.warp_y)],
            rank,
            patterns: steps(&weights.patterns, PATTERN_STEPS),
            embedding: steps(&weights.embedding, EMBEDDING_STEPS),
        })
    }

    /// The memory that the model takes, in bytes.
    pub fn memory(&self) -> usize {
        let floats = [&self.field, &self.patterns, &self.embedding].map(Vec::len).iter().sum::<usize>()
            + self.knots.iter().chain(&self.moves).map(Vec::len).sum::<usize>();
        size_of::<Self>() + floats * size_of::<f32>()
    }

    /// Hinted positions in pixels of an axis's knots, ascending.
    fn hinted_knots(&self, axis: usize, ppem: f32) -> impl Iterator<Item = f32> + '_ {
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
    /// `InvalidParameter` for a size that is not in `0..=MAX_PPEM`, `LimitExceeded` for a bitmap that is larger
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
            let low = hinted.next().unwrap_or(self.bounds[axis] * ppem);
            let high = hinted.last().unwrap_or(self.bounds[axis + 2] * ppem);
            let first = (low + origin[axis] + BOX_SLACK).floor() as i32;
            (first, ((high + origin[axis] - BOX_SLACK).ceil() as i32).max(first.saturating_add(1)))
        };
        let [(left, right), (bottom, top)] = [range(0), range(1)];
        let place = Placement { left, top, width: right.abs_diff(left), height: top.abs_diff(bottom) };
        if place.width > MAX_SIDE || place.height > MAX_SIDE {
            return Err(Error::LimitExceeded(format!(
                "a bitmap of {}×{} pixels at {ppem} ppem",
                place.width, place.height
            )));
        }
        Ok(place)
    }

    /// Draws the pixels of `placement` at a size. `pixels` has `placement.area()` bytes, top row first.
    pub fn draw(&self, ppem: f32, placement: Placement, scratch: &mut Scratch, pixels: &mut [u8]) {
        self.draw_at(ppem, [0.0; 2], placement, scratch, pixels);
    }

    /// Draws as `draw` does, with the glyph at `origin` (pixels).
    pub fn draw_at(
        &self,
        ppem: f32,
        origin: [f32; 2],
        placement: Placement,
        scratch: &mut Scratch,
        pixels: &mut [u8],
    ) {
        if self.field.is_empty() || placement.area() == 0 {
            return;
        }
        let n = samples_per_pixel(ppem);
        let (width, height) = (placement.width as usize, placement.height as usize);
        for (axis, hinted) in scratch.hinted.iter_mut().enumerate() {
            hinted.clear();
            hinted.extend(self.hinted_knots(axis, ppem));
        }
        self.mix_patterns(ppem, &mut scratch.deform);
        let per_em = ppem * n as f32;
        let mut rows = std::mem::take(&mut scratch.rows);
        rows.clear();
        rows.extend((0..height * n).map(|j| {
            let sample = placement.top as f32 - (j as f32 + 0.5) / n as f32 - origin[1];
            self.unwarp(1, &scratch.hinted[1], ppem, n, sample)
        }));
        scratch.sums.clear();
        scratch.sums.resize(width * height, 0.0);
        for i in 0..width * n {
            let sample = placement.left as f32 + (i as f32 + 0.5) / n as f32 - origin[0];
            let [x, slope_x] = self.unwarp(0, &scratch.hinted[0], ppem, n, sample);
            let node_column = self.contract(x, slope_x, &scratch.deform, &mut scratch.column);
            for (j, &[y, slope_y]) in rows.iter().enumerate() {
                let coverage = self.sample(y, slope_y, per_em, &node_column, &scratch.column);
                scratch.sums[(j / n) * width + i / n] += coverage;
            }
        }
        scratch.rows = rows;
        let level = 255.0 / (n * n) as f32;
        for (pixel, sum) in pixels.iter_mut().zip(&scratch.sums) {
            *pixel = (sum * level + 0.5) as u8;
        }
    }

    /// The plain coordinate (em) of a hinted one (pixels) and how fast it changes (em per em), taken over the
    /// middle half of a sample.
    fn unwarp(&self, axis: usize, hinted: &[f32], ppem: f32, n: usize, at: f32) -> [f32; 2] {
        let knots = &self.knots[axis];
        let reach = SLOPE_REACH / n as f32;
        let (low, high) =
            (unwarp_point(knots, hinted, ppem, at - reach), unwarp_point(knots, hinted, ppem, at + reach));
        [(low + high) * 0.5, (high - low) / (2.0 * reach) * ppem]
    }

    /// The deformation grid (em) at a size.
    fn mix_patterns(&self, ppem: f32, out: &mut Vec<f32>) {
        let fit = self.scale.fit(ppem);
        let nodes = DEFORM_NODES * DEFORM_NODES;
        out.clear();
        out.resize(nodes, 0.0);
        for r in 0..self.rank {
            let weight = self.embedding[fit.size * self.rank + r] * fit.strength / fit.grid;
            for (sum, value) in out.iter_mut().zip(&self.patterns[r * nodes..(r + 1) * nodes]) {
                *sum += value * weight;
            }
        }
    }

    /// Contracts the field and the deformation at column `x`: into `column` the spline's coefficients along y
    /// and those of its x derivative; returns the deformation's nodes along y.
    fn contract(
        &self,
        x: f32,
        slope_x: f32,
        deform: &[f32],
        column: &mut Vec<[f32; 2]>,
    ) -> [f32; DEFORM_NODES] {
        let (cell, t) = self.grid[0].locate(x);
        let (w, d) = (spline(t), spline_slope(t));
        let scale = self.grid[0].cells_per_em * slope_x;
        let stride = self.grid[0].cells + 2;
        column.clear();
        column.extend(self.field.chunks_exact(stride).map(|row| {
            let g = [row[cell], row[cell + 1], row[cell + 2]];
            [w[0] * g[0] + w[1] * g[1] + w[2] * g[2], (d[0] * g[0] + d[1] * g[1] + d[2] * g[2]) * scale]
        }));
        let (node, t) = self.grid[0].locate_node(x);
        let mut nodes = [0.0; DEFORM_NODES];
        for (out, row) in nodes.iter_mut().zip(deform.chunks_exact(DEFORM_NODES)) {
            *out = row[node] + (row[node + 1] - row[node]) * t;
        }
        nodes
    }

    /// Coverage of one sample of a contracted column.
    fn sample(
        &self,
        y: f32,
        slope_y: f32,
        per_em: f32,
        nodes: &[f32; DEFORM_NODES],
        column: &[[f32; 2]],
    ) -> f32 {
        let (node, t) = self.grid[1].locate_node(y);
        let y = y + (nodes[node] + (nodes[node + 1] - nodes[node]) * t);
        let (cell, t) = self.grid[1].locate(y);
        let (w, d) = (spline(t), spline_slope(t));
        let c = [column[cell], column[cell + 1], column[cell + 2]];
        let value = w[0] * c[0][0] + w[1] * c[1][0] + w[2] * c[2][0];
        let gx = w[0] * c[0][1] + w[1] * c[1][1] + w[2] * c[2][1];
        let gy = (d[0] * c[0][0] + d[1] * c[1][0] + d[2] * c[2][0]) * (self.grid[1].cells_per_em * slope_y);
        half_plane(value * per_em, gx, gy)
    }
}

/// Inverse of the piecewise-linear map from `knots` (em) to `hinted` (pixels); beyond the ends the map has
/// the plain scale.
pub(crate) fn unwarp_point(knots: &[f32], hinted: &[f32], ppem: f32, at: f32) -> f32 {
    let (Some(&first), Some(&last)) = (hinted.first(), hinted.last()) else { return at / ppem };
    if at <= first {
        return knots[0] + (at - first) / ppem;
    }
    if at >= last {
        return knots[knots.len() - 1] + (at - last) / ppem;
    }
    let k = hinted.partition_point(|h| *h <= at) - 1;
    knots[k] + (at - hinted[k]) * ((knots[k + 1] - knots[k]) / (hinted[k + 1] - hinted[k]))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
