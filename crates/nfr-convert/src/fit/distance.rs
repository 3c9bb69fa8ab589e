//! Exact signed distance to an outline, for the initial field.

/// Distance from `point` to the nearest of the straight `segments`, positive inside (nonzero winding).
/// Everything in em.
pub(super) fn signed_distance(segments: &[[[f32; 2]; 2]], point: [f32; 2]) -> f32 {
    let [x, y] = point;
    let mut nearest = f32::INFINITY;
    let mut winding = 0;
    for &[[ax, ay], [bx, by]] in segments {
        let (dx, dy) = (bx - ax, by - ay);
        let t = (((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        let (ex, ey) = (ax + t * dx - x, ay + t * dy - y);
        nearest = nearest.min(ex * ex + ey * ey);
        let side = dx * (y - ay) - dy * (x - ax);
        if ay <= y && by > y && side > 0.0 {
            winding += 1;
        } else if by <= y && ay > y && side < 0.0 {
            winding -= 1;
        }
    }
    if winding != 0 { nearest.sqrt() } else { -nearest.sqrt() }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::signed_distance;

    /// Points that the twin looks at on each segment.
    const POINTS: usize = 2000;
    /// The largest distance between them in em: that of the longest possible segment, and as much again.
    const SPACING: f32 = 3.0 / POINTS as f32;

    /// The nearest of many points on the polygon, and the turns that it makes around the point.
    fn twin(polygon: &[[f32; 2]], [x, y]: [f32; 2]) -> (f32, f64) {
        let (mut nearest, mut turn) = (f32::INFINITY, 0.0);
        for (k, [ax, ay]) in polygon.iter().enumerate() {
            let [bx, by] = polygon[(k + 1) % polygon.len()];
            for step in 0..=POINTS {
                let t = step as f32 / POINTS as f32;
                nearest = nearest.min((ax + t * (bx - ax) - x).hypot(ay + t * (by - ay) - y));
            }
            let angle = |px: f32, py: f32| f64::from(py - y).atan2(f64::from(px - x));
            let mut change = angle(bx, by) - angle(*ax, *ay);
            change -= (change / std::f64::consts::TAU).round() * std::f64::consts::TAU;
            turn += change;
        }
        (nearest, turn / std::f64::consts::TAU)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

        #[test]
        fn it_is_the_distance_to_the_nearest_point_positive_inside(
            polygon in vec([-1.0f32..1.0, -1.0f32..1.0], 3..9), point in [-1.2f32..1.2, -1.2f32..1.2],
        ) {
            let segments: Vec<_> = (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]]).collect();
            let (distance, turns) = twin(&polygon, point);
            prop_assume!(distance > SPACING);
            let found = signed_distance(&segments, point);
            prop_assert!((found.abs() - distance).abs() <= SPACING, "{found} for {distance}");
            prop_assert_eq!(found > 0.0, turns.round() != 0.0, "{} with {} turns", found, turns);
        }
    }

    #[test]
    fn a_hole_is_outside() {
        let square = |r: f32| [[-r, -r], [r, -r], [r, r], [-r, r]];
        let around = |c: [[f32; 2]; 4]| [0, 1, 2, 3].map(|k| [c[k], c[(k + 1) % 4]]);
        let mut hole = square(0.5);
        hole.reverse();
        let segments = [around(square(1.0)), around(hole)].concat();
        assert_eq!(signed_distance(&segments, [0.0, 0.0]), -0.5);
        assert_eq!(signed_distance(&segments, [0.75, 0.0]), 0.25);
        assert_eq!(signed_distance(&segments, [2.0, 0.0]), -1.0);
    }
}
