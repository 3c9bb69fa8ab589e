//! The inputs and the parts of a report.

use super::beside::OtherReport;
use crate::error_table::ErrorRow;
use crate::evaluation::Evaluation;
use crate::experiment::Experiment;
use crate::network_variant::{GRID_FIT, NetworkVariant};
use crate::statistics::Summary;
use crate::study::{StudyPlan, StudyResults};
use crate::train::result::TrainingOrigin;
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
    /// Another report, whose verdicts stand beside these.
    pub beside: Option<&'r OtherReport>,
}

impl ReportContext<'_> {
    /// The scale, the settings that matter most, and the devices of the trainings.
    pub(super) fn label(&self) -> String {
        let settings = self.experiment.settings.label();
        let mut devices: Vec<&str> = self.origins().map(|origin| origin.device.as_str()).collect();
        devices.sort_unstable();
        devices.dedup();
        let devices = match devices.is_empty() {
            true => String::new(),
            false => format!("; trained on {}", devices.join(" and ")),
        };
        let unfinished = match self.unfinished() {
            0 => String::new(),
            count => format!("; UNFINISHED: {count} trainings, with fewer epochs"),
        };
        format!("{settings}{devices}{unfinished}")
    }

    /// The number of results that are of unfinished trainings.
    fn unfinished(&self) -> usize {
        let (settings, results) = (&self.experiment.settings, self.results);
        let masked = NetworkVariant::Masked.name();
        let epochs =
            |model: &str| if model == masked { settings.masked_epochs } else { settings.implicit_epochs };
        let single = results.evaluations.iter().chain(&results.ablations);
        let single = single.filter(|one| one.origin.is_some() && one.history.len() < epochs(&one.model));
        let families = results.weights.iter().chain(&results.styles);
        single.count() + families.filter(|one| one.history.len() < settings.implicit_epochs).count()
    }

    /// Where the networks of all results were trained.
    fn origins(&self) -> impl Iterator<Item = &TrainingOrigin> {
        let results = self.results;
        let single = results.evaluations.iter().chain(&results.ablations);
        let families = results.weights.iter().chain(&results.styles);
        single.filter_map(|one| one.origin.as_ref()).chain(families.map(|one| &one.origin))
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

/// A heading of the report with its text and figures. Without either, its experiment was not run.
pub(super) struct ReportSection {
    pub(super) title: &'static str,
    pub(super) text: Markup,
    pub(super) figures: Vec<ReportFigure>,
}

impl ReportSection {
    /// The section of an experiment that was not run.
    pub(super) fn not_run(title: &'static str) -> Self {
        Self { title, text: Markup::default(), figures: Vec::new() }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.text.0.is_empty() && self.figures.is_empty()
    }
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
