//! The report's pictures.

use image::RgbImage;
use maud::{Markup, html};

use super::content::{ReportContext, ReportFigure, ReportSection, compared_models};
use crate::SquareBitmap;
use crate::evaluation::Evaluation;
use crate::interpolation::Interpolation;
use crate::output::{COLUMNS, between};
use crate::pictures::{BitmapRow, PredictionRow, bitmap_rows, captioned, prediction_rows, size_series};
use crate::resize::{Method, shrunk};
use nfr_convert::compare::picture::{LabelFont, png};
use nfr_convert::error::Error;

/// The enlargement of single bitmaps, of large ones, and of those at all sizes.
const ZOOM: u32 = 5;
const LARGE_ZOOM: u32 = 3;
const SERIES_ZOOM: u32 = 3;
/// Boxes with longer sides are large.
const LARGE_SIDE: usize = 40;

/// All pictures.
pub(super) fn sections(context: &ReportContext<'_>) -> Result<Vec<ReportSection>, Error> {
    let pictures = Pictures { context, font: context.plan.fonts[0].label_font()? };
    Ok(vec![
        pictures.predictions()?,
        pictures.series()?,
        pictures.bitmaps()?,
        pictures.family("Between two weights", "weights", &context.results.weights)?,
        pictures.family("Between two typefaces", "styles", &context.results.styles)?,
        stored(context),
    ])
}

struct Pictures<'r> {
    context: &'r ReportContext<'r>,
    font: LabelFont,
}

impl Pictures<'_> {
    /// A picture, with a line that says at which scale it was made.
    fn figure(
        &self,
        file: String,
        picture: &RgbImage,
        caption: impl Into<String>,
    ) -> Result<ReportFigure, Error> {
        let note = self.context.experiment.settings.scale_note();
        Ok(ReportFigure {
            file,
            bytes: png(&captioned(&self.font, picture, note)?)?,
            caption: caption.into(),
        })
    }

    /// The models' evaluations of a character on the first font.
    fn evaluations(&self, glyph: char) -> Vec<&Evaluation> {
        let font = self.context.font();
        let find = |model: String| {
            let mut all = self.context.results.evaluations.iter();
            all.find(|one| one.model == model && one.font == font && one.glyph == glyph)
        };
        compared_models().into_iter().filter_map(find).collect()
    }

    fn predictions(&self) -> Result<ReportSection, Error> {
        let mut figures = Vec::new();
        let sizes = self.context.plan.fonts[0].truth.sizes.len();
        for (name, size) in [("small", 0), ("large", sizes.saturating_sub(2))] {
            let evaluations: Vec<&Evaluation> =
                self.context.plan.ablated.chars().flat_map(|glyph| self.evaluations(glyph)).collect();
            let labels: Vec<String> =
                evaluations.iter().map(|one| format!("{} {}", one.glyph, one.model)).collect();
            let rows = evaluations.iter().zip(&labels).filter_map(|(one, label)| {
                Some(PredictionRow { label, prediction: one.drawn.get(size)?, truth: one.truth.get(size)? })
            });
            let rows: Vec<PredictionRow<'_>> = rows.collect();
            // Nothing of these characters may be finished yet.
            let Some(side) = rows.first().map(|row| row.truth.side) else { continue };
            let zoom = if side > LARGE_SIDE { LARGE_ZOOM } else { ZOOM };
            let caption = format!(
                "{}, boxes of {side}×{side} pixels: what the model draws, its error (red too dark, blue too light), the \
                 truth.",
                self.context.font()
            );
            let picture = prediction_rows(&self.font, &rows, zoom)?;
            figures.push(self.figure(format!("triptychs-{name}.png"), &picture, caption)?);
        }
        Ok(ReportSection { title: "Prediction, error, truth", text: Markup::default(), figures })
    }

    fn series(&self) -> Result<ReportSection, Error> {
        let mut figures = Vec::new();
        for glyph in self.context.plan.ablated.chars() {
            let evaluations = self.evaluations(glyph);
            let Some(first) = evaluations.first() else { continue };
            let mut rows = vec![BitmapRow { label: "truth", squares: first.truth.iter().collect() }];
            rows.extend(
                evaluations
                    .iter()
                    .map(|one| BitmapRow { label: &one.model, squares: one.drawn.iter().collect() }),
            );
            let file = format!("cascade-u{:04x}.png", u32::from(glyph));
            let picture = size_series(&self.font, &rows, COLUMNS, SERIES_ZOOM)?;
            figures.push(self.figure(file, &picture, format!("{}: {glyph}", self.context.font()))?);
        }
        Ok(ReportSection { title: "Cascades over all sizes", text: Markup::default(), figures })
    }

    fn bitmaps(&self) -> Result<ReportSection, Error> {
        let dataset = self.context.plan.all_sizes;
        let mut rows: Vec<(String, Vec<SquareBitmap>)> = Vec::new();
        let mut hinting: Vec<(String, Vec<SquareBitmap>)> = Vec::new();
        for (glyph, gid) in dataset.glyphs(self.context.plan.ablated)? {
            let mut squares = vec![dataset.truth.hinted(gid, 0)?];
            for method in Method::ALL {
                squares.push(shrunk(&dataset.truth, gid, 0, method)?.0);
            }
            rows.push((glyph.to_string(), squares));
            hinting
                .push((glyph.to_string(), vec![dataset.truth.hinted(gid, 0)?, dataset.truth.plain(gid, 0)?]));
        }
        let mut headings = vec!["hinted"];
        headings.extend(Method::ALL.map(Method::name));
        let wrong: Vec<(String, Vec<SquareBitmap>)> = self
            .context
            .results
            .wrong_pixel
            .iter()
            .map(|one| (one.glyph.to_string(), vec![one.truth.clone(), one.wrong.clone()]))
            .collect();
        let side = dataset.truth.sizes.first().map_or(0, |size| size.side);
        let figure =
            |file: &str, headings: &[&str], rows: &[(String, Vec<SquareBitmap>)], caption: String| {
                let rows: Vec<BitmapRow<'_>> = rows
                    .iter()
                    .map(|(label, squares)| BitmapRow { label, squares: squares.iter().collect() })
                    .collect();
                self.figure(file.into(), &bitmap_rows(&self.font, headings, &rows, ZOOM)?, caption)
            };
        let font = self.context.font();
        Ok(ReportSection {
            title: "Bitmaps without models",
            text: Markup::default(),
            figures: vec![
                figure(
                    "resizing.png",
                    &headings,
                    &rows,
                    format!("{font}, s = {side}: hinted, and shrunk from the largest."),
                )?,
                figure("hinting.png", &["hinted", "unhinted"], &hinting, format!("{font}, s = {side}."))?,
                figure(
                    "wrong-pixel.png",
                    &["truth", "wrong"],
                    &wrong,
                    format!("{font}, s = {side}: one pixel of ink gone."),
                )?,
            ],
        })
    }

    fn family(
        &self,
        title: &'static str,
        experiment: &str,
        all: &[Interpolation],
    ) -> Result<ReportSection, Error> {
        if all.is_empty() {
            return Ok(ReportSection::not_run(title));
        }
        let mut figures = Vec::new();
        for one in all {
            let picture = between(&self.font, one)?;
            let real = one.between.iter().any(|rendering| rendering.truth.is_some());
            let caption = format!(
                "{}: the first font as it is, what lies half-way between the two (by the implicit network's interpolated \
                 latent vector, by our two models interpolated, the same with snapped knots{}), the last font as it is.",
                one.glyph,
                if real { ", and the real font" } else { "" }
            );
            let file = format!("{experiment}-u{:04x}.png", u32::from(one.glyph));
            figures.push(self.figure(file, &picture, caption)?);
        }
        let renderings =
            || all.iter().flat_map(|one| one.ends.iter().chain(&one.between).map(|r| (one.glyph, r)));
        let text = html! {
            table {
                tr { @for name in ["character", "compared with", "drawn by", "mse"] { th { (name) } } }
                @for (glyph, rendering) in renderings() {
                    tr {
                        td { (glyph) }
                        td { (rendering.of) }
                        td { (rendering.name) }
                        td { (rendering.mse().map_or_else(|| "no truth".into(), |mse| format!("{mse:.2e}"))) }
                    }
                }
            }
        };
        Ok(ReportSection { title, text, figures })
    }
}

fn stored(context: &ReportContext<'_>) -> ReportSection {
    let title = "The network in a font";
    if context.results.stored.is_empty() {
        return ReportSection::not_run(title);
    }
    let bytes = &context.results.grid_fit_bytes;
    let mean_bytes = bytes.iter().sum::<usize>() as f64 / bytes.len().max(1) as f64;
    let text = html! {
        p {
            "A trained implicit network in the table " code { "Nfrt" } ", drawn by the library's usual call, which draws \
             the hinted glyph's box alone: errors, before it was stored too, are without what it draws beside the glyph. \
             Our own models take " (format!("{mean_bytes:.0}")) " bytes a character."
        }
        table {
            tr { @for name in ["character", "bits", "bytes", "mse", "mse before", "mae"] { th { (name) } } }
            @for one in &context.results.stored {
                tr {
                    td { (one.glyph) }
                    td { (one.bits) }
                    td { (one.bytes) }
                    td { (format!("{:.3e}", one.evaluation.mse())) }
                    td { (format!("{:.3e}", one.mse_before)) }
                    td { (format!("{:.4}", one.evaluation.mae())) }
                }
            }
        }
    };
    ReportSection { title, text, figures: Vec::new() }
}
