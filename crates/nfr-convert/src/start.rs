//! A glyph's first guess: the warp from its points, the field from its outline.

use crate::deform::{self, Sample};
use crate::distance::signed_distance;
use crate::error::Error;
use crate::teach::{HintedGlyph, Lesson};
use crate::warp::{self, Limits, Warp, warp_point};
use nfr::Target;
use nfr::internals::model::gridfit::{
    AxisWarp, DEFORM_NODES, FIELD_LIMIT, GridAxis, MAX_KNOTS, PADDING, Scale, WARP_STEPS, Weights,
};
use nfr::internals::table::codec::MAX_RANK;

/// How large a glyph's model may become.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capacity {
    /// Edge of a field cell in em; small glyphs and large ones keep within `MIN_CELLS..=MAX_CELLS`.
    pub cell: f32,
    /// Knots of each warped axis, at most.
    pub knots: usize,
    /// Knots are added until they leave less than this of the points' moves (mean square, pixels²).
    pub knot_gain: f64,
    /// Deformation patterns, at most.
    pub rank: usize,
    /// Deformation patterns, at least; those that the points do not call for are left to the training.
    pub least_rank: usize,
    /// Patterns are added until they leave less than this of the points' moves at every size (mean square,
    /// pixels²).
    pub pattern_gain: f64,
}

impl Default for Capacity {
    fn default() -> Self {
        Self { cell: 0.031, knots: 12, knot_gain: 5e-4, rank: 8, least_rank: 2, pattern_gain: 0.0025 }
    }
}

impl Capacity {
    /// Checks that a table can hold such models.
    ///
    /// # Errors
    ///
    /// `InvalidParameter`, naming the first number that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |what: String| Err(Error::InvalidParameter(what));
        let Self { cell, knots, knot_gain, rank, least_rank, pattern_gain } = *self;
        // The table tells the cell in ten-thousandths of an em, in 16 bits.
        if !(CELLS_TOLD.recip()..=f32::from(u16::MAX) / CELLS_TOLD).contains(&cell) {
            return wrong(format!("cells of {cell} em; use 0.0001 to 6.5535"));
        }
        if !(2..=MAX_KNOTS).contains(&knots) {
            return wrong(format!("{knots} knots; use 2 to {MAX_KNOTS}"));
        }
        if least_rank == 0 || least_rank > rank || rank > MAX_RANK.into() {
            return wrong(format!("{least_rank} to {rank} patterns; use 1 to {MAX_RANK}, the fewer first"));
        }
        for (gain, of) in [(knot_gain, "knots"), (pattern_gain, "patterns")] {
            // Infinity is a way to say that none need be added.
            if gain.is_nan() || gain < 0.0 {
                return wrong(format!("{of} are to leave less than {gain} of the moves; use 0 or more"));
            }
        }
        Ok(())
    }
}

/// A table tells of cells in this share of an em.
pub(super) const CELLS_TOLD: f32 = 10_000.0;
/// The fewest cells along an axis.
const MIN_CELLS: f32 = 6.0;
/// The most cells along an axis.
const MAX_CELLS: f32 = 40.0;

/// A model's weights in their natural units while it is trained.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Draft {
    /// The plain outline's box in font units.
    pub bounds: [i16; 4],
    /// Cells of the field along x and y.
    pub cells: [usize; 2],
    /// Spline coefficients in em, bottom row first. Empty: nothing to draw.
    pub field: Vec<f32>,
    /// Knots in font units, for x and y.
    pub knots: [Vec<i16>; 2],
    /// Hinted knot positions in pixels for each axis, by size and knot.
    pub hinted: [Vec<f32>; 2],
    /// The number of deformation patterns.
    pub rank: usize,
    /// Patterns, bottom row first.
    pub patterns: Vec<f32>,
    /// The weight of each pattern in pixels, by size and pattern.
    pub embedding: Vec<f32>,
}

impl Draft {
    /// The first guess for a lesson. `seed` and the glyph's number determine the patterns' noise.
    pub fn from_lesson(lesson: &Lesson, scale: Scale, target: Target, capacity: Capacity, seed: u64) -> Self {
        let points = &lesson.outline.points;
        if points.is_empty() {
            return Self::default();
        }
        let units = f32::from(scale.units_per_em());
        let extreme = |axis: usize| {
            let values = points.iter().map(move |p| p[axis] * units);
            values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
        };
        let [(x0, x1), (y0, y1)] = [extreme(0), extreme(1)];
        let bounds = [x0.floor() as i16, y0.floor() as i16, x1.ceil() as i16, y1.ceil() as i16];
        let axis = |k: usize| {
            let (low, high) = (f32::from(bounds[k]) / units, f32::from(bounds[k + 2]) / units);
            let cells = ((high - low + 2.0 * PADDING) / capacity.cell).round().clamp(MIN_CELLS, MAX_CELLS);
            GridAxis::new(low, high, cells as usize)
        };
        let grid = [axis(0), axis(1)];
        let mut draft = Self {
            bounds,
            cells: grid.map(|g| g.cells),
            field: first_field(lesson, grid),
            ..Self::default()
        };
        for axis in if target == Target::Smooth { 1..2 } else { 0..2 } {
            let fitted = first_warp(lesson, axis, units, capacity);
            draft.knots[axis] = fitted.knots.iter().map(|k| (k * units).round() as i16).collect();
            draft.hinted[axis] = fitted.hinted.concat();
        }
        let seed = seed ^ u64::from(lesson.gid);
        draft.first_deformation(lesson, grid, units, capacity, seed);
        draft
    }

    /// What the warp in y leaves of the points' moves, and some noise for the patterns that find nothing.
    fn first_deformation(
        &mut self,
        lesson: &Lesson,
        grid: [GridAxis; 2],
        units: f32,
        capacity: Capacity,
        seed: u64,
    ) {
        let knots: Vec<f32> = self.knots[1].iter().map(|k| f32::from(*k) / units).collect();
        let samples = |(size, hinted): (usize, &HintedGlyph)| -> Vec<Sample> {
            let ppem = f32::from(hinted.ppem);
            let at_knots = &self.hinted[1][size * knots.len()..(size + 1) * knots.len()];
            let sample = |(moved, plain): (&[f32; 2], &[f32; 2])| {
                let y = warp_point(&knots, at_knots, ppem, plain[1]);
                Sample { at: *plain, by: f64::from(y - moved[1]) }
            };
            hinted.points.iter().zip(&lesson.outline.points).map(sample).collect()
        };
        let samples: Vec<Vec<Sample>> = lesson.sizes.iter().enumerate().map(samples).collect();
        let found = deform::fit(&samples, grid, capacity.rank, capacity.pattern_gain);
        let nodes = DEFORM_NODES * DEFORM_NODES;
        self.rank = found.patterns.len().max(capacity.least_rank);
        self.patterns = found.patterns.concat();
        let noise = noise(self.rank * nodes, seed);
        self.patterns.extend_from_slice(&noise[self.patterns.len()..]);
        let strength = |size: usize, r: usize| found.strengths.get(r).map_or(0.0, |s| s[size]);
        let rank = self.rank;
        self.embedding = (0..lesson.sizes.len())
            .flat_map(|size| (0..rank).map(move |r| (size, r)))
            .map(|(s, r)| strength(s, r))
            .collect();
    }

    /// Whether every number is one.
    pub(super) fn is_finite(&self) -> bool {
        let all = [&self.field, &self.hinted[0], &self.hinted[1], &self.patterns, &self.embedding];
        all.into_iter().flatten().all(|v| v.is_finite())
    }

    /// Rounds to what is stored.
    pub fn quantise(&self) -> Weights {
        use nfr::internals::model::gridfit::{EMBEDDING_STEPS, FIELD_STEPS, PATTERN_STEPS};
        let bytes = |values: &[f32], steps: f32| {
            values
                .iter()
                .map(|v| (v * steps).round_ties_even().clamp(-127.0, 127.0) as i8)
                .collect::<Vec<_>>()
        };
        let warp = |k: usize| AxisWarp {
            knots: self.knots[k].clone(),
            hinted: self.hinted[k].iter().map(|h| (h * WARP_STEPS).round_ties_even() as i32).collect(),
        };
        Weights {
            bounds: self.bounds,
            cells: self.cells.map(|c| c as u8),
            field: bytes(&self.field, FIELD_STEPS),
            warp_x: warp(0),
            warp_y: warp(1),
            rank: self.rank as u8,
            patterns: bytes(&self.patterns, PATTERN_STEPS),
            embedding: bytes(&self.embedding, EMBEDDING_STEPS),
        }
    }
}

fn first_warp(lesson: &Lesson, axis: usize, units: f32, capacity: Capacity) -> Warp {
    let plain: Vec<f32> = lesson.outline.points.iter().map(|p| p[axis]).collect();
    let hinted: Vec<Vec<f32>> =
        lesson.sizes.iter().map(|s| s.points.iter().map(|p| p[axis]).collect()).collect();
    let ppem: Vec<u16> = lesson.sizes.iter().map(|s| s.ppem).collect();
    let limits = Limits { units, knots: capacity.knots, good_enough: capacity.knot_gain };
    warp::fit(&plain, &hinted, &ppem, limits)
}

/// Spline coefficients from the signed distance at their centres.
fn first_field(lesson: &Lesson, [gx, gy]: [GridAxis; 2]) -> Vec<f32> {
    let segments = lesson.outline.segments();
    let centre = |axis: GridAxis, k: usize| axis.origin + (k as f32 - 0.5) / axis.cells_per_em;
    let mut field = Vec::with_capacity((gx.cells + 2) * (gy.cells + 2));
    for row in 0..gy.cells + 2 {
        for column in 0..gx.cells + 2 {
            let distance = signed_distance(&segments, [centre(gx, column), centre(gy, row)]);
            field.push(distance.clamp(-FIELD_LIMIT, FIELD_LIMIT));
        }
    }
    field
}

/// Reproducible noise in ±½ (SplitMix64).
fn noise(count: usize, seed: u64) -> Vec<f32> {
    let mut state = seed;
    (0..count)
        .map(|_| {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^= z >> 31;
            (z >> 40) as f32 / (1u64 << 24) as f32 - 0.5
        })
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::samples::lessons;
    use nfr::internals::model::gridfit::GridFit;

    const TEXT: &str = "agiW%.|_'";

    #[test]
    fn a_first_guess_is_a_model_for_every_target() {
        for target in [Target::Smooth, Target::Mono, Target::Lcd] {
            let (lessons, scale) = lessons(TEXT, target);
            for lesson in &lessons {
                let draft = Draft::from_lesson(lesson, scale, target, Capacity::default(), 1);
                GridFit::new(&draft.quantise(), scale).unwrap();
                assert_eq!(draft.knots[0].is_empty(), target == Target::Smooth);
                assert!(draft.knots.iter().all(|k| k.len() <= Capacity::default().knots));
                let units = f32::from(scale.units_per_em());
                for [x, y] in lesson.outline.points.iter().map(|p| p.map(|v| v * units)) {
                    let [x0, y0, x1, y1] = draft.bounds.map(f32::from);
                    assert!(
                        x0 <= x && x <= x1 && y0 <= y && y <= y1,
                        "({x}, {y}) outside {:?}",
                        draft.bounds
                    );
                }
            }
        }
    }

    #[test]
    fn the_first_field_is_positive_inside_and_negative_outside() {
        let (lessons, scale) = lessons("|", Target::Smooth);
        let draft = Draft::from_lesson(&lessons[0], scale, Target::Smooth, Capacity::default(), 1);
        let stride = draft.cells[0] + 2;
        let middle = draft.field.len() / stride / 2 * stride;
        assert!(draft.field[middle + stride / 2] > 0.0, "the middle of a bar");
        assert!(draft.field[..stride].iter().all(|d| *d < 0.0), "below it");
        assert!(draft.field[middle] < 0.0 && draft.field[middle + stride - 1] < 0.0, "beside it");
    }

    #[test]
    fn the_seed_changes_patterns_that_the_points_do_not_call_for_and_nothing_else() {
        let (lessons, scale) = lessons("g", Target::Smooth);
        let none_called_for = Capacity { pattern_gain: f64::INFINITY, ..Capacity::default() };
        let guess = |seed| Draft::from_lesson(&lessons[0], scale, Target::Smooth, none_called_for, seed);
        assert_eq!(guess(1), guess(1));
        let (one, two) = (guess(1), guess(2));
        assert_eq!(one.rank, none_called_for.least_rank);
        assert_ne!(one.patterns, two.patterns);
        assert_eq!(Draft { patterns: Vec::new(), ..one }, Draft { patterns: Vec::new(), ..two });
    }

    #[test]
    fn a_blank_glyph_has_nothing_to_train() {
        let (lessons, scale) = lessons(" ", Target::Smooth);
        let draft = Draft::from_lesson(&lessons[0], scale, Target::Smooth, Capacity::default(), 1);
        assert_eq!(draft, Draft::default());
        assert_eq!(draft.quantise(), Weights::default());
    }

    #[test]
    fn rounding_keeps_weights_within_half_a_step() {
        let (lessons, scale) = lessons("R", Target::Mono);
        let draft = Draft::from_lesson(&lessons[0], scale, Target::Mono, Capacity::default(), 1);
        let stored = draft.quantise();
        let field = stored.field.iter().zip(&draft.field);
        let worst =
            field.map(|(q, v)| (f32::from(*q) - v * nfr::internals::model::gridfit::FIELD_STEPS).abs());
        assert!(worst.fold(0.0, f32::max) <= 0.5, "the field's limit fits a byte");
        let hinted = stored.warp_x.hinted.iter().zip(&draft.hinted[0]);
        assert!(hinted.map(|(q, v)| (*q as f32 - v * WARP_STEPS).abs()).fold(0.0, f32::max) <= 0.5);
    }
}
