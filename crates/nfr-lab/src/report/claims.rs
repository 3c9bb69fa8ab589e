//! The paper's claims beside the measurements.

use super::content::{mean_mse, rows_of_model};
use crate::error_table::{ErrorRow, summaries};
use crate::evaluation::ClassAccuracy;
use crate::implicit::Implicit;
use crate::interpolation::{Rendering, names};
use crate::network_variant::{Ablation, GRID_FIT, NetworkVariant};
use crate::resize::Method;
use crate::settings::{ExperimentScale, Settings};
use crate::statistics::Summary;
use crate::study::StudyResults;

/// A claim beside its measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// The paper's statement.
    pub statement: &'static str,
    /// The measurement, in figures.
    pub measured: String,
    /// Whether the measurement confirms the statement; `None` where it decides nothing.
    pub holds: Option<bool>,
}

impl Claim {
    /// The verdict in a word or two.
    pub fn verdict(&self) -> &'static str {
        match self.holds {
            Some(true) => "holds",
            Some(false) => "does not hold",
            None => "–",
        }
    }
}

impl Claim {
    /// The claim, unless one of the numbers that it needs is missing.
    fn of<const N: usize>(
        statement: &'static str,
        numbers: [f64; N],
        decided: impl FnOnce([f64; N]) -> (String, Option<bool>),
    ) -> Self {
        let (measured, holds) = match numbers.iter().all(|number| number.is_finite()) {
            true => decided(numbers),
            false => (NOT_RUN.to_owned(), None),
        };
        Self { statement, measured, holds }
    }
}

/// The measurement of a claim whose experiments are not finished.
pub(super) const NOT_RUN: &str = "not run";
/// More than an order of magnitude.
const MAGNITUDE: f64 = 10.0;
/// The share of the smallest and of the largest sizes that are compared.
const THIRD: usize = 3;

/// All claims.
pub fn claims(results: &StudyResults, settings: &Settings) -> Vec<Claim> {
    let implicit = rows_of_model(&results.evaluations, &NetworkVariant::Implicit(Vec::new()).name());
    let masked = rows_of_model(&results.evaluations, &NetworkVariant::Masked.name());
    let grid_fit = rows_of_model(&results.evaluations, GRID_FIT);
    let mut claims = vec![beats(&implicit, &masked), falls_with_size(&implicit), easy_and_hard(&implicit)];
    claims.extend(Ablation::ALL.into_iter().map(|part| ablation(results, &implicit, part)));
    claims.push(interpolates(results));
    claims.push(shrinking(results, &implicit, &grid_fit));
    claims.push(wrong_pixel(results));
    claims.push(classes(results, &masked));
    claims.push(megabytes(settings));
    claims
}

/// The rows of a font's characters that some other rows are of.
fn same_glyphs(rows: &[ErrorRow], others: &[ErrorRow]) -> Vec<ErrorRow> {
    let paired =
        |row: &&ErrorRow| others.iter().any(|other| other.glyph == row.glyph && other.font == row.font);
    rows.iter().filter(paired).cloned().collect()
}

fn beats(implicit: &[ErrorRow], masked: &[ErrorRow]) -> Claim {
    let (implicit, masked) = (same_glyphs(implicit, masked), same_glyphs(masked, implicit));
    let bitmaps = implicit.len();
    let statement = "The implicit network's error is more than an order of magnitude below the masked one's";
    Claim::of(statement, [mean_mse(&implicit), mean_mse(&masked)], |[a, b]| {
        let times = b / a;
        (
            format!("mse {a:.2e} and {b:.2e} on {bitmaps} bitmaps: {times:.2} times as small"),
            Some(times > MAGNITUDE),
        )
    })
}

fn falls_with_size(implicit: &[ErrorRow]) -> Claim {
    let by_size: Vec<f64> = summaries(implicit, |row| row.side).into_values().map(|s| s.mean).collect();
    let count = (by_size.len() / THIRD).max(1).min(by_size.len());
    let mean = |part: &[f64]| Summary::of(part.iter().copied()).map_or(f64::NAN, |summary| summary.mean);
    let numbers = [mean(&by_size[..count]), mean(&by_size[by_size.len() - count..])];
    Claim::of("The error falls as the size grows", numbers, |[small, large]| {
        let measured = format!(
            "implicit: mse {small:.2e} in the smallest third of the sizes, {large:.2e} in the largest"
        );
        (measured, Some(large < small))
    })
}

fn easy_and_hard(implicit: &[ErrorRow]) -> Claim {
    let by_glyph = summaries(implicit, |row| row.glyph);
    let mean = |glyphs: &str| {
        let means = glyphs.chars().filter_map(|glyph| by_glyph.get(&glyph));
        Summary::of(means.map(|summary| summary.mean)).map(|summary| summary.mean)
    };
    let mut order: Vec<(char, f64)> =
        by_glyph.iter().map(|(glyph, summary)| (*glyph, summary.mean)).collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    let order: Vec<String> = order.iter().map(|(glyph, mse)| format!("{glyph} {mse:.1e}")).collect();
    let means = ["li", "gmw"].map(|glyphs| mean(glyphs).unwrap_or(f64::NAN));
    Claim::of("l and i are easy, g, m and w are hard", means, |[easy, hard]| {
        (format!("implicit, from the easiest: {}", order.join(", ")), Some(easy < hard))
    })
}

fn ablation(results: &StudyResults, implicit: &[ErrorRow], part: Ablation) -> Claim {
    let without = rows_of_model(&results.ablations, &NetworkVariant::Implicit(vec![part]).name());
    let without = same_glyphs(&without, implicit);
    let statement = match part {
        Ablation::Frequencies => "Without the frequency encoding the error rises",
        Ablation::Memorisation => "Without the memorisation adaptations the error rises",
        Ablation::Residuals => "Without the residual additions the error rises",
        Ablation::Size => "(The paper's text has the size as an input, its code for one weight has not)",
    };
    Claim::of(statement, [mean_mse(&same_glyphs(implicit, &without)), mean_mse(&without)], |[full, less]| {
        let measured = format!("mse {less:.2e} without, {full:.2e} with: {:.2} times", less / full);
        (measured, if part == Ablation::Size { None } else { Some(less > full) })
    })
}

fn interpolates(results: &StudyResults) -> Claim {
    let mean = |name: &str| {
        let drawn = results.weights.iter().flat_map(|one| &one.between);
        let mse = drawn.filter(|rendering| rendering.name == name).filter_map(Rendering::mse);
        Summary::of(mse).map_or(f64::NAN, |summary| summary.mean)
    };
    let means = [names::IMPLICIT, names::GRID_FIT, names::SNAPPED, names::FIRST, names::LAST].map(mean);
    let statement = "A network trained on medium and bold draws semi-bold from the interpolated latent vector, with artefacts";
    Claim::of(statement, means, |[implicit, grid_fit, snapped, first, last]| {
        let measured = format!(
            "mse against semi-bold: {implicit:.2e}; medium and bold as they are {first:.2e} and {last:.2e}; the \
             grid-fit field interpolated likewise {grid_fit:.2e}, snapped {snapped:.2e}"
        );
        // An interpolated bitmap has to be nearer than either end.
        (measured, Some(implicit < first.min(last)))
    })
}

fn shrinking(results: &StudyResults, implicit: &[ErrorRow], grid_fit: &[ErrorRow]) -> Claim {
    // At the largest size nothing is shrunk.
    let largest = results.resized.iter().map(|row| row.side).max().unwrap_or(0);
    let rows = same_glyphs(&results.resized, implicit);
    let rows: Vec<ErrorRow> = rows.into_iter().filter(|row| row.side < largest).collect();
    let by_method = summaries(&rows, |row| row.model.clone());
    let best = by_method.iter().min_by(|a, b| a.1.mean.total_cmp(&b.1.mean));
    let (name, best) = best.map_or((Method::Nearest.name(), f64::NAN), |(name, s)| (name.as_str(), s.mean));
    let unhinted = mean_mse(&same_glyphs(&results.unhinted, implicit));
    let numbers =
        [best, mean_mse(&same_glyphs(implicit, &rows)), mean_mse(&same_glyphs(grid_fit, &rows)), unhinted];
    let statement = "A large bitmap shrunk by any of the usual methods is no substitute for the hinted one";
    Claim::of(statement, numbers, |[best, implicit, grid_fit, unhinted]| {
        let measured = format!(
            "the best method, {name}: mse {best:.2e}; implicit {implicit:.2e}, grid-fit {grid_fit:.2e}, unhinted \
             {unhinted:.2e}"
        );
        (measured, Some(best > implicit))
    })
}

fn wrong_pixel(results: &StudyResults) -> Claim {
    let mse = Summary::of(results.wrong_pixel.iter().map(|one| one.mse)).map_or(f64::NAN, |s| s.mean);
    Claim {
        statement: "A single wrong pixel is seen at once, although the error hardly changes",
        measured: format!("one pixel of ink gone at the smallest size: mse {mse:.2e}; see the picture"),
        holds: None,
    }
}

/// The error of rounding to classes, and that of the network's choice of classes.
fn classes(results: &StudyResults, masked: &[ErrorRow]) -> Claim {
    let name = NetworkVariant::Implicit(Vec::new()).name();
    let evaluations = results.evaluations.iter().filter(|evaluation| evaluation.model == name);
    let class_accuracy: Vec<ClassAccuracy> =
        evaluations.filter_map(|evaluation| evaluation.class_accuracy).collect();
    let wrong: usize = class_accuracy.iter().map(|one| one.wrong).sum();
    let pixels: usize = class_accuracy.iter().map(|one| one.pixels).sum();
    let [mse, rounding] = [|one: &ClassAccuracy| one.mse, |one: &ClassAccuracy| one.rounding]
        .map(|of| Summary::of(class_accuracy.iter().map(of)).map_or(f64::NAN, |summary| summary.mean));
    let statement =
        "(The implicit network chooses one of 21 classes; the published code rounds down to them)";
    Claim::of(statement, [rounding, mse, mean_mse(masked)], |[rounding, mse, masked]| {
        let measured = format!(
            "the right classes have mse {rounding:.2e} against the truth; {wrong} of {pixels} pixels are in a wrong one, \
             which is mse {mse:.2e} against the right ones; the masked network's error is {masked:.2e}"
        );
        (measured, None)
    })
}

fn megabytes(settings: &Settings) -> Claim {
    let published = Settings::new(ExperimentScale::Paper);
    let parameters = |config| Implicit::parameters(config);
    let mebibytes = |count: usize| count as f64 * 4.0 / f64::from(1 << 20);
    let (text, code) = (parameters(published.implicit), parameters(Ablation::Size.apply(published.implicit)));
    Claim {
        statement: "A glyph's network has about 5 million parameters and takes 24 MB",
        measured: format!(
            "{:.2} million and {:.1} MiB as in the published code, without the size as an input; {:.2} million and \
             {:.1} MiB with it; here {:.3} million",
            code as f64 / 1e6,
            mebibytes(code),
            text as f64 / 1e6,
            mebibytes(text),
            parameters(settings.implicit) as f64 / 1e6
        ),
        holds: Some((mebibytes(code) - 24.0).abs() < 0.5),
    }
}
