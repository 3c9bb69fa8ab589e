//! Plain outlines, for glyphs that have no model: the font's own curves, flattened and filled with exact areas.

use alloc::vec::Vec;

use read_fonts::model::glyph::outline::{DrawMemory, DrawOptions as OutlineOptions, PathSink};
use read_fonts::types::GlyphId;

use super::draw::{Scratch, draw_polygons};
use super::font::Font;
use crate::bitmap::Canvas;
use crate::error::Error;
use crate::limits::{Budget, Limits};
use crate::number::floor;
use crate::options::DrawOptions;
use crate::placement::Placement;

/// The largest distance (pixels) of a polygon from the curve that it approximates.
const TOLERANCE: f32 = 1.0 / 128.0;
/// The most edges that a curve becomes.
const MAX_PIECES: u16 = 256;

/// Draws a glyph's plain outline into the canvas that `room` gives for its placement, if it gives one.
pub(super) fn draw_outline<'b>(
    font: &Font,
    glyph: u32,
    options: DrawOptions,
    limits: &Limits,
    scratch: &mut Scratch,
    room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
) -> Result<Option<Placement>, Error> {
    let options = options.checked()?;
    let Flattened { mut vertices, ends, .. } = flatten(font, glyph, options)?;
    let placement = place(&vertices)?;
    limits.check_sides(placement.width, placement.height)?;
    let Some(mut canvas) = room(placement)? else { return Ok(None) };
    orient(&mut vertices, &ends);
    let (left, top) = (placement.left as f32, placement.top as f32);
    let size = [placement.width as f32, placement.height as f32];
    for [x, y] in &mut vertices {
        [*x, *y] = [(*x - left).clamp(0.0, size[0]), (top - *y).clamp(0.0, size[1])];
    }
    let mut budget = Budget::new(glyph, limits);
    budget.spend(placement.area() as u64)?;
    draw_polygons(&vertices, &ends, placement, scratch, &mut canvas, &mut budget)?;
    Ok(Some(placement))
}

/// A glyph's outline at a size as polygons.
fn flatten(font: &Font, glyph: u32, options: DrawOptions) -> Result<Flattened, Error> {
    if glyph >= font.glyph_count() {
        return Err(Error::NoSuchGlyph(glyph));
    }
    let mut flattened = Flattened { offset: options.offset, ..Flattened::default() };
    // A blank glyph has an entry, too: no entry means that the outline cannot be read.
    let outline = font.model().outline_glyphs().get(GlyphId::new(glyph));
    let outline = outline.ok_or(Error::MalformedOutline(glyph))?;
    let size = OutlineOptions::new().with_ppem(Some(options.ppem));
    outline.draw(&size, DrawMemory::default(), &mut flattened).map_err(|_| Error::MalformedOutline(glyph))?;
    flattened.close();
    if flattened.vertices.iter().flatten().all(|v| v.is_finite()) {
        Ok(flattened)
    } else {
        Err(Error::MalformedOutline(glyph))
    }
}

/// The whole pixels that vertices span.
fn place(vertices: &[[f32; 2]]) -> Result<Placement, Error> {
    let Some(first) = vertices.first() else { return Ok(Placement::default()) };
    let [mut low, mut high] = [*first; 2];
    for vertex in vertices {
        for axis in 0..2 {
            low[axis] = low[axis].min(vertex[axis]);
            high[axis] = high[axis].max(vertex[axis]);
        }
    }
    let [left, bottom] = low.map(floor);
    let [right, top] = high.map(|v| floor(-v).saturating_neg());
    if left == right || bottom == top {
        return Ok(Placement::default());
    }
    Ok(Placement { left, top, width: right.abs_diff(left), height: top.abs_diff(bottom) })
}

/// Reverses all polygons if their inside is on their right, as in TrueType; PostScript has it on the left.
fn orient(vertices: &mut [[f32; 2]], ends: &[usize]) {
    let mut start = 0;
    let mut area = 0.0;
    for &end in ends {
        let polygon = &vertices[start..end];
        let next = polygon.iter().skip(1).chain(polygon.first());
        area += polygon.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f32>();
        start = end;
    }
    if area < 0.0 {
        let mut start = 0;
        for &end in ends {
            vertices[start..end].reverse();
            start = end;
        }
    }
}

/// Closed polygons in pixels, y up.
#[derive(Default)]
struct Flattened {
    vertices: Vec<[f32; 2]>,
    /// Where each polygon ends.
    ends: Vec<usize>,
    /// The subpixel offset, which is added to every point.
    offset: [f32; 2],
}

impl Flattened {
    fn at(&self, x: f32, y: f32) -> [f32; 2] {
        [x + self.offset[0], y + self.offset[1]]
    }

    /// The current point of the path.
    fn last(&self) -> [f32; 2] {
        self.vertices.last().copied().unwrap_or(self.offset)
    }

    /// Adds the points at equal steps of a curve's parameter, its end included. `bend` bounds the curve's distance from its
    /// chord.
    fn pieces(&mut self, bend: f32, at: impl Fn(f32) -> [f32; 2]) {
        // The distance falls with the square of the number of pieces.
        let mut pieces = 1u16;
        while f32::from(pieces) * f32::from(pieces) * TOLERANCE < bend && pieces < MAX_PIECES {
            pieces += 1;
        }
        self.vertices.extend((1..=pieces).map(|piece| at(f32::from(piece) / f32::from(pieces))));
    }
}

/// The longer side of the box around the second difference of three points.
fn second_difference(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> f32 {
    [0, 1].map(|k| (a[k] - 2.0 * b[k] + c[k]).abs()).into_iter().fold(0.0, f32::max)
}

impl PathSink for Flattened {
    fn move_to(&mut self, x: f32, y: f32) {
        self.close();
        self.vertices.push(self.at(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.vertices.push(self.at(x, y));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        let (a, b, c) = (self.last(), self.at(cx, cy), self.at(x, y));
        let curve = |t: f32| {
            let s = 1.0 - t;
            [0, 1].map(|k| s * s * a[k] + 2.0 * s * t * b[k] + t * t * c[k])
        };
        self.pieces(second_difference(a, b, c) / 4.0, curve);
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        let (a, b, c, d) = (self.last(), self.at(cx0, cy0), self.at(cx1, cy1), self.at(x, y));
        let curve = |t: f32| {
            let s = 1.0 - t;
            [0, 1].map(|k| s * s * s * a[k] + 3.0 * s * t * (s * b[k] + t * c[k]) + t * t * t * d[k])
        };
        let bend = second_difference(a, b, c).max(second_difference(b, c, d));
        self.pieces(0.75 * bend, curve);
    }

    fn close(&mut self) {
        if self.ends.last().copied().unwrap_or(0) < self.vertices.len() {
            self.ends.push(self.vertices.len());
        }
    }
}
