use proptest::collection::vec;
use proptest::prelude::*;

use super::*;

/// Moves one contour of points, given in font units, which are scaled by `scale` in 1/65536. `moves[k]` is the move of point k
/// in 1/64 pixel if it is touched. Gives the positions.
fn moved(units: &[i16], scale: i32, moves: &[Option<i16>]) -> Vec<i32> {
    let mut out = Vec::new();
    out.extend(units.iter().map(|v| mul_fixed((*v).into(), scale)));
    // Each touched point has a track of its own.
    let track_of: Vec<u8> = moves.iter().enumerate().map(|(k, m)| m.map_or(UNTOUCHED, |_| k as u8)).collect();
    let moves: Vec<i16> = moves.iter().map(|moved| moved.unwrap_or_default()).collect();
    move_contour(units, 0..units.len(), &track_of, &moves, &mut out);
    out
}

/// One font unit is 1/64 pixel.
const EQUAL: i32 = 0x10000;

#[test]
fn a_contour_without_touched_points_stays() {
    let units = [0, 100, 333, -7];
    assert_eq!(moved(&units, EQUAL, &[None; 4]), [0, 100, 333, -7]);
}

#[test]
fn one_touched_point_moves_its_whole_contour() {
    let units = [0, 100, 333, -7];
    for touched in 0..4 {
        let mut moves = [None; 4];
        moves[touched] = Some(-20);
        assert_eq!(moved(&units, EQUAL, &moves), [-20, 80, 313, -27], "point {touched}");
    }
}

#[test]
fn points_between_two_touched_ones_keep_their_share_of_the_way() {
    let moves = [Some(0), None, None, None, Some(40)];
    assert_eq!(moved(&[0, 25, 50, 75, 100], EQUAL, &moves), [0, 35, 70, 105, 140]);
    // Shares are those of font units, whatever order the points have.
    assert_eq!(
        moved(&[100, 25, 50, 75, 0], EQUAL, &[Some(40), None, None, None, Some(0)]),
        [140, 35, 70, 105, 0]
    );
}

#[test]
fn points_beyond_two_touched_ones_move_with_the_nearer_one() {
    let moves = [Some(-10), None, None, Some(30), None, None];
    assert_eq!(moved(&[0, -5, -300, 100, 101, 900], EQUAL, &moves), [-10, -15, -310, 130, 131, 930]);
}

#[test]
fn points_before_the_first_touched_one_lie_between_the_last_one_and_it() {
    // Points 2 and 4 are touched. Points 5, 0 and 1 lie between 4 and 2 on the way around, point 3 between 2 and 4.
    let moves = [None, None, Some(0), None, Some(64), None];
    assert_eq!(moved(&[50, 25, 0, 10, 100, 75], EQUAL, &moves), [82, 41, 0, 16, 164, 123]);
    // Neighbours count, not the nearest touched coordinates: the last point lies between points 3 and 0.
    let moves = [Some(8), Some(0), Some(0), Some(16), None];
    assert_eq!(moved(&[0, 40, 60, 100, 50], EQUAL, &moves), [8, 40, 60, 116, 62]);
}

#[test]
fn points_between_two_touched_ones_that_meet_come_to_the_same_place() {
    assert_eq!(moved(&[0, 100, 40, 99], EQUAL, &[Some(60), Some(-40), None, None]), [60, 60, 60, 60]);
}

#[test]
fn of_two_touched_points_at_one_coordinate_the_first_moves_what_is_there_or_below() {
    // The last three points lie between point 1 and point 0.
    assert_eq!(
        moved(&[10, 10, 30, -4, 10], EQUAL, &[Some(5), Some(19), None, None, None]),
        [15, 29, 35, 15, 29]
    );
}

#[test]
fn other_contours_stay() {
    let units: [i16; 6] = [0, 50, 100, 0, 50, 100];
    let mut out: Vec<i32> = units.map(i32::from).to_vec();
    let track_of = [0, UNTOUCHED, UNTOUCHED, 1, UNTOUCHED, UNTOUCHED];
    move_contour(&units, 3..6, &track_of, &[7, -9], &mut out);
    assert_eq!(out, [0, 50, 100, -9, 41, 91]);
}

/// Where `IUP` puts a point (FreeType's `_iup_worker_interpolate`), in exact arithmetic: what lies between two touched points
/// is not rounded.
fn exact(units: i16, plain: i32, ends: [Touched; 2]) -> f64 {
    let [a, b] = if ends[0].0 > ends[1].0 { [ends[1], ends[0]] } else { ends };
    if plain <= a.1 {
        f64::from(plain + a.2 - a.1)
    } else if plain >= b.1 {
        f64::from(plain + b.2 - b.1)
    } else if a.0 == b.0 {
        f64::from(a.2)
    } else {
        f64::from(a.2) + f64::from(b.2 - a.2) * f64::from(i32::from(units) - a.0) / f64::from(b.0 - a.0)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn every_untouched_point_follows_the_touched_ones_before_and_after_it(
        points in vec((-2000i16..2000, prop::option::weighted(0.4, -200i16..200)), 1..30),
        ppem in 5i32..200,
    ) {
        let (units, moves): (Vec<i16>, Vec<Option<i16>>) = points.into_iter().unzip();
        let scale = div_fixed(ppem * 64, 2048);
        let out = moved(&units, scale, &moves);
        let count = units.len();
        let plain = |k: usize| mul_fixed(units[k].into(), scale);
        let touched = |k: usize| moves[k].map(|by| (i32::from(units[k]), plain(k), plain(k) + i32::from(by)));
        for k in 0..count {
            let before = (1..=count).find_map(|back| touched((k + count - back) % count));
            let after = (1..=count).find_map(|on| touched((k + on) % count));
            let Some(ends) = before.zip(after) else {
                prop_assert_eq!(out[k], plain(k));
                continue;
            };
            match touched(k) {
                Some((_, _, hinted)) => prop_assert_eq!(out[k], hinted),
                None => {
                    // Half of 1/64 pixel for the result, half of 1/65536 for each of up to 4000 units.
                    let off = f64::from(out[k]) - exact(units[k], plain(k), ends.into());
                    prop_assert!(off.abs() <= 0.5 + 4000.0 / 131_072.0, "point {} is off by {}", k, off);
                }
            }
        }
    }

    #[test]
    fn a_contour_may_begin_anywhere(
        points in vec((-2000i16..2000, prop::option::weighted(0.4, -200i16..200)), 1..20),
        first in any::<prop::sample::Index>(),
    ) {
        let (mut units, mut moves): (Vec<i16>, Vec<Option<i16>>) = points.into_iter().unzip();
        // Of two touched points at one coordinate, the earlier one counts.
        units.iter_mut().enumerate().for_each(|(k, units)| *units = *units / 20 * 20 + k as i16);
        let mut out = moved(&units, EQUAL, &moves);
        let first = first.index(units.len());
        units.rotate_left(first);
        moves.rotate_left(first);
        out.rotate_left(first);
        prop_assert_eq!(moved(&units, EQUAL, &moves), out);
    }
}
