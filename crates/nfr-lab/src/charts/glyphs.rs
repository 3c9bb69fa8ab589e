//! Errors glyph by glyph.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axis::LogAxis;
use super::frame::{FAINT, GRID, Headings, INK, chart, colour, failed, text};
use nfr_convert::error::Error;

const HEIGHT: u32 = 340;
/// The share of a glyph's column where the models' marks stand.
const FILLED: f64 = 0.7;

/// A model's error at each glyph.
#[derive(Debug, Clone, PartialEq)]
pub struct GlyphSeries {
    /// The model's name.
    pub name: String,
    /// Each glyph and its error.
    pub glyphs: Vec<(char, f64)>,
}

/// Draws each model's error at each glyph as a dot on a stem, glyphs ascending.
///
/// # Errors
///
/// `LimitExceeded` if the chart cannot be drawn.
pub fn error_by_glyph(headings: &Headings<'_>, models: &[GlyphSeries]) -> Result<String, Error> {
    let all = || models.iter().flat_map(|model| &model.glyphs);
    let mut glyphs: Vec<char> = all().map(|(glyph, _)| *glyph).collect();
    glyphs.sort_unstable();
    glyphs.dedup();
    let axis = LogAxis::around(all().map(|(_, error)| *error));
    let names: Vec<&str> = models.iter().map(|model| model.name.as_str()).collect();
    chart(headings, &names, HEIGHT, |area| {
        let mut context = ChartBuilder::on(area)
            .x_label_area_size(48)
            .y_label_area_size(76)
            .build_cartesian_2d(-0.5..glyphs.len().max(1) as f64 - 0.5, axis)
            .map_err(failed)?;
        context
            .configure_mesh()
            .disable_x_mesh()
            .bold_line_style(GRID)
            .light_line_style(TRANSPARENT)
            .axis_style(FAINT)
            .label_style(text(INK, HPos::Left))
            .x_desc("glyph")
            .y_desc("mean squared error (coverage 0–1)")
            .x_labels(0)
            .draw()
            .map_err(failed)?;
        // Labels under the columns are drawn by hand: the library's stand at round numbers only.
        let label = text(INK, HPos::Center);
        for (column, glyph) in glyphs.iter().enumerate() {
            let (x, y) = context.backend_coord(&(column as f64, axis.low()));
            let (left, top) = area.get_base_pixel();
            area.draw_text(&glyph.to_string(), &label, (x - left, y - top + 14)).map_err(failed)?;
        }
        for (index, model) in models.iter().enumerate() {
            let offset = FILLED * ((index as f64 + 0.5) / models.len() as f64 - 0.5);
            let marks: Vec<(f64, f64)> = model
                .glyphs
                .iter()
                .filter(|(_, error)| error.is_finite())
                .filter_map(|(glyph, error)| {
                    Some((glyphs.binary_search(glyph).ok()? as f64 + offset, *error))
                })
                .collect();
            let stem = |&(x, y): &(f64, f64)| {
                PathElement::new([(x, axis.low()), (x, y)], colour(index).mix(0.35).stroke_width(2))
            };
            context.draw_series(marks.iter().map(stem)).map_err(failed)?;
            let dot = |&point: &(f64, f64)| Circle::new(point, 4, colour(index).filled());
            context.draw_series(marks.iter().map(dot)).map_err(failed)?;
        }
        Ok(())
    })
}
