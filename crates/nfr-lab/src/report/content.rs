//! The inputs and the parts of a report.

use crate::error_table::ErrorRow;
use crate::evaluation::Evaluation;
use crate::experiment::Experiment;
use crate::network_variant::{GRID_FIT, NetworkVariant};
use crate::statistics::Summary;
use crate::study::{StudyPlan, StudyResults};
use maud::Markup;

/// The inputs of a report.
#[derive(Clone, Copy)]
pub struct ReportContext<'r> {
    /// How the experiments ran.
    pub experiment: &'r Experiment<'r>,
    /// The fonts and characters of the experiments.
    pub plan: &'r StudyPlan<'r>,
    /// Their results.
    pub results: &'r StudyResults,
}

impl ReportContext<'_> {
    pub(super) fn label(&self) -> String {
        self.experiment.settings.label()
    }

    /// The name of the font that has all experiments.
    pub(super) fn font(&self) -> &str {
        &self.plan.fonts[0].name
    }
}

/// A chart or a picture of the report.
pub(super) struct ReportFigure {
    /// The file's name.
    pub(super) file: String,
    pub(super) bytes: Vec<u8>,
    /// The contents, and how to read them.
    pub(super) caption: String,
}

/// A heading of the report with its text and figures.
pub(super) struct ReportSection {
    pub(super) title: &'static str,
    pub(super) text: Markup,
    pub(super) figures: Vec<ReportFigure>,
}

/// The models in the order in which charts and pictures have them.
pub(super) fn compared_models() -> [String; 3] {
    [NetworkVariant::Masked.name(), NetworkVariant::Implicit(Vec::new()).name(), GRID_FIT.to_owned()]
}

/// The rows of a model's evaluations.
pub(super) fn rows_of_model(evaluations: &[Evaluation], model: &str) -> Vec<ErrorRow> {
    evaluations
        .iter()
        .filter(|evaluation| evaluation.model == model)
        .flat_map(|evaluation| evaluation.rows.clone())
        .collect()
}

/// The mean squared error of rows; NaN without any.
pub(super) fn mean_mse(rows: &[ErrorRow]) -> f64 {
    Summary::of(rows.iter().map(|row| row.mse)).map_or(f64::NAN, |summary| summary.mean)
}
