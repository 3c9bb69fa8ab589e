use super::*;
use crate::compare::metrics::Sums;
use crate::convert::samples::lessons;
use crate::convert::start::{Capacity, Draft};
use crate::model::Target;
use crate::model::gridfit::Scratch;
use crate::render::{Bitmap, Placement};

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
    model.draw(ppem, placement, &mut Scratch::default(), &mut pixels);
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

/// The parts that are drawn again hold every pixel that a change of a number changes.
#[test]
fn nothing_changes_outside_the_regions_of_a_number() {
    for target in [Target::Smooth, Target::Mono] {
        let (lessons, scale) = lessons("g", target);
        let weights = first_guess(&lessons[0], scale, target);
        let model = GridFit::new(&weights, scale).unwrap();
        let judge = Judge::new(&lessons[0]);
        let stride = usize::from(weights.cells[0]) + 2;
        let mut seen = 0;
        let parts = |regions: Regions| match regions {
            Regions::Parts(parts, _) => parts,
            Regions::Whole(_) => Vec::new(),
        };
        // Two rounds look at all sizes.
        let around = |model: &GridFit, reach: [[f32; 2]; 2]| {
            let round = |round: usize| parts(judge.around(model, reach, round, |_| true).unwrap());
            [round(0), round(1)].concat()
        };
        let mut hold = |changed: &GridFit, parts: &[(usize, Placement)], what: &str| {
            for (size, hinted) in lessons[0].sizes.iter().enumerate() {
                let ppem = f32::from(hinted.ppem);
                let (a, b) = (draw(&model, ppem), draw(changed, ppem));
                assert_eq!(a.placement, b.placement);
                let place = a.placement;
                for (at, _) in a.pixels.iter().zip(&b.pixels).enumerate().filter(|(_, (a, b))| a != b) {
                    seen += 1;
                    let (i, j) = (at as i32 % place.width as i32, at as i32 / place.width as i32);
                    let (x, y) = (place.left + i, place.top - 1 - j);
                    let inside = parts.iter().any(|(s, p)| {
                        let columns = p.left..p.left + p.width as i32;
                        *s == size && columns.contains(&x) && y < p.top && y >= p.top - p.height as i32
                    });
                    assert!(inside, "{target}: {what} changes ({x}, {y}) at {ppem} ppem");
                }
            }
        };
        for at in (0..weights.field.len()).step_by(5) {
            let mut changed = model.clone();
            changed.set_field(at, weights.field[at].saturating_sub(40));
            let reach =
                [changed.coefficient_reach(0, at % stride), changed.coefficient_reach(1, at / stride)];
            hold(&changed, &around(&model, reach), &format!("coefficient {at}"));
        }
        for node in 0..NODES {
            let mut changed = model.clone();
            changed.set_pattern(node, weights.patterns[node].saturating_add(9));
            let reach = [changed.node_reach(0, node % 8), changed.node_reach(1, node / 8)];
            // A node may be looked up from as far as it moves look-ups itself.
            hold(&changed, &around(&changed, reach), &format!("node {node}"));
        }
        for (axis, warp) in [&weights.warp_x, &weights.warp_y].into_iter().enumerate() {
            let count = warp.knots.len();
            for at in (0..warp.hinted.len()).filter(|at| at % count > 0 && at % count + 1 < count) {
                let (low, high) = (warp.hinted[at - 1], warp.hinted[at + 1]);
                if !(low..high).contains(&warp.hinted[at]) {
                    continue;
                }
                let mut changed = model.clone();
                changed.set_hinted(axis, at / count, at % count, i32::midpoint(low, high));
                let pixel = |h: i32| h as f32 / WARP_STEPS;
                let regions = judge.between(&model, at / count, axis, pixel(low), pixel(high)).unwrap();
                hold(&changed, &parts(regions), &format!("position {at}"));
            }
        }
        assert!(seen > 1000, "the changes are worth looking at: {seen} pixels");
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
