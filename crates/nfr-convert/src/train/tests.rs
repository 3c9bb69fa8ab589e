use super::*;
use crate::compare::metrics::Sums;
use crate::fit::initial_fit;
use crate::fixtures::glyph_samples;
use crate::options::Capacity;
use crate::teacher::Outline;
use crate::training_samples::TrainingSample;
use nfr::Target;
use nfr::internals::Scratch;
use nfr::internals::model::gridfit::GridFit;
use nfr::{Bitmap, Placement};
use skrifa::PathSink;

fn initial(glyphs: &[GlyphSamples], scale: Scale, target: Target) -> Vec<Parameters> {
    glyphs.iter().map(|samples| initial_fit(samples, scale, target, Capacity::default(), 1)).collect()
}

/// The mean absolute error of what would be stored.
fn mae(samples: &GlyphSamples, parameters: &Parameters, scale: Scale) -> f64 {
    let model = GridFit::new(&parameters.quantise(), scale).unwrap();
    let mut sums = Sums::default();
    for sample in &samples.sizes {
        let ppem = f32::from(sample.ppem);
        let placement = model.placement(ppem).unwrap();
        let mut pixels = vec![0; placement.area()];
        model.draw(ppem, placement, &mut Scratch::default(), &mut pixels).unwrap();
        sums.add(&sample.bitmap, &Bitmap { placement, pixels });
    }
    sums.mae()
}

fn trained(glyphs: &[GlyphSamples], scale: Scale, target: Target, steps: usize) -> Vec<Parameters> {
    let mut parameters = initial(glyphs, scale, target);
    let schedule = Schedule { steps, ..Schedule::default() };
    train(&glyphs.iter().collect::<Vec<_>>(), &mut parameters, scale, schedule, Backend::default()).unwrap();
    parameters
}

/// The largest share of the initial error after `STEPS` steps.
const REMAINING: f64 = 0.7;
const STEPS: usize = 60;

#[test]
fn training_lowers_every_glyphs_error() {
    for target in [Target::Smooth, Target::Mono] {
        let (glyphs, scale) = glyph_samples("agR", target);
        let before = initial(&glyphs, scale, target);
        let after = trained(&glyphs, scale, target, STEPS);
        for ((samples, before), after) in glyphs.iter().zip(&before).zip(&after) {
            let (before, after) = (mae(samples, before, scale), mae(samples, after, scale));
            assert!(after < before * REMAINING, "{target} glyph {}: {before} to {after}", samples.gid);
        }
    }
}

#[test]
fn training_is_reproducible() {
    let (glyphs, scale) = glyph_samples("gi", Target::Smooth);
    assert_eq!(trained(&glyphs, scale, Target::Smooth, 20), trained(&glyphs, scale, Target::Smooth, 20));
}

/// Sums over other lengths round differently. Where there is hardly any gradient Adam turns that into whole steps, so
/// that some numbers drift apart. Half of them drift by no more than this share of how far half of them move.
const DRIFT: f32 = 0.1;
/// Every group of sizes has one turn.
const ONE_ROUND: usize = GROUPS;

#[test]
fn glyphs_that_are_trained_together_do_not_influence_each_other() {
    let (glyphs, scale) = glyph_samples("g.W", Target::Smooth);
    // The gradient of the smoothness penalty changes its sign where a field is smooth, which causes drift too; the penalty
    // has a test of its own.
    let trained = |glyphs: &[GlyphSamples]| {
        let mut parameters = initial(glyphs, scale, Target::Smooth);
        let schedule = Schedule { steps: ONE_ROUND, smoothness: 0.0, ..Schedule::default() };
        let glyphs: Vec<_> = glyphs.iter().collect();
        train(&glyphs, &mut parameters, scale, schedule, Backend::default()).unwrap();
        parameters
    };
    let together = trained(&glyphs);
    let start = initial(&glyphs, scale, Target::Smooth);
    for ((samples, together), start) in glyphs.iter().zip(&together).zip(&start) {
        let alone = &trained(std::slice::from_ref(samples))[0];
        let far = |a: &[f32], b: &[f32]| {
            let mut far: Vec<f32> = a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect();
            far.sort_by(f32::total_cmp);
            far[far.len() / 2]
        };
        let drift = [far(&together.field, &alone.field), far(&together.hinted[1], &alone.hinted[1])];
        let moved = [far(&together.field, &start.field), far(&together.hinted[1], &start.hinted[1])];
        for (drift, moved) in drift.into_iter().zip(moved) {
            assert!(drift < DRIFT * moved, "glyph {}: {drift} of {moved}", samples.gid);
        }
    }
}

#[test]
fn no_steps_leave_the_initial_fit() {
    let (glyphs, scale) = glyph_samples("g", Target::Smooth);
    assert_eq!(trained(&glyphs, scale, Target::Smooth, 0), initial(&glyphs, scale, Target::Smooth));
}

#[test]
fn any_number_of_sizes_is_trained() {
    for count in 1..=9 {
        let (mut glyphs, scale) = glyph_samples("g.", Target::Smooth);
        glyphs.iter_mut().for_each(|samples| samples.sizes.truncate(count));
        let scale =
            Scale::new(scale.units_per_em(), scale.first_ppem(), scale.first_ppem() + count as u16 - 1)
                .unwrap();
        let (before, after) =
            (initial(&glyphs, scale, Target::Smooth), trained(&glyphs, scale, Target::Smooth, STEPS));
        let (before, after) = (mae(&glyphs[0], &before[0], scale), mae(&glyphs[0], &after[0], scale));
        assert!(after < before * REMAINING, "{count} sizes: {before} to {after}");
    }
}

#[test]
fn an_outline_without_height_is_trained_too() {
    let mut outline = Outline::default();
    outline.move_to(0.0, 0.25);
    outline.line_to(0.5, 0.25);
    outline.close();
    let scale = Scale::new(1000, 8, 9).unwrap();
    let hinted = |ppem: u16| {
        let points = outline.points.iter().map(|p| p.map(|v| v * f32::from(ppem))).collect();
        let placement = Placement { left: 0, top: 3, width: 4, height: 1 };
        TrainingSample {
            advance: None,
            dropout: Default::default(),
            ppem,
            points,
            bitmap: Bitmap { placement, pixels: vec![0, 0, 9, 0] },
            predicted: false,
        }
    };
    let sizes = vec![hinted(8), hinted(9)];
    let samples =
        GlyphSamples { gid: 1, outline: outline.clone(), hint_error: None, contours_change: false, sizes };
    let parameters = trained(&[samples], scale, Target::Smooth, 3);
    assert_eq!(parameters[0].knots[1], [250]);
}
