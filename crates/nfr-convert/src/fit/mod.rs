//! The initial fit of a model: the warp and the deformation by least squares from the outline's hinted points, the field
//! from the distance to the unhinted outline.

mod deformation;
mod distance;
mod parameters;
mod warp;

use crate::options::Capacity;
use crate::random::SplitMix64;
use crate::training_samples::GlyphSamples;
use deformation::Displacement;
use distance::signed_distance;
use nfr::Target;
use nfr::internals::model::gridfit::{DEFORM_NODES, FIELD_LIMIT, GridAxis, PADDING, Scale};
use warp::{Limits, Warp, warp_point};

pub use parameters::Parameters;

/// The fewest and the most cells of a field along an axis that are chosen; the format allows more.
const CELLS: [f32; 2] = [6.0, 40.0];
/// A point farther from its unhinted position (pixels) has been moved: scaled points are rounded to 1/64 pixel, and implied ones lie
/// between two of them.
const MOVED: f32 = 1.0 / 16.0;

/// Fits a model to a glyph's training samples. `seed` and the glyph's number determine the noise in its patterns.
pub fn initial_fit(
    samples: &GlyphSamples,
    scale: Scale,
    target: Target,
    capacity: Capacity,
    seed: u64,
) -> Parameters {
    let points = &samples.outline.points;
    if points.is_empty() {
        return Parameters::default();
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
        let cells = ((high - low + 2.0 * PADDING) / capacity.cell).round().clamp(CELLS[0], CELLS[1]);
        GridAxis::new(low, high, cells as usize)
    };
    let grid = [axis(0), axis(1)];
    let mut parameters = Parameters {
        bounds,
        cells: grid.map(|g| g.cells),
        field: fit_field(samples, grid),
        ..Parameters::default()
    };
    for axis in if target == Target::Smooth && !moves_in_x(samples) { 1..2 } else { 0..2 } {
        let fitted = fit_warp(samples, axis, units, capacity);
        parameters.knots[axis] = fitted.knots.iter().map(|k| (k * units).round() as i16).collect();
        parameters.hinted[axis] = fitted.hinted.concat();
    }
    fit_deformation(&mut parameters, samples, grid, units, capacity, seed ^ u64::from(samples.gid));
    parameters
}

/// Whether hinting moves a point in x. For the smooth target it does so in fonts that leave the interpreter's backward compatibility
/// mode (OpenType 1.9, "INSTCTRL", selector 3).
fn moves_in_x(samples: &GlyphSamples) -> bool {
    samples.sizes.iter().any(|size| {
        let plain = samples.outline.points.iter().map(|p| p[0] * f32::from(size.ppem));
        size.points.iter().zip(plain).any(|(hinted, plain)| (hinted[0] - plain).abs() > MOVED)
    })
}

/// Spline coefficients: the signed distance to the outline at their centres.
fn fit_field(samples: &GlyphSamples, [gx, gy]: [GridAxis; 2]) -> Vec<f32> {
    let segments = samples.outline.segments();
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

fn fit_warp(samples: &GlyphSamples, axis: usize, units: f32, capacity: Capacity) -> Warp {
    let unhinted: Vec<f32> = samples.outline.points.iter().map(|p| p[axis]).collect();
    let hinted: Vec<Vec<f32>> =
        samples.sizes.iter().map(|s| s.points.iter().map(|p| p[axis]).collect()).collect();
    let ppem: Vec<u16> = samples.sizes.iter().map(|s| s.ppem).collect();
    let limits = Limits { units, knots: capacity.knots, max_residual: capacity.knot_gain };
    warp::fit(&unhinted, &hinted, &ppem, limits)
}

/// Fits the patterns to the residual moves of the points after the warp in y. Patterns beyond those begin as noise.
fn fit_deformation(
    parameters: &mut Parameters,
    samples: &GlyphSamples,
    grid: [GridAxis; 2],
    units: f32,
    capacity: Capacity,
    seed: u64,
) {
    let knots: Vec<f32> = parameters.knots[1].iter().map(|k| f32::from(*k) / units).collect();
    let residuals = samples.sizes.iter().enumerate().map(|(size, sample)| -> Vec<Displacement> {
        let at_knots = &parameters.hinted[1][size * knots.len()..(size + 1) * knots.len()];
        let residual = |(hinted, unhinted): (&[f32; 2], &[f32; 2])| {
            let y = warp_point(&knots, at_knots, f32::from(sample.ppem), unhinted[1]);
            Displacement { at: *unhinted, by: f64::from(y - hinted[1]) }
        };
        sample.points.iter().zip(&samples.outline.points).map(residual).collect()
    });
    let residuals: Vec<_> = residuals.collect();
    let fitted = deformation::fit(&residuals, grid, capacity.rank, capacity.pattern_gain);
    let rank = fitted.patterns.len().max(capacity.least_rank);
    let mut random = SplitMix64::new(seed);
    let noise: Vec<f32> = (0..rank * DEFORM_NODES * DEFORM_NODES).map(|_| random.uniform() - 0.5).collect();
    parameters.rank = rank;
    parameters.patterns = fitted.patterns.concat();
    parameters.patterns.extend_from_slice(&noise[parameters.patterns.len()..]);
    let strength = |size: usize, r: usize| fitted.strengths.get(r).map_or(0.0, |s| s[size]);
    parameters.embedding = (0..samples.sizes.len())
        .flat_map(|size| (0..rank).map(move |r| (size, r)))
        .map(|(size, r)| strength(size, r))
        .collect();
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::fixtures::glyph_samples;
    use nfr::internals::model::gridfit::{FIELD_STEPS, GridFit, WARP_STEPS, Weights};

    const TEXT: &str = "agiW%.|_'";

    #[test]
    fn an_initial_fit_is_a_model_for_every_target() {
        for target in [Target::Smooth, Target::Mono, Target::Lcd] {
            let (glyphs, scale) = glyph_samples(TEXT, target);
            for samples in &glyphs {
                let parameters = initial_fit(samples, scale, target, Capacity::default(), 1);
                GridFit::new(&parameters.quantise(), scale).unwrap();
                assert_eq!(parameters.knots[0].is_empty(), target == Target::Smooth);
                assert!(parameters.knots.iter().all(|k| k.len() <= Capacity::default().knots));
                let units = f32::from(scale.units_per_em());
                for [x, y] in samples.outline.points.iter().map(|p| p.map(|v| v * units)) {
                    let [x0, y0, x1, y1] = parameters.bounds.map(f32::from);
                    assert!(
                        x0 <= x && x <= x1 && y0 <= y && y <= y1,
                        "({x}, {y}) outside {:?}",
                        parameters.bounds
                    );
                }
            }
        }
    }

    #[test]
    fn the_initial_field_is_positive_inside_and_negative_outside() {
        let (glyphs, scale) = glyph_samples("|", Target::Smooth);
        let parameters = initial_fit(&glyphs[0], scale, Target::Smooth, Capacity::default(), 1);
        let stride = parameters.cells[0] + 2;
        let middle = parameters.field.len() / stride / 2 * stride;
        assert!(parameters.field[middle + stride / 2] > 0.0, "the middle of a bar");
        assert!(parameters.field[..stride].iter().all(|d| *d < 0.0), "below it");
        assert!(parameters.field[middle] < 0.0 && parameters.field[middle + stride - 1] < 0.0, "beside it");
    }

    #[test]
    fn the_seed_changes_patterns_that_the_points_do_not_need_and_nothing_else() {
        let (glyphs, scale) = glyph_samples("g", Target::Smooth);
        let none_needed = Capacity { pattern_gain: f64::INFINITY, ..Capacity::default() };
        let fit = |seed| initial_fit(&glyphs[0], scale, Target::Smooth, none_needed, seed);
        assert_eq!(fit(1), fit(1));
        let (one, two) = (fit(1), fit(2));
        assert_eq!(one.rank, none_needed.least_rank);
        assert_ne!(one.patterns, two.patterns);
        assert_eq!(Parameters { patterns: Vec::new(), ..one }, Parameters { patterns: Vec::new(), ..two });
    }

    #[test]
    fn a_blank_glyph_has_nothing_to_train() {
        let (glyphs, scale) = glyph_samples(" ", Target::Smooth);
        let parameters = initial_fit(&glyphs[0], scale, Target::Smooth, Capacity::default(), 1);
        assert_eq!(parameters, Parameters::default());
        assert_eq!(parameters.quantise(), Weights::default());
    }

    #[test]
    fn rounding_keeps_weights_within_half_a_step() {
        let (glyphs, scale) = glyph_samples("R", Target::Mono);
        let parameters = initial_fit(&glyphs[0], scale, Target::Mono, Capacity::default(), 1);
        let stored = parameters.quantise();
        let field = stored.field.iter().zip(&parameters.field);
        let worst = field.map(|(q, v)| (f32::from(*q) - v * FIELD_STEPS).abs());
        assert!(worst.fold(0.0, f32::max) <= 0.5, "the field's limit fits a byte");
        let hinted = stored.warp_x.hinted.iter().zip(&parameters.hinted[0]);
        assert!(hinted.map(|(q, v)| (*q as f32 - v * WARP_STEPS).abs()).fold(0.0, f32::max) <= 0.5);
    }
}
