//! A comparison's result, as numbers for people and scripts.

use std::fmt;

use serde::Serialize;

use super::diff::{GlyphAtSize, Tallies, Tally, TallyPair};
use super::metrics::Figures;

/// SizeBand that are reported together, in pixels per em: small text, text, and headings.
pub const BANDS: [(u16, u16); 3] = [(8, 15), (16, 31), (32, 64)];

/// Glyphs that the printed report lists.
const WORST_PRINTED: usize = 10;

/// The two fonts, and the sizes and glyphs compared.
#[derive(Debug, Clone, Serialize)]
pub struct ReportHeader {
    /// The hinted font's path.
    pub original: String,
    /// The neural font's path.
    pub neural: String,
    /// The target of the hinted bitmaps.
    pub target: String,
    /// What hinted them: "font" or "auto", as on the command line.
    pub hinter: String,
    /// The sizes, as on the command line.
    pub ppem: String,
    /// The number of glyphs compared.
    pub glyphs: usize,
    /// The length of the `Nfrt` table.
    pub table_bytes: usize,
    /// That length divided by the glyphs in the table, compared or not.
    pub bytes_per_glyph: f64,
}

/// Metrics, and where the largest error is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LocatedErrors {
    /// The metrics.
    #[serde(flatten)]
    pub figures: Figures,
    /// The glyph and size with the largest error of a pixel; none if all is exact.
    pub max_at: Option<GlyphAtSize>,
}

impl From<&Tally> for LocatedErrors {
    fn from(tally: &Tally) -> Self {
        Self { figures: tally.sums.figures(), max_at: tally.max_at }
    }
}

/// The models' metrics beside those of the unhinted outlines.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ComparedErrors {
    /// Models against the hinted truth.
    pub neural: LocatedErrors,
    /// Unhinted outlines against the hinted truth.
    pub unhinted: LocatedErrors,
}

impl From<&TallyPair> for ComparedErrors {
    fn from(pair: &TallyPair) -> Self {
        Self { neural: (&pair.neural).into(), unhinted: (&pair.unhinted).into() }
    }
}

/// The metrics of some sizes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SizeBand {
    /// The smallest size, in pixels per em.
    pub first_ppem: u16,
    /// The largest.
    pub last_ppem: u16,
    /// The metrics.
    #[serde(flatten)]
    pub compared: ComparedErrors,
}

/// The metrics of a glyph.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GlyphErrors {
    /// The glyph.
    pub gid: u16,
    /// Its name in 'post'.
    pub name: Option<String>,
    /// The first character that stands for it.
    pub character: Option<char>,
    /// The size at which its mean absolute error is largest.
    pub worst_ppem: u16,
    /// The metrics over all sizes.
    #[serde(flatten)]
    pub compared: ComparedErrors,
}

/// A comparison.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The two fonts, and the sizes and glyphs compared.
    #[serde(flatten)]
    pub header: ReportHeader,
    /// Everything together.
    pub totals: ComparedErrors,
    /// [`BANDS`], where they have a size; with the sizes that were compared.
    pub bands: Vec<SizeBand>,
    /// One size each, ascending.
    pub by_ppem: Vec<SizeBand>,
    /// Largest mean absolute error first.
    pub by_glyph: Vec<GlyphErrors>,
}

impl Report {
    /// Adds the tallies up. `label` returns a glyph's name and character.
    pub fn new(
        header: ReportHeader,
        tallies: &Tallies,
        label: impl Fn(u16) -> (Option<String>, Option<char>),
    ) -> Self {
        let sum = |sizes: std::ops::RangeInclusive<u16>| {
            tallies.by_ppem.range(sizes).fold(TallyPair::default(), |mut sum, (_, pair)| {
                sum.merge(pair);
                sum
            })
        };
        let band = |(first, last): (u16, u16)| {
            let mut sizes = tallies.by_ppem.range(first..=last).map(|(ppem, _)| *ppem);
            let first_ppem = sizes.next()?;
            let last_ppem = sizes.next_back().unwrap_or(first_ppem);
            Some(SizeBand { first_ppem, last_ppem, compared: (&sum(first..=last)).into() })
        };
        let mut by_glyph: Vec<_> = tallies
            .by_glyph
            .iter()
            .map(|(&gid, tally)| {
                let (name, character) = label(gid);
                let worst_ppem = tally.worst.map_or(0, |(ppem, _)| ppem);
                GlyphErrors { gid, name, character, worst_ppem, compared: (&tally.all).into() }
            })
            .collect();
        let mae = |glyph: &GlyphErrors| glyph.compared.neural.figures.mae;
        by_glyph.sort_by(|a, b| mae(b).total_cmp(&mae(a)).then(a.gid.cmp(&b.gid)));
        Self {
            header,
            totals: (&sum(0..=u16::MAX)).into(),
            bands: BANDS.into_iter().filter_map(band).collect(),
            by_ppem: tallies.by_ppem.keys().filter_map(|&ppem| band((ppem, ppem))).collect(),
            by_glyph,
        }
    }
}

/// The report for people.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let header = &self.header;
        writeln!(f, "{} against {}", header.neural, header.original)?;
        let (glyphs, hinter) = (glyph_count_text(header.glyphs), &header.hinter);
        writeln!(f, "{glyphs}, {} ppem, target {}, hinter {hinter}", header.ppem, header.target)?;
        writeln!(f, "{} bytes of models, {:.1} per glyph", header.table_bytes, header.bytes_per_glyph)?;
        writeln!(f, "\n{:<20}{:>9}{:>9}{:>9}{:>10}{:>10}", "", "mae", "rmse", "max", "bad16", "exact")?;
        write_pair(f, "all", &self.totals)?;
        for band in &self.bands {
            write_pair(f, &format!("{}-{}", band.first_ppem, band.last_ppem), &band.compared)?;
        }
        if let Some(at) = self.totals.neural.max_at {
            writeln!(f, "\nlargest error: glyph {} at {} ppem", at.gid, at.ppem)?;
        }
        writeln!(
            f,
            "\n{:<26}{:>9}{:>10}{:>10}{:>12}",
            "worst glyphs", "mae", "bad16", "unhinted", "worst at"
        )?;
        for glyph in self.by_glyph.iter().take(WORST_PRINTED) {
            let figures = &glyph.compared.neural.figures;
            writeln!(
                f,
                "{:<26}{:>9.5}{:>8.2} %{:>10.5}{:>7} ppem",
                glyph.title(),
                figures.mae,
                100.0 * figures.bad16,
                glyph.compared.unhinted.figures.mae,
                glyph.worst_ppem
            )?;
        }
        Ok(())
    }
}

impl GlyphErrors {
    /// The glyph's number, name and character.
    pub fn title(&self) -> String {
        glyph_title(self.gid, self.name.as_deref(), self.character)
    }
}

/// A glyph's number, name and character.
pub(super) fn glyph_title(gid: u16, name: Option<&str>, character: Option<char>) -> String {
    let title = name.map_or(gid.to_string(), |name| format!("{gid} {name}"));
    match character {
        Some(c) if !c.is_control() && name != Some(c.to_string().as_str()) => format!("{title} ({c})"),
        _ => title,
    }
}

/// "1 glyph", "2 glyphs".
pub fn glyph_count_text(count: usize) -> String {
    format!("{count} glyph{}", if count == 1 { "" } else { "s" })
}

fn write_pair(f: &mut fmt::Formatter<'_>, sizes: &str, pair: &ComparedErrors) -> fmt::Result {
    for (name, located) in [("neural", &pair.neural), ("unhinted", &pair.unhinted)] {
        let m = &located.figures;
        writeln!(
            f,
            "{sizes:<10}{name:<10}{:>9.5}{:>9.5}{:>9.5}{:>8.2} %{:>8.2} %",
            m.mae,
            m.rmse,
            m.max,
            100.0 * m.bad16,
            100.0 * m.exact
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::diff::GlyphTally;
    use crate::compare::metrics::Sums;
    use nfr::{Bitmap, Placement};

    fn off_by(difference: u8) -> TallyPair {
        let placement = Placement { left: 0, top: 1, width: 1, height: 1 };
        let sums =
            Sums::of(&Bitmap { placement, pixels: vec![0] }, &Bitmap { placement, pixels: vec![difference] });
        TallyPair { neural: Tally { sums, max_at: None }, unhinted: Tally::default() }
    }

    fn report() -> Report {
        let mut tallies = Tallies::default();
        for ppem in [10, 12, 20, 70] {
            tallies.by_ppem.insert(ppem, off_by(51));
        }
        for (gid, difference) in [(3, 51), (4, 102), (5, 51)] {
            let all = off_by(difference);
            tallies.by_glyph.insert(gid, GlyphTally { all, worst: Some((12, all)) });
        }
        let header = ReportHeader {
            original: "a.ttf".into(),
            neural: "b.ttf".into(),
            target: "smooth".into(),
            hinter: "font".into(),
            ppem: "10,12,20,70".into(),
            glyphs: 3,
            table_bytes: 30,
            bytes_per_glyph: 10.0,
        };
        Report::new(header, &tallies, |gid| (Some(format!("name{gid}")), char::from_u32(gid.into())))
    }

    #[test]
    fn bands_name_the_sizes_that_they_have() {
        let bands: Vec<_> = report().bands.iter().map(|b| (b.first_ppem, b.last_ppem)).collect();
        assert_eq!(bands, [(10, 12), (20, 20)]);
        assert_eq!(report().totals.neural.figures.pixels, 4);
    }

    #[test]
    fn the_worst_glyph_comes_first_and_equals_in_order() {
        let gids: Vec<_> = report().by_glyph.iter().map(|glyph| glyph.gid).collect();
        assert_eq!(gids, [4, 3, 5]);
    }

    #[test]
    fn the_printed_report_shows_totals_bands_and_glyphs() {
        let text = report().to_string();
        for part in
            ["b.ttf against a.ttf", "30 bytes of models, 10.0 per glyph", "10-12", "4 name4", "0.20000"]
        {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }
}
