use proptest::collection::vec;
use proptest::prelude::*;

use super::*;

/// A field whose coefficients, and so all that is a plane of two such, are what `value` is at their places, in cells.
fn field_of(cells: [usize; 2], value: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    let at = |k: usize| k as f32 - 0.5;
    let stride = cells[0] + 2;
    (0..stride * (cells[1] + 2)).map(|k| value(at(k % stride), at(k / stride))).collect()
}

fn traced(field: &[f32], cells: [usize; 2]) -> Lattice {
    let mut lattice = Lattice::default();
    lattice.trace(field, cells);
    lattice
}

/// The areas of all loops, in cells.
fn areas(lattice: &mut Lattice) -> Vec<f64> {
    let mut areas = Vec::new();
    lattice.loops(|chain| {
        let next = chain.iter().skip(1).chain(chain.first());
        let corner = |(a, b): (&[f32; 2], &[f32; 2])| {
            let [[ax, ay], [bx, by]] = [a, b].map(|p| p.map(|v| f64::from(v) / LATTICE as f64));
            ax * by - ay * bx
        };
        areas.push(chain.iter().zip(next).map(corner).sum::<f64>() * 0.5);
    });
    areas
}

/// Each coefficient times its B-spline, at a place in cells.
fn value(field: &[f32], cells: [usize; 2], at: [f64; 2]) -> f64 {
    let weight = |k: usize, at: f64| match (at - (k as f64 - 0.5)).abs() {
        d if d <= 0.5 => 0.75 - d * d,
        d if d <= 1.5 => 0.5 * (1.5 - d) * (1.5 - d),
        _ => 0.0,
    };
    let stride = cells[0] + 2;
    let near = |at: f64, count: usize| at as usize..(at as usize + 3).min(count);
    near(at[1], cells[1] + 2)
        .flat_map(|row| near(at[0], stride).map(move |column| (row, column)))
        .map(|(row, column)| {
            f64::from(field[row * stride + column]) * weight(column, at[0]) * weight(row, at[1])
        })
        .sum()
}

/// The area where a field is positive, in cells, by counting points.
fn counted(field: &[f32], cells: [usize; 2]) -> f64 {
    const POINTS: usize = 24;
    let at = |k: usize| (k as f64 + 0.5) / POINTS as f64;
    let inside = (0..cells[1] * POINTS)
        .flat_map(|j| (0..cells[0] * POINTS).map(move |i| [i, j]))
        .filter(|point| value(field, cells, point.map(at)) > 0.0);
    inside.count() as f64 / (POINTS * POINTS) as f64
}

fn random_field() -> impl Strategy<Value = ([usize; 2], Vec<f32>)> {
    (1usize..=12, 1usize..=12).prop_flat_map(|(columns, rows)| {
        let coefficients = vec(prop_oneof![any::<i8>(), Just(0), -2i8..3], (columns + 2) * (rows + 2));
        let em = |v: Vec<i8>| v.into_iter().map(|v| f32::from(v) / 1536.0).collect();
        (Just([columns, rows]), coefficients.prop_map(em))
    })
}

#[test]
fn a_blank_field_has_no_outline() {
    for value in [-0.06, -1e-30, 0.0] {
        let mut lattice = traced(&field_of([5, 7], |_, _| value), [5, 7]);
        assert!(areas(&mut lattice).is_empty(), "{value}");
    }
}

#[test]
fn a_field_that_is_positive_up_to_its_border_ends_there() {
    for cells in [[1, 1], [1, 6], [9, 2], [64, 64]] {
        let mut lattice = traced(&field_of(cells, |_, _| 0.06), cells);
        let whole = (cells[0] * cells[1]) as f64;
        let found = areas(&mut lattice);
        assert_eq!(found.len(), 1);
        // A fiftieth of a lattice cell all around, and half a lattice cell in each corner.
        let cut = (cells[0] + cells[1]) as f64 * 2.0 * 0.25 / 50.0 + 4.0 * 0.25 * 0.25 * 0.5;
        assert!(found[0] < whole && found[0] > whole - cut, "{found:?} for {whole}");
    }
}

#[test]
fn a_ring_has_an_outer_loop_and_an_inner_one_that_goes_the_other_way() {
    let ring = field_of([20, 16], |x, y| 2.0 - ((x - 10.0).hypot(y - 8.0) - 5.0).abs());
    let found = areas(&mut traced(&ring, [20, 16]));
    let disc = |radius: f64| std::f64::consts::PI * radius * radius;
    assert_eq!(found.len(), 2);
    // A spline of a distance is a little off where the distance bends.
    for (found, wanted) in found.iter().zip([disc(7.0), -disc(3.0)]) {
        assert!((found / wanted - 1.0).abs() < 0.03, "{found} for {wanted}");
    }
}

#[test]
fn a_straight_edge_is_found_where_it_is() {
    let mut lattice = traced(&field_of([12, 12], |x, y| 3.0 - (x * 0.6 + y * 0.8 - 6.5).abs()), [12, 12]);
    lattice.loops(|chain| {
        for [x, y] in chain.iter().map(|p| p.map(|v| v / LATTICE as f32)) {
            let within = |v: f32| (0.26..11.74).contains(&v);
            let off = ((x * 0.6 + y * 0.8 - 6.5).abs() - 3.0).abs();
            assert!(!within(x) || !within(y) || off < 1e-4, "({x}, {y}) is {off} off");
        }
    });
}

#[test]
fn opposite_corners_are_connected_if_the_mean_between_them_is_inside() {
    // Two quadrants that meet in the middle of a lattice cell.
    let middle = 3.0 + 0.5 / LATTICE as f32;
    for turned in [1.0, -1.0] {
        let loops = |more: f32| {
            let field = field_of([6, 6], |x, y| turned * (x - middle) * (y - middle) + more);
            areas(&mut traced(&field, [6, 6])).len()
        };
        assert_eq!([loops(0.01), loops(-0.01)], [1, 2], "{turned}");
    }
}

#[test]
fn memory_that_was_used_before_gives_the_same_outline() {
    let [large, small] = [[20, 16], [6, 9]].map(|cells| {
        let half = cells[0] as f32 / 2.0;
        (cells, field_of(cells, move |x, y| half * 0.7 - (x - half).hypot(y - half)))
    });
    let mut lattice = Lattice::default();
    for (cells, field) in [&large, &small, &large, &small] {
        lattice.trace(field, *cells);
        let fresh = traced(field, *cells);
        assert_eq!((&lattice.points, &lattice.next), (&fresh.points, &fresh.next));
    }
}

/// How far the area may be off for each point, in lattice cells: the field bends between lattice lines, and what is
/// counted is off by the points along the edge. What lies between lattice lines as a whole is not found.
const AREA_PER_POINT: f64 = 0.2;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn every_point_has_one_follower_and_follows_one((cells, field) in random_field()) {
        let mut lattice = traced(&field, cells);
        let mut followed = vec![0; lattice.points.len()];
        for next in &lattice.next {
            prop_assert!(*next != NONE);
            followed[*next as usize] += 1;
        }
        prop_assert!(followed.iter().all(|count| *count == 1));
        let (points, mut visited) = (lattice.points.clone(), 0);
        lattice.loops(|chain| {
            visited += chain.len();
            let next = chain.iter().skip(1).chain(chain.first());
            let steps = chain.iter().zip(next).map(|(a, b)| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()));
            assert!(steps.fold(0.0, f32::max) <= 1.0, "a side leaves its lattice cell");
        });
        prop_assert_eq!(visited, points.len());
        for [x, y] in points {
            let [right, top] = cells.map(|c| (c * LATTICE) as f32);
            prop_assert!((0.0..=right).contains(&x) && (0.0..=top).contains(&y));
        }
    }

    #[test]
    fn the_area_is_where_the_field_is_positive((cells, mut field) in random_field()) {
        // What is inside ends at the border anyway.
        let stride = cells[0] + 2;
        for (k, value) in field.iter_mut().enumerate() {
            let [x, y] = [k % stride, k / stride];
            let border = x.min(y) < 2 || x + 2 >= stride || y >= cells[1];
            // Nothing is nearly level where it crosses zero.
            *value += value.signum() * 16.0 / 1536.0;
            *value = if border { -value.abs() } else { *value };
        }
        let mut lattice = traced(&field, cells);
        let allowed = AREA_PER_POINT * lattice.points.len() as f64 / (LATTICE * LATTICE) as f64 + 0.15;
        let (found, wanted) = (areas(&mut lattice).iter().sum::<f64>(), counted(&field, cells));
        prop_assert!((found - wanted).abs() <= allowed, "{found} for {wanted} ± {allowed}");
    }
}
