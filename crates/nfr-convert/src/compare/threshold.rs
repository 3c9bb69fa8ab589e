//! Conditions under which a comparison counts as failed: `mae>0.006 || bad16>0.02`.
//!
//! ```text
//! conditions = condition { ("," | "||") condition }      any that holds fails the comparison
//! condition  = metric comparison number
//! metric     = "mae" | "rmse" | "max" | "bad16" | "exact" | "bytes_per_glyph"
//! comparison = ">" | ">=" | "<" | "<="
//! number     = digits [ "." digits ]
//! ```
//!
//! White space may stand between any two parts. Metrics other than `bytes_per_glyph` are in 0..1.

use std::fmt;
use std::str::FromStr;

use super::report::Report;

const METRICS: [&str; 6] = ["mae", "rmse", "max", "bad16", "exact", "bytes_per_glyph"];
/// Longer ones first, so that `>=` is not read as `>`.
const COMPARISONS: [&str; 4] = [">=", "<=", ">", "<"];

/// Conditions any of which fails a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct FailOn(Vec<Condition>);

/// One metric against one number.
#[derive(Debug, Clone, PartialEq)]
struct Condition {
    metric: &'static str,
    comparison: &'static str,
    limit: f64,
}

impl FailOn {
    /// A line for each condition that holds for the models' totals.
    pub fn failures(&self, report: &Report) -> Vec<String> {
        let holding = self.0.iter().filter_map(|condition| {
            let value = value(report, condition.metric);
            condition.holds(value).then(|| format!("{} is {value:.6}: {condition}", condition.metric))
        });
        holding.collect()
    }
}

fn value(report: &Report, metric: &str) -> f64 {
    let figures = &report.totals.neural.figures;
    match metric {
        "mae" => figures.mae,
        "rmse" => figures.rmse,
        "max" => figures.max,
        "bad16" => figures.bad16,
        "exact" => figures.exact,
        _ => report.header.bytes_per_glyph,
    }
}

impl Condition {
    fn holds(&self, value: f64) -> bool {
        match self.comparison {
            ">" => value > self.limit,
            ">=" => value >= self.limit,
            "<" => value < self.limit,
            _ => value <= self.limit,
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.metric, self.comparison, self.limit)
    }
}

impl FromStr for FailOn {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let conditions = text.split("||").flat_map(|part| part.split(','));
        Ok(Self(conditions.map(|condition| condition.trim().parse()).collect::<Result<_, _>>()?))
    }
}

impl FromStr for Condition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let usage =
            |what: &str| format!("{what} in {text:?}; write conditions as in 'mae>0.006 || bad16>0.02'");
        let (at, comparison) = text
            .char_indices()
            .find_map(|(at, _)| COMPARISONS.into_iter().find(|c| text[at..].starts_with(c)).map(|c| (at, c)))
            .ok_or_else(|| usage("no comparison (>, >=, < or <=)"))?;
        let name = text[..at].trim();
        let metric = METRICS
            .into_iter()
            .find(|metric| *metric == name)
            .ok_or_else(|| usage(&format!("no metric {name:?} ({})", METRICS.join(", "))))?;
        let number = text[at + comparison.len()..].trim();
        // `f64` would also take "inf", "nan", signs and exponents.
        let plain = number.bytes().all(|b| b.is_ascii_digit() || b == b'.');
        let limit = number.parse().ok().filter(|_| plain);
        Ok(Self { metric, comparison, limit: limit.ok_or_else(|| usage(&format!("no number {number:?}")))? })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn conditions_are_joined_by_commas_and_bars() {
        let all: FailOn = " mae>0.006 || bad16 >= .02,exact<0.5||bytes_per_glyph <= 600".parse().unwrap();
        let texts: Vec<_> = all.0.iter().map(ToString::to_string).collect();
        assert_eq!(texts, ["mae > 0.006", "bad16 >= 0.02", "exact < 0.5", "bytes_per_glyph <= 600"]);
    }

    #[test]
    fn what_is_no_condition_is_refused() {
        for text in
            ["", "mae", "mae>", ">1", "mea>1", "mae=1", "mae==1", "mae>1,", "mae>x", "mae>nan", "mae>-1"]
        {
            assert!(text.parse::<FailOn>().unwrap_err().contains("write conditions"), "{text}");
        }
        for text in ["mae>1|mae>2", "mae>1 && max>1", "mae>1e3", "mae>>1", "mae>1||", "mae>."] {
            assert!(text.parse::<FailOn>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_limit_itself_passes_the_strict_comparison_only() {
        let holds = |text: &str, value| text.parse::<Condition>().unwrap().holds(value);
        assert!(!holds("mae>0.5", 0.5) && holds("mae>=0.5", 0.5));
        assert!(!holds("exact<0.5", 0.5) && holds("exact<=0.5", 0.5));
        assert!(holds("mae>0.5", 0.6) && holds("exact<0.5", 0.4));
    }
}
