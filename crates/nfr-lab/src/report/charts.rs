//! The report's charts.

use std::collections::BTreeMap;

use maud::{Markup, html};

use super::content::{ReportContext, ReportFigure, ReportSection, compared_models, rows_of_model};
use crate::charts::{
    ErrorSeries, GlyphSeries, Headings, Line, SizeSeries, box_plot, error_by_glyph, error_by_size,
    error_histogram, lines, loss_history,
};
use crate::dataset::Dataset;
use crate::error_table::{ErrorRow, summaries};
use crate::evaluation::Evaluation;
use crate::network_variant::{Ablation, NetworkVariant};
use crate::output::loss_line;
use crate::resize::Method;
use crate::schedule::resets;
use crate::study::UNHINTED;
use nfr_convert::error::Error;

const SIZE_AXES: [&str; 2] = ["size of the box s (pixels)", "mean squared error (coverage 0–1)"];

/// All charts.
pub(super) fn sections(context: &ReportContext<'_>) -> Result<Vec<ReportSection>, Error> {
    Ok(vec![
        histograms(context)?,
        by_size(context)?,
        by_glyph(context)?,
        ablations(context)?,
        losses(context)?,
        without_models(context)?,
    ])
}

fn svg(file: &str, chart: String, caption: impl Into<String>) -> ReportFigure {
    ReportFigure { file: file.into(), bytes: chart.into_bytes(), caption: caption.into() }
}

fn errors(rows: &[ErrorRow]) -> Vec<f64> {
    rows.iter().map(|row| row.mse).collect()
}

fn histograms(context: &ReportContext<'_>) -> Result<ReportSection, Error> {
    let label = context.label();
    let figure = |dataset: &Dataset| -> Result<Option<ReportFigure>, Error> {
        let series = compared_models().map(|model| {
            let rows = rows_of_model(&context.results.evaluations, &model);
            let values = rows.into_iter().filter(|row| row.font == dataset.name).map(|row| row.mse);
            ErrorSeries { name: model, values: values.collect() }
        });
        if series.iter().all(|model| model.values.is_empty()) {
            return Ok(None);
        }
        let title = format!("Errors on {}", dataset.name);
        let chart = error_histogram(&Headings { title: &title, subtitle: &label }, &series)?;
        let caption =
            format!("{}: how many bitmaps, of all characters and sizes, have which error.", dataset.name);
        Ok(Some(svg(&format!("histogram-{}.svg", dataset.name), chart, caption)))
    };
    Ok(ReportSection {
        title: "Masked network, implicit network and grid-fit field",
        text: html! {
            "The mean squared error of every bitmap of the characters " (context.plan.glyphs) ", font by font. The \
             grid-fit field is this project's own model with its default options."
        },
        figures: context
            .plan
            .fonts
            .iter()
            .filter_map(|font| figure(font).transpose())
            .collect::<Result<_, _>>()?,
    })
}

fn by_size(context: &ReportContext<'_>) -> Result<ReportSection, Error> {
    let series = compared_models().map(|model| {
        let rows = rows_of_model(&context.results.evaluations, &model);
        SizeSeries { name: model, sizes: summaries(&rows, |row| row.side).into_iter().collect() }
    });
    let label = context.label();
    let chart = error_by_size(&Headings { title: "Error by size", subtitle: &label }, &series)?;
    let caption = "The mean over all characters and fonts, in a band of one standard deviation.";
    Ok(ReportSection {
        title: "Error by size",
        text: Markup::default(),
        figures: vec![svg("by-size.svg", chart, caption)],
    })
}

fn by_glyph(context: &ReportContext<'_>) -> Result<ReportSection, Error> {
    let series = compared_models().map(|model| {
        let rows = rows_of_model(&context.results.evaluations, &model);
        let glyphs =
            summaries(&rows, |row| row.glyph).into_iter().map(|(glyph, errors)| (glyph, errors.mean));
        GlyphSeries { name: model, glyphs: glyphs.collect() }
    });
    let label = context.label();
    let chart = error_by_glyph(&Headings { title: "Error by character", subtitle: &label }, &series)?;
    let caption = "The mean over all sizes and fonts.";
    Ok(ReportSection {
        title: "Error by character",
        text: Markup::default(),
        figures: vec![svg("by-glyph.svg", chart, caption)],
    })
}

fn ablations(context: &ReportContext<'_>) -> Result<ReportSection, Error> {
    let full = NetworkVariant::Implicit(Vec::new()).name();
    let whole = rows_of_model(&context.results.evaluations, &full).into_iter();
    let whole = whole.filter(|row| row.font == context.font() && context.plan.ablated.contains(row.glyph));
    let mut variants = vec![ErrorSeries { values: whole.map(|row| row.mse).collect(), name: full }];
    for ablation in Ablation::ALL {
        let name = NetworkVariant::Implicit(vec![ablation]).name();
        variants
            .push(ErrorSeries { values: errors(&rows_of_model(&context.results.ablations, &name)), name });
    }
    let title = "The implicit network without its parts";
    if variants[1..].iter().all(|variant| variant.values.is_empty()) {
        return Ok(ReportSection::not_run(title));
    }
    let label = context.label();
    let chart = box_plot(&Headings { title: "Ablations", subtitle: &label }, &variants)?;
    let caption = format!(
        "{}, the characters {:?} at all sizes: from the least error to the greatest, the middle half, the median (bar) and \
         the mean (dot, number).",
        context.font(),
        context.plan.ablated
    );
    Ok(ReportSection {
        title,
        text: html! {
            "Without the size as an input the network is that of the published code for one weight: it tells sizes \
             apart by where their pixels lie and by the statistics of the batch."
        },
        figures: vec![svg("ablations.svg", chart, caption)],
    })
}

fn losses(context: &ReportContext<'_>) -> Result<ReportSection, Error> {
    let label = context.label();
    let mut figures = Vec::new();
    for (model, file) in compared_models().iter().zip(["loss-masked.svg", "loss-implicit.svg"]) {
        let selected =
            |evaluation: &&Evaluation| evaluation.model == *model && evaluation.font == context.font();
        let evaluations: Vec<&Evaluation> = context.results.evaluations.iter().filter(selected).collect();
        let curves: Vec<Line> = evaluations
            .iter()
            .map(|evaluation| loss_line(&evaluation.glyph.to_string(), &evaluation.history))
            .collect();
        let Some(first) = evaluations.first() else { continue };
        let rates: Vec<f64> = first.history.iter().map(|epoch| epoch.rate).collect();
        let starts: Vec<f64> = resets(&rates).into_iter().map(|epoch| epoch as f64).collect();
        let title = format!("Loss of the {model} network on {}", context.font());
        let chart = loss_history(&Headings { title: &title, subtitle: &label }, &curves, &starts)?;
        let caption = "A curve for each character; dashed where the learning rate starts anew.";
        figures.push(svg(file, chart, caption));
    }
    let text = if figures.is_empty() { Markup::default() } else { trainings(context) };
    Ok(ReportSection { title: "Training", text, figures })
}

/// The trainings by network and device: how many there are, what they took, and how fast they went.
fn trainings(context: &ReportContext<'_>) -> Markup {
    let mut groups: BTreeMap<(&str, &str, usize, usize), Vec<&Evaluation>> = BTreeMap::new();
    for one in context.results.evaluations.iter().chain(&context.results.ablations) {
        if let Some(origin) = &one.origin {
            groups
                .entry((&one.model, &origin.device, origin.together, one.history.len()))
                .or_default()
                .push(one);
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    html! {
        table {
            tr { @for name in ["network", "device", "in lockstep", "trainings", "epochs", "seconds of one", "TFLOP/s"] { th { (name) } } }
            @for ((model, device, together, epochs), all) in &groups {
                @let seconds: Vec<f64> = all.iter().filter_map(|one| one.seconds()).collect();
                @let rates: Vec<f64> = all.iter().filter_map(|one| one.operations_per_second()).collect();
                tr {
                    td { (model) } td { (device) } td { (together) } td { (all.len()) } td { (epochs) }
                    @if seconds.is_empty() { td { "–" } td { "–" } }
                    @else { td { (format!("{:.1}", mean(&seconds))) } td { (format!("{:.3}", mean(&rates) / 1e12)) } }
                }
            }
        }
    }
}

fn without_models(context: &ReportContext<'_>) -> Result<ReportSection, Error> {
    let curve = |name: &str, rows: &[ErrorRow]| {
        let points = summaries(rows, |row| row.side).into_iter().map(|(side, s)| [side as f64, s.mean]);
        Line { name: name.to_owned(), points: points.collect() }
    };
    let on_font = |model: &str| -> Vec<ErrorRow> {
        rows_of_model(&context.results.evaluations, model)
            .into_iter()
            .filter(|row| row.font == context.font())
            .collect()
    };
    let mut methods: Vec<Line> = Vec::new();
    for method in Method::ALL {
        let rows = context.results.resized.iter().filter(|row| row.model == method.name());
        methods.push(curve(method.name(), &rows.cloned().collect::<Vec<_>>()));
    }
    let unhinted = curve(UNHINTED, &context.results.unhinted);
    let [_, implicit, grid_fit] = compared_models();
    let trained = [curve(&implicit, &on_font(&implicit)), curve(&grid_fit, &on_font(&grid_fit))];
    let label = context.label();
    methods.extend(trained.iter().cloned());
    let resizing = lines(
        &Headings { title: "The largest bitmap, shrunk, against the hinted one", subtitle: &label },
        SIZE_AXES,
        &methods,
    )?;
    let hinting = lines(
        &Headings { title: "Unhinted against hinted", subtitle: &label },
        SIZE_AXES,
        &[&[unhinted][..], &trained].concat(),
    )?;
    let caption = format!("{}, the mean over the characters {:?}.", context.font(), context.plan.glyphs);
    Ok(ReportSection {
        title: "Why not resize, why hint",
        text: html! {
            "Both figures compare with the hinted bitmap of each size; the networks and our model are there for scale."
        },
        figures: vec![svg("resizing.svg", resizing, caption.clone()), svg("hinting.svg", hinting, caption)],
    })
}
