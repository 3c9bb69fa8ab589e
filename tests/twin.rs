//! The model as spec/nfrt.md words it, once more: in double precision, each sample on its own, with no matrix
//! contracted and nothing kept between samples. What the library draws is this, to a level of 255.
#![cfg(feature = "convert")]
#![allow(clippy::unwrap_used)]

mod samples;

use nfr::convert::start::{Capacity, Draft};
use nfr::convert::teach::lesson;
use nfr::convert::teacher::Teacher;
use nfr::model::gridfit::{
    AxisWarp, BOX_SLACK, DEFORM_NODES, EMBEDDING_STEPS, FIELD_STEPS, GridFit, MAX_PPEM, MIN_GRADIENT,
    MIN_KNOT_GAP, MIN_SKEW, PADDING, PATTERN_STEPS, SLOPE_REACH, Scale, Scratch, WARP_STEPS, Weights,
    half_plane, samples_per_pixel,
};
use nfr::table::codec::{MAX_CELLS, MAX_KNOTS, MAX_RANK};
use nfr::table::{MAJOR_VERSION, MAX_TRAINED_PPEM, MINOR_VERSION};
use nfr::{Placement, Target};
use proptest::prelude::*;
use read_fonts::FontRef;

use samples::{ascii, font, gid};

/// A model at a size.
struct Twin<'a> {
    weights: &'a Weights,
    scale: Scale,
    ppem: f64,
}

impl Twin<'_> {
    fn em(&self, units: i16) -> f64 {
        f64::from(units) / f64::from(self.scale.units_per_em)
    }

    /// The number of the trained size that this one is fitted as: it is less than half a pixel per em off, or half of
    /// one above it.
    fn fitted(&self) -> Option<usize> {
        let off = |size: &usize| self.ppem - self.scale.ppem_of(*size) as f64;
        (0..self.scale.sizes()).find(|size| (-0.5..0.5).contains(&off(size)))
    }

    /// The size that displacements belong to.
    fn grid_size(&self) -> f64 {
        self.fitted().map_or(self.ppem, |size| self.scale.ppem_of(size) as f64)
    }

    /// What a displacement known for each trained size is at this one.
    fn at_size(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.fitted().map_or(0.0, value)
    }

    fn warp(&self, axis: usize) -> &AxisWarp {
        [&self.weights.warp_x, &self.weights.warp_y][axis]
    }

    /// Plain (em) and hinted (pixels) knot positions.
    fn knots(&self, axis: usize) -> Vec<(f64, f64)> {
        let warp = self.warp(axis);
        let mut knots: Vec<(f64, f64)> = Vec::new();
        for (k, &units) in warp.knots.iter().enumerate() {
            let plain = self.em(units);
            let moved = self.at_size(|size| {
                let hinted = f64::from(warp.hinted[size * warp.knots.len() + k]) / f64::from(WARP_STEPS);
                hinted - plain * self.scale.ppem_of(size) as f64
            });
            let hinted = plain * self.grid_size() + moved;
            let least = knots.last().map_or(f64::NEG_INFINITY, |(_, below)| below + f64::from(MIN_KNOT_GAP));
            knots.push((plain, hinted.max(least)));
        }
        knots
    }

    /// The ends of the box along an axis before rounding.
    fn extent(&self, axis: usize) -> [f64; 2] {
        let knots = self.knots(axis);
        let bound = |k: usize| self.em(self.weights.bounds[k]) * self.ppem;
        let low = knots.first().map_or(bound(axis), |k| k.1);
        let high = if knots.len() > 1 { knots[knots.len() - 1].1 } else { bound(axis + 2) };
        [low + f64::from(BOX_SLACK), high - f64::from(BOX_SLACK)]
    }

    fn unwarp(&self, knots: &[(f64, f64)], at: f64) -> f64 {
        let (Some(first), Some(last)) = (knots.first(), knots.last()) else { return at / self.ppem };
        for pair in knots.windows(2) {
            let ((p, h), (next_p, next_h)) = (pair[0], pair[1]);
            if h <= at && at <= next_h {
                return p + (at - h) / (next_h - h) * (next_p - p);
            }
        }
        let end = if at < first.1 { first } else { last };
        end.0 + (at - end.1) / self.ppem
    }

    /// Where the grid begins and how long it is, in em.
    fn grid(&self, axis: usize) -> [f64; 2] {
        let [low, high] = [axis, axis + 2].map(|k| self.em(self.weights.bounds[k]));
        [low - f64::from(PADDING), high - low + 2.0 * f64::from(PADDING)]
    }

    /// How far the deformation moves a point up, in em.
    fn deformation(&self, x: f64, y: f64) -> f64 {
        let rank = usize::from(self.weights.rank);
        let node = |axis: usize, q: f64| {
            let [origin, span] = self.grid(axis);
            ((q - origin) / span * (DEFORM_NODES - 1) as f64).clamp(0.0, (DEFORM_NODES - 1) as f64)
        };
        let (u, v) = (node(0, x), node(1, y));
        let hat = |at: f64, node: usize| (1.0 - (at - node as f64).abs()).max(0.0);
        let mut sum = 0.0;
        for r in 0..rank {
            let strength = self.at_size(|size| {
                f64::from(self.weights.embedding[size * rank + r]) / f64::from(EMBEDDING_STEPS)
            });
            for (row, column) in
                (0..DEFORM_NODES * DEFORM_NODES).map(|k| (k / DEFORM_NODES, k % DEFORM_NODES))
            {
                let pattern =
                    f64::from(self.weights.patterns[(r * DEFORM_NODES + row) * DEFORM_NODES + column])
                        / f64::from(PATTERN_STEPS);
                sum += strength * pattern * hat(u, column) * hat(v, row);
            }
        }
        sum / self.grid_size()
    }

    /// The field at a point and its gradient: all coefficients, each times its B-spline.
    fn field(&self, x: f64, y: f64) -> [f64; 3] {
        let cells = self.weights.cells.map(usize::from);
        let per_em = [0, 1].map(|axis| cells[axis] as f64 / self.grid(axis)[1]);
        let at =
            |axis: usize, q: f64| ((q - self.grid(axis)[0]) * per_em[axis]).clamp(0.0, cells[axis] as f64);
        let (u, v) = (at(0, x), at(1, y));
        let mut result = [0.0; 3];
        for (k, value) in self.weights.field.iter().enumerate() {
            let (column, row) = (k % (cells[0] + 2), k / (cells[0] + 2));
            let (dx, dy) = (u - (column as f64 - 0.5), v - (row as f64 - 0.5));
            let value = f64::from(*value) / f64::from(FIELD_STEPS);
            result[0] += value * spline(dx) * spline(dy);
            result[1] += value * slope(dx) * per_em[0] * spline(dy);
            result[2] += value * spline(dx) * slope(dy) * per_em[1];
        }
        result
    }

    fn draw(&self, place: Placement) -> Vec<f64> {
        let n = samples_per_pixel(self.ppem as f32) as i32;
        let knots = [self.knots(0), self.knots(1)];
        let reach = f64::from(SLOPE_REACH) / f64::from(n);
        let plain = |axis: usize, at: f64| {
            let [low, high] = [at - reach, at + reach].map(|at| self.unwarp(&knots[axis], at));
            ((low + high) / 2.0, (high - low) / (2.0 * reach) * self.ppem)
        };
        let mut pixels = Vec::new();
        for (j, i) in (0..place.height).flat_map(|j| (0..place.width).map(move |i| (j, i))) {
            let mut sum = 0.0;
            for (b, a) in (0..n).flat_map(|b| (0..n).map(move |a| (b, a))) {
                let part = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
                let (x, slope_x) = plain(0, f64::from(place.left) + f64::from(i) + part(a));
                let (y, slope_y) = plain(1, f64::from(place.top) - f64::from(j) - part(b));
                let [value, gx, gy] = self.field(x, y + self.deformation(x, y));
                sum += area(value * self.ppem * f64::from(n), gx * slope_x, gy * slope_y);
            }
            pixels.push(sum / f64::from(n * n) * 255.0);
        }
        pixels
    }
}

/// The centred quadratic B-spline.
fn spline(d: f64) -> f64 {
    match d.abs() {
        d if d <= 0.5 => 0.75 - d * d,
        d if d <= 1.5 => 0.5 * (1.5 - d) * (1.5 - d),
        _ => 0.0,
    }
}

fn slope(d: f64) -> f64 {
    match d.abs() {
        a if a <= 0.5 => -2.0 * d,
        a if a <= 1.5 => -d.signum() * (1.5 - a),
        _ => 0.0,
    }
}

/// Area of the unit square around the origin where `value + gx·x + gy·y > 0`: the half-plane that begins at each
/// corner, added and taken away in turn.
fn area(value: f64, gx: f64, gy: f64) -> f64 {
    let a = gx.abs().max(gy.abs()).max(f64::from(MIN_GRADIENT));
    let b = gx.abs().min(gy.abs()).max(f64::from(MIN_SKEW) * a);
    let corner = |at: f64| at.max(0.0).powi(2);
    let (sum, difference) = ((a + b) / 2.0, (a - b) / 2.0);
    (corner(value + sum) - corner(value + difference) - corner(value - difference) + corner(value - sum))
        / (2.0 * a * b)
}

/// Reproducible noise, so that the deformation moves points by up to about half a pixel.
fn shaken(mut weights: Weights) -> Weights {
    let mut state = 1u32;
    let mut noise = |amplitude: i32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((state >> 8) as i32 % (2 * amplitude + 1) - amplitude) as i8
    };
    weights.patterns.iter_mut().for_each(|v| *v = noise(16));
    weights.embedding.iter_mut().for_each(|v| *v = noise(8));
    weights
}

/// Single precision and rounding to whole levels.
const LEVELS: f64 = 0.52;
/// Where an end of the box is this close to a whole pixel (as a share of its distance from the origin), single
/// precision decides.
const TIE: f64 = 1e-5;

fn compare(weights: &Weights, scale: Scale, ppem: f32, what: &str) {
    let model = GridFit::new(weights, scale).unwrap();
    let place = model.placement(ppem).unwrap();
    let mut pixels = vec![0; place.area()];
    model.draw(ppem, place, &mut Scratch::default(), &mut pixels);

    let twin = Twin { weights, scale, ppem: ppem.into() };
    let [[left, right], [bottom, top]] = [twin.extent(0), twin.extent(1)];
    let (right, top) = (right.ceil().max(left.floor() + 1.0), top.ceil().max(bottom.floor() + 1.0));
    let ours = [place.left, place.top - place.height as i32].map(f64::from);
    let far = [place.left + place.width as i32, place.top].map(f64::from);
    for (end, found) in [(left, ours[0]), (bottom, ours[1])] {
        let tie = (end - end.round()).abs() <= TIE * end.abs().max(1.0);
        assert!(found == end.floor() || tie && (found - end).abs() < 1.5, "{what}: {found} for {end}");
    }
    for (end, found) in [(right, far[0]), (top, far[1])] {
        assert!((found - end).abs() <= 1.0, "{what}: {found} for {end}");
    }
    for (k, (ours, twin)) in pixels.iter().zip(twin.draw(place)).enumerate() {
        let difference = (f64::from(*ours) - twin).abs();
        assert!(difference <= LEVELS, "{what} at {ppem} ppem, pixel {k}: {ours} for {twin}");
    }
}

fn compare_font(name: &str, target: Target, sizes: &[f32]) {
    let data = font(name);
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), target).unwrap();
    let scale = Scale { units_per_em: teacher.units_per_em(), first_ppem: 8, last_ppem: 40 };
    let hinted: Vec<_> = (scale.first_ppem..=scale.last_ppem).map(|s| teacher.at(s).unwrap()).collect();
    for character in ascii().chars() {
        let lesson = lesson(&teacher, &hinted, gid(&data, character)).unwrap();
        let draft = Draft::from_lesson(&lesson, scale, target, Capacity::default(), 1);
        let weights = shaken(draft.quantise());
        for ppem in sizes {
            compare(&weights, scale, *ppem, &format!("{name}, {target}, {character:?}"));
        }
    }
}

#[test]
fn the_specification_names_the_constants_that_are_in_use() {
    let page = include_str!("../spec/nfrt.md");
    let [a, b, c, d, e] = [10.9, 15.9, 23.9, 95.9, 96.0].map(samples_per_pixel);
    let (gap, slack) = (1.0 / MIN_KNOT_GAP, 1.0 / BOX_SLACK);
    for words in [
        format!("are in 1/{WARP_STEPS} pixel"),
        format!("G[row][column] = stored / {FIELD_STEPS} "),
        format!("φ_r[row][column] = stored / {PATTERN_STEPS}\n"),
        format!("e[s][r] = stored / {EMBEDDING_STEPS} "),
        format!("a number above 0 and at most {MAX_PPEM}:"),
        format!("h_(k−1) + 1/{gap})"),
        format!("floor(l + 1/{slack}) to max(ceil(h − 1/{slack}), floor(l + 1/{slack}) + 1)"),
        format!("n = {a} below 11 ppem, {b} below 16, {c} below 24, {d} below 96, and {e} from there"),
        format!("reach = {SLOPE_REACH} / n"),
        format!("origin = low − {PADDING}, cellsPerEm = c / ((high − low) + 2 · {PADDING})"),
        format!("· {0}, 0, {0}),", DEFORM_NODES - 1),
        format!("A = max(|gx|, |gy|, {MIN_GRADIENT})"),
        format!("B = max(min(|gx|, |gy|), {MIN_SKEW} · A)"),
        format!("more than {MAX_CELLS} cells, {MAX_KNOTS} knots or rank {MAX_RANK};"),
        format!("| lastPpem | The largest, `firstPpem` to {MAX_TRAINED_PPEM}. |"),
        format!("version {MAJOR_VERSION}.{MINOR_VERSION}\n"),
    ] {
        assert!(page.contains(&words), "spec/nfrt.md does not say {words:?}");
    }
}

#[test]
fn every_glyph_hinted_in_y_is_drawn_as_the_specification_says() {
    compare_font(
        "LiberationSerif-Regular",
        Target::Smooth,
        &[7.5, 8.0, 10.0, 13.3, 20.0, 31.5, 32.0, 42.0, 50.0, 96.0],
    );
}

#[test]
fn every_glyph_hinted_in_x_and_y_is_drawn_as_the_specification_says() {
    compare_font("DejaVuSans", Target::Mono, &[8.0, 11.0, 17.75, 40.0, 43.0]);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn a_half_plane_covers_what_the_corners_add_up_to(
        value in -2.0f32..2.0, gx in -2.0f32..2.0, gy in -2.0f32..2.0,
    ) {
        let (ours, twin) = (half_plane(value, gx, gy), area(value.into(), gx.into(), gy.into()));
        prop_assert!((f64::from(ours) - twin).abs() < 1e-4, "{ours} for {twin}");
    }
}
