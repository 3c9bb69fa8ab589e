//! The levels of one outline along one axis, and where they go at a size that is not known.

use std::collections::HashMap;

use super::rule::{View, Vote, best, offer};
use super::zones::Zone;

/// What a rule has to be better by that leans on another level, on two, or on a level of the font.
const LEAN_ON_ONE: f64 = 2.0;
const LEAN_ON_TWO: f64 = 3.0;
const LEAN_ON_ZONE: f64 = 3.0;
/// So many tracks, the surest ones, may be leant on; few glyphs have more along an axis.
const MOST_BASES: usize = 64;
/// What mixing the moves at the neighbouring sizes is worth: a rule that fails at three near sizes is worse.
const MIXING: f64 = -24.0;
/// Moves below this (pixels) are rounding: the axis is not hinted.
const STILL: f64 = 1.0 / 32.0;

/// Points that lie at the same height in the plain outline and in every hinted one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Track {
    /// In em.
    pub(super) plain: f64,
    /// In pixels, at each known size.
    pub(super) hinted: Vec<f64>,
}

impl Track {
    /// The same for tracks that are equal, and for no others.
    pub(super) fn key(&self) -> Vec<u64> {
        // Adding 0 makes −0 of it, too.
        std::iter::once(&self.plain).chain(&self.hinted).map(|v| (v + 0.0).to_bits()).collect()
    }
}

/// Where a track goes at the wanted size (pixels), and how sure that is (the logarithm of a share).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Place {
    pub(super) at: f64,
    pub(super) sure: f64,
}

/// One coordinate of all points of an outline.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    pub(super) tracks: Vec<Track>,
    /// The track of each point.
    track_of: Vec<usize>,
}

impl Motion {
    /// Sorts points into tracks: `plain` in em, `hinted` in pixels by known size.
    pub(super) fn new(plain: &[f32], hinted: &[Vec<f32>]) -> Self {
        let mut tracks: Vec<Track> = Vec::new();
        let mut known = HashMap::new();
        let track_of = plain
            .iter()
            .enumerate()
            .map(|(point, plain)| {
                let hinted = hinted.iter().map(|row| f64::from(row[point])).collect();
                let track = Track { plain: f64::from(*plain), hinted };
                *known.entry(track.key()).or_insert_with(|| {
                    tracks.push(track);
                    tracks.len() - 1
                })
            })
            .collect();
        Self { tracks, track_of }
    }

    /// The coordinate of each point at the wanted size in pixels.
    pub(super) fn at(&self, view: &View, zones: &[Zone]) -> Vec<f32> {
        let at: Vec<f64> = if self.is_still(view) {
            self.tracks.iter().map(|track| track.plain * view.wanted).collect()
        } else {
            let mut at: Vec<f64> = settle(&self.tracks, view, zones).iter().map(|place| place.at).collect();
            keep_order(&self.tracks, view, &mut at);
            at
        };
        self.track_of.iter().map(|track| at[*track] as f32).collect()
    }

    fn is_still(&self, view: &View) -> bool {
        let still = |track: &Track| {
            track.hinted.iter().zip(&view.sizes).all(|(at, size)| (at - track.plain * size).abs() <= STILL)
        };
        self.tracks.iter().all(still)
    }
}

/// Finds where tracks go: the surest first, and then those that lean on them. The work grows with the number of tracks,
/// not with its cube.
pub(super) fn settle(tracks: &[Track], view: &View, zones: &[Zone]) -> Vec<Place> {
    let mut votes: Vec<Vec<Vote>> = tracks.iter().map(|track| alone(track, view)).collect();
    let mut scratch = Vec::new();
    for (track, votes) in tracks.iter().zip(&mut votes) {
        lean_on_zones(track, zones, view, votes, &mut scratch);
    }
    let mut places = vec![Place::default(); tracks.len()];
    let mut settled: Vec<usize> = Vec::with_capacity(tracks.len());
    let mut open: Vec<usize> = (0..tracks.len()).collect();
    let confidence = |votes: &[Vote]| {
        let (vote, sure) = best(votes);
        vote.evidence + sure
    };
    while settled.len() < MOST_BASES
        && let Some((slot, _)) = open
            .iter()
            .enumerate()
            .map(|(slot, track)| (slot, confidence(&votes[*track])))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    {
        let next = open.swap_remove(slot);
        let (vote, sure) = best(&votes[next]);
        places[next] = Place { at: vote.at, sure };
        let base = (&tracks[next], places[next]);
        for &track in &open {
            lean_on_one(&tracks[track], base, view, &mut votes[track], &mut scratch);
            for &other in &settled {
                lean_on_two(&tracks[track], [base, (&tracks[other], places[other])], view, &mut votes[track]);
            }
        }
        settled.push(next);
    }
    for track in open {
        let (vote, sure) = best(&votes[track]);
        places[track] = Place { at: vote.at, sure };
    }
    places
}

/// Rules that need no other track: snapped by itself, not hinted, or between its neighbours.
fn alone(track: &Track, view: &View) -> Vec<Vote> {
    let mut votes = Vec::new();
    view.snapped(&track.hinted, track.plain, &mut votes);
    let plain = view.evidence(&track.hinted, |k| track.plain * view.sizes[k]);
    offer(&mut votes, track.plain * view.wanted, plain);
    offer(&mut votes, mixed(track, view), MIXING);
    votes
}

/// The plain position, moved as at the nearest known sizes, in proportion.
fn mixed(track: &Track, view: &View) -> f64 {
    let [a, b] = view.near;
    let span = view.sizes[b] - view.sizes[a];
    let share = if span > 0.0 { (view.wanted - view.sizes[a]) / span } else { 0.0 };
    let moved = |k: usize| track.hinted[k] - track.plain * view.sizes[k];
    track.plain * view.wanted + moved(a) + (moved(b) - moved(a)) * share
}

/// A track that is a level of the font goes where that goes; others may keep a whole distance from one.
fn lean_on_zones(track: &Track, zones: &[Zone], view: &View, votes: &mut Vec<Vote>, scratch: &mut Vec<Vote>) {
    if let Some(zone) = zones.iter().find(|zone| zone.track == *track) {
        *votes = vec![Vote { at: zone.place.at, evidence: zone.place.sure }];
        return;
    }
    for zone in zones {
        let sure = zone.place.sure - LEAN_ON_ZONE;
        let distance = difference(track, &zone.track);
        view.snapped(&distance, track.plain - zone.track.plain, scratch);
        scratch.iter().for_each(|vote| offer(votes, zone.place.at + vote.at, sure + vote.evidence));
    }
}

/// A track may keep its plain distance from another, or a whole number of pixels.
fn lean_on_one(
    track: &Track,
    (base, place): (&Track, Place),
    view: &View,
    votes: &mut Vec<Vote>,
    scratch: &mut Vec<Vote>,
) {
    let sure = place.sure - LEAN_ON_ONE;
    let distance = difference(track, base);
    let apart = track.plain - base.plain;
    let shifted = view.evidence(&distance, |k| apart * view.sizes[k]);
    offer(votes, place.at + apart * view.wanted, sure + shifted);
    view.snapped(&distance, apart, scratch);
    scratch.iter().for_each(|vote| offer(votes, place.at + vote.at, sure + vote.evidence));
}

/// A track between two others may keep its share of their distance, rounded or not.
fn lean_on_two(track: &Track, [a, b]: [(&Track, Place); 2], view: &View, votes: &mut Vec<Vote>) {
    let share = (track.plain - a.0.plain) / (b.0.plain - a.0.plain);
    if !(0.0..=1.0).contains(&share) {
        return;
    }
    let sure = a.1.sure.min(b.1.sure) - LEAN_ON_TWO;
    let between = |low: f64, high: f64| low + share * (high - low);
    let guess = |k: usize| between(a.0.hinted[k], b.0.hinted[k]);
    let at = between(a.1.at, b.1.at);
    offer(votes, at, sure + view.evidence(&track.hinted, guess));
    let rounded = view.evidence(&track.hinted, |k| (guess(k) + 0.5).floor());
    offer(votes, (at + 0.5).floor(), sure + rounded);
}

fn difference(a: &Track, b: &Track) -> Vec<f64> {
    a.hinted.iter().zip(&b.hinted).map(|(a, b)| a - b).collect()
}

/// Lifts tracks that would cross one below them, unless they do so at a neighbouring size too.
fn keep_order(tracks: &[Track], view: &View, at: &mut [f64]) {
    let mut upwards: Vec<usize> = (0..tracks.len()).collect();
    upwards.sort_by(|a, b| tracks[*a].plain.total_cmp(&tracks[*b].plain));
    let ordered = |a: usize, b: usize| view.near.iter().all(|k| tracks[a].hinted[*k] <= tracks[b].hinted[*k]);
    for (rank, &above) in upwards.iter().enumerate() {
        for &below in &upwards[..rank] {
            if at[below] > at[above] && tracks[below].plain < tracks[above].plain && ordered(below, above) {
                at[above] = at[below];
            }
        }
    }
}
