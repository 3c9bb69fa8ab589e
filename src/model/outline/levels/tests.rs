use proptest::collection::vec;
use proptest::prelude::*;

use super::*;
use crate::model::outline::OutlinePoints;
use crate::model::outline::weights::{AxisHints, Correction, OutlineModel, OutlineWeights};
use crate::model::outline::{Interpolation, Tracks, hint, scale_of};
use crate::model::sizes::{Origin, Scale};

/// 16 pixels per em of 1024 units: a unit is 1/64 pixel.
const EQUAL: i32 = 0x10000;

fn hints(levels: &[i16], track_of: &[u8], is_local: &[bool]) -> AxisHints {
    AxisHints {
        is_hinted: true,
        levels: levels.to_vec(),
        track_of: track_of.to_vec(),
        is_local: is_local.to_vec(),
        ..AxisHints::default()
    }
}

/// The places of the points of one contour, in 1/64 pixel.
fn placed(units: &[i16], on_curve: &[bool], hints: &AxisHints, moves: &[i16], scale: i32) -> Vec<f64> {
    let mut out = vec![0; units.len()];
    let tracks = Tracks::new(hints, moves, on_curve, Interpolation::Level);
    tracks.place(units, 0..units.len(), scale, &mut out);
    out.into_iter().map(|place| f64::from(place) / 4.0).collect()
}

#[test]
fn points_lie_between_the_tracks_below_and_above_them_wherever_those_have_points() {
    // The tracks' own points are the first three.
    let units = [0, 100, 200, 50, 150, 175, 300, -30];
    let hints = hints(&[0, 100, 200], &[0, 1, 2, 255, 255, 255, 255, 255], &[]);
    let places = placed(&units, &[true; 8], &hints, &[4, 24, 0], EQUAL);
    assert_eq!(places, [4.0, 124.0, 200.0, 64.0, 162.0, 181.0, 300.0, -26.0]);
}

#[test]
fn a_local_track_moves_its_own_points_alone() {
    let units = [0, 100, 100, 200, 99];
    let with_local = hints(&[0, 100, 200], &[0, 1, 255, 2, 255], &[false, true, false]);
    let places = placed(&units, &[true; 5], &with_local, &[0, 50, 0], EQUAL);
    assert_eq!(places, [0.0, 150.0, 100.0, 200.0, 99.0]);
    let without = hints(&[0, 100, 200], &[0, 1, 255, 2, 255], &[false; 3]);
    let places = placed(&units, &[true; 5], &without, &[0, 50, 0], EQUAL);
    assert_eq!(places[1..3], [150.0, 150.0]);
}

#[test]
fn without_tracks_points_are_scaled() {
    let places = placed(&[0, 100, -7], &[true, false, true], &hints(&[], &[], &[]), &[], EQUAL);
    assert_eq!(places, [0.0, 100.0, -7.0]);
}

#[test]
fn a_control_point_of_a_track_goes_where_the_track_is() {
    // Two control points between two points on the curve, the second one with a track.
    let on_curve = [true, false, false, true];
    let hints = hints(&[0, 60, 100], &[0, 255, 1, 2], &[false, true, false]);
    let places = placed(&[0, 40, 60, 100], &on_curve, &hints, &[0, 9, 0], EQUAL);
    assert_eq!(places, [0.0, 40.0, 69.0, 100.0]);
}

#[test]
fn a_correction_leads_to_a_multiple_of_64ths() {
    let mut y = hints(&[0, 100], &[0, 255, 1], &[]);
    y.moves = vec![0, 50];
    y.corrections = vec![Correction { size: 0, point: 1, by: 3 }];
    let points = OutlinePoints {
        coordinates: [vec![0, 50, 10], vec![0, 33, 100]],
        on_curve: vec![true; 3],
        ends: vec![3],
        is_unfit: false,
    };
    let scale = Scale::new(1024, 16, 16).unwrap().with_origin(Origin::PostScript);
    let weights = OutlineWeights { axes: [AxisHints::default(), y], ..OutlineWeights::default() };
    let mut places = [Vec::new(), Vec::new()];
    let mut model = OutlineModel::new(points, weights, scale, 0..1).unwrap();
    hint(&model, &scale.at(16.0), &mut places);
    // Without the correction it is at 49.5 of 1/64 pixel, in between.
    assert_eq!(places[1], [0, 4 * (50 + 3), 4 * 150]);
    model.weights.axes[1].corrections.clear();
    hint(&model, &scale.at(16.0), &mut places);
    assert_eq!(places[1], [0, 198, 4 * 150]);
}

/// One control point of so many quadratic curves, in floating point.
fn control(cubic: [f64; 4], count: usize, index: usize) -> f64 {
    let n = count as f64;
    let point = |t: f64| {
        let s = 1.0 - t;
        s * s * s * cubic[0] + 3.0 * s * s * t * cubic[1] + 3.0 * s * t * t * cubic[2] + t * t * t * cubic[3]
    };
    let slope = |t: f64| {
        let s = 1.0 - t;
        let [a, b, c] = [0, 1, 2].map(|k| cubic[k + 1] - cubic[k]);
        3.0 * (s * s * a + 2.0 * s * t * b + t * t * c)
    };
    let [from, to] = [index, index + 1].map(|k| k as f64 / n);
    let share = if count > 1 { index as f64 / (n - 1.0) } else { 0.5 };
    let [after, before] = [point(from) + slope(from) / (2.0 * n), point(to) - slope(to) / (2.0 * n)];
    after * (1.0 - share) + before * share
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn control_points_are_those_of_the_moved_cubic_curve(
        cubic in [-1000i16..1000, -1000i16..1000, -1000i16..1000, -1000i16..1000],
        count in 1usize..=8,
        knots in vec((-900i16..900, -200i16..200), 2..6),
        ppem in 8u16..64,
    ) {
        // A map that keeps the order, so that nothing folds.
        let mut knots = knots;
        knots.sort_unstable();
        knots.dedup_by_key(|knot| knot.0);
        let (levels, moves): (Vec<i16>, Vec<i16>) = knots.into_iter().unzip();
        let cubic = if count == 1 {
            // A quadratic curve as a cubic one.
            let [a, control, _, d] = cubic.map(f64::from);
            [a, a + (control - a) * 2.0 / 3.0, d + (control - d) * 2.0 / 3.0, d]
        } else {
            cubic.map(f64::from)
        };
        let controls: Vec<f64> = (0..count).map(|index| control(cubic, count, index)).collect();
        let whole: Vec<i16> = controls.iter().map(|v| v.round() as i16).collect();
        let units = [&[cubic[0] as i16][..], &whole, &[cubic[3] as i16]].concat();
        let mut on_curve = vec![false; units.len()];
        (on_curve[0], on_curve[count + 1]) = (true, true);
        let (hints, scale) = (hints(&levels, &vec![UNTOUCHED; units.len()], &[]), scale_of(ppem.into(), 1000));
        let places = placed(&units, &on_curve, &hints, &moves, scale);
        let factor = f64::from(scale) / 65536.0;
        // The map, from font units to how far it moves, in 1/64 pixel.
        let knots: Vec<(f64, f64)> = levels
            .iter()
            .zip(&moves)
            .map(|(level, by)| {
                (f64::from(*level), f64::from(mul_fixed((*level).into(), scale)) + f64::from(*by) - f64::from(*level) * factor)
            })
            .collect();
        let by = |level: f64| {
            let above = knots.partition_point(|knot| knot.0 <= level);
            match (above.checked_sub(1).map(|k| knots[k]), knots.get(above)) {
                (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (level - a.0) / (b.0 - a.0),
                (Some(a), None) => a.1,
                (None, b) => b.map_or(0.0, |b| b.1),
            }
        };
        // Between knots that hinting turns around, IUP's rule counts and not the map.
        prop_assume!(knots.windows(2).all(|k| (k[1].0 - k[0].0) * factor + k[1].1 - k[0].1 > 1.0));
        let moved = cubic.map(by);
        for index in 0..count {
            let expected = f64::from(whole[index]) * factor + control(moved, count, index);
            let off = (places[index + 1] - expected).abs();
            // Whole control points tell the cubic's tangents less exactly: by half a unit times 2 count / 3, of which the map makes at most
            // its steepest slope.
            let steepest = knots.windows(2).map(|k| ((k[1].1 - k[0].1) / (k[1].0 - k[0].0)).abs()).fold(0.0, f64::max);
            let allowed = 1.0 + steepest * (count as f64 / 3.0 + 1.0) * 1.5;
            prop_assert!(off <= allowed, "{index} of {count}: off by {off}, {allowed} allowed");
        }
    }

    #[test]
    fn any_contour_with_any_tracks_is_placed(
        points in vec((any::<i16>(), any::<bool>(), 0u8..6), 0..40),
        levels in vec(any::<i16>(), 0..4),
        moves in vec(any::<i16>(), 0..5),
        is_local in vec(any::<bool>(), 0..5),
        scale in any::<i32>(),
    ) {
        let mut levels = levels;
        levels.sort_unstable();
        let units: Vec<i16> = points.iter().map(|point| point.0).collect();
        let on_curve: Vec<bool> = points.iter().map(|point| point.1).collect();
        let track_of: Vec<u8> = points.iter().map(|point| if point.2 == 5 { UNTOUCHED } else { point.2 }).collect();
        let places = placed(&units, &on_curve, &hints(&levels, &track_of, &is_local), &moves, scale >> 4);
        prop_assert_eq!(places.len(), units.len());
    }
}
