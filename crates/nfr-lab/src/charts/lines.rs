//! Curves: errors by size, losses by epoch, anything else by anything else.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axis::LogAxis;
use super::frame::{FAINT, GRID, Headings, INK, chart, colour, failed, text};
use crate::statistics::Summary;
use nfr_convert::error::Error;

const HEIGHT: u32 = 360;
/// No curve has more points than a chart has columns; of longer ones the mean of each piece is drawn.
const MOST_POINTS: usize = 800;
/// Up to so many points, each has a dot.
const MOST_DOTS: usize = 60;

/// A curve: its name in the legend, and its points, x ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The name.
    pub name: String,
    /// x and y.
    pub points: Vec<[f64; 2]>,
}

/// A model's errors at each size of the box.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeSeries {
    /// The model's name.
    pub name: String,
    /// The side in pixels, and the errors there; sides ascending.
    pub sizes: Vec<(usize, Summary)>,
}

/// Draws each model's mean error by size, in a band of one standard deviation up and down, cut off where no error is
/// so small or so large.
///
/// # Errors
///
/// `LimitExceeded` if the chart cannot be drawn.
pub fn error_by_size(headings: &Headings<'_>, models: &[SizeSeries]) -> Result<String, Error> {
    let curve = |model: &SizeSeries| {
        let point = |(side, errors): &(usize, Summary)| {
            let [low, .., high] = errors.quartiles;
            let (below, above) = (errors.mean - errors.deviation, errors.mean + errors.deviation);
            Point { x: *side as f64, y: errors.mean, band: Some([below.max(low), above.min(high)]) }
        };
        Curve { name: model.name.clone(), points: model.sizes.iter().map(point).collect() }
    };
    let curves: Vec<Curve> = models.iter().map(curve).collect();
    let axes = ["size of the box s (pixels)", "mean squared error (coverage 0–1)"];
    draw(headings, axes, &curves, &[])
}

/// Draws curves over linear x and logarithmic y.
///
/// # Errors
///
/// `LimitExceeded` if the chart cannot be drawn.
pub fn lines(headings: &Headings<'_>, axes: [&str; 2], curves: &[Line]) -> Result<String, Error> {
    draw(headings, axes, &curves.iter().map(Curve::plain).collect::<Vec<_>>(), &[])
}

/// Draws losses over epochs, and a dashed line at each epoch where the learning rate starts anew.
///
/// # Errors
///
/// `LimitExceeded` if the chart cannot be drawn.
pub fn loss_history(headings: &Headings<'_>, curves: &[Line], resets: &[f64]) -> Result<String, Error> {
    let axes = ["epoch (dashed: the learning rate starts anew)", "loss"];
    let axes = if resets.is_empty() { ["epoch", axes[1]] } else { axes };
    draw(headings, axes, &curves.iter().map(Curve::plain).collect::<Vec<_>>(), resets)
}

struct Curve {
    name: String,
    points: Vec<Point>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Point {
    x: f64,
    y: f64,
    band: Option<[f64; 2]>,
}

impl Curve {
    fn plain(line: &Line) -> Self {
        let finite = line.points.iter().filter(|point| point.iter().all(|v| v.is_finite()));
        let points: Vec<[f64; 2]> = finite.copied().collect();
        let piece = points.len().div_ceil(MOST_POINTS).max(1);
        let mean = |piece: &[[f64; 2]]| {
            let [x, y] = [0, 1].map(|k| piece.iter().map(|p| p[k]).sum::<f64>() / piece.len() as f64);
            Point { x, y, band: None }
        };
        Self { name: line.name.clone(), points: points.chunks(piece).map(mean).collect() }
    }

    /// The band's outline: its upper edge from left to right, then its lower edge back.
    fn band(&self) -> Vec<(f64, f64)> {
        let edge = |k: usize| self.points.iter().filter_map(move |p| Some((p.x, p.band?[k])));
        let lower: Vec<_> = edge(0).collect();
        edge(1).chain(lower.into_iter().rev()).collect()
    }
}

fn draw(headings: &Headings<'_>, axes: [&str; 2], curves: &[Curve], dashed: &[f64]) -> Result<String, Error> {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let y_axis = LogAxis::around(points().flat_map(|p| p.band.into_iter().flatten().chain([p.y])));
    let names: Vec<&str> = curves.iter().map(|curve| curve.name.as_str()).collect();
    chart(headings, &names, HEIGHT, |area| {
        let mut context = ChartBuilder::on(area)
            .x_label_area_size(48)
            .y_label_area_size(76)
            .build_cartesian_2d(x_range(points().map(|p| p.x).chain(dashed.iter().copied())), y_axis)
            .map_err(failed)?;
        context
            .configure_mesh()
            .bold_line_style(GRID)
            .light_line_style(TRANSPARENT)
            .axis_style(FAINT)
            .label_style(text(INK, HPos::Left))
            .x_desc(axes[0])
            .y_desc(axes[1])
            .x_label_formatter(&|x| format!("{}", (x * 100.0).round() / 100.0))
            .draw()
            .map_err(failed)?;
        for &x in dashed {
            let [low, high] = [y_axis.low(), y_axis.at(1.0)];
            context
                .draw_series(DashedLineSeries::new([(x, low), (x, high)], 5, 4, FAINT.into()))
                .map_err(failed)?;
        }
        for (index, curve) in curves.iter().enumerate() {
            let band = Polygon::new(curve.band(), colour(index).mix(0.16));
            context.draw_series([band]).map_err(failed)?;
        }
        for (index, curve) in curves.iter().enumerate() {
            let path = || curve.points.iter().map(|p| (p.x, p.y));
            context.draw_series(LineSeries::new(path(), colour(index).stroke_width(2))).map_err(failed)?;
            if curve.points.len() <= MOST_DOTS {
                let dots = path().map(|point| Circle::new(point, 3, colour(index).filled()));
                context.draw_series(dots).map_err(failed)?;
            }
        }
        Ok(())
    })
}

/// All values with a little room; never empty.
fn x_range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return 0.0..1.0;
    }
    let room = ((high - low) * 0.02).max(0.5);
    low - room..high + room
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_is_drawn_by_the_means_of_its_pieces() {
        let points = (0..2400).map(|i| [f64::from(i), f64::from(i % 3)]).chain([[9.0, f64::NAN]]).collect();
        let curve = Curve::plain(&Line { name: String::new(), points });
        assert_eq!(curve.points.len(), 800);
        assert_eq!(curve.points[1], Point { x: 4.0, y: 1.0, band: None });
    }

    #[test]
    fn a_band_goes_there_above_and_back_below() {
        let point = |x| Point { x, y: 2.0, band: Some([1.0, 3.0]) };
        let curve = Curve { name: String::new(), points: vec![point(0.0), point(1.0)] };
        assert_eq!(curve.band(), [(0.0, 3.0), (1.0, 3.0), (1.0, 1.0), (0.0, 1.0)]);
    }
}
