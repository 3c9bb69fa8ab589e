//! The report's charts.

use super::super::charts::{
    GlyphSeries, Headings, Line, Series, SizeSeries, ablations, error_by_glyph, error_by_size,
    error_histogram, lines, loss_history,
};
use super::super::error::{ErrorRow, summaries};
use super::super::output::loss_line;
use super::super::schedule::resets;
use super::super::single::{Ablation, GRID_FIT, Model, Outcome};
use super::super::study::UNHINTED;
use super::{Figure, Part, Section, of_model};
use nfr_convert::compare::html::escape;
use nfr_convert::error::Error;

const SIZE_AXES: [&str; 2] = ["size of the box s (pixels)", "mean squared error (coverage 0–1)"];

/// The models in the order in which charts and pictures have them.
pub(super) fn models() -> [String; 3] {
    [Model::Masked.name(), Model::Implicit(Vec::new()).name(), GRID_FIT.to_owned()]
}

/// All charts.
pub(super) fn sections(part: &Part<'_>) -> Result<Vec<Section>, Error> {
    Ok(vec![
        histograms(part)?,
        by_size(part)?,
        by_glyph(part)?,
        without(part)?,
        losses(part)?,
        no_models(part)?,
    ])
}

fn svg(file: &str, chart: String, caption: impl Into<String>) -> Figure {
    Figure { file: file.into(), bytes: chart.into_bytes(), caption: caption.into() }
}

fn errors(rows: &[ErrorRow]) -> Vec<f64> {
    rows.iter().map(|row| row.mse).collect()
}

fn histograms(part: &Part<'_>) -> Result<Section, Error> {
    let label = part.label();
    let figure = |subject: &super::super::bench::Subject| {
        let series = models().map(|model| {
            let rows = of_model(&part.findings.outcomes, &model);
            let values = rows.into_iter().filter(|row| row.font == subject.name).map(|row| row.mse);
            Series { name: model, values: values.collect() }
        });
        let title = format!("Errors on {}", subject.name);
        let chart = error_histogram(&Headings { title: &title, subtitle: &label }, &series)?;
        let caption =
            format!("{}: how many bitmaps, of all characters and sizes, have which error.", subject.name);
        Ok(svg(&format!("histogram-{}.svg", subject.name), chart, caption))
    };
    Ok(Section {
        title: "Masked network, implicit network and grid-fit field",
        text: format!(
            "The mean squared error of every bitmap of the characters {}, on three fonts. The grid-fit field is this \
             project's own model with its default options.",
            escape(part.plan.glyphs)
        ),
        figures: part.plan.fonts.iter().map(figure).collect::<Result<_, Error>>()?,
    })
}

fn by_size(part: &Part<'_>) -> Result<Section, Error> {
    let series = models().map(|model| {
        let rows = of_model(&part.findings.outcomes, &model);
        SizeSeries { name: model, sizes: summaries(&rows, |row| row.side).into_iter().collect() }
    });
    let label = part.label();
    let chart = error_by_size(&Headings { title: "Error by size", subtitle: &label }, &series)?;
    let caption = "The mean over all characters and fonts, in a band of one standard deviation.";
    Ok(Section {
        title: "Error by size",
        text: String::new(),
        figures: vec![svg("by-size.svg", chart, caption)],
    })
}

fn by_glyph(part: &Part<'_>) -> Result<Section, Error> {
    let series = models().map(|model| {
        let rows = of_model(&part.findings.outcomes, &model);
        let glyphs =
            summaries(&rows, |row| row.glyph).into_iter().map(|(glyph, errors)| (glyph, errors.mean));
        GlyphSeries { name: model, glyphs: glyphs.collect() }
    });
    let label = part.label();
    let chart = error_by_glyph(&Headings { title: "Error by character", subtitle: &label }, &series)?;
    let caption = "The mean over all sizes and fonts.";
    Ok(Section {
        title: "Error by character",
        text: String::new(),
        figures: vec![svg("by-glyph.svg", chart, caption)],
    })
}

fn without(part: &Part<'_>) -> Result<Section, Error> {
    let full = Model::Implicit(Vec::new()).name();
    let whole = of_model(&part.findings.outcomes, &full).into_iter();
    let whole = whole.filter(|row| row.font == part.font() && part.plan.ablated.contains(row.glyph));
    let mut variants = vec![Series { values: whole.map(|row| row.mse).collect(), name: full }];
    for ablation in Ablation::ALL {
        let name = Model::Implicit(vec![ablation]).name();
        variants.push(Series { values: errors(&of_model(&part.findings.ablations, &name)), name });
    }
    let label = part.label();
    let chart = ablations(&Headings { title: "Ablations", subtitle: &label }, &variants)?;
    let caption = format!(
        "{}, the characters {:?} at all sizes: from the least error to the greatest, the middle half, the median (bar) and \
         the mean (dot, number).",
        part.font(),
        part.plan.ablated
    );
    Ok(Section {
        title: "The implicit network without its parts",
        text: "Without the size as an input the network is that of the published code for one weight: it tells sizes \
               apart by where their pixels lie and by the statistics of the batch."
            .into(),
        figures: vec![svg("ablations.svg", chart, caption)],
    })
}

fn losses(part: &Part<'_>) -> Result<Section, Error> {
    let label = part.label();
    let mut figures = Vec::new();
    for (model, file) in models().iter().zip(["loss-masked.svg", "loss-implicit.svg"]) {
        let ours = |outcome: &&Outcome| outcome.model == *model && outcome.font == part.font();
        let outcomes: Vec<&Outcome> = part.findings.outcomes.iter().filter(ours).collect();
        let curves: Vec<Line> =
            outcomes.iter().map(|outcome| loss_line(&outcome.glyph.to_string(), &outcome.history)).collect();
        let rates: Vec<f64> =
            outcomes.first().map_or(Vec::new(), |one| one.history.iter().map(|e| e.rate).collect());
        let starts: Vec<f64> = resets(&rates).into_iter().map(|epoch| epoch as f64).collect();
        let title = format!("Loss of the {model} network on {}", part.font());
        let chart = loss_history(&Headings { title: &title, subtitle: &label }, &curves, &starts)?;
        let caption = "A curve for each character; dashed where the learning rate starts anew.";
        figures.push(svg(file, chart, caption));
    }
    Ok(Section { title: "Training", text: String::new(), figures })
}

fn no_models(part: &Part<'_>) -> Result<Section, Error> {
    let curve = |name: &str, rows: &[ErrorRow]| {
        let points = summaries(rows, |row| row.side).into_iter().map(|(side, s)| [side as f64, s.mean]);
        Line { name: name.to_owned(), points: points.collect() }
    };
    let on_font = |model: &str| -> Vec<ErrorRow> {
        of_model(&part.findings.outcomes, model).into_iter().filter(|row| row.font == part.font()).collect()
    };
    let mut methods: Vec<Line> = Vec::new();
    for method in super::super::resize::Method::ALL {
        let rows = part.findings.resized.iter().filter(|row| row.model == method.name());
        methods.push(curve(method.name(), &rows.cloned().collect::<Vec<_>>()));
    }
    let unhinted = curve(UNHINTED, &part.findings.unhinted);
    let [_, implicit, grid_fit] = models();
    let learnt = [curve(&implicit, &on_font(&implicit)), curve(&grid_fit, &on_font(&grid_fit))];
    let label = part.label();
    methods.extend(learnt.iter().cloned());
    let resizing = lines(
        &Headings { title: "The largest bitmap, shrunk, against the hinted one", subtitle: &label },
        SIZE_AXES,
        &methods,
    )?;
    let hinting = lines(
        &Headings { title: "Unhinted against hinted", subtitle: &label },
        SIZE_AXES,
        &[&[unhinted][..], &learnt].concat(),
    )?;
    let who = format!("{}, the mean over the characters {:?}.", part.font(), part.plan.glyphs);
    Ok(Section {
        title: "Why not resize, why hint",
        text: "Both figures compare with the hinted bitmap of each size; the networks and our model are there for scale."
            .into(),
        figures: vec![svg("resizing.svg", resizing, who.clone()), svg("hinting.svg", hinting, who)],
    })
}
