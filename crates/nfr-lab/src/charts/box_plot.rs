//! Variants of one model against each other, as box plots.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axis::{LogAxis, number};
use super::frame::{Area, ErrorSeries, FAINT, GRID, Headings, INK, chart, colour, failed, text};
use crate::statistics::Summary;
use nfr_convert::error::Error;

/// The height of a variant's row, and of its box.
const ROW: u32 = 40;
const BOX: f64 = 0.5;
/// Room for the names at the left and the means at the right, in letters of this width.
const LETTER: u32 = 8;
const MEANS: u32 = 64;

type Context<'a, 's> = ChartContext<'a, SVGBackend<'s>, Cartesian2d<LogAxis, RangedCoordf64>>;

/// Draws a row for each variant: a line from the smallest error to the largest, a box around the middle half with a
/// bar at the median, a dot at the mean, and the mean as a number.
///
/// # Errors
///
/// `LimitExceeded` if the chart cannot be drawn.
pub fn box_plot(headings: &Headings<'_>, variants: &[ErrorSeries]) -> Result<String, Error> {
    let axis = LogAxis::around(variants.iter().flat_map(|variant| variant.values.iter().copied()));
    let letters = variants.iter().map(|variant| variant.name.chars().count()).max().unwrap_or(0) as u32;
    let names_width = (letters * LETTER + 16).min(360);
    let height = variants.len().max(1) as u32 * ROW + 72;
    chart(headings, &[], height, |area| {
        let mut context = ChartBuilder::on(area)
            .x_label_area_size(48)
            .y_label_area_size(names_width)
            .right_y_label_area_size(MEANS)
            .build_cartesian_2d(axis, variants.len().max(1) as f64 - 0.5..-0.5)
            .map_err(failed)?;
        context
            .configure_mesh()
            .disable_y_mesh()
            .bold_line_style(GRID)
            .light_line_style(TRANSPARENT)
            .axis_style(FAINT)
            .label_style(text(INK, HPos::Left))
            .x_desc("mean squared error (coverage 0–1); at the right: its mean")
            .y_labels(0)
            .draw()
            .map_err(failed)?;
        for (row, variant) in variants.iter().enumerate() {
            let finite = variant.values.iter().copied().filter(|value| value.is_finite());
            draw_row(area, &mut context, &axis, row, &variant.name, Summary::of(finite))?;
        }
        Ok(())
    })
}

fn draw_row<'s>(
    area: &Area<'s>,
    context: &mut Context<'_, 's>,
    axis: &LogAxis,
    row: usize,
    name: &str,
    errors: Option<Summary>,
) -> Result<(), Error> {
    let y = row as f64;
    let (left, top) = area.get_base_pixel();
    let at = |context: &Context<'_, 's>, x| {
        let (x, y) = context.backend_coord(&(x, y));
        (x - left, y - top)
    };
    let (x, middle) = at(context, axis.low());
    area.draw_text(name, &text(INK, HPos::Right), (x - 10, middle)).map_err(failed)?;
    let Some(errors) = errors else { return Ok(()) };
    let [low, first, median, third, high] = errors.quartiles;
    let shade = colour(row);
    let line =
        |from: (f64, f64), to: (f64, f64), width| PathElement::new([from, to], shade.stroke_width(width));
    let whiskers = [(low, first), (third, high)].map(|(from, to)| line((from, y), (to, y), 2));
    context.draw_series(whiskers).map_err(failed)?;
    let (upper, lower) = (y - BOX / 2.0, y + BOX / 2.0);
    let filled = Rectangle::new([(first, upper), (third, lower)], shade.mix(0.25).filled());
    let outline = Rectangle::new([(first, upper), (third, lower)], shade.stroke_width(1));
    context.draw_series([filled, outline]).map_err(failed)?;
    context.draw_series([line((median, upper), (median, lower), 3)]).map_err(failed)?;
    context.draw_series([Circle::new((errors.mean, y), 4, INK.filled())]).map_err(failed)?;
    let (right, middle) = at(context, axis.at(1.0));
    area.draw_text(&number(errors.mean), &text(INK, HPos::Left), (right + 10, middle)).map_err(failed)
}
