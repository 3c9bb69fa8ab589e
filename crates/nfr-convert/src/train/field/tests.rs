use super::super::beyond::extended;
use super::twin::Twin;
use super::*;
use crate::samples::lessons;
use crate::start::Capacity;
use crate::teach::Lesson;
use crate::train::batch::GROUPS;
use nfr::Target;
use nfr::internals::model::gridfit::{GridFit, Scale, Weights};
use nfr::{Bitmap, Placement};

/// Bitmaps have whole levels: half of one.
const ROUNDING: f32 = 0.5 / 255.0;
/// How far single precision may take the two apart, in a different order of operations.
const PRECISION: f32 = 1e-3;

/// A lesson that shows what the twin draws, border included, instead of what the teacher draws.
fn own_lesson(lesson: &Lesson, weights: &Weights, scale: Scale) -> Lesson {
    let mut lesson = lesson.clone();
    let model = GridFit::new(weights, scale).unwrap();
    for hinted in &mut lesson.sizes {
        let ppem = f32::from(hinted.ppem);
        let p = model.placement(ppem).unwrap();
        let placement =
            Placement { left: p.left - 4, top: p.top + 4, width: p.width + 8, height: p.height + 8 };
        let twin = Twin { weights, scale, ppem: ppem.into() };
        let pixels = twin.draw(placement).iter().map(|level| level.round() as u8).collect();
        hinted.bitmap = Bitmap { placement, pixels };
    }
    lesson
}

/// Moves the deformation away from nothing.
fn shake(draft: &mut Draft) {
    for (k, v) in draft.embedding.iter_mut().enumerate() {
        *v = (k % 17) as f32 / 32.0 - 0.25;
    }
}

/// The largest difference of a pixel between what training evaluates and the twin, and the number
/// of pixels.
fn largest_difference(text: &str, target: Target) -> (f32, usize) {
    let device = Device::flex();
    let (lessons, scale) = lessons(text, target);
    let mut drafts: Vec<Draft> =
        lessons.iter().map(|l| Draft::from_lesson(l, scale, target, Capacity::default(), 1)).collect();
    drafts.iter_mut().for_each(shake);
    let stored: Vec<Weights> = drafts.iter().map(Draft::quantise).collect();
    let models: Vec<GridFit> = stored.iter().map(|w| GridFit::new(w, scale).unwrap()).collect();
    let units = f32::from(scale.units_per_em());
    let (lessons, drafts): (Vec<Lesson>, Vec<Draft>) =
        lessons.iter().zip(&drafts).map(|(l, d)| extended(l, d, units).unwrap()).unzip();
    let lessons: Vec<Lesson> = lessons.iter().zip(&stored).map(|(l, w)| own_lesson(l, w, scale)).collect();
    let extent = Extent::of(&drafts, lessons[0].sizes.len());
    assert!(extent.sizes > scale.sizes(), "plain sizes are evaluated, too");
    let learnt = Learnt::new(scale.sizes(), extent, &device);
    let weights = Parameters::from_drafts(&drafts, extent, &device).rounded(&learnt).ordered(extent);
    let (mut largest, mut pixels) = (0.0f32, 0);
    for k in 0..GROUPS {
        let group = Group::new(&lessons, &drafts, &models, units, extent, k, &device).unwrap();
        let basis = column_basis(&group.columns, &weights.hinted[0], extent);
        let columns = contract(&basis, &group.columns, &weights, extent);
        let coverage = draw(&columns, &group.rows, &weights.hinted[1], &group.samples).coverage;
        let coverage = values(&coverage);
        let target = values(&group.samples.target);
        let mut target = target.iter();
        for &(first, count, each) in &group.samples.runs {
            for (samples, target) in coverage[first..first + count * each].chunks(each).zip(&mut target) {
                let drawn = samples.iter().sum::<f32>() / each as f32;
                largest = largest.max((drawn - target).abs());
                pixels += 1;
            }
        }
    }
    (largest, pixels)
}

#[test]
fn training_evaluates_what_the_twin_does() {
    let (largest, pixels) = largest_difference("agiRW%.", Target::Smooth);
    assert!(pixels > 10_000);
    assert!(largest <= ROUNDING + PRECISION, "{largest}");
}

#[test]
fn training_evaluates_what_the_twin_does_with_a_warp_in_x_too() {
    let (largest, pixels) = largest_difference("agiRW%.", Target::Mono);
    assert!(pixels > 10_000);
    assert!(largest <= ROUNDING + PRECISION, "{largest}");
}

#[test]
fn weights_survive_the_way_into_tensors_and_back() {
    let (lessons, scale) = lessons("g.W", Target::Mono);
    let mut drafts: Vec<Draft> =
        lessons.iter().map(|l| Draft::from_lesson(l, scale, Target::Mono, Capacity::default(), 1)).collect();
    drafts.iter_mut().for_each(shake);
    let before = drafts.clone();
    let extent = Extent::of(&drafts, scale.sizes());
    let weights = Parameters::from_drafts(&drafts, extent, &Device::flex());
    drafts.iter_mut().for_each(|d| *d = Draft { field: vec![0.0; d.field.len()], ..d.clone() });
    weights.store(&mut drafts, extent);
    assert_eq!(drafts, before);
}
