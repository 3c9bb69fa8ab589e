//! A font's alignment zones, as the baseline and the x-height: their hinting is known better than that of any track of a
//! single glyph, because many glyphs show it.

use std::collections::BTreeMap;

use super::likelihood::WeightedSizes;
use super::placement::place;
use super::track::{AlignmentZone, Position, Track};

/// The fewest glyphs that share an alignment zone.
const MIN_GLYPHS: usize = 3;
/// The most alignment zones of a font along an axis; those of the most glyphs.
const MAX_ZONES: usize = 24;
/// An alignment zone is on a whole pixel at this share of the known sizes.
const GRID_FITTED: f64 = 0.9;

/// Counts the glyphs that have each grid-fitted track.
#[derive(Debug, Default)]
pub(super) struct TrackCounts {
    /// By the tracks' keys, so that the order is the same on every machine.
    counts: BTreeMap<Vec<u64>, (usize, Track)>,
}

impl TrackCounts {
    /// Counts the tracks of a glyph.
    pub(super) fn add(&mut self, glyph: &[Track]) {
        for track in glyph {
            let whole = track.hinted.iter().filter(|at| at.fract() == 0.0).count();
            if whole as f64 >= GRID_FITTED * track.hinted.len() as f64 {
                self.counts.entry(track.key()).or_insert_with(|| (0, track.clone())).0 += 1;
            }
        }
    }

    /// The tracks of the font's alignment zones.
    pub(super) fn into_zone_tracks(self) -> Vec<Track> {
        let mut tracks: Vec<(usize, Track)> = self.counts.into_values().collect();
        tracks.retain(|(count, _)| *count >= MIN_GLYPHS);
        tracks.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        tracks.truncate(MAX_ZONES);
        tracks.into_iter().map(|(_, track)| track).collect()
    }
}

/// Predicts the positions of alignment zones at the wanted size, within those at the neighbouring known sizes.
pub(super) fn alignment_zones(tracks: &[Track], sizes: &WeightedSizes) -> Vec<AlignmentZone> {
    let positions = place(tracks, sizes, &[]);
    let zone = |(track, position): (&Track, Position)| {
        let [a, b] = sizes.near.map(|k| track.hinted[k]);
        let at = position.at.clamp(a.min(b), a.max(b));
        AlignmentZone { track: track.clone(), position: Position { at, ..position } }
    };
    tracks.iter().zip(positions).map(zone).collect()
}
