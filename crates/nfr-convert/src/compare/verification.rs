//! The result of a verification: which hinted points, advance widths and side bearings a neural font
//! keeps.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

use super::points::{GlyphTally, PointTally};
use super::report::{glyph_count_text, glyph_title};

/// Glyphs that the printed report lists.
const WORST_PRINTED: usize = 10;

/// Why a glyph's points cannot be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum NoPoints {
    /// A field draws it.
    Field,
    /// A network draws it.
    Network,
    /// It has no model.
    NoModel,
    /// Its outline or advance width was changed after its model was made, so that it is not drawn.
    Stale,
}

impl fmt::Display for NoPoints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Field => "drawn from a field",
            Self::Network => "drawn by a network",
            Self::NoModel => "without a model",
            Self::Stale => "whose outline or advance width was changed after its model was made",
        })
    }
}

/// What is compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Subject {
    /// The hinted font's path.
    pub original: String,
    /// The neural font's path.
    pub neural: String,
    /// The target of the hints.
    pub target: String,
    /// The sizes in pixels per em, as on the command line.
    pub ppem: String,
    /// The number of glyphs, with those that cannot be compared.
    pub glyphs: usize,
}

/// A glyph that cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct NotCompared {
    /// The glyph.
    pub gid: u16,
    /// Why.
    pub reason: NoPoints,
}

/// A glyph over all sizes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct GlyphPoints {
    /// The glyph.
    pub gid: u16,
    /// Its name in 'post'.
    pub name: Option<String>,
    /// The first character that stands for it.
    pub character: Option<char>,
    /// The smallest size that has its largest difference, or where contours or metrics alone differ, the first such size; none
    /// if all is equal.
    pub worst_ppem: Option<u16>,
    /// What differs.
    #[serde(flatten)]
    pub tally: PointTally,
}

/// All glyphs at a size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct SizePoints {
    /// Pixels per em.
    pub ppem: u16,
    /// What differs.
    #[serde(flatten)]
    pub tally: PointTally,
}

/// A verification: hinted points, advance widths and left side bearings of a neural font against those of the
/// interpreter.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Verification {
    /// What is compared.
    #[serde(flatten)]
    pub subject: Subject,
    /// Everything together.
    #[serde(flatten)]
    pub totals: PointTally,
    /// The glyphs that cannot be compared, ascending.
    pub not_compared: Vec<NotCompared>,
    /// Each size, ascending.
    pub by_ppem: Vec<SizePoints>,
    /// Each glyph that was compared, the largest difference first.
    pub by_glyph: Vec<GlyphPoints>,
}

impl Verification {
    /// Adds the tallies up. `label` returns a glyph's name and character.
    pub(super) fn new(
        subject: Subject,
        tallies: &[GlyphTally],
        not_compared: Vec<NotCompared>,
        label: impl Fn(u16) -> (Option<String>, Option<char>),
    ) -> Self {
        let mut totals = PointTally::default();
        let mut by_ppem: BTreeMap<u16, PointTally> = BTreeMap::new();
        let mut by_glyph = Vec::with_capacity(tallies.len());
        for glyph in tallies {
            let mut all = PointTally::default();
            for (ppem, tally) in &glyph.sizes {
                all.merge(tally);
                by_ppem.entry(*ppem).or_default().merge(tally);
            }
            totals.merge(&all);
            let largest = |tally: &PointTally| tally.largest_difference == all.largest_difference;
            let worst = glyph.sizes.iter().find(|(_, tally)| !tally.is_equal() && largest(tally));
            let ((name, character), worst_ppem) = (label(glyph.gid), worst.map(|(ppem, _)| *ppem));
            by_glyph.push(GlyphPoints { gid: glyph.gid, name, character, worst_ppem, tally: all });
        }
        let badness = |glyph: &GlyphPoints| {
            let PointTally { largest_difference, differing_points, changed_contours, .. } = glyph.tally;
            let metrics = glyph.tally.differing_advances + glyph.tally.differing_bearings;
            [changed_contours, largest_difference.into(), differing_points, metrics]
        };
        by_glyph.sort_by(|a, b| badness(b).cmp(&badness(a)).then(a.gid.cmp(&b.gid)));
        let by_ppem = by_ppem.into_iter().map(|(ppem, tally)| SizePoints { ppem, tally }).collect();
        Self { subject, totals, not_compared, by_ppem, by_glyph }
    }

    /// A line for each kind of thing that is not equal: none if every glyph was compared, no point or side bearing is off by more than
    /// `at_most` 1/64 pixel along x or y, and all advance widths are equal.
    pub fn failures(&self, at_most: u32) -> Vec<String> {
        let totals = &self.totals;
        let mut failures = Vec::new();
        let counts = [
            (totals.differing_points, totals.points, "points"),
            (totals.differing_bearings, totals.bearings, "left side bearings"),
        ];
        let largest = totals.largest_difference;
        for (differing, all, what) in counts {
            if differing > 0 && largest > at_most {
                failures.push(format!("{differing} of {all} {what} differ, by up to {largest}/64 pixel"));
            }
        }
        if totals.changed_contours > 0 {
            failures.push(format!("hinting changes the contours at {} glyph sizes", totals.changed_contours));
        }
        if totals.differing_advances > 0 {
            let (differing, all) = (totals.differing_advances, totals.advances);
            failures.push(format!("{differing} of {all} advance widths differ"));
        }
        if !self.not_compared.is_empty() {
            failures.push(format!("{} cannot be compared", glyph_count_text(self.not_compared.len())));
        }
        failures
    }

    /// A line if there are glyphs that are not drawn from a model at all: they have none, or their outline was changed.
    pub fn undrawn(&self) -> Option<String> {
        let is_undrawn = |glyph: &&NotCompared| matches!(glyph.reason, NoPoints::NoModel | NoPoints::Stale);
        let count = self.not_compared.iter().filter(is_undrawn).count();
        (count > 0).then(|| format!("{} cannot be compared", glyph_count_text(count)))
    }

    /// The number of glyphs that cannot be compared for each reason.
    pub fn reasons(&self) -> BTreeMap<NoPoints, usize> {
        let mut reasons = BTreeMap::new();
        self.not_compared.iter().for_each(|glyph| *reasons.entry(glyph.reason).or_default() += 1);
        reasons
    }
}

/// The report for people.
impl fmt::Display for Verification {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (subject, totals) = (&self.subject, &self.totals);
        writeln!(f, "{} against {}", subject.neural, subject.original)?;
        let glyphs = glyph_count_text(subject.glyphs);
        writeln!(f, "{glyphs}, {} ppem, target {}\n", subject.ppem, subject.target)?;
        writeln!(f, "points        {} compared, {} differ", totals.points, totals.differing_points)?;
        writeln!(f, "largest       {}/64 pixel", totals.largest_difference)?;
        let (equal, all) = (totals.equal_glyph_sizes, totals.glyph_sizes);
        writeln!(f, "glyph sizes   {all} compared, all points equal at {equal}")?;
        if totals.changed_contours > 0 {
            let changed = totals.changed_contours;
            writeln!(
                f,
                "contours      changed by hinting at {changed} glyph sizes, where points do not correspond"
            )?;
        }
        writeln!(f, "advances      {} compared, {} differ", totals.advances, totals.differing_advances)?;
        writeln!(f, "bearings      {} compared, {} differ", totals.bearings, totals.differing_bearings)?;
        for (reason, count) in self.reasons() {
            writeln!(f, "not compared  {} {reason}", glyph_count_text(count))?;
        }
        let worst = || self.by_glyph.iter().filter(|glyph| !glyph.tally.is_equal()).take(WORST_PRINTED);
        if worst().next().is_some() {
            writeln!(f, "\n{:<26}{:>10}{:>10}{:>12}", "worst glyphs", "differ", "largest", "worst at")?;
        }
        worst().try_for_each(|glyph| {
            let GlyphPoints { gid, name, character, worst_ppem, tally } = glyph;
            let title = glyph_title(*gid, name.as_deref(), *character);
            let (differ, largest) = (tally.differing_points, tally.largest_difference);
            let at = worst_ppem.unwrap_or_default();
            writeln!(f, "{title:<26}{differ:>10}{largest:>7}/64{at:>7} ppem")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn off_by(largest_difference: u32, differing_points: u64) -> PointTally {
        PointTally {
            glyph_sizes: 1,
            equal_glyph_sizes: (differing_points == 0).into(),
            points: 10,
            differing_points,
            largest_difference,
            advances: 1,
            ..PointTally::default()
        }
    }

    fn verification(
        glyphs: &[(u16, &[(u16, PointTally)])],
        not_compared: &[(u16, NoPoints)],
    ) -> Verification {
        let tallies: Vec<_> =
            glyphs.iter().map(|(gid, sizes)| GlyphTally { gid: *gid, sizes: sizes.to_vec() }).collect();
        let not_compared = not_compared.iter().map(|&(gid, reason)| NotCompared { gid, reason }).collect();
        let subject = Subject {
            original: "a.ttf".into(),
            neural: "b.ttf".into(),
            target: "smooth".into(),
            ppem: "8-9".into(),
            glyphs: glyphs.len(),
        };
        Verification::new(subject, &tallies, not_compared, |gid| (None, char::from_u32(gid.into())))
    }

    #[test]
    fn sums_are_those_of_all_glyphs_and_sizes_and_the_worst_glyph_comes_first() {
        let equal = off_by(0, 0);
        let found = verification(
            &[
                (65, &[(8, equal), (9, equal)]),
                (66, &[(8, off_by(2, 3)), (9, off_by(7, 1))]),
                (67, &[(8, off_by(2, 1)), (9, equal)]),
            ],
            &[],
        );
        assert_eq!((found.totals.points, found.totals.differing_points), (60, 5));
        assert_eq!((found.totals.glyph_sizes, found.totals.equal_glyph_sizes), (6, 3));
        let order: Vec<_> = found.by_glyph.iter().map(|glyph| (glyph.gid, glyph.worst_ppem)).collect();
        assert_eq!(order, [(66, Some(9)), (67, Some(8)), (65, None)]);
        let sizes: Vec<_> = found.by_ppem.iter().map(|s| (s.ppem, s.tally.largest_difference)).collect();
        assert_eq!(sizes, [(8, 2), (9, 7)]);
        let text = found.to_string();
        for part in ["b.ttf against a.ttf", "60 compared, 5 differ", "7/64", "66 (B)", "67 (C)"] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
        assert!(!text.contains("65 (A)"), "an equal glyph is listed\n{text}");
    }

    #[test]
    fn a_tolerance_is_for_points_and_for_nothing_else() {
        let found = verification(&[(65, &[(8, off_by(3, 1))])], &[]);
        assert_eq!((found.failures(3).len(), found.failures(2).len()), (0, 1));
        let wider = PointTally { differing_advances: 1, ..off_by(0, 0) };
        assert!(verification(&[(65, &[(8, wider)])], &[]).failures(100)[0].contains("1 of 1 advance"));
        let changed = PointTally { glyph_sizes: 1, changed_contours: 1, ..PointTally::default() };
        assert!(verification(&[(65, &[(8, changed)])], &[]).failures(100)[0].contains("contours"));
    }

    #[test]
    fn a_glyph_that_cannot_be_compared_is_a_failure_with_its_reason() {
        let found = verification(&[], &[(65, NoPoints::Field), (66, NoPoints::Stale), (67, NoPoints::Field)]);
        assert!(found.failures(100)[0].contains("3 glyphs cannot be compared"));
        assert!(found.to_string().contains("2 glyphs drawn from a field"), "{found}");
    }
}
