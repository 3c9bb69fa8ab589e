//! The positions of an outline's tracks at the wanted size: the likeliest of what hint programs do, for each track.

use super::likelihood::{Candidate, WeightedSizes, add_candidate, likeliest};
use super::track::{AlignmentZone, Position, Track};

/// The log-likelihood that a rule loses for each assumption: a position relative to one track, between two, or relative
/// to an alignment zone.
const RELATIVE_TO_ONE: f64 = 2.0;
const BETWEEN_TWO: f64 = 3.0;
const RELATIVE_TO_ZONE: f64 = 3.0;
/// The most tracks, the most probable ones, that others are placed relative to; few glyphs have more along an axis.
const MAX_REFERENCES: usize = 64;
/// The log-likelihood of interpolating the moves at the neighbouring sizes. A rule that fails at three near sizes has
/// less.
const INTERPOLATION: f64 = -24.0;

/// Places tracks: the most probable one first, and then the others relative to those placed before. The work grows with
/// the number of tracks, not with its cube.
pub(super) fn place(tracks: &[Track], sizes: &WeightedSizes, zones: &[AlignmentZone]) -> Vec<Position> {
    let mut candidates: Vec<Vec<Candidate>> = tracks.iter().map(|track| alone(track, sizes)).collect();
    let mut scratch = Vec::new();
    for (track, candidates) in tracks.iter().zip(&mut candidates) {
        relative_to_zones(track, zones, sizes, candidates, &mut scratch);
    }
    let mut positions = vec![Position::default(); tracks.len()];
    let mut placed: Vec<usize> = Vec::with_capacity(tracks.len());
    let mut open: Vec<usize> = (0..tracks.len()).collect();
    let confidence = |candidates: &[Candidate]| {
        let (best, log_probability) = likeliest(candidates);
        best.log_likelihood + log_probability
    };
    while placed.len() < MAX_REFERENCES
        && let Some((slot, _)) = open
            .iter()
            .enumerate()
            .map(|(slot, track)| (slot, confidence(&candidates[*track])))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    {
        let next = open.swap_remove(slot);
        let (best, log_probability) = likeliest(&candidates[next]);
        positions[next] = Position { at: best.at, log_probability };
        let reference = (&tracks[next], positions[next]);
        for &track in &open {
            let candidates = &mut candidates[track];
            relative_to_one(&tracks[track], reference, sizes, candidates, &mut scratch);
            for &other in &placed {
                let references = [reference, (&tracks[other], positions[other])];
                between_two(&tracks[track], references, sizes, candidates);
            }
        }
        placed.push(next);
    }
    for track in open {
        let (best, log_probability) = likeliest(&candidates[track]);
        positions[track] = Position { at: best.at, log_probability };
    }
    positions
}

/// Rules without another track: rounded, not hinted, or interpolated between the neighbouring sizes.
fn alone(track: &Track, sizes: &WeightedSizes) -> Vec<Candidate> {
    let mut candidates = Vec::new();
    sizes.rounded(&track.hinted, track.unhinted, &mut candidates);
    let unhinted = sizes.log_likelihood(&track.hinted, |k| track.unhinted * sizes.ppem[k]);
    add_candidate(&mut candidates, track.unhinted * sizes.wanted, unhinted);
    add_candidate(&mut candidates, interpolated(track, sizes), INTERPOLATION);
    candidates
}

/// The unhinted position plus the linearly interpolated move at the nearest known sizes.
fn interpolated(track: &Track, sizes: &WeightedSizes) -> f64 {
    let [a, b] = sizes.near;
    let span = sizes.ppem[b] - sizes.ppem[a];
    let share = if span > 0.0 { (sizes.wanted - sizes.ppem[a]) / span } else { 0.0 };
    let moved = |k: usize| track.hinted[k] - track.unhinted * sizes.ppem[k];
    track.unhinted * sizes.wanted + moved(a) + (moved(b) - moved(a)) * share
}

/// A track that is an alignment zone has the zone's position; others may have a whole distance from one.
fn relative_to_zones(
    track: &Track,
    zones: &[AlignmentZone],
    sizes: &WeightedSizes,
    candidates: &mut Vec<Candidate>,
    scratch: &mut Vec<Candidate>,
) {
    if let Some(zone) = zones.iter().find(|zone| zone.track == *track) {
        let Position { at, log_probability } = zone.position;
        *candidates = vec![Candidate { at, log_likelihood: log_probability }];
        return;
    }
    for zone in zones {
        let log_likelihood = zone.position.log_probability - RELATIVE_TO_ZONE;
        sizes.rounded(&track.distance_from(&zone.track), track.unhinted - zone.track.unhinted, scratch);
        for distance in &*scratch {
            let at = zone.position.at + distance.at;
            add_candidate(candidates, at, log_likelihood + distance.log_likelihood);
        }
    }
}

/// A track may keep its unhinted distance from another, or have a whole number of pixels (MDRP and MIRP of TrueType).
fn relative_to_one(
    track: &Track,
    (reference, position): (&Track, Position),
    sizes: &WeightedSizes,
    candidates: &mut Vec<Candidate>,
    scratch: &mut Vec<Candidate>,
) {
    let log_likelihood = position.log_probability - RELATIVE_TO_ONE;
    let distance = track.distance_from(reference);
    let unhinted = track.unhinted - reference.unhinted;
    let shifted = sizes.log_likelihood(&distance, |k| unhinted * sizes.ppem[k]);
    add_candidate(candidates, position.at + unhinted * sizes.wanted, log_likelihood + shifted);
    sizes.rounded(&distance, unhinted, scratch);
    for distance in &*scratch {
        add_candidate(candidates, position.at + distance.at, log_likelihood + distance.log_likelihood);
    }
}

/// A track between two others may be interpolated between them (IP and IUP of TrueType), rounded or not.
fn between_two(
    track: &Track,
    [a, b]: [(&Track, Position); 2],
    sizes: &WeightedSizes,
    candidates: &mut Vec<Candidate>,
) {
    let share = (track.unhinted - a.0.unhinted) / (b.0.unhinted - a.0.unhinted);
    if !(0.0..=1.0).contains(&share) {
        return;
    }
    let log_likelihood = a.1.log_probability.min(b.1.log_probability) - BETWEEN_TWO;
    let between = |low: f64, high: f64| low + share * (high - low);
    let rule = |k: usize| between(a.0.hinted[k], b.0.hinted[k]);
    let at = between(a.1.at, b.1.at);
    add_candidate(candidates, at, log_likelihood + sizes.log_likelihood(&track.hinted, rule));
    let rounded = sizes.log_likelihood(&track.hinted, |k| (rule(k) + 0.5).floor());
    add_candidate(candidates, (at + 0.5).floor(), log_likelihood + rounded);
}
