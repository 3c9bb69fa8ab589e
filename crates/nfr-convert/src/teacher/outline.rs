//! The teacher's outlines, filled with exact area coverage by zeno. The renderer has outlines of its own.

use std::mem::discriminant;

use skrifa::PathSink;
use zeno::{Command, Mask, Origin, PathBuilder, Vector};

use crate::error::Error;
use nfr::internals::model::gridfit::MAX_SIDE;
use nfr::internals::table::Dropout;
use nfr::{Bitmap, Placement};

/// Line segments that approximate one quadratic curve: off by less than 1/2000 em on any glyph-sized arc.
const SEGMENTS_PER_CURVE: usize = 8;

/// The chords of cubic curves are so near to them (pixels); zeno computes in 1/256 pixel.
const CHORD_ERROR: f32 = 1.0 / 1024.0;
/// The most chords of a cubic curve, which bend less than that error for curves of thousands of pixels.
const MAX_CHORDS: usize = 1024;

/// Coordinates lie within this distance of the origin (pixels): beyond it an `f32` does not have fractions of a pixel
/// fine enough for coverage.
const MAX_REACH: f32 = (1 << 16) as f32;

/// One glyph's outline at one size, in pixels, y up.
#[derive(Debug, Clone, Default)]
pub struct Outline {
    commands: Vec<Command>,
    /// All points of the outline's commands, in order. Hinting moves points and never reorders them, so that hinted and
    /// unhinted outlines correspond index by index, unless hinting changes the contours ([`Self::has_contours_of`]).
    pub points: Vec<[f32; 2]>,
    /// The advance width in the same unit, hinted if the points are.
    pub advance: Option<f32>,
    /// What the hints ask of a renderer in black and white.
    pub dropout: Dropout,
    /// The path that is filled, if it is not that of `commands`: the cubic curves that quadratic ones come near to.
    filled: Option<Vec<Command>>,
}

impl Outline {
    /// The same outline, filled as another one, whose cubic curves become lines, and whose contours turn the other way.
    pub(super) fn filled_as(self, other: &Self) -> Self {
        let mut filled = Vec::new();
        let mut contour: Vec<Vector> = Vec::new();
        for command in &other.commands {
            match command {
                Command::MoveTo(to) => {
                    add_reversed(&mut contour, &mut filled);
                    contour.push(*to);
                }
                Command::LineTo(to) => contour.push(*to),
                Command::CurveTo(a, b, to) => {
                    let at = contour.last().copied().unwrap_or(Vector::ZERO);
                    contour.extend(chords([at, *a, *b, *to]));
                }
                // Charstrings have no quadratic curves, and contours are closed where the next one begins.
                Command::QuadTo(..) | Command::Close => {}
            }
        }
        add_reversed(&mut contour, &mut filled);
        Self { filled: Some(filled), ..self }
    }

    /// The path.
    pub(super) fn commands(&self) -> &[Command] {
        &self.commands
    }

    /// Multiplies every coordinate by `factor`.
    pub fn scale(&mut self, factor: f32) {
        self.map(|point| point.map(|v| v * factor));
    }

    /// Moves the outline.
    pub fn translate(&mut self, by: [f32; 2]) {
        self.map(|point| [point[0] + by[0], point[1] + by[1]]);
    }

    /// The same commands with other coordinates, as many as `points` has.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` if there are more or fewer.
    pub fn with_points(&self, points: &[[f32; 2]]) -> Result<Self, Error> {
        if points.len() != self.points.len() {
            return Err(Error::InvalidParameter(format!(
                "{} points for an outline of {}; pass as many",
                points.len(),
                self.points.len()
            )));
        }
        let mut rest = points.iter();
        let mut next = |p: &Vector| rest.next().map_or(*p, |p| Vector::from(*p));
        let commands = self
            .commands
            .iter()
            .map(|command| match command {
                Command::MoveTo(p) => Command::MoveTo(next(p)),
                Command::LineTo(p) => Command::LineTo(next(p)),
                Command::QuadTo(c, p) => Command::QuadTo(next(c), next(p)),
                Command::CurveTo(a, b, p) => Command::CurveTo(next(a), next(b), next(p)),
                Command::Close => Command::Close,
            })
            .collect();
        Ok(Self { commands, points: points.to_vec(), filled: None, ..self.clone() })
    }

    /// Whether another outline has the same contours but for its points' positions. A hint program can put a control point on the
    /// curve or take a point off it (`FLIPPT`, `FLIPRGON`, `FLIPRGOFF`); points do not correspond then.
    pub fn has_contours_of(&self, other: &Self) -> bool {
        self.commands.len() == other.commands.len()
            && self.commands.iter().zip(&other.commands).all(|(a, b)| discriminant(a) == discriminant(b))
    }

    fn map(&mut self, to: impl Fn([f32; 2]) -> [f32; 2]) {
        for point in &mut self.points {
            *point = to(*point);
        }
        let moved = |p: &Vector| Vector::from(to([p.x, p.y]));
        for command in self.commands.iter_mut().chain(self.filled.iter_mut().flatten()) {
            *command = match command {
                Command::MoveTo(p) => Command::MoveTo(moved(p)),
                Command::LineTo(p) => Command::LineTo(moved(p)),
                Command::QuadTo(c, p) => Command::QuadTo(moved(c), moved(p)),
                Command::CurveTo(a, b, p) => Command::CurveTo(moved(a), moved(b), moved(p)),
                Command::Close => Command::Close,
            };
        }
    }

    /// The outline as line segments `[from, to]`.
    pub fn segments(&self) -> Vec<[[f32; 2]; 2]> {
        let mut segments = Vec::new();
        let (mut start, mut at) = ([0.0f32; 2], [0.0f32; 2]);
        let xy = |p: &Vector| [p.x, p.y];
        for command in &self.commands {
            match command {
                Command::MoveTo(p) => (start, at) = (xy(p), xy(p)),
                Command::LineTo(p) => {
                    segments.push([at, xy(p)]);
                    at = xy(p);
                }
                Command::QuadTo(c, p) => {
                    let (from, c, p) = (at, xy(c), xy(p));
                    for piece in 1..=SEGMENTS_PER_CURVE {
                        let t = piece as f32 / SEGMENTS_PER_CURVE as f32;
                        let point = [0, 1].map(|k| {
                            (1.0 - t) * (1.0 - t) * from[k] + 2.0 * t * (1.0 - t) * c[k] + t * t * p[k]
                        });
                        segments.push([at, point]);
                        at = point;
                    }
                }
                // glyf outlines have no cubic curves; their end keeps the contour closed.
                Command::CurveTo(_, _, p) => {
                    segments.push([at, xy(p)]);
                    at = xy(p);
                }
                Command::Close => {
                    segments.push([at, start]);
                    at = start;
                }
            }
        }
        segments.retain(|[a, b]| a != b);
        segments
    }

    /// Exact area coverage of every pixel that the outline touches (nonzero winding).
    ///
    /// # Errors
    ///
    /// `Malformed` for a coordinate that is not a finite number, `LimitExceeded` for a box of more than [`MAX_SIDE`]
    /// pixels a side or more than 65,536 pixels away from the origin.
    pub fn rasterize(&self) -> Result<Bitmap, Error> {
        if self.commands.is_empty() {
            return Ok(Bitmap::default());
        }
        self.check_box()?;
        let mut mask = Mask::new(self.filled.as_ref().unwrap_or(&self.commands).as_slice());
        // Without this call zeno 0.3 computes `top` from a height that it has not set yet.
        mask.origin(Origin::BottomLeft).inspect(|_, _, _| {});
        let (pixels, place) = mask.render();
        let placement =
            Placement { left: place.left, top: place.top, width: place.width, height: place.height };
        Ok(Bitmap { placement, pixels })
    }

    /// zeno allocates whatever box the points ask for, and multiplies its sides in 32 bits.
    fn check_box(&self) -> Result<(), Error> {
        let (mut low, mut high) = ([0.0f32; 2], [0.0f32; 2]);
        for (index, point) in self.points.iter().enumerate() {
            for axis in 0..2 {
                let v = point[axis];
                if !v.is_finite() {
                    return Err(Error::Malformed(format!(
                        "an outline has the coordinate {v}; repair the font"
                    )));
                }
                if v.abs() > MAX_REACH {
                    return Err(Error::LimitExceeded(format!(
                        "an outline reaches {v} pixels from its origin, and {MAX_REACH} are allowed; choose a smaller size"
                    )));
                }
                low[axis] = if index == 0 { v } else { low[axis].min(v) };
                high[axis] = if index == 0 { v } else { high[axis].max(v) };
            }
        }
        let [width, height] = [0, 1].map(|axis| high[axis].ceil() - low[axis].floor());
        if width.max(height) > MAX_SIDE as f32 {
            return Err(Error::LimitExceeded(format!(
                "an outline would have {width}×{height} pixels, and {MAX_SIDE} a side are allowed; choose a smaller size"
            )));
        }
        Ok(())
    }
}

/// Moves a contour's points to a path, the last one first.
fn add_reversed(contour: &mut Vec<Vector>, path: &mut Vec<Command>) {
    let mut points = contour.drain(..).rev();
    if let Some(start) = points.next() {
        path.push(Command::MoveTo(start));
        path.extend(points.map(Command::LineTo));
        path.push(Command::Close);
    }
}

/// The ends of the chords of a cubic curve. zeno's own, as FreeType's, are off by up to a tenth of a pixel.
fn chords(curve: [Vector; 4]) -> impl Iterator<Item = Vector> {
    let bend = |[a, b, c]: [Vector; 3]| (a.x - 2.0 * b.x + c.x).hypot(a.y - 2.0 * b.y + c.y);
    let [a, b, c, d] = curve;
    // A chord of a curve whose second derivative is v at most is v/8 away from it, at the parameter's unit step.
    let count = (6.0 * bend([a, b, c]).max(bend([b, c, d])) / (8.0 * CHORD_ERROR)).sqrt().ceil().max(1.0);
    // A damaged coordinate is found where the box is checked.
    (1..=(count as usize).min(MAX_CHORDS)).map(move |k| {
        let t = k as f32 / count.min(MAX_CHORDS as f32);
        let s = 1.0 - t;
        if t >= 1.0 {
            d
        } else {
            a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
        }
    })
}

impl PathSink for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.points.push([x, y]);
        self.commands.move_to([x, y]);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.points.push([x, y]);
        self.commands.line_to([x, y]);
    }
    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.points.extend([[cx, cy], [x, y]]);
        self.commands.quad_to([cx, cy], [x, y]);
    }
    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.points.extend([[ax, ay], [bx, by], [x, y]]);
        self.commands.curve_to([ax, ay], [bx, by], [x, y]);
    }
    fn close(&mut self) {
        self.commands.close();
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn triangle(points: [[f32; 2]; 3]) -> Outline {
        let mut outline = Outline::default();
        outline.move_to(points[0][0], points[0][1]);
        outline.line_to(points[1][0], points[1][1]);
        outline.line_to(points[2][0], points[2][1]);
        outline.close();
        outline
    }

    #[test]
    fn a_box_within_the_limit_is_drawn_and_one_beyond_it_is_refused() {
        let side = MAX_SIDE as f32;
        let drawn = triangle([[0.0, 0.0], [side, 0.0], [0.0, 1.0]]).rasterize().unwrap();
        assert_eq!([drawn.placement.width, drawn.placement.height], [MAX_SIDE, 1]);
        for points in [
            [[0.0, 0.0], [side + 0.5, 0.0], [0.0, 1.0]],
            [[0.0, 0.0], [1.0, side + 0.5], [0.0, 1.0]],
            // The product of these sides does not fit 32 bits.
            [[-6e4, -6e4], [6e4, 6e4], [0.0, 1.0]],
            // Small, but far away.
            [[1e9, 0.0], [1e9 + 64.0, 0.0], [1e9, 1.0]],
            [[f32::MIN, 0.0], [f32::MAX, 0.0], [0.0, 1.0]],
        ] {
            let refused = triangle(points).rasterize();
            assert!(matches!(refused, Err(Error::LimitExceeded(_))), "{points:?}");
        }
    }

    #[test]
    fn another_number_of_points_is_refused() {
        let outline = triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert!(outline.with_points(&[[0.0; 2]; 3]).is_ok());
        for count in [2, 4] {
            assert!(matches!(outline.with_points(&vec![[0.0; 2]; count]), Err(Error::InvalidParameter(_))));
        }
    }

    #[test]
    fn a_coordinate_that_is_not_finite_is_malformed() {
        for v in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for points in [[[v, 0.0], [1.0, 0.0], [0.0, 1.0]], [[0.0, 0.0], [1.0, 0.0], [0.0, v]]] {
                let refused = triangle(points).rasterize();
                assert!(matches!(refused, Err(Error::Malformed(_))), "{points:?}");
            }
        }
    }
}
