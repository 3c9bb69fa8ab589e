use std::iter::once;

use proptest::collection::vec;
use proptest::prelude::*;
use zeno::{Command, Mask, Origin, PathBuilder};

use super::*;
use crate::render::area::Area;

/// A point in 1/64 pixel, and whether it is on the curve.
type Stop = (Point, bool);

/// Contours as polygons. Only places count: coordinates in font units stay empty.
fn flattened(contours: &[Vec<Stop>], offset: Point) -> Polygons {
    let mut outline = OutlinePoints::default();
    let mut places = [Vec::new(), Vec::new()];
    for contour in contours {
        for ([x, y], on_curve) in contour {
            places[0].push(4 * x);
            places[1].push(4 * y);
            outline.on_curve.push(*on_curve);
        }
        outline.ends.push(outline.on_curve.len() as u16);
    }
    let mut polygons = Polygons { precision: Precision::TRUE_TYPE, ..Polygons::default() };
    polygons.add(&outline, &places, offset, [1; 2], Precision::TRUE_TYPE);
    polygons
}

/// The vertices of one contour's polygon.
fn polygon(contour: &[Stop]) -> Vec<Point> {
    let Polygons { vertices: [x, y], ends, .. } = flattened(&[contour.to_vec()], [0; 2]);
    assert_eq!(ends, [x.len()]);
    x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
}

/// A closed polygon, wherever it begins: its lowest vertices first.
fn from_anywhere(polygon: &[Point]) -> Vec<Point> {
    let turned = |k: usize| [&polygon[k..], &polygon[..k]].concat();
    (0..polygon.len()).map(turned).min().unwrap_or_default()
}

fn on(x: i32, y: i32) -> Stop {
    ([x, y], true)
}

fn off(x: i32, y: i32) -> Stop {
    ([x, y], false)
}

/// A contour with its implied points, from a point on the curve.
fn explicit(contour: &[Stop]) -> Vec<Stop> {
    let next = contour.iter().skip(1).chain(contour.first());
    let mut all: Vec<Stop> = Vec::new();
    for (here, next) in contour.iter().zip(next) {
        all.push(*here);
        if !here.1 && !next.1 {
            // Halves are dropped, of negative numbers too.
            all.push((
                [0, 1].map(|k| ((f64::from(here.0[k]) + f64::from(next.0[k])) / 2.0).trunc() as i32),
                true,
            ));
        }
    }
    let first = all.iter().position(|stop| stop.1).unwrap_or_default();
    all.rotate_left(first);
    all
}

/// The exact coordinate of a curve.
fn curve_at([a, b, c]: [i32; 3], t: f64) -> f64 {
    let [a, b, c] = [a, b, c].map(f64::from);
    (1.0 - t) * (1.0 - t) * a + 2.0 * t * (1.0 - t) * b + t * t * c
}

/// The vertices of one curve, which is given in units, without its first point.
fn curve(points: [Point; 3]) -> Vec<Point> {
    let mut polygons = Polygons { precision: Precision::TRUE_TYPE, ..Polygons::default() };
    polygons.curve(points[0], points[1], points[2]);
    let [x, y] = polygons.vertices;
    x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
}

fn contour(
    length: core::ops::Range<i32>,
    points: core::ops::Range<usize>,
) -> impl Strategy<Value = Vec<Stop>> {
    vec(([length.clone(), length], any::<bool>()), points)
}

#[test]
fn a_contour_without_curves_is_its_points_in_units() {
    let contour = [on(1, -2), on(64, 0), on(64, 65)];
    assert_eq!(polygon(&contour), [[256, 0], [256, 260], [4, -8]]);
    let Polygons { vertices, ends, .. } =
        flattened(&[contour.to_vec(), Vec::new(), contour.to_vec()], [10, -100]);
    assert_eq!(vertices[0], [296, 296, 44, 296, 296, 44]);
    assert_eq!(vertices[1], [-400, -140, -408, -400, -140, -408]);
    assert_eq!(ends[0], 3);
    assert_eq!(ends.last(), Some(&6));
}

#[test]
fn a_contour_of_control_points_begins_between_its_last_and_its_first_one() {
    let diamond = [off(0, 0), off(64, 0), off(64, 64), off(0, 64)];
    let vertices = polygon(&diamond);
    assert_eq!(vertices.last(), Some(&[0, 128]));
    for middle in [[128, 0], [256, 128], [128, 256]] {
        assert!(vertices.contains(&middle), "no {middle:?}");
    }
    assert!(vertices.iter().all(|v| v.iter().all(|v| (0..=256).contains(v))));
    let corner = [[0, 0], [256, 0], [0, 256], [256, 256]];
    assert!(corner.iter().all(|corner| !vertices.contains(corner)), "control points are not on the curve");
}

#[test]
fn a_contour_may_begin_with_a_control_point_and_end_on_the_curve() {
    let contour = [off(0, 100), off(90, 77), on(64, 0), off(31, -40), on(-5, 3)];
    let vertices = polygon(&contour);
    // It begins and ends at the first of its points that is on the curve, and passes the others.
    assert_eq!(vertices.last(), Some(&[256, 0]));
    assert!(vertices.contains(&[-20, 12]) && vertices.contains(&[180, 352]));
    for first in 1..contour.len() {
        let turned = [&contour[first..], &contour[..first]].concat();
        assert_eq!(from_anywhere(&polygon(&turned)), from_anywhere(&vertices), "from point {first} on");
    }
}

#[test]
fn implied_points_are_rounded_towards_0() {
    let between = |a: Stop, b: Stop| polygon(&[on(500, 500), a, b]).into_iter().collect::<Vec<_>>();
    assert!(between(off(1, 10), off(2, 21)).contains(&[4, 60]), "1.5 and 15.5");
    assert!(between(off(-1, -10), off(-2, -21)).contains(&[-4, -60]), "-1.5 and -15.5");
    assert!(between(off(-1, 3), off(0, -4)).contains(&[0, 0]), "-0.5 and -0.5");
}

#[test]
fn a_curve_that_is_nearly_straight_is_one_side() {
    // The second difference along x: 64 units are a quarter pixel.
    assert_eq!(curve([[0, 0], [128, 0], [320, 0]]), [[320, 0]]);
    assert_eq!(curve([[0, 0], [128, 0], [321, 0]]).len(), 2);
    assert_eq!(curve([[0, 0], [0, 128], [0, 64 + 256 + 3]]).len(), 2);
}

#[test]
fn an_outline_without_points_has_no_polygons() {
    assert!(flattened(&[], [0; 2]).ends.is_empty());
    assert!(flattened(&[Vec::new()], [0; 2]).vertices[0].is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn points_that_are_implied_need_not_be_written(contour in contour(-2000..2000, 3..12)) {
        let (short, long) = (polygon(&contour), polygon(&explicit(&contour)));
        prop_assert_eq!(from_anywhere(&short), from_anywhere(&long));
    }

    #[test]
    fn vertices_of_a_curve_are_on_it_within_what_its_splits_round(
        points in prop::array::uniform3([-9000i32..9000, -9000i32..9000]),
    ) {
        let vertices = curve(points);
        let count = vertices.len();
        prop_assert!(count.is_power_of_two());
        // Each split rounds down by up to 3/4 of a unit.
        let allowed = 0.75 * f64::from(count.ilog2());
        for axis in 0..2 {
            let exact = |k: f64| curve_at(points.map(|point| point[axis]), k / count as f64);
            for (k, vertex) in vertices.iter().enumerate() {
                let below = exact((k + 1) as f64) - f64::from(vertex[axis]);
                prop_assert!((0.0..=allowed).contains(&below), "vertex {} of {}: {}", k, count, below);
            }
            // The curve between two vertices is a quarter of the second difference away from their middle.
            let ends = once(&points[0]).chain(&vertices).zip(&vertices);
            for (k, (a, b)) in ends.enumerate() {
                let middle = f64::from(a[axis] + b[axis]) / 2.0;
                let away = (exact(k as f64 + 0.5) - middle).abs();
                prop_assert!(away <= f64::from(Precision::TRUE_TYPE.flat + 1) / 4.0 + allowed, "after vertex {}: {}", k, away);
            }
        }
        prop_assert_eq!(vertices.last(), Some(&points[2]));
    }

    #[test]
    fn an_outline_is_filled_as_zeno_fills_it(
        (width, height) in (1usize..20, 1usize..20),
        contours in vec(contour(0..64 * 20, 3..9), 1..4),
    ) {
        let [right, top] = [width, height].map(|pixels| pixels as i32 * 64);
        let inside = |(point, on): &Stop| ([point[0] % (right + 1), point[1] % (top + 1)], *on);
        let contours: Vec<Vec<Stop>> = contours.iter().map(|contour| contour.iter().map(inside).collect()).collect();

        let Polygons { vertices: [x, y], ends, .. } = flattened(&contours, [0; 2]);
        let y: Vec<i32> = y.iter().map(|y| top * UNIT / 64 - y).collect();
        let (mut area, mut pixels, mut start) = (Area::default(), vec![77; width * height], 0);
        area.start(width, height);
        for end in ends {
            area.polygon::<false>(&x[start..end], &y[start..end]);
            start = end;
        }
        area.finish(width, &mut pixels);

        let mut path: Vec<Command> = Vec::new();
        for contour in &contours {
            let stops = explicit(contour);
            let place = |stop: &Stop| stop.0.map(|v| v as f32 / 64.0);
            path.move_to(place(&stops[0]));
            let mut control = None;
            for stop in stops.iter().skip(1).chain(&stops[..1]) {
                match control.take() {
                    None if stop.1 => _ = path.line_to(place(stop)),
                    None => control = Some(place(stop)),
                    Some(control) => _ = path.quad_to(control, place(stop)),
                }
            }
            path.close();
        }
        let mut mask = Mask::new(path.as_slice());
        mask.origin(Origin::BottomLeft).size(width as u32, height as u32);
        prop_assert_eq!(pixels, mask.render().0);
    }
}

#[test]
fn contours_of_one_or_two_points_draw_nothing() {
    for count in 1..4u16 {
        let points = OutlinePoints {
            coordinates: [vec![0, 100, 50], vec![0, 0, 100]].map(|v| v[..usize::from(count)].to_vec()),
            on_curve: vec![true; count.into()],
            ends: vec![count],
            is_unfit: false,
        };
        let places = points.coordinates.each_ref().map(|v| v.iter().map(|v| 4 * i32::from(*v)).collect());
        let mut polygons = Polygons { precision: Precision::TRUE_TYPE, ..Polygons::default() };
        polygons.add(&points, &places, [0, 0], [1; 2], Precision::TRUE_TYPE);
        assert_eq!(polygons.ends.is_empty(), count < 3, "{count} points");
    }
}
