use proptest::prelude::*;

use super::*;

/// A closed curve: its distance from the middle (em) is some waves over the angle.
fn blob(radius: f32, waves: [f32; 3], points: usize) -> Vec<[f32; 2]> {
    let at = |k: usize| k as f32 / points as f32 * std::f32::consts::TAU;
    let far = |angle: f32| {
        let sum: f32 = waves.iter().zip(2u8..).map(|(w, k)| w * (angle * f32::from(k) + 2.0 * w).sin()).sum();
        radius * (1.0 + sum)
    };
    (0..points).map(|k| [at(k).cos() * far(at(k)) + 0.3, at(k).sin() * far(at(k)) + 0.4]).collect()
}

fn area(points: &[[f32; 2]]) -> f64 {
    let next = points.iter().skip(1).chain(points.first());
    let corner = |(a, b): (&[f32; 2], &[f32; 2])| {
        let [[ax, ay], [bx, by]] = [a, b].map(|p| p.map(f64::from));
        ax * by - ay * bx
    };
    points.iter().zip(next).map(corner).sum::<f64>() * 0.5
}

/// How far a point is from a polygon's sides.
fn distance(polygon: &[[f32; 2]], at: [f32; 2]) -> f32 {
    let next = polygon.iter().skip(1).chain(polygon.first());
    let to_side = |(a, b): (&[f32; 2], &[f32; 2])| {
        let (side, arm) = (minus(*b, *a), minus(at, *a));
        let square = side[0] * side[0] + side[1] * side[1];
        let t = ((arm[0] * side[0] + arm[1] * side[1]) / square.max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        length(minus(arm, side.map(|v| v * t)))
    };
    polygon.iter().zip(next).map(to_side).fold(f32::INFINITY, f32::min)
}

/// The polygon before sides are made upright or level.
fn balanced(points: &[[f32; 2]], tolerance: f32) -> Vec<[f32; 2]> {
    let mut simplifier = Simplifier::default();
    simplifier.keep(points, tolerance);
    simplifier.measure(points);
    simplifier.balance(points);
    simplifier.points
}

#[test]
fn a_straight_side_has_no_points_between_its_ends() {
    let side = |from: [f32; 2], to: [f32; 2]| {
        (0..40).map(move |k| [0, 1].map(|a| from[a] + (to[a] - from[a]) * k as f32 / 40.0))
    };
    let corners = [[0.1, 0.2], [0.8, 0.3], [0.6, 0.9], [0.2, 0.7]];
    let points: Vec<_> = (0..4).flat_map(|k| side(corners[k], corners[(k + 1) % 4])).collect();
    let mut simplifier = Simplifier::default();
    let left = simplifier.simplify(&points, 1e-4);
    assert_eq!(left.len(), 4);
    for (left, corner) in left.iter().zip(corners) {
        assert!(length(minus(*left, corner)) < 1e-5, "{left:?} for {corner:?}");
    }
}

#[test]
fn what_is_thinner_than_the_tolerance_is_left_out() {
    let mut simplifier = Simplifier::default();
    assert!(simplifier.simplify(&blob(0.0004, [0.0; 3], 20), 0.001).is_empty());
    let sliver: Vec<[f32; 2]> = (0..60).map(|k| [(30.0 - (k as f32 - 30.0).abs()) * 0.01, 0.5]).collect();
    assert!(simplifier.simplify(&sliver, 0.001).is_empty());
    assert!(simplifier.simplify(&[], 0.001).is_empty());
    assert!(!simplifier.simplify(&blob(0.01, [0.0; 3], 20), 0.001).is_empty());
}

#[test]
fn nearly_upright_sides_become_upright_and_nearly_level_ones_level() {
    let corners = [[0.1, 0.1], [0.5, 0.1004], [0.5006, 0.6], [0.1, 0.6]];
    let mut simplifier = Simplifier::default();
    let [a, b, c, d] = simplifier.simplify(&corners, 0.001) else { panic!("four corners stay") };
    assert_eq!([a[1], b[0], c[1], d[0]], [b[1], c[0], d[1], a[0]]);
    let [a, b, c, d] = simplifier.simplify(&corners, 0.0002) else { panic!("four corners stay") };
    assert_eq!([*a, *b, *c, *d], corners);
}

#[test]
fn a_large_tolerance_leaves_few_points_and_a_small_one_more() {
    let circle = blob(0.25, [0.0; 3], 400);
    let count = |tolerance| Simplifier::default().simplify(&circle, tolerance).len();
    let [coarse, fine] = [count(0.0012), count(0.00005)];
    assert!((12..40).contains(&coarse) && (2 * coarse..8 * coarse).contains(&fine), "{coarse}, {fine}");
}

/// How far points and sides may be apart, in tolerances: points that stay are moved after they were chosen, by one
/// tolerance at most, so that the area stays, and by half of one to make sides upright.
const MOVED: f32 = 2.0;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn no_point_is_far_from_the_sides_that_are_left(
        radius in 0.02f32..0.4, waves in prop::array::uniform3(-0.2f32..0.2), fine in 0.00005f32..0.0015,
    ) {
        let points = blob(radius, waves, 240);
        let mut simplifier = Simplifier::default();
        let left = simplifier.simplify(&points, fine).to_vec();
        let far = points.iter().map(|p| distance(&left, *p)).fold(0.0, f32::max);
        prop_assert!(far <= fine * MOVED, "{far} is {} times the tolerance", far / fine);
        let back = left.iter().map(|p| distance(&points, *p)).fold(0.0, f32::max);
        prop_assert!(back <= fine * MOVED, "{back} is {} times the tolerance", back / fine);
    }

    #[test]
    fn the_area_stays_what_it_was(
        radius in 0.02f32..0.4, waves in prop::array::uniform3(-0.2f32..0.2), fine in 0.00005f32..0.0015,
    ) {
        let points = blob(radius, waves, 240);
        let left = balanced(&points, fine);
        let off = (area(&left) - area(&points)).abs();
        // Neighbours move at once: what both win is counted twice, or not at all.
        let square = f64::from(fine * fine) * left.len() as f64;
        prop_assert!(off <= square + 1e-7, "{off} is {} times the squares", off / square);
        // A side that becomes upright or level moves by half the tolerance at most, on either side of the curve.
        let straight = Simplifier::default().simplify(&points, fine).to_vec();
        let off = (area(&straight) - area(&points)).abs();
        prop_assert!(off <= f64::from(fine * radius) + 1e-7);
    }
}
