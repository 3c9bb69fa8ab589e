use proptest::prelude::*;

use super::lattice::BORDER;
use super::simplify::{MIN_STRAIGHT, STEEP};
use super::*;
use crate::constants::{MAX_PPEM, MAX_TRAINED_PPEM};
use crate::model::grid::PADDING;
use crate::model::gridfit::{
    BOX_SLACK, EMBEDDING_STEPS, FIELD_STEPS, MAX_KNOTS, MIN_KNOT_GAP, PATTERN_STEPS, WARP_STEPS,
};
use crate::table::codec::{MAX_CELLS, MAX_RANK};
use crate::table::{MAJOR_VERSION, NETWORK_MINOR_VERSION};

/// A frame without knots or patterns: a grid over a box from (0, 0), and coefficients that are what `value` says at
/// their places.
struct FieldOfTest {
    grid: [GridAxis; 2],
    field: Vec<f32>,
}

impl FieldOfTest {
    fn new(size: [f32; 2], cells: [usize; 2], value: impl Fn(f32, f32) -> f32) -> Self {
        let grid = [0, 1].map(|k| GridAxis::new(0.0, size[k], cells[k]));
        let centre = |axis: usize, k: usize| grid[axis].origin + (k as f32 - 0.5) / grid[axis].cells_per_em;
        let stride = cells[0] + 2;
        let field = (0..stride * (cells[1] + 2))
            .map(|k| value(centre(0, k % stride), centre(1, k / stride)).clamp(-0.06, 0.06))
            .collect();
        Self { grid, field }
    }

    fn diamond() -> Self {
        Self::new([0.6, 0.6], [22, 22], |x, y| 0.3 - ((x - 0.3).abs() + (y - 0.3).abs()))
    }

    fn frame(&self) -> Frame<'_> {
        Frame { field: &self.field, grid: self.grid, knots: [&[], &[]], patterns: &[] }
    }
}

fn traced(frame: &Frame<'_>, tolerance: f32) -> Polygons {
    let mut polygons = [Polygons::default()];
    Tracer::default().trace(frame, &mut polygons, &[tolerance]);
    let [polygons] = polygons;
    polygons
}

fn loops(polygons: &Polygons) -> Vec<Vec<[f32; 2]>> {
    let starts = std::iter::once(0).chain(polygons.ends.iter().copied());
    let points = |(from, to): (u32, &u32)| {
        (from as usize..*to as usize).map(|k| [polygons.at[0][k], polygons.at[1][k]]).collect()
    };
    starts.zip(&polygons.ends).map(points).collect()
}

fn area(points: &[[f32; 2]]) -> f64 {
    let next = points.iter().skip(1).chain(points.first());
    let corner = |(a, b): (&[f32; 2], &[f32; 2])| {
        let [[ax, ay], [bx, by]] = [a, b].map(|p| p.map(f64::from));
        ax * by - ay * bx
    };
    points.iter().zip(next).map(corner).sum::<f64>() * 0.5
}

#[test]
fn lists_are_padded_alike_and_polygons_end_within_them() {
    let polygons = traced(&FieldOfTest::diamond().frame(), 0.001);
    let count = *polygons.ends.last().unwrap() as usize;
    let padded = count.next_multiple_of(LANES);
    assert!(count >= 4);
    assert_eq!(polygons.at.each_ref().map(Vec::len), [padded; 2]);
    assert_eq!(polygons.knots.each_ref().map(Vec::len), [padded; 2]);
    assert!(polygons.patterns.is_empty());
}

#[test]
fn a_ring_is_an_outer_polygon_and_a_hole() {
    let ring = FieldOfTest::new([0.6, 0.6], [22, 22], |x, y| 0.08 - ((x - 0.3).hypot(y - 0.3) - 0.2).abs());
    for (_, tolerance) in LEVELS_OF_DETAIL {
        let areas: Vec<f64> = loops(&traced(&ring.frame(), tolerance)).iter().map(|l| area(l)).collect();
        let disc = |radius: f64| std::f64::consts::PI * radius * radius;
        assert_eq!(areas.len(), 2);
        for (found, wanted) in areas.iter().zip([disc(0.28), -disc(0.12)]) {
            assert!((found / wanted - 1.0).abs() < 0.02, "{found} for {wanted}");
        }
    }
}

#[test]
fn all_levels_of_tolerance_are_traced_as_each_would_be_alone() {
    let disc = FieldOfTest::new([0.6, 0.6], [22, 22], |x, y| 0.28 - (x - 0.3).hypot(y - 0.3));
    let tolerances = LEVELS_OF_DETAIL.map(|(_, tolerance)| tolerance);
    let mut levels: [Polygons; LEVELS_OF_DETAIL.len()] = Default::default();
    let mut tracer = Tracer::default();
    for _ in 0..2 {
        tracer.trace(&disc.frame(), &mut levels, &tolerances);
        for (level, tolerance) in levels.iter().zip(tolerances) {
            assert_eq!(loops(level), loops(&traced(&disc.frame(), tolerance)));
        }
        assert!(levels.is_sorted_by_key(|level| level.ends[0]), "finer ones have more vertices");
    }
}

#[test]
fn slanted_sides_are_cut_at_knots_and_the_polygon_stays_the_same() {
    let shape = FieldOfTest::diamond();
    let plain = traced(&shape.frame(), 0.0012);
    let knots: [&[f32]; 2] = [&[0.0, 0.12, 0.41, 0.6], &[0.0, 0.22, 0.47, 0.6]];
    let cut = traced(&Frame { knots, ..shape.frame() }, 0.0012);
    assert!((area(&loops(&cut)[0]) - area(&loops(&plain)[0])).abs() < 1e-6);
    for (axis, knot) in [(0, 0.12), (0, 0.41), (1, 0.22), (1, 0.47)] {
        let at = cut.at[axis].iter().filter(|v| (**v - knot).abs() < 1e-5).count();
        assert_eq!(at, 2, "two sides of a diamond pass by {knot} along axis {axis}");
    }
}

#[test]
fn upright_and_level_sides_are_not_cut_at_knots() {
    let square = FieldOfTest::new([0.6, 0.6], [22, 22], |x, y| x.min(0.6 - x).min(y).min(0.6 - y));
    let knots: [&[f32]; 2] = [&[0.0, 0.12, 0.41, 0.6], &[0.0, 0.22, 0.47, 0.6]];
    let [plain, cut] =
        [square.frame(), Frame { knots, ..square.frame() }].map(|frame| traced(&frame, 0.0012));
    assert_eq!(loops(&plain), loops(&cut));
}

#[test]
fn wide_sides_are_cut_at_columns_of_nodes() {
    let bar = FieldOfTest::new([0.7, 0.1], [24, 6], |x, y| x.min(0.7 - x).min(y).min(0.1 - y));
    let patterns = [1.0; NODES];
    let cut = traced(&Frame { patterns: &patterns, ..bar.frame() }, 0.0012);
    for node in (1..DEFORM_NODES - 1).map(|node| bar.grid[0].node(node)) {
        let at = cut.at[0].iter().filter(|x| (**x - node).abs() < 1e-5).count();
        assert_eq!(at, 2, "the upper and the lower side of a bar pass by {node}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(100) })]

    #[test]
    fn vertices_know_their_knots_and_the_patterns_there(
        mut knots in prop::collection::vec(-0.05f32..0.7, 0..MAX_KNOTS),
        patterns in prop::collection::vec(-2.0f32..2.0, 2 * NODES),
    ) {
        knots.sort_by(f32::total_cmp);
        let shape = FieldOfTest::diamond();
        let frame = Frame { knots: [&knots, &knots[knots.len() / 2..]], patterns: &patterns, ..shape.frame() };
        let polygons = traced(&frame, 0.0012);
        let padded = polygons.at[0].len();
        for k in 0..padded {
            let at = polygons.at.each_ref().map(|at| at[k]);
            for (axis, at) in at.iter().enumerate() {
                let below = frame.knots[axis].iter().filter(|knot| *knot <= at).count();
                prop_assert_eq!(usize::from(polygons.knots[axis][k]), below);
            }
            for (r, pattern) in patterns.chunks(NODES).enumerate() {
                let found = polygons.patterns[r * padded + k];
                let wanted = bilinear(pattern, shape.grid, at);
                prop_assert!((f64::from(found) - wanted).abs() < 1e-4, "{found} for {wanted}");
            }
        }
    }
}

/// Each node times a pyramid around it.
fn bilinear(pattern: &[f32], grid: [GridAxis; 2], at: [f32; 2]) -> f64 {
    let hat = |axis: usize, node: usize| {
        let step = f64::from(grid[axis].node(1)) - f64::from(grid[axis].node(0));
        (1.0 - (f64::from(at[axis]) - f64::from(grid[axis].node(node))).abs() / step).max(0.0)
    };
    let share = |k: usize| hat(0, k % DEFORM_NODES) * hat(1, k / DEFORM_NODES);
    pattern.iter().enumerate().map(|(k, value)| f64::from(*value) * share(k)).sum()
}

#[test]
fn the_specification_names_the_constants_that_are_in_use() {
    let page = include_str!("../../../spec/nfrt.md");
    let (gap, slack) = (1.0 / MIN_KNOT_GAP, 1.0 / BOX_SLACK);
    for words in [
        format!("are in 1/{WARP_STEPS} pixel"),
        format!("G[row][column] = stored / {FIELD_STEPS} "),
        format!("φ_r[row][column] = stored / {PATTERN_STEPS}\n"),
        format!("e[s][r] = stored / {EMBEDDING_STEPS} "),
        format!("a number above 0 and at most {MAX_PPEM}:"),
        format!("h_(k−1) + 1/{gap})"),
        format!("floor(l + o + 1/{slack}) to max(ceil(h + o − 1/{slack}), floor(l + o + 1/{slack}) + 1)"),
        format!("origin = low − {PADDING}, cellsPerEm = c / ((high − low) + 2 · {PADDING})"),
        format!("· {0}, 0, {0}),", DEFORM_NODES - 1),
        format!("a lattice of {LATTICE} steps a cell"),
        format!("F is at most −1/{}.", -1.0 / BORDER),
        format!(
            "{} em below {} ppem, {} em below {},",
            LEVELS_OF_DETAIL[0].1, LEVELS_OF_DETAIL[0].0, LEVELS_OF_DETAIL[1].1, LEVELS_OF_DETAIL[1].0
        ),
        format!(
            "{} em below {}, and {FINEST} em from there on",
            LEVELS_OF_DETAIL[2].1, LEVELS_OF_DETAIL[2].0
        ),
        format!("if |c| > {MIN_STRAIGHT} · z,"),
        format!("|b_y − a_y| > |b_x − a_x| · {STEEP},"),
        format!("W · H > (W + H) · (T · {SLANT})"),
        format!("if W > {MIN_WIDTH}."),
        format!("above 1/{0} and below 1 − 1/{0} count", 1.0 / MIN_SPLIT),
        format!("more than {MAX_CELLS} cells, {MAX_KNOTS} knots or rank {MAX_RANK};"),
        format!("| lastPpem | The largest, `firstPpem` to {MAX_TRAINED_PPEM}. |"),
        format!("version {MAJOR_VERSION}.{NETWORK_MINOR_VERSION}\n"),
    ] {
        assert!(page.contains(&words), "spec/nfrt.md does not say {words:?}");
    }
}
