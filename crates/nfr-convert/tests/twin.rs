//! What a model draws, once more: the inside of its field's zero level, moved by hinting. In double precision, with no
//! outline traced: the field is searched in thin upright strips, and what is inside is put where hinting puts it.
#![allow(clippy::unwrap_used)]

mod samples;

use nfr::internals::Scratch;
use nfr::internals::model::gridfit::{
    AxisWarp, BOX_SLACK, DEFORM_NODES, EMBEDDING_STEPS, FIELD_STEPS, GridFit, MIN_KNOT_GAP, PADDING,
    PATTERN_STEPS, Scale, WARP_STEPS, Weights,
};
use nfr::{Placement, Target};
use nfr_convert::start::{Capacity, Draft};
use nfr_convert::teach::lesson;
use nfr_convert::teacher::Teacher;
use read_fonts::FontRef;

use samples::{FONTS, ascii, font, gid};

/// The field is evaluated so many times in the height of a cell; between, it is taken as straight.
const STEPS: usize = 16;

/// A glyph's inside in thin strips, in em: where each strip is, and from where to where it is inside.
struct Strips {
    width: f64,
    inside: Vec<(f64, [f64; 2])>,
}

/// Where the grid begins and how long it is, in em.
fn grid(weights: &Weights, scale: Scale, axis: usize) -> [f64; 2] {
    let [low, high] =
        [axis, axis + 2].map(|k| f64::from(weights.bounds[k]) / f64::from(scale.units_per_em()));
    [low - f64::from(PADDING), high - low + 2.0 * f64::from(PADDING)]
}

impl Strips {
    /// Strips of about `1 / per_em` em.
    fn of(weights: &Weights, scale: Scale, per_em: f64) -> Self {
        let [[left, span], [bottom, height]] = [0, 1].map(|axis| grid(weights, scale, axis));
        let cells = weights.cells.map(usize::from);
        let count = (span * per_em).ceil() as usize;
        let mut strips = Self { width: span / count as f64, inside: Vec::new() };
        for k in 0..count {
            let share = (k as f64 + 0.5) / count as f64;
            let column = contracted(weights, share * cells[0] as f64);
            let value = |step: usize| weighed(&column, step as f64 / STEPS as f64);
            let y = |step: f64| bottom + step / (cells[1] * STEPS) as f64 * height;
            let (mut before, mut from) = (value(0), None);
            for step in 1..=cells[1] * STEPS {
                let here = value(step);
                let at = y(step as f64 - here / (here - before));
                match from {
                    None if here > 0.0 => from = Some(if before > 0.0 { bottom } else { at }),
                    Some(from) if here <= 0.0 => strips.inside.push((left + share * span, [from, at])),
                    _ => {}
                }
                from = from.filter(|_| here > 0.0);
                before = here;
            }
            strips.inside.extend(from.map(|from| (left + share * span, [from, bottom + height])));
        }
        strips
    }
}

/// The coefficients of an upright line through the field, at `u` cells from its left: B-splines along x.
fn contracted(weights: &Weights, u: f64) -> Vec<f64> {
    let rows = weights.field.chunks(usize::from(weights.cells[0]) + 2);
    let em = |row: &[i8]| row.iter().map(|v| f64::from(*v) / f64::from(FIELD_STEPS)).collect::<Vec<_>>();
    rows.map(|row| weighed(&em(row), u)).collect()
}

/// Coefficients, each times its B-spline at `at`. Those that are farther off are zero there.
fn weighed(coefficients: &[f64], at: f64) -> f64 {
    let near = (at as usize).saturating_sub(1)..(at as usize + 4).min(coefficients.len());
    near.map(|k| coefficients[k] * spline(at - (k as f64 - 0.5))).sum()
}

/// The centred quadratic B-spline.
fn spline(d: f64) -> f64 {
    match d.abs() {
        d if d <= 0.5 => 0.75 - d * d,
        d if d <= 1.5 => 0.5 * (1.5 - d) * (1.5 - d),
        _ => 0.0,
    }
}

/// A model at a size.
struct Twin<'a> {
    weights: &'a Weights,
    scale: Scale,
    ppem: f64,
}

impl Twin<'_> {
    fn em(&self, units: i16) -> f64 {
        f64::from(units) / f64::from(self.scale.units_per_em())
    }

    /// The number of the trained size that this one is fitted as: it is less than half a pixel per em off, or half of
    /// one above it.
    fn fitted(&self) -> Option<usize> {
        let off = |size: &usize| self.ppem - self.scale.ppem_of(*size) as f64;
        (0..self.scale.sizes()).find(|size| (-0.5..0.5).contains(&off(size)))
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
        let grid_size = self.fitted().map_or(self.ppem, |size| self.scale.ppem_of(size) as f64);
        let mut knots: Vec<(f64, f64)> = Vec::new();
        for (k, &units) in warp.knots.iter().enumerate() {
            let plain = self.em(units);
            let moved = self.at_size(|size| {
                let hinted = f64::from(warp.hinted[size * warp.knots.len() + k]) / f64::from(WARP_STEPS);
                hinted - plain * self.scale.ppem_of(size) as f64
            });
            let hinted = plain * grid_size + moved;
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

    /// The hinted place (pixels) of a plain one (em).
    fn warped(&self, knots: &[(f64, f64)], at: f64) -> f64 {
        let (Some(first), Some(last)) = (knots.first(), knots.last()) else { return at * self.ppem };
        for pair in knots.windows(2) {
            let ((plain, hinted), (next_plain, next_hinted)) = (pair[0], pair[1]);
            if plain <= at && at <= next_plain {
                return hinted + (at - plain) / (next_plain - plain) * (next_hinted - hinted);
            }
        }
        let end = if at < first.0 { first } else { last };
        end.1 + (at - end.0) * self.ppem
    }

    /// How far the deformation moves a plain point down, in pixels.
    fn deformation(&self, x: f64, y: f64) -> f64 {
        let rank = usize::from(self.weights.rank);
        let near = |axis: usize, q: f64| {
            let [origin, span] = grid(self.weights, self.scale, axis);
            let at = ((q - origin) / span).clamp(0.0, 1.0) * (DEFORM_NODES - 1) as f64;
            let hat = move |node: usize| (node, (1.0 - (at - node as f64).abs()).max(0.0));
            [hat(at as usize), hat((at as usize + 1).min(DEFORM_NODES - 1))]
        };
        let (columns, rows) = (near(0, x), near(1, y));
        let mut sum = 0.0;
        for r in 0..rank {
            let strength = self.at_size(|size| {
                f64::from(self.weights.embedding[size * rank + r]) / f64::from(EMBEDDING_STEPS)
            });
            for ((row, v), (column, u)) in rows.iter().flat_map(|row| columns.map(|column| (*row, column))) {
                let node = self.weights.patterns[(r * DEFORM_NODES + row) * DEFORM_NODES + column];
                sum += strength * f64::from(node) / f64::from(PATTERN_STEPS) * u * v;
            }
        }
        sum
    }

    /// What is covered of each pixel, in levels.
    fn draw(&self, strips: &Strips, place: Placement) -> Vec<f64> {
        let knots = [self.knots(0), self.knots(1)];
        let mut pixels = vec![0.0; place.area()];
        for &(x, ends) in &strips.inside {
            let columns = [-0.5, 0.5]
                .map(|side| self.warped(&knots[0], x + side * strips.width) - f64::from(place.left));
            let rows =
                ends.map(|y| f64::from(place.top) - self.warped(&knots[1], y) + self.deformation(x, y));
            for (i, across) in overlaps(columns, place.width) {
                for (j, down) in overlaps([rows[1], rows[0]], place.height) {
                    pixels[j * place.width as usize + i] += across * down * 255.0;
                }
            }
        }
        pixels
    }
}

/// What an interval has in common with the pixels `0..count`.
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

/// Where an end of the box is this close to a whole pixel (as a share of its distance from the origin), single
/// precision decides.
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

/// Differences in levels.
#[derive(Debug, Default, Clone, Copy)]
struct Differences {
    largest: f64,
    sum: f64,
    pixels: f64,
}

impl Differences {
    fn add(&mut self, pixels: &[u8], twin: &[f64]) {
        for (ours, twin) in pixels.iter().zip(twin) {
            let difference = (f64::from(*ours) - twin).abs();
            self.largest = self.largest.max(difference);
            self.sum += difference;
            self.pixels += 1.0;
        }
    }
}

/// A size, and how many levels a pixel may differ there: at most, and on average.
///
/// Half a level is rounding, a quarter on average. Up to 128 ppem, sides may be 0.03 pixel from the outline, eight
/// levels of a pixel that they pass through from border to border; and short ones are not cut at knots, where a warp in
/// x and y bends them. All sizes have the outline in straight pieces of a lattice, 0.008 em long: in a pixel at a sharp
/// tip, or where two edges nearly meet, what lies between its lines counts, the more the larger the size.
type Bound = (f32, f64, f64);

/// For targets that are hinted in y. Measured, and a tenth more.
const SMOOTH: [Bound; 6] = [
    (7.0, 3.2, 0.34),
    (8.0, 11.0, 0.61),
    (10.0, 18.0, 0.55),
    (13.3, 17.0, 0.48),
    (20.0, 28.0, 0.63),
    (24.9, 60.0, 0.64),
];

/// For those that are hinted in x, too.
const MONO: [Bound; 6] = [
    (7.0, 3.2, 0.34),
    (8.0, 31.0, 1.05),
    (10.0, 34.0, 0.92),
    (13.3, 51.0, 0.79),
    (20.0, 48.0, 0.82),
    (24.9, 62.0, 0.8),
];

/// For some letters and all targets.
const LARGE: [Bound; 9] = [
    (25.0, 23.0, 0.51),
    (31.5, 45.0, 0.57),
    (40.0, 64.0, 0.54),
    (49.0, 18.0, 0.4),
    (63.0, 29.0, 0.35),
    (96.0, 45.0, 0.38),
    (127.5, 53.0, 0.39),
    (128.0, 54.0, 0.27),
    (200.0, 95.0, 0.28),
];

/// Strips in a pixel: the ends of upright sides are so much of a pixel off, at most half of it.
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
        let lesson = lesson(&teacher, &hinted, gid(&data, character)).unwrap();
        let weights = deformed(Draft::from_lesson(&lesson, scale, target, CAPACITY, 1).quantise());
        let model = GridFit::new(&weights, scale).unwrap();
        let strips = Strips::of(&weights, scale, finest);
        for ((ppem, ..), found) in bounds.iter().zip(&mut found) {
            let twin = Twin { weights: &weights, scale, ppem: f64::from(*ppem) };
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
    for name in FONTS {
        compare(name, Target::Smooth, "agRSW%&i", &LARGE);
        compare(name, Target::Mono, "agRSW%&i", &LARGE);
    }
}
