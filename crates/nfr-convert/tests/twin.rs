//! A naive twin of the renderer, in double precision. The field's zero level is interpolated on a lattice as in marching
//! squares, but nothing is traced, simplified or cut: every lattice cell's polygon is drawn on its own, in thin vertical
//! strips, whose ends are moved by the warp and the deformation.

use nfr::internals::Scratch;
use nfr::internals::model::gridfit::{
    BOX_SLACK, DEFORM_NODES, EMBEDDING_STEPS, FIELD_STEPS, GridFit, PATTERN_STEPS, Scale, Weights,
};
use nfr::{Placement, Target};
use nfr_convert::fit::initial_fit;
use nfr_convert::options::Capacity;
use nfr_convert::teacher::Teacher;
use nfr_convert::training_samples::GlyphSamples;
use read_fonts::FontRef;

use crate::model_twin::{ModelTwin, spline};
use crate::samples::{FONTS, ascii, font, gid};

/// Lattice steps in a cell of the field, along each axis.
const LATTICE: usize = 4;
/// The field is at most this (em) on the border of its grid.
const BORDER: f64 = -1.0 / 1024.0;

/// The inside of a glyph in thin vertical strips, in em: the position along x, and the ends along y.
struct Strips {
    width: f64,
    inside: Vec<(f64, [f64; 2])>,
}

impl Strips {
    /// Strips of about `1 / per_em` em.
    fn of(model: &ModelTwin<'_>, per_em: f64) -> Self {
        let [[left, span], [bottom, height]] = [0, 1].map(|axis| model.grid(axis));
        let weights = model.weights;
        let steps = weights.cells.map(|cells| usize::from(cells) * LATTICE);
        let values = lattice(weights, steps);
        let count = (span * per_em).ceil() as usize;
        let mut strips = Self { width: span / count as f64, inside: Vec::new() };
        for k in 0..count {
            let share = (k as f64 + 0.5) / count as f64;
            let at = share * steps[0] as f64;
            let column = at as usize;
            let mut runs: Vec<[f64; 2]> = Vec::new();
            for row in 0..steps[1] {
                let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| values[row + j][column + i]);
                for [from, to] in inside(corners, at - column as f64) {
                    let [from, to] = [from, to].map(|y| bottom + (row as f64 + y) / steps[1] as f64 * height);
                    match runs.last_mut() {
                        Some(last) if last[1] == from => last[1] = to,
                        _ => runs.push([from, to]),
                    }
                }
            }
            strips.inside.extend(runs.into_iter().map(|run| (left + share * span, run)));
        }
        strips
    }
}

/// The field in em at the nodes of the lattice, bottom row first. On the border of the grid it is negative, so that the
/// inside ends there.
fn lattice(weights: &Weights, steps: [usize; 2]) -> Vec<Vec<f64>> {
    let rows = weights.field.chunks(usize::from(weights.cells[0]) + 2);
    let em = |row: &[i8]| row.iter().map(|v| f64::from(*v) / f64::from(FIELD_STEPS)).collect::<Vec<_>>();
    let rows: Vec<Vec<f64>> = rows.map(em).collect();
    let cells = |step: usize| step as f64 / LATTICE as f64;
    let node = |i: usize, j: usize| {
        let column: Vec<f64> = rows.iter().map(|row| weighed(row, cells(i))).collect();
        let value = weighed(&column, cells(j));
        if i.is_multiple_of(steps[0]) || j.is_multiple_of(steps[1]) { value.min(BORDER) } else { value }
    };
    (0..=steps[1]).map(|j| (0..=steps[0]).map(|i| node(i, j)).collect()).collect()
}

/// The intersection of a vertical line at `x` with the inside of a lattice cell, both 0..1: marching squares. The corners'
/// values are anticlockwise from the lower left. Two opposite corners are connected if the mean is inside.
fn inside(corners: [f64; 4], x: f64) -> Vec<[f64; 2]> {
    const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let is_inside = corners.map(|value| value > 0.0);
    let mut polygons: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
    let is_saddle =
        is_inside[0] == is_inside[2] && is_inside[1] == is_inside[3] && is_inside[0] != is_inside[1];
    let is_connected = corners.iter().sum::<f64>() > 0.0;
    for k in 0..4 {
        let next = (k + 1) % 4;
        let mut push = |point| polygons.last_mut().unwrap().push(point);
        if is_inside[k] {
            push(CORNERS[k]);
        }
        if is_inside[k] != is_inside[next] {
            let share = corners[k] / (corners[k] - corners[next]);
            push([0, 1].map(|axis| CORNERS[k][axis] + share * (CORNERS[next][axis] - CORNERS[k][axis])));
            if is_inside[k] && is_saddle && !is_connected {
                polygons.push(Vec::new());
            }
        }
    }
    // The polygon that begins with the first corner may end behind the last one.
    if polygons.len() > 1 {
        let last = polygons.pop().unwrap();
        polygons[0].extend(last);
    }
    polygons.iter().filter_map(|polygon| crossed(polygon, x)).collect()
}

/// The intersection of a vertical line with a convex polygon.
fn crossed(polygon: &[[f64; 2]], x: f64) -> Option<[f64; 2]> {
    let mut ends: Option<[f64; 2]> = None;
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        if (a[0] <= x) != (b[0] <= x) {
            let y = a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
            ends = Some(ends.map_or([y, y], |[low, high]| [low.min(y), high.max(y)]));
        }
    }
    ends
}

/// Coefficients, each times its B-spline at `at`. Those that are farther off are zero there.
fn weighed(coefficients: &[f64], at: f64) -> f64 {
    let near = (at as usize).saturating_sub(1)..(at as usize + 4).min(coefficients.len());
    near.map(|k| coefficients[k] * spline(at - (k as f64 - 0.5))).sum()
}

/// A model at a size.
struct Twin<'a>(ModelTwin<'a>);

impl Twin<'_> {
    /// The ends of the box along an axis before rounding.
    fn extent(&self, axis: usize) -> [f64; 2] {
        let knots = self.0.knots(axis);
        let bound = |k: usize| self.0.em(self.0.weights.bounds[k]) * self.0.ppem;
        let low = knots.first().map_or(bound(axis), |k| k.1);
        let high = if knots.len() > 1 { knots[knots.len() - 1].1 } else { bound(axis + 2) };
        [low + f64::from(BOX_SLACK), high - f64::from(BOX_SLACK)]
    }

    /// The hinted position (pixels) of an unhinted one (em).
    fn warped(&self, knots: &[(f64, f64)], at: f64) -> f64 {
        let (Some(first), Some(last)) = (knots.first(), knots.last()) else { return at * self.0.ppem };
        for pair in knots.windows(2) {
            let ((unhinted, hinted), (next_unhinted, next_hinted)) = (pair[0], pair[1]);
            if unhinted <= at && at <= next_unhinted {
                return hinted + (at - unhinted) / (next_unhinted - unhinted) * (next_hinted - hinted);
            }
        }
        let end = if at < first.0 { first } else { last };
        end.1 + (at - end.0) * self.0.ppem
    }

    /// The coverage of each pixel, 0 to 255.
    fn draw(&self, strips: &Strips, place: Placement) -> Vec<f64> {
        let knots = [self.0.knots(0), self.0.knots(1)];
        let mut pixels = vec![0.0; place.area()];
        for &(x, ends) in &strips.inside {
            let columns = [-0.5, 0.5]
                .map(|side| self.warped(&knots[0], x + side * strips.width) - f64::from(place.left));
            let rows =
                ends.map(|y| f64::from(place.top) - self.warped(&knots[1], y) + self.0.deformation(x, y));
            for (i, across) in overlaps(columns, place.width) {
                for (j, down) in overlaps([rows[1], rows[0]], place.height) {
                    pixels[j * place.width as usize + i] += across * down * 255.0;
                }
            }
        }
        pixels
    }
}

/// The overlap of an interval with each of the pixels `0..count`.
fn overlaps([from, to]: [f64; 2], count: u32) -> impl Iterator<Item = (usize, f64)> + Clone {
    let first = from.clamp(0.0, f64::from(count)) as usize;
    let last = to.clamp(0.0, f64::from(count)).ceil() as usize;
    (first..last).map(move |k| (k, (to.min(k as f64 + 1.0) - from.max(k as f64)).max(0.0)))
}

/// A smooth deformation that moves points by up to about a quarter of a pixel.
fn deformed(mut weights: Weights) -> Weights {
    let rank = usize::from(weights.rank);
    for (k, value) in weights.patterns.iter_mut().enumerate() {
        let (pattern, row, column) = (k / 64, k / 8 % 8, k % 8);
        let [u, v] = [row, column].map(|node| node as f32 / (DEFORM_NODES - 1) as f32);
        let phase = pattern as f32 * 2.1;
        *value = (PATTERN_STEPS * (phase + 2.5 * u).cos() * (phase * 1.7 + 2.0 * v).sin()).round() as i8;
    }
    for (k, value) in weights.embedding.iter_mut().enumerate() {
        let (size, pattern) = (k / rank, k % rank);
        let most = EMBEDDING_STEPS * 0.25 / rank as f32;
        *value = (most * (size as f32 * 0.7 + pattern as f32).cos()).round() as i8;
    }
    weights
}

/// An end of the box that is this close to a whole pixel, as a share of its distance from the origin, may be rounded
/// either way in single precision.
const TIE: f64 = 1e-5;

fn compare_placement(twin: &Twin<'_>, place: Placement, what: &str) {
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
}

/// Differences in 1/256 of full coverage. A level stands for all coverage from so many 256ths up to the next.
#[derive(Debug, Default, Clone, Copy)]
struct Differences {
    largest: f64,
    sum: f64,
    pixels: f64,
}

impl Differences {
    fn add(&mut self, pixels: &[u8], twin: &[f64]) {
        for (ours, twin) in pixels.iter().zip(twin) {
            let (level, coverage) = (f64::from(*ours), twin * 256.0 / 255.0);
            let difference = (level - coverage).max(coverage - level - 1.0).max(0.0);
            self.largest = self.largest.max(difference);
            self.sum += difference;
            self.pixels += 1.0;
        }
    }
}

/// A hinted size in pixels per em, and the largest and the mean difference there.
///
/// Sides of the renderer's polygons that are short or nearly upright or level are moved at their ends only, and not cut at
/// the knots and nodes between, where the warp and the deformation bend them. With every side cut, the largest differences
/// are 2 to 14. The deformation here is arbitrary, so that it bends more than those of fonts.
type Bound = (f32, f64, f64);

/// For targets that are hinted in y. Measured, and a tenth more.
const SMOOTH: [Bound; 5] =
    [(8.0, 10.7, 0.57), (10.0, 17.4, 0.51), (13.3, 17.1, 0.43), (20.0, 27.7, 0.59), (24.9, 59.0, 0.51)];

/// For targets that are hinted in x, too.
const MONO: [Bound; 5] =
    [(8.0, 30.4, 0.94), (10.0, 33.1, 0.77), (13.3, 51.0, 0.68), (20.0, 47.1, 0.77), (24.9, 60.2, 0.74)];

/// For some letters and all targets.
const LARGE: [Bound; 3] = [(25.0, 22.3, 0.44), (31.5, 44.2, 0.43), (40.0, 65.3, 0.41)];

/// Sizes at which nothing is hinted, and the mean difference.
const UNHINTED: [(f32, f64); 7] =
    [(7.0, 0.31), (49.0, 0.24), (63.0, 0.18), (96.0, 0.2), (127.5, 0.22), (128.0, 0.04), (200.0, 0.03)];

/// The largest difference at a size where nothing is hinted: rounding; the distance of the polygons' sides from the traced
/// points, as covered by a diagonal side; and the ends of upright sides, which are half a strip off at most.
fn unhinted_bound(ppem: f32, strips_per_em: f64) -> f64 {
    let tolerance = match ppem {
        ..25.0 => 0.0012,
        ..50.0 => 0.0006,
        ..128.0 => 0.0004,
        _ => 0.00005,
    };
    let ppem = f64::from(ppem);
    0.5 + 255.0 * ppem * (tolerance * std::f64::consts::SQRT_2 + 0.5 / strips_per_em)
}

/// Strips in a pixel of the largest size.
const STRIPS_PER_PIXEL: f64 = 64.0;

/// As many patterns as the bounds above were measured with, whatever the converter calls for.
const CAPACITY: Capacity =
    Capacity { cell: 0.031, knots: 12, knot_gain: 5e-4, rank: 8, least_rank: 2, pattern_gain: 0.01 };

/// Compares the glyphs of a text at some sizes, the largest last.
fn compare(name: &str, target: Target, text: &str, bounds: &[Bound]) {
    let data = font(name);
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), target).unwrap();
    let scale = Scale::new(teacher.units_per_em(), 8, 40).unwrap();
    let hinted: Vec<_> = (scale.first_ppem()..=scale.last_ppem()).map(|s| teacher.at(s).unwrap()).collect();
    let finest = f64::from(bounds[bounds.len() - 1].0) * STRIPS_PER_PIXEL;
    let mut found = vec![Differences::default(); bounds.len()];
    for character in text.chars() {
        let samples = GlyphSamples::draw(&teacher, &hinted, gid(&data, character)).unwrap();
        let weights = deformed(initial_fit(&samples, scale, target, CAPACITY, 1).quantise());
        let model = GridFit::new(&weights, scale).unwrap();
        let model_at = |ppem: f32| ModelTwin { weights: &weights, scale, ppem: ppem.into() };
        let strips = Strips::of(&model_at(1.0), finest);
        for ((ppem, ..), found) in bounds.iter().zip(&mut found) {
            let twin = Twin(model_at(*ppem));
            let place = model.placement(*ppem).unwrap();
            compare_placement(&twin, place, &format!("{name}, {target}, {character:?} at {ppem} ppem"));
            let mut pixels = vec![0; place.area()];
            model.draw(*ppem, place, &mut Scratch::default(), &mut pixels).unwrap();
            found.add(&pixels, &twin.draw(&strips, place));
        }
    }
    for ((ppem, largest, mean), found) in bounds.iter().zip(&found) {
        let Differences { largest: most, sum, pixels } = found;
        let what = format!("{name}, {target}, {ppem} ppem: {most} at most, {} on average", sum / pixels);
        assert!(most <= largest && sum / pixels <= *mean, "{what}");
    }
}

#[test]
fn every_glyph_hinted_in_y_is_drawn_as_the_inside_of_its_field() {
    FONTS.iter().for_each(|name| compare(name, Target::Smooth, &ascii(), &SMOOTH));
}

#[test]
fn every_glyph_hinted_in_x_and_y_is_drawn_as_the_inside_of_its_field() {
    FONTS.iter().for_each(|name| compare(name, Target::Mono, &ascii(), &MONO));
}

#[test]
fn large_glyphs_are_drawn_as_the_inside_of_their_fields() {
    for (name, target) in FONTS.iter().flat_map(|name| [(name, Target::Smooth), (name, Target::Mono)]) {
        compare(name, target, "agRSW%&i", &LARGE);
    }
}

#[test]
fn unhinted_glyphs_are_drawn_as_the_inside_of_their_fields_within_the_tolerance_of_their_polygons() {
    let strips_per_em = f64::from(UNHINTED[UNHINTED.len() - 1].0) * STRIPS_PER_PIXEL;
    let bounds = UNHINTED.map(|(ppem, mean)| (ppem, unhinted_bound(ppem, strips_per_em), mean));
    for (name, target) in FONTS.iter().flat_map(|name| [(name, Target::Smooth), (name, Target::Mono)]) {
        compare(name, target, "agRSW%&i", &bounds);
    }
}
