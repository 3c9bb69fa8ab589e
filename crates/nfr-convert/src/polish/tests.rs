use super::*;
use crate::compare::metrics::Sums;
use crate::samples::lessons;
use crate::start::{Capacity, Draft};
use nfr::Bitmap;
use nfr::Target;
use nfr::internals::Scratch;

fn first_guess(lesson: &Lesson, scale: Scale, target: Target) -> Weights {
    let mut weights = Draft::from_lesson(lesson, scale, target, Capacity::default(), 1).quantise();
    // Patterns need weights, or none of their nodes can be tried.
    let rank = usize::from(weights.rank);
    weights.embedding.iter_mut().step_by(rank.max(1)).for_each(|weight| *weight = 3);
    weights
}

fn draw(model: &GridFit, ppem: f32) -> Bitmap {
    let placement = model.placement(ppem).unwrap();
    let mut pixels = vec![0; placement.area()];
    model.draw(ppem, placement, &mut Scratch::default(), &mut pixels).unwrap();
    Bitmap { placement, pixels }
}

fn mae(lesson: &Lesson, weights: &Weights, scale: Scale) -> f64 {
    let model = GridFit::new(weights, scale).unwrap();
    let mut sums = Sums::default();
    lesson.sizes.iter().for_each(|s| sums.add(&s.bitmap, &draw(&model, f32::from(s.ppem))));
    sums.mae()
}

/// So much of the first guess's error is left after a round, at most.
const LEFT: f64 = 0.9;

#[test]
fn a_round_lowers_the_error() {
    for target in [Target::Smooth, Target::Mono] {
        let (lessons, scale) = lessons("g", target);
        let before = first_guess(&lessons[0], scale, target);
        let mut after = before.clone();
        polish(&mut after, &lessons[0], scale, Polish { rounds: 1, bit_worth: 0.0 }).unwrap();
        let (before, after) = (mae(&lessons[0], &before, scale), mae(&lessons[0], &after, scale));
        assert!(after < before * LEFT, "{target}: {before} to {after}");
    }
}

#[test]
fn dear_bits_are_saved() {
    let (lessons, scale) = lessons("g", Target::Smooth);
    let start = first_guess(&lessons[0], scale, Target::Smooth);
    let polished = |bit_worth: f64| {
        let mut weights = start.clone();
        polish(&mut weights, &lessons[0], scale, Polish { rounds: 1, bit_worth }).unwrap();
        let rate = WarpRate::new(&weights.warp_y, scale);
        let count = weights.warp_y.knots.len();
        let warp = (0..weights.warp_y.hinted.len())
            .map(|at| rate.bits(&weights.warp_y.hinted, at / count, at % count));
        let plane = Plane { values: &weights.field, stride: usize::from(weights.cells[0]) + 2 };
        warp.sum::<f64>() + (0..weights.field.len()).map(|at| plane.bits(at)).sum::<f64>()
    };
    assert!(polished(0.1) < 0.95 * polished(0.0));
}

/// A model whose numbers are changed one by one draws what one made of the changed numbers does.
#[test]
fn a_changed_model_is_the_model_of_the_changed_weights() {
    for target in [Target::Smooth, Target::Mono] {
        let (lessons, scale) = lessons("g", target);
        let mut weights = first_guess(&lessons[0], scale, target);
        let mut model = GridFit::new(&weights, scale).unwrap();
        let mut differ = 0;
        for k in 0..40 {
            let before = draw(&model, 12.0);
            let pick = |len: usize| k * 37 % len;
            match k % 4 {
                0 => {
                    let at = pick(weights.field.len());
                    weights.field[at] = weights.field[at].saturating_sub(40);
                    model.set_field(at, weights.field[at]);
                }
                1 => {
                    let at = pick(weights.patterns.len());
                    weights.patterns[at] = weights.patterns[at].saturating_add(9);
                    model.set_pattern(at, weights.patterns[at]);
                }
                2 => {
                    let (at, rank) = (pick(weights.embedding.len()), usize::from(weights.rank));
                    weights.embedding[at] = weights.embedding[at].saturating_add(5);
                    model.set_embedding(at / rank, at % rank, weights.embedding[at]);
                }
                _ => {
                    let (at, count) = (pick(weights.warp_y.hinted.len()), weights.warp_y.knots.len());
                    weights.warp_y.hinted[at] += 7;
                    model.set_hinted(1, at / count, at % count, weights.warp_y.hinted[at]);
                }
            }
            differ += usize::from(draw(&model, 12.0) != before);
            let fresh = GridFit::new(&weights, scale).unwrap();
            for ppem in [8.0, 12.0, 20.0, 33.0, 64.0] {
                assert_eq!(draw(&model, ppem), draw(&fresh, ppem), "{target}: change {k} at {ppem} ppem");
            }
        }
        assert!(differ > 5, "the changes are worth looking at: {differ}");
    }
}

#[test]
fn no_rounds_and_no_ink_change_nothing() {
    let (lessons, scale) = lessons("g", Target::Smooth);
    let start = first_guess(&lessons[0], scale, Target::Smooth);
    let mut weights = start.clone();
    polish(&mut weights, &lessons[0], scale, Polish { rounds: 0, ..Polish::default() }).unwrap();
    assert_eq!(weights, start);
    let mut blank = Weights::default();
    polish(&mut blank, &lessons[0], scale, Polish::default()).unwrap();
    assert_eq!(blank, Weights::default());
}
