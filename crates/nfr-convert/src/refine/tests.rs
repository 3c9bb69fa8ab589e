use super::*;
use crate::compare::metrics::Sums;
use crate::cost::cost;
use crate::fit::initial_fit;
use crate::fixtures::glyph_samples;
use crate::options::Capacity;
use nfr::Bitmap;
use nfr::Target;
use nfr::internals::Scratch;

fn initial_weights(samples: &GlyphSamples, scale: Scale, target: Target) -> Weights {
    let mut weights = initial_fit(samples, scale, target, Capacity::default(), 1).quantise();
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

fn mae(samples: &GlyphSamples, weights: &Weights, scale: Scale) -> f64 {
    let model = GridFit::new(weights, scale).unwrap();
    let mut sums = Sums::default();
    samples.sizes.iter().for_each(|s| sums.add(&s.bitmap, &draw(&model, f32::from(s.ppem))));
    sums.mae()
}

/// The largest share of the initial error after a round.
const REMAINING: f64 = 0.9;

#[test]
fn a_round_lowers_the_error() {
    for target in [Target::Smooth, Target::Mono] {
        let (glyphs, scale) = glyph_samples("g", target);
        let before = initial_weights(&glyphs[0], scale, target);
        let mut after = before.clone();
        refine(&mut after, &glyphs[0], scale, Refinement { rounds: 1, error_per_bit: 0.0 }).unwrap();
        let (before, after) = (mae(&glyphs[0], &before, scale), mae(&glyphs[0], &after, scale));
        assert!(after < before * REMAINING, "{target}: {before} to {after}");
    }
}

#[test]
fn a_higher_price_of_bits_saves_bits() {
    let (glyphs, scale) = glyph_samples("g", Target::Smooth);
    let start = initial_weights(&glyphs[0], scale, Target::Smooth);
    let bits = |error_per_bit: f64| {
        let mut weights = start.clone();
        refine(&mut weights, &glyphs[0], scale, Refinement { rounds: 1, error_per_bit }).unwrap();
        cost(&weights, scale).unwrap().total()
    };
    assert!(bits(0.1) < 0.95 * bits(0.0));
}

#[test]
fn the_price_of_a_section_is_its_share_of_the_whole_message() {
    let (glyphs, scale) = glyph_samples("g", Target::Mono);
    let mut weights = initial_weights(&glyphs[0], scale, Target::Mono);
    let (before, whole) = (weights.clone(), cost(&weights, scale).unwrap());
    for (section, bits) in [
        (Section::Header, whole.header),
        (Section::Warp, whole.warp),
        (Section::Field, whole.field),
        (Section::Patterns, whole.patterns),
        (Section::Embedding, whole.embedding),
    ] {
        let alone = section_bits(&mut weights, scale, section).unwrap();
        assert!((alone - bits).abs() < 1e-6 && bits > 0.0, "{section:?}: {alone} for {bits}");
    }
    assert_eq!(weights, before);
}

/// Changing a model's weights one by one is the same as making a model of the changed weights.
#[test]
fn a_changed_model_is_the_model_of_the_changed_weights() {
    for target in [Target::Smooth, Target::Mono] {
        let (glyphs, scale) = glyph_samples("g", target);
        let mut weights = initial_weights(&glyphs[0], scale, target);
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
        assert!(differ > 5, "few of the changes change a bitmap: {differ}");
    }
}

#[test]
fn no_rounds_and_no_ink_change_nothing() {
    let (glyphs, scale) = glyph_samples("g", Target::Smooth);
    let start = initial_weights(&glyphs[0], scale, Target::Smooth);
    let mut weights = start.clone();
    refine(&mut weights, &glyphs[0], scale, Refinement { rounds: 0, ..Refinement::default() }).unwrap();
    assert_eq!(weights, start);
    let mut blank = Weights::default();
    refine(&mut blank, &glyphs[0], scale, Refinement::default()).unwrap();
    assert_eq!(blank, Weights::default());
}
