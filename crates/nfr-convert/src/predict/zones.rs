//! The levels that many glyphs of a font share, as the baseline and the x-height: what hinting does to them says
//! more than what it does to any level of a single glyph.

use std::collections::BTreeMap;

use super::motion::{Motion, Place, Track, settle};
use super::rule::View;

/// A level that so many glyphs have in common is one of the font.
const LEAST_GLYPHS: usize = 3;
/// The most levels of a font; the commonest ones.
const MOST_ZONES: usize = 24;
/// The share of the known sizes at which a level of the font is on a whole pixel.
const SNAPPED: f64 = 0.9;

/// A level of a font at the wanted size.
#[derive(Debug, Clone)]
pub(super) struct Zone {
    pub(super) track: Track,
    pub(super) place: Place,
}

/// Counts levels, glyph by glyph.
#[derive(Debug, Default)]
pub(super) struct Census {
    /// By their keys, which order them the same way everywhere.
    counts: BTreeMap<Vec<u64>, (usize, Track)>,
}

impl Census {
    /// Counts the levels of a glyph.
    pub(super) fn count(&mut self, glyph: &Motion) {
        for track in &glyph.tracks {
            let whole = track.hinted.iter().filter(|at| at.fract() == 0.0).count();
            if whole as f64 >= SNAPPED * track.hinted.len() as f64 {
                self.counts.entry(track.key()).or_insert_with(|| (0, track.clone())).0 += 1;
            }
        }
    }

    /// The levels of the font.
    pub(super) fn levels(self) -> Vec<Track> {
        let mut levels: Vec<(usize, Track)> = self.counts.into_values().collect();
        levels.retain(|(count, _)| *count >= LEAST_GLYPHS);
        levels.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        levels.truncate(MOST_ZONES);
        levels.into_iter().map(|(_, track)| track).collect()
    }
}

/// Where the levels of a font go at the wanted size: as from glyph to glyph, but never beyond the neighbouring
/// known sizes.
pub(super) fn zones(levels: &[Track], view: &View) -> Vec<Zone> {
    let settled = settle(levels, view, &[]);
    let zone = |(track, place): (&Track, Place)| {
        let [a, b] = view.near.map(|k| track.hinted[k]);
        let at = place.at.clamp(a.min(b), a.max(b));
        Zone { track: track.clone(), place: Place { at, ..place } }
    };
    levels.iter().zip(settled).map(zone).collect()
}
