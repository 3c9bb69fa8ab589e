//! A line chart as inline SVG, whose lines take their colours from the page's style sheet.

use maud::{Markup, html};

/// The drawing's size and the room for its axes, in CSS pixels.
const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 260.0;
const LEFT: f64 = 60.0;
const BOTTOM: f64 = 32.0;
const TOP: f64 = 8.0;
const RIGHT: f64 = 12.0;
/// About so many lines across, and numbers below.
const TICKS: f64 = 6.0;

/// One line of the chart: its CSS class and its points, x ascending.
pub(super) struct Series<'s> {
    pub(super) class: &'s str,
    pub(super) points: Vec<(f64, f64)>,
}

/// Draws the series over one x axis; y starts at 0.
pub(super) fn line_chart(series: &[Series<'_>], x_label: &str) -> Markup {
    let points = || series.iter().flat_map(|line| &line.points);
    let (x_min, x_max) =
        points().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| (lo.min(p.0), hi.max(p.0)));
    let y_max = points().fold(0.0, |max: f64, p| max.max(p.1));
    // One size, or no error at all, still needs an axis of some length.
    let (x_span, y_top) = ((x_max - x_min).max(1.0), if y_max > 0.0 { y_max * 1.05 } else { 1.0 });
    let x = |value: f64| format!("{:.1}", LEFT + (value - x_min) / x_span * (WIDTH - LEFT - RIGHT));
    let y = |value: f64, below: f64| {
        format!("{:.1}", HEIGHT - BOTTOM - value / y_top * (HEIGHT - TOP - BOTTOM) + below)
    };
    html! {
        svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" {
            @for value in ticks(0.0, y_top) {
                line.grid x1=(LEFT) x2=(WIDTH - RIGHT) y1=(y(value, 0.0)) y2=(y(value, 0.0)) {}
                text x=(LEFT - 6.0) y=(y(value, 4.0)) text-anchor="end" { (format!("{value:.4}")) }
            }
            @for value in ticks(x_min, x_min + x_span).into_iter().filter(|value| value.fract() == 0.0) {
                text x=(x(value)) y=(HEIGHT - BOTTOM + 14.0) text-anchor="middle" { (value) }
            }
            text x=((LEFT + WIDTH - RIGHT) / 2.0) y=(HEIGHT - 4.0) text-anchor="middle" { (x_label) }
            @for line in series {
                polyline class=(line.class)
                    points=(line.points.iter().map(|p| x(p.0) + "," + &y(p.1, 0.0) + " ").collect::<String>()) {}
                @for point in &line.points {
                    circle class=(line.class) cx=(x(point.0)) cy=(y(point.1, 0.0)) r="2" {}
                }
            }
        }
    }
}

/// Multiples of 1, 2 or 5 times a power of ten from `from` to `to`.
fn ticks(from: f64, to: f64) -> Vec<f64> {
    let raw = (to - from) / TICKS;
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|&step| step >= raw).unwrap_or(raw);
    let (first, last) = ((from / step).ceil() as i64, (to / step).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(ticks(8.0, 64.0), [10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
        assert_eq!(ticks(0.0, 1.0), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
    }

    #[test]
    fn one_point_without_error_still_draws() {
        let svg = line_chart(&[Series { class: "neural", points: vec![(12.0, 0.0)] }], "ppem").into_string();
        assert!(svg.contains("polyline") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
}
