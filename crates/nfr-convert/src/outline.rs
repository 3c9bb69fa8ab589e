//! Plain outlines, filled with exact area coverage.

use skrifa::outline::OutlinePen;
use zeno::{Command, Mask, Origin, PathBuilder, Vector};

use nfr::{Bitmap, Placement};

/// Straight pieces that stand for one quadratic curve: off by less than 1/2000 em on any glyph-sized arc.
const CURVE_PIECES: usize = 8;

/// One glyph's outline at one size, in pixels, y up.
#[derive(Debug, Clone, Default)]
pub struct Outline {
    commands: Vec<Command>,
    /// Every coordinate that the outline's commands carry, in order. Hinting moves points and never
    /// reorders them, so hinted and unhinted outlines correspond index by index.
    pub points: Vec<[f32; 2]>,
}

impl Outline {
    /// Multiplies every coordinate by `factor`.
    pub fn scale(&mut self, factor: f32) {
        self.map(|point| point.map(|v| v * factor));
    }

    /// Moves the outline.
    pub fn translate(&mut self, by: [f32; 2]) {
        self.map(|point| [point[0] + by[0], point[1] + by[1]]);
    }

    /// The same commands with other coordinates, as many as `points` has.
    pub fn with_points(&self, points: &[[f32; 2]]) -> Self {
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
        Self { commands, points: points.to_vec() }
    }

    fn map(&mut self, to: impl Fn([f32; 2]) -> [f32; 2]) {
        for point in &mut self.points {
            *point = to(*point);
        }
        let moved = |p: &Vector| Vector::from(to([p.x, p.y]));
        for command in &mut self.commands {
            *command = match command {
                Command::MoveTo(p) => Command::MoveTo(moved(p)),
                Command::LineTo(p) => Command::LineTo(moved(p)),
                Command::QuadTo(c, p) => Command::QuadTo(moved(c), moved(p)),
                Command::CurveTo(a, b, p) => Command::CurveTo(moved(a), moved(b), moved(p)),
                Command::Close => Command::Close,
            };
        }
    }

    /// The outline as straight pieces `[from, to]`, curves cut into `CURVE_PIECES`.
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
                    for piece in 1..=CURVE_PIECES {
                        let t = piece as f32 / CURVE_PIECES as f32;
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
    pub fn rasterize(&self) -> Bitmap {
        if self.commands.is_empty() {
            return Bitmap::default();
        }
        let mut mask = Mask::new(self.commands.as_slice());
        // Without this call zeno 0.3 does not know the height yet when it works out `top`.
        mask.origin(Origin::BottomLeft).inspect(|_, _, _| {});
        let (pixels, place) = mask.render();
        let placement =
            Placement { left: place.left, top: place.top, width: place.width, height: place.height };
        Bitmap { placement, pixels }
    }
}

impl OutlinePen for Outline {
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
