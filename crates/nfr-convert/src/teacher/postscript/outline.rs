//! A glyph's cubic outline as contours of `glyf`.

use std::ops::Range;

use skrifa::PathSink;
use zeno::Command;

use super::super::outline::Outline;
use super::curve::{controls, quadratics};
use super::whole::whole_controls;

/// The quadratics stay within this part of an em of the cubic curves, before their control points are rounded to font units.
const TOLERANCE: f64 = 0.0002;

/// A point of `glyf`, by points of the cubic outline.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Source {
    /// That point, which is on the curve.
    On(usize),
    /// A control point of the quadratics of a cubic.
    Control { cubic: [usize; 4], count: usize, index: usize },
}

impl Source {
    /// The place of the point if the cubic outline has these points, without rounding.
    fn place(&self, points: &[[f32; 2]]) -> [f64; 2] {
        match self {
            Self::On(point) => points[*point].map(f64::from),
            Self::Control { cubic, count, index } => [0, 1]
                .map(|axis| controls(&cubic.map(|point| f64::from(points[point][axis])), *count)[*index]),
        }
    }
}

/// A glyph whose cubic curves have become quadratic ones.
#[derive(Debug, Clone, Default)]
pub(super) struct QuadraticGlyph {
    /// The cubic outline, in font units.
    pub(super) cubic: Outline,
    sources: Vec<Source>,
    /// Coordinates along x and y, in font units.
    pub(super) points: Vec<[i16; 2]>,
    pub(super) contours: Vec<Range<usize>>,
}

impl QuadraticGlyph {
    /// Converts an outline in font units. The error says what does not fit.
    pub(super) fn new(cubic: Outline, units_per_em: u16) -> Result<Self, String> {
        let tolerance = TOLERANCE * f64::from(units_per_em);
        let mut glyph = Self { cubic, ..Self::default() };
        for contour in contours(glyph.cubic.commands()) {
            let points = glyph.points_of(&contour, tolerance);
            let start = glyph.sources.len();
            glyph.sources.extend(points);
            glyph.contours.push(start..glyph.sources.len());
        }
        if glyph.sources.len() > usize::from(u16::MAX) || glyph.contours.len() > i16::MAX as usize {
            return Err(format!("has {} points, and 'glyf' allows {}", glyph.sources.len(), u16::MAX));
        }
        glyph.points = glyph
            .whole()
            .into_iter()
            .map(|[x, y]| {
                fit(x).zip(fit(y)).map(|(x, y)| [x, y]).ok_or_else(|| {
                    format!("has a point at {x}, {y} font units, which does not fit the 16 bits of 'glyf'")
                })
            })
            .collect::<Result<_, String>>()?;
        Ok(glyph)
    }

    /// Whether a point is on the curve.
    pub(super) fn is_on_curve(&self, point: usize) -> bool {
        matches!(self.sources[point], Source::On(_))
    }

    /// The quadratic outline whose cubic one has these points; `scale` is pixels in a font unit.
    pub(super) fn outline(&self, cubic: &[[f32; 2]], scale: f64) -> Outline {
        let at = |point: usize| match &self.sources[point] {
            Source::On(of) => cubic[*of],
            Source::Control { .. } => {
                let [plain, moved] =
                    [&self.cubic.points[..], cubic].map(|cubic| self.sources[point].place(cubic));
                [0, 1].map(|axis| {
                    let rounding = f64::from(self.points[point][axis]) - plain[axis];
                    // Models hold 26.6.
                    (((moved[axis] + rounding * scale) * 64.0).round() / 64.0) as f32
                })
            }
        };
        let mut outline = Outline::default();
        for contour in &self.contours {
            let points: Vec<([f32; 2], bool)> =
                contour.clone().map(|point| (at(point), self.is_on_curve(point))).collect();
            add_contour(&points, &mut outline);
        }
        outline
    }

    /// All points in whole font units.
    fn whole(&self) -> Vec<[f64; 2]> {
        let at = |point: usize| self.cubic.points[point].map(f64::from);
        let mut last = None;
        let place = |source: &Source| match source {
            Source::On(point) => at(*point).map(f64::round),
            Source::Control { cubic, count, index } => {
                let (_, [x, y]) = match last.take() {
                    Some((of, controls)) if of == *cubic => last.insert((of, controls)),
                    _ => {
                        let axes = [0, 1].map(|axis| cubic.map(|point| at(point)[axis]));
                        last.insert((*cubic, whole_controls(&axes, *count)))
                    }
                };
                [x[*index], y[*index]]
            }
        };
        self.sources.iter().map(place).collect()
    }

    /// The points of a contour in the direction of TrueType, in which ink is to the right.
    fn points_of(&self, contour: &Contour, tolerance: f64) -> Vec<Source> {
        let mut points = vec![Source::On(contour.start)];
        let mut last = contour.start;
        for segment in &contour.segments {
            if let Segment::Curve([a, b, end]) = *segment {
                let cubic = [last, a, b, end];
                let axes = [0, 1].map(|axis| cubic.map(|point| f64::from(self.cubic.points[point][axis])));
                let count = quadratics(axes, tolerance);
                points.extend((0..count).map(|index| Source::Control { cubic, count, index }));
            }
            last = segment.end();
            points.push(Source::On(last));
        }
        // The first point stands for the last one, too, where a curve ends in it.
        if points.len() > 2 && self.cubic.points[last] == self.cubic.points[contour.start] {
            points.pop();
        }
        points[1..].reverse();
        points
    }
}

fn fit(v: f64) -> Option<i16> {
    (f64::from(i16::MIN)..=f64::from(i16::MAX)).contains(&v).then_some(v as i16)
}

/// Draws a contour that begins on the curve as skrifa draws those of `glyf`.
fn add_contour(points: &[([f32; 2], bool)], outline: &mut Outline) {
    let Some((&(start, _), rest)) = points.split_first() else { return };
    outline.move_to(start[0], start[1]);
    let mut control: Option<[f32; 2]> = None;
    for &(point, is_on) in rest {
        match (control, is_on) {
            (None, true) => outline.line_to(point[0], point[1]),
            (Some(c), true) => outline.quad_to(c[0], c[1], point[0], point[1]),
            (Some(c), false) => {
                outline.quad_to(c[0], c[1], (c[0] + point[0]) / 2.0, (c[1] + point[1]) / 2.0);
            }
            (None, false) => {}
        }
        control = (!is_on).then_some(point);
    }
    if let Some(c) = control {
        outline.quad_to(c[0], c[1], start[0], start[1]);
    }
    outline.close();
}

/// A contour of a path, by the numbers of its points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contour {
    pub(super) start: usize,
    pub(super) segments: Vec<Segment>,
}

/// A part of a contour, from the end of the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Segment {
    Line(usize),
    Curve([usize; 3]),
}

impl Segment {
    /// The point in which it ends.
    pub(super) fn end(&self) -> usize {
        match self {
            Self::Line(end) | Self::Curve([_, _, end]) => *end,
        }
    }
}

/// The contours of a path of lines and cubic curves.
pub(super) fn contours(commands: &[Command]) -> Vec<Contour> {
    let mut contours: Vec<Contour> = Vec::new();
    let mut at = 0;
    for command in commands {
        let segment = match command {
            Command::MoveTo(_) => {
                contours.push(Contour { start: at, segments: Vec::new() });
                at += 1;
                continue;
            }
            Command::LineTo(_) => Segment::Line(at),
            Command::CurveTo(..) => Segment::Curve([at, at + 1, at + 2]),
            // Charstrings have no quadratic curves.
            Command::QuadTo(..) | Command::Close => continue,
        };
        at = segment.end() + 1;
        if let Some(contour) = contours.last_mut() {
            contour.segments.push(segment);
        }
    }
    contours
}
