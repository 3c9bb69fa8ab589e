//! Finding the tracks of a glyph: levels whose points hinting moves together, chosen one after the other by what they save.

use super::correction::correct;
use super::distortion::Distortion;
use super::samples::OutlineSamples;
use nfr::internals::model::outline::{AxisHints, Interpolation, MAX_TRACKS, OutlineWeights, UNTOUCHED};
use nfr::internals::mul_fixed;

use crate::options::Fidelity;
use nfr::internals::table::outline::MAX_CORRECTED;

/// The bits that a track takes, roughly: for itself, and for each size.
const TRACK_BITS: f64 = 12.0;
const MOVE_BITS: f64 = 0.7;

/// A glyph's hints, and what an error of each track's moves costs.
#[derive(Debug, Clone)]
pub(crate) struct FittedOutline {
    pub(crate) weights: OutlineWeights,
    /// For each axis, for each track: pixels of error for 1/64 pixel, at each size.
    pub(crate) costs: [Vec<Vec<f64>>; 2],
}

/// Adds the corrections of what the tracks leave.
pub(super) fn add_corrections(
    weights: &mut OutlineWeights,
    samples: &OutlineSamples,
    units_per_em: u16,
    fidelity: Fidelity,
) {
    if samples.points.len() * samples.sizes() > MAX_CORRECTED && !fidelity.is_exact() {
        return;
    }
    for (axis, hints) in weights.axes.iter_mut().enumerate() {
        if samples.is_still(axis, fidelity) {
            continue;
        }
        let distortion = Distortion::new(samples, axis, units_per_em, fidelity);
        hints.corrections =
            correct(samples, axis, hints, fidelity, |point, size| distortion.of_point(point, size));
    }
}

/// The error of hints over all sizes, in pixels of full coverage.
pub(super) fn error(
    weights: &OutlineWeights,
    samples: &OutlineSamples,
    units_per_em: u16,
    fidelity: Fidelity,
) -> f64 {
    let axes = weights.axes.iter().enumerate().filter(|(axis, _)| !samples.is_still(*axis, fidelity));
    axes.map(|(axis, hints)| Distortion::new(samples, axis, units_per_em, fidelity).of_all(hints)).sum()
}

/// Points that one track could move.
#[derive(Clone)]
struct Cluster {
    level: i16,
    points: Vec<u16>,
    /// How far hinting moves them at each size.
    moves: Vec<i16>,
    contours: Vec<usize>,
    /// Whether the track moves these points alone.
    is_local: bool,
}

/// Finds the hints of a glyph. An axis that hinting leaves alone, as seen with the fidelity `still`, gets none.
pub(crate) fn fit(
    samples: &OutlineSamples,
    units_per_em: u16,
    fidelity: Fidelity,
    still: Fidelity,
) -> FittedOutline {
    let mut costs = [Vec::new(), Vec::new()];
    let axes = [0, 1].map(|axis| {
        if samples.is_still(axis, still) {
            return AxisHints::default();
        }
        let distortion = Distortion::new(samples, axis, units_per_em, fidelity);
        let hints = fit_axis(samples, axis, &distortion, fidelity);
        costs[axis] = (0..hints.levels.len()).map(|track| distortion.weights(&hints, track)).collect();
        hints
    });
    FittedOutline { weights: OutlineWeights { axes, advances: samples.advances.clone() }, costs }
}

fn fit_axis(
    samples: &OutlineSamples,
    axis: usize,
    distortion: &Distortion<'_>,
    fidelity: Fidelity,
) -> AxisHints {
    let clusters = clusters(samples, axis, distortion, fidelity.tolerance());
    // Each cluster is followed by its local twin.
    let has_twins = samples.interpolation(axis) == Interpolation::Level;
    let price = fidelity.error_per_bit() * (TRACK_BITS + MOVE_BITS * samples.sizes() as f64);
    let mut chosen = vec![false; clusters.len()];
    let mut errors: Vec<f64> =
        (0..distortion.contour_count()).map(|c| distortion.of_contour(c, &AxisHints::default())).collect();
    let hints_of = |chosen: &[bool]| hints(samples, &clusters, chosen);
    let gain = |chosen: &mut Vec<bool>, errors: &[f64], k: usize| {
        chosen[k] = !chosen[k];
        let hints = hints_of(chosen);
        chosen[k] = !chosen[k];
        let after: Vec<f64> =
            clusters[k].contours.iter().map(|c| distortion.of_contour(*c, &hints)).collect();
        let saved = clusters[k].contours.iter().zip(&after).map(|(c, after)| errors[*c] - after).sum::<f64>();
        (saved, after)
    };
    // The lowest and the highest level begin.
    for k in [0, clusters.len() - 1 - usize::from(has_twins)] {
        if !chosen[k] {
            let (_, after) = gain(&mut chosen, &errors, k);
            chosen[k] = true;
            clusters[k].contours.iter().zip(after).for_each(|(c, after)| errors[*c] = after);
        }
    }
    // A gain that was small stays small, mostly: the candidates with the highest last gain are tried first.
    let mut last: Vec<f64> = vec![f64::INFINITY; clusters.len()];
    while chosen.iter().filter(|c| **c).count() < MAX_TRACKS {
        let mut best: Option<(usize, f64, Vec<f64>)> = None;
        let is_free = |k: &usize| !(chosen[*k] || has_twins && chosen[k ^ 1]);
        let mut order: Vec<usize> = (0..clusters.len()).filter(is_free).collect();
        order.sort_by(|a, b| last[*b].total_cmp(&last[*a]));
        for k in order {
            if best.as_ref().is_some_and(|(_, gain, _)| last[k] * PATIENCE < *gain) {
                break;
            }
            let (saved, after) = gain(&mut chosen, &errors, k);
            last[k] = saved.max(0.0);
            if best.as_ref().is_none_or(|(_, gain, _)| saved > *gain) {
                best = Some((k, saved, after));
            }
        }
        let Some((k, _, after)) = best.filter(|(_, saved, _)| *saved > price.max(1e-9)) else { break };
        chosen[k] = true;
        clusters[k].contours.iter().zip(after).for_each(|(c, after)| errors[*c] = after);
    }
    // What is not needed any more goes.
    for k in 0..clusters.len() {
        if chosen[k] {
            let (saved, after) = gain(&mut chosen, &errors, k);
            if -saved < price.max(1e-9) {
                chosen[k] = false;
                clusters[k].contours.iter().zip(after).for_each(|(c, after)| errors[*c] = after);
            }
        }
    }
    hints_of(&chosen)
}

/// A candidate is not tried again while another gains more than so many times its last gain.
const PATIENCE: f64 = 1.5;

/// Points of one level that hinting moves alike, the lowest level first.
fn clusters(
    samples: &OutlineSamples,
    axis: usize,
    distortion: &Distortion<'_>,
    tolerance: i32,
) -> Vec<Cluster> {
    let units = &samples.points.coordinates[axis];
    let mut order: Vec<u16> = (0..samples.points.len() as u16).collect();
    order.sort_by_key(|p| (units[usize::from(*p)], *p));
    let mut clusters: Vec<Cluster> = Vec::new();
    for point in order {
        let p = usize::from(point);
        let moves: Vec<i16> = (0..samples.sizes())
            .map(|size| {
                let plain = mul_fixed(units[p].into(), samples.scales[size]);
                (samples.hinted_at(axis, size)[p] - plain).clamp(i16::MIN.into(), i16::MAX.into()) as i16
            })
            .collect();
        let like = |cluster: &&mut Cluster| {
            cluster.level == units[p]
                && cluster.moves.iter().zip(&moves).all(|(a, b)| i32::from(a.abs_diff(*b)) <= tolerance)
        };
        match clusters.iter_mut().rev().take_while(|c| c.level == units[p]).find(like) {
            Some(cluster) => cluster.points.push(point),
            None => {
                clusters.push(Cluster {
                    level: units[p],
                    points: vec![point],
                    moves,
                    contours: Vec::new(),
                    is_local: false,
                });
            }
        }
    }
    for cluster in &mut clusters {
        cluster.contours = distortion.contours_of(&cluster.points, false);
    }
    if samples.interpolation(axis) == Interpolation::Contour {
        return clusters;
    }
    let both = |cluster: Cluster| {
        let contours = distortion.contours_of(&cluster.points, true);
        [cluster.clone(), Cluster { contours, is_local: true, ..cluster }]
    };
    clusters.into_iter().flat_map(both).collect()
}

/// The hints that the chosen clusters make.
fn hints(samples: &OutlineSamples, clusters: &[Cluster], chosen: &[bool]) -> AxisHints {
    let chosen: Vec<&Cluster> =
        clusters.iter().zip(chosen).filter(|(_, chosen)| **chosen).map(|(c, _)| c).collect();
    if chosen.is_empty() {
        return AxisHints::default();
    }
    let mut track_of = vec![UNTOUCHED; samples.points.len()];
    for (track, cluster) in chosen.iter().enumerate() {
        cluster.points.iter().for_each(|p| track_of[usize::from(*p)] = track as u8);
    }
    AxisHints {
        is_hinted: true,
        first_size: 0,
        levels: chosen.iter().map(|cluster| cluster.level).collect(),
        track_of,
        is_local: if chosen.iter().any(|cluster| cluster.is_local) {
            chosen.iter().map(|cluster| cluster.is_local).collect()
        } else {
            Vec::new()
        },
        moves: (0..samples.sizes()).flat_map(|size| chosen.iter().map(move |c| c.moves[size])).collect(),
        corrections: Vec::new(),
    }
}
