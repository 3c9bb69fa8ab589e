use super::*;

/// Two contours and a point alone, as x = y: each number is the coordinate of a point, `true` for one on the curve.
fn outline() -> OutlinePoints {
    let points = [
        (0, true),
        (300, true),
        (300, false),
        (100, true),
        (200, true),
        (500, false),
        (0, true),
        (700, true),
    ];
    OutlinePoints {
        coordinates: [0, 1].map(|_| points.iter().map(|(at, _)| *at).collect()),
        on_curve: points.iter().map(|(_, on_curve)| *on_curve).collect(),
        ends: vec![4, 7, 8],
        is_unfit: false,
    }
}

#[test]
fn levels_know_how_their_points_lie_on_their_contours() {
    let points = outline();
    let (keys, bits) = (sorted_keys(&points.coordinates[1]), point_bits(&points, 1));
    let found: Vec<_> = levels(&keys, &bits)
        .map(|level| {
            let points: Vec<usize> = level.keys.iter().map(point_of).collect();
            (level.units, points, level.extreme, level.on_curve, level.is_flat)
        })
        .collect();
    let expected = [
        // The lowest points of two contours, which do not follow each other.
        (0, vec![0, 6], 2, 2, false),
        (100, vec![3], 0, 1, false),
        (200, vec![4], 0, 1, false),
        // The highest ones of the first contour follow each other.
        (300, vec![1, 2], 1, 1, true),
        (500, vec![5], 1, 0, false),
        // A point alone is not followed by another.
        (700, vec![7], 2, 1, false),
    ];
    assert_eq!(found, expected);
}

#[test]
fn the_last_point_of_a_contour_is_followed_by_the_first() {
    let mut points = outline();
    points.ends = vec![8];
    points.coordinates[1][7] = 0;
    let (keys, bits) = (sorted_keys(&points.coordinates[1]), point_bits(&points, 1));
    let flat: Vec<i16> =
        levels(&keys, &bits).filter(|level| level.is_flat).map(|level| level.units).collect();
    assert_eq!(flat, [0, 300]);
}

#[test]
fn points_in_no_contour_and_contours_without_points_are_read_without_harm() {
    let mut points = outline();
    points.ends = vec![2, 99];
    assert_eq!(point_bits(&points, 0)[..3], [ON_CURVE | EXTREME, ON_CURVE | EXTREME, 0]);
    points.ends.clear();
    let bits: Vec<bool> = point_bits(&points, 0).iter().map(|bits| *bits == ON_CURVE).collect();
    assert_eq!(bits, points.on_curve);
}
