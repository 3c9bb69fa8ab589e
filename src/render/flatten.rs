//! Contours as polygons: curves are split as in zeno 0.3, after FreeType's `ftgrays.c` (`gray_render_conic`), so that
//! the polygons are those of zeno.

use alloc::vec::Vec;
use core::ops::Range;

use crate::model::outline::OutlinePoints;
use crate::number::UNIT;

/// How finely outlines are computed, in units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Precision {
    /// A curve is split until its second difference is at most this along both axes.
    flat: i32,
    /// The points that two control points imply are rounded towards 0 to a multiple of this.
    implied: i32,
}

impl Precision {
    /// That of zeno and FreeType.
    pub(super) const TRUE_TYPE: Self = Self { flat: UNIT / 4, implied: UNIT / 64 };
    /// That of outlines that were PostScript's: their models learn from cubic curves that are filled almost exactly, against which
    /// coarser lines would be an error.
    pub(super) const FINE: Self = Self { flat: UNIT / 64, implied: 1 };
}

/// The most vertices of a glyph.
const MAX_VERTICES: usize = 1 << 18;

/// Closed polygons, in units from the glyph's origin, y up.
#[derive(Debug, Clone, Default)]
pub(super) struct Polygons {
    /// The vertices' coordinates along x and y.
    pub(super) vertices: [Vec<i32>; 2],
    /// Where each polygon ends.
    pub(super) ends: Vec<usize>,
    /// The least and the greatest coordinates along x and y, once they are [measured](Self::measure).
    pub(super) bounds: [[i32; 2]; 2],
    /// How finely outlines that are added are computed.
    precision: Precision,
}

type Point = [i32; 2];

impl Polygons {
    /// Removes all polygons.
    pub(super) fn clear(&mut self) {
        self.vertices.iter_mut().for_each(Vec::clear);
        self.ends.clear();
    }

    /// Becomes a copy of others, in the memory that is there.
    pub(super) fn copy_from(&mut self, other: &Self) {
        for (own, other) in self.vertices.iter_mut().zip(&other.vertices) {
            own.clone_from(other);
        }
        self.ends.clone_from(&other.ends);
        self.bounds = other.bounds;
    }

    /// Finds the bounds.
    pub(super) fn measure(&mut self) {
        self.bounds = self.vertices.each_ref().map(|vertices| {
            vertices.iter().fold([i32::MAX, i32::MIN], |[low, high], v| [low.min(*v), high.max(*v)])
        });
    }

    /// The memory that the polygons take, in bytes.
    pub(super) fn memory(&self) -> usize {
        self.vertices.iter().map(|vertices| vertices.capacity() * size_of::<i32>()).sum::<usize>()
            + self.ends.capacity() * size_of::<usize>()
    }

    /// Adds an outline whose points are at `places`, in units, moved by `offset` in 1/64 pixel, and made `stretch` times as wide and
    /// high. Contours of one or two points, which
    /// fonts use as anchors, have no area and are left out.
    pub(super) fn add(
        &mut self,
        outline: &OutlinePoints,
        places: &[Vec<i32>; 2],
        offset: Point,
        stretch: Point,
        precision: Precision,
    ) {
        self.precision = precision;
        for contour in outline.contours().filter(|contour| contour.len() > 2) {
            self.add_contour(outline, places, contour, offset, stretch);
        }
    }

    fn add_contour(
        &mut self,
        outline: &OutlinePoints,
        places: &[Vec<i32>; 2],
        contour: Range<usize>,
        offset: Point,
        stretch: Point,
    ) {
        let [Some(x), Some(y)] = places.each_ref().map(|places| places.get(contour.clone())) else { return };
        let Some(on_curve) = outline.on_curve.get(contour) else { return };
        let offset = offset.map(|v| v.wrapping_mul(UNIT / 64));
        let moved = |v: i32, axis: usize| v.wrapping_add(offset[axis]).wrapping_mul(stretch[axis]);
        let grain = self.precision.implied;
        let point = |k: usize| [moved(x[k], 0), moved(y[k], 1)];
        let Some(last) = on_curve.len().checked_sub(1) else { return };
        // A contour begins at its first point on the curve, or else between its last and its first point.
        let first = on_curve.iter().position(|on| *on);
        let start = first.map_or_else(|| middle(point(last), point(0), grain), point);
        let mut from = start;
        let mut control: Option<Point> = None;
        let begin = first.map_or(0, |first| first + 1);
        for k in (begin..=last).chain(0..begin.saturating_sub(1)) {
            let here = point(k);
            let to = match (control, on_curve[k]) {
                (None, false) => {
                    control = Some(here);
                    continue;
                }
                (Some(before), false) => middle(before, here, grain),
                (_, true) => here,
            };
            self.piece(from, control, to);
            from = to;
            control = (!on_curve[k]).then_some(here);
        }
        self.piece(from, control, start);
        self.ends.push(self.vertices[0].len());
    }

    fn piece(&mut self, from: Point, control: Option<Point>, to: Point) {
        match control {
            None => self.push(to),
            Some(control) => self.curve(from, control, to),
        }
    }

    fn push(&mut self, point: Point) {
        self.vertices[0].push(point[0]);
        self.vertices[1].push(point[1]);
    }

    /// Whether there are more vertices than any glyph needs; further curves are not split then.
    pub(super) fn are_too_many(&self) -> bool {
        self.vertices[0].len() > MAX_VERTICES
    }

    /// A quadratic curve, without its first point.
    fn curve(&mut self, from: Point, control: Point, to: Point) {
        let bend = [0, 1]
            .map(|k| from[k].wrapping_add(to[k]).wrapping_sub(control[k].wrapping_mul(2)).saturating_abs());
        let mut bend = bend[0].max(bend[1]);
        let mut depth = 0;
        if self.are_too_many() {
            bend = 0;
        }
        while bend > self.precision.flat {
            bend >>= 2;
            depth += 1;
        }
        self.split(from, control, to, depth);
    }

    fn split(&mut self, from: Point, control: Point, to: Point, depth: u32) {
        if depth == 0 {
            self.push(to);
            return;
        }
        let before = [0, 1].map(|k| from[k].wrapping_add(control[k]) >> 1);
        let after = [0, 1].map(|k| control[k].wrapping_add(to[k]) >> 1);
        let sum = |k: usize| from[k].wrapping_add(control[k]).wrapping_add(control[k].wrapping_add(to[k]));
        let middle = [0, 1].map(|k| sum(k) >> 2);
        self.split(from, before, middle, depth - 1);
        self.split(middle, after, to, depth - 1);
    }
}

/// The point that two control points imply between them, rounded towards 0 to a multiple of `grain`, as FreeType does.
fn middle(a: Point, b: Point, grain: i32) -> Point {
    [0, 1].map(|k| a[k].wrapping_add(b[k]) / (2 * grain) * grain)
}

#[cfg(test)]
mod tests;
