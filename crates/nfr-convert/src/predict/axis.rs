//! One coordinate of an outline's points at the known sizes, and its prediction at the wanted size.

use std::collections::HashMap;

use super::likelihood::WeightedSizes;
use super::placement::place;
use super::track::{AlignmentZone, Track};

/// Moves up to this (pixels) are rounding: the axis is not hinted.
const ROUNDING: f64 = 1.0 / 32.0;

/// One coordinate of all points of an outline.
#[derive(Debug, Clone)]
pub(super) struct AxisTracks {
    pub(super) tracks: Vec<Track>,
    /// The track of each point.
    track_of: Vec<usize>,
}

impl AxisTracks {
    /// Groups points into tracks: `unhinted` in em, `hinted` in pixels by known size.
    pub(super) fn new(unhinted: &[f32], hinted: &[Vec<f32>]) -> Self {
        let mut tracks: Vec<Track> = Vec::new();
        let mut known = HashMap::new();
        let track_of = unhinted
            .iter()
            .enumerate()
            .map(|(point, unhinted)| {
                let hinted = hinted.iter().map(|size| f64::from(size[point])).collect();
                let track = Track { unhinted: f64::from(*unhinted), hinted };
                *known.entry(track.key()).or_insert_with(|| {
                    tracks.push(track);
                    tracks.len() - 1
                })
            })
            .collect();
        Self { tracks, track_of }
    }

    /// The coordinate of each point at the wanted size in pixels.
    pub(super) fn predict(&self, sizes: &WeightedSizes, zones: &[AlignmentZone]) -> Vec<f32> {
        let at: Vec<f64> = if self.is_unhinted(sizes) {
            self.tracks.iter().map(|track| track.unhinted * sizes.wanted).collect()
        } else {
            let mut at: Vec<f64> = place(&self.tracks, sizes, zones).iter().map(|p| p.at).collect();
            keep_order(&self.tracks, sizes, &mut at);
            at
        };
        self.track_of.iter().map(|track| at[*track] as f32).collect()
    }

    fn is_unhinted(&self, sizes: &WeightedSizes) -> bool {
        let is_unhinted = |track: &Track| {
            let mut moves = track.hinted.iter().zip(&sizes.ppem).map(|(at, size)| at - track.unhinted * size);
            moves.all(|moved| moved.abs() <= ROUNDING)
        };
        self.tracks.iter().all(is_unhinted)
    }
}

/// Raises tracks that would cross one below them, unless they cross at a neighbouring known size too.
fn keep_order(tracks: &[Track], sizes: &WeightedSizes, at: &mut [f64]) {
    let mut upwards: Vec<usize> = (0..tracks.len()).collect();
    upwards.sort_by(|a, b| tracks[*a].unhinted.total_cmp(&tracks[*b].unhinted));
    let ordered =
        |a: usize, b: usize| sizes.near.iter().all(|k| tracks[a].hinted[*k] <= tracks[b].hinted[*k]);
    for (rank, &above) in upwards.iter().enumerate() {
        for &below in &upwards[..rank] {
            if at[below] > at[above]
                && tracks[below].unhinted < tracks[above].unhinted
                && ordered(below, above)
            {
                at[above] = at[below];
            }
        }
    }
}
