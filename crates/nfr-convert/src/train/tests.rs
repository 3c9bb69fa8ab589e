use super::*;
use crate::compare::metrics::Sums;
use crate::outline::Outline;
use crate::samples::lessons;
use crate::start::Capacity;
use crate::teach::HintedGlyph;
use nfr::Target;
use nfr::internals::Scratch;
use nfr::internals::model::gridfit::GridFit;
use nfr::{Bitmap, Placement};
use skrifa::outline::OutlinePen;

fn drafts(lessons: &[Lesson], scale: Scale, target: Target) -> Vec<Draft> {
    lessons.iter().map(|l| Draft::from_lesson(l, scale, target, Capacity::default(), 1)).collect()
}

/// The mean absolute error of what would be stored.
fn mae(lesson: &Lesson, draft: &Draft, scale: Scale) -> f64 {
    let model = GridFit::new(&draft.quantise(), scale).unwrap();
    let mut sums = Sums::default();
    for hinted in &lesson.sizes {
        let ppem = f32::from(hinted.ppem);
        let placement = model.placement(ppem).unwrap();
        let mut pixels = vec![0; placement.area()];
        model.draw(ppem, placement, &mut Scratch::default(), &mut pixels).unwrap();
        sums.add(&hinted.bitmap, &Bitmap { placement, pixels });
    }
    sums.mae()
}

fn trained(lessons: &[Lesson], scale: Scale, target: Target, steps: usize) -> Vec<Draft> {
    let mut drafts = drafts(lessons, scale, target);
    let schedule = Schedule { steps, ..Schedule::default() };
    train(&lessons.iter().collect::<Vec<_>>(), &mut drafts, scale, schedule, Backend::default()).unwrap();
    drafts
}

/// So much of the first guess's error is left, at most, after `STEPS` steps.
const LEFT: f64 = 0.7;
const STEPS: usize = 60;

#[test]
fn training_lowers_every_glyphs_error() {
    for target in [Target::Smooth, Target::Mono] {
        let (lessons, scale) = lessons("agR", target);
        let before = drafts(&lessons, scale, target);
        let after = trained(&lessons, scale, target, STEPS);
        for ((lesson, before), after) in lessons.iter().zip(&before).zip(&after) {
            let (before, after) = (mae(lesson, before, scale), mae(lesson, after, scale));
            assert!(after < before * LEFT, "{target} glyph {}: {before} to {after}", lesson.gid);
        }
    }
}

#[test]
fn training_is_reproducible() {
    let (lessons, scale) = lessons("gi", Target::Smooth);
    assert_eq!(trained(&lessons, scale, Target::Smooth, 20), trained(&lessons, scale, Target::Smooth, 20));
}

/// Sums over other lengths round differently. Where there is hardly any gradient Adam turns that into whole steps, so
/// that some numbers drift apart. Half of them drift by no more than this share of how far half of them move.
const DRIFT: f32 = 0.1;
/// Every group of sizes comes by once.
const ONE_ROUND: usize = GROUPS;

#[test]
fn glyphs_that_are_trained_together_do_not_influence_each_other() {
    let (lessons, scale) = lessons("g.W", Target::Smooth);
    // The pull on rough fields turns round where a field is smooth, which drifts too; it has a test of its own.
    let trained = |lessons: &[Lesson]| {
        let mut drafts = drafts(lessons, scale, Target::Smooth);
        let schedule = Schedule { steps: ONE_ROUND, smoothness: 0.0, ..Schedule::default() };
        let lessons: Vec<_> = lessons.iter().collect();
        train(&lessons, &mut drafts, scale, schedule, Backend::default()).unwrap();
        drafts
    };
    let together = trained(&lessons);
    let start = drafts(&lessons, scale, Target::Smooth);
    for ((lesson, together), start) in lessons.iter().zip(&together).zip(&start) {
        let alone = &trained(std::slice::from_ref(lesson))[0];
        let far = |a: &[f32], b: &[f32]| {
            let mut far: Vec<f32> = a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect();
            far.sort_by(f32::total_cmp);
            far[far.len() / 2]
        };
        let drift = [far(&together.field, &alone.field), far(&together.hinted[1], &alone.hinted[1])];
        let moved = [far(&together.field, &start.field), far(&together.hinted[1], &start.hinted[1])];
        for (drift, moved) in drift.into_iter().zip(moved) {
            assert!(drift < DRIFT * moved, "glyph {}: {drift} of {moved}", lesson.gid);
        }
    }
}

#[test]
fn no_steps_leave_the_first_guess() {
    let (lessons, scale) = lessons("g", Target::Smooth);
    assert_eq!(trained(&lessons, scale, Target::Smooth, 0), drafts(&lessons, scale, Target::Smooth));
}

#[test]
fn any_number_of_sizes_is_trained() {
    for count in 1..=9 {
        let (mut lessons, scale) = lessons("g.", Target::Smooth);
        lessons.iter_mut().for_each(|l| l.sizes.truncate(count));
        let scale =
            Scale::new(scale.units_per_em(), scale.first_ppem(), scale.first_ppem() + count as u16 - 1)
                .unwrap();
        let (before, after) =
            (drafts(&lessons, scale, Target::Smooth), trained(&lessons, scale, Target::Smooth, STEPS));
        let (before, after) = (mae(&lessons[0], &before[0], scale), mae(&lessons[0], &after[0], scale));
        assert!(after < before * LEFT, "{count} sizes: {before} to {after}");
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
        HintedGlyph { ppem, points, bitmap: Bitmap { placement, pixels: vec![0, 0, 9, 0] }, predicted: false }
    };
    let sizes = vec![hinted(8), hinted(9)];
    let lesson = Lesson { gid: 1, outline: outline.clone(), complaint: None, sizes };
    let drafts = trained(&[lesson], scale, Target::Smooth, 3);
    assert_eq!(drafts[0].knots[1], [250]);
}
