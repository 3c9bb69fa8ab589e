//! How errors are spread: several models' histograms side by side.

use plotters::prelude::*;

use super::axis::LogAxis;
use super::frame::{ErrorSeries, FAINT, GRID, Headings, INK, chart, colour, failed, text};
use nfr_convert::error::Error;

/// As in the paper.
const BINS: usize = 30;
const HEIGHT: u32 = 340;
/// The share of a bin that bars fill.
const FILLED: f64 = 0.86;

/// Draws how many glyph bitmaps of each model have an error in each of 30 bins, the bars of a bin beside each other.
///
/// # Errors
///
/// `LimitExceeded` if the chart cannot be drawn.
pub fn error_histogram(headings: &Headings<'_>, models: &[ErrorSeries]) -> Result<String, Error> {
    let axis = LogAxis::around(models.iter().flat_map(|model| model.values.iter().copied()));
    let counts: Vec<[usize; BINS]> = models.iter().map(|model| counts(&axis, &model.values)).collect();
    let most = counts.iter().flatten().copied().max().unwrap_or(0).max(1);
    let names: Vec<&str> = models.iter().map(|model| model.name.as_str()).collect();
    chart(headings, &names, HEIGHT, |area| {
        let mut context = ChartBuilder::on(area)
            .x_label_area_size(48)
            .y_label_area_size(58)
            .build_cartesian_2d(axis, 0.0..most as f64 * 1.06)
            .map_err(failed)?;
        context
            .configure_mesh()
            .disable_x_mesh()
            .bold_line_style(GRID)
            .light_line_style(TRANSPARENT)
            .axis_style(FAINT)
            .label_style(text(INK, plotters::style::text_anchor::HPos::Left))
            .x_desc("mean squared error (coverage 0–1)")
            .y_desc("bitmaps")
            .y_labels(6)
            .y_label_formatter(&|count| format!("{count:.0}"))
            .draw()
            .map_err(failed)?;
        for (index, counts) in counts.iter().enumerate() {
            let bars = counts.iter().enumerate().filter(|(_, count)| **count > 0).map(|(bin, &count)| {
                let start = bin as f64 + (1.0 - FILLED) / 2.0;
                let edge =
                    |bar: usize| axis.at((start + FILLED * bar as f64 / models.len() as f64) / BINS as f64);
                Rectangle::new([(edge(index), 0.0), (edge(index + 1), count as f64)], colour(index).filled())
            });
            context.draw_series(bars).map_err(failed)?;
        }
        Ok(())
    })
}

fn counts(axis: &LogAxis, values: &[f64]) -> [usize; BINS] {
    let mut counts = [0; BINS];
    for value in values.iter().filter(|value| value.is_finite()) {
        counts[axis.part(*value, BINS)] += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_in_a_bin_and_zero_in_the_first() {
        let axis = LogAxis::around([1e-4, 1e-2]);
        let counts = counts(&axis, &[0.0, 1e-4, 1e-2, 1.0, f64::NAN]);
        assert_eq!((counts.iter().sum::<usize>(), counts[0], counts[BINS - 1]), (4, 1, 1));
    }
}
