//! The evaluation against a twin that goes pixel by pixel, and against hand-made networks.

use proptest::prelude::*;

use super::encoding::tanh;
use super::*;
use crate::constants::MAX_TRAINED_PPEM;
use crate::error::Damage;

/// Numbers that look random, from −1 to 1.
fn noise(seed: u64) -> impl FnMut() -> f32 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) as f32 - 8_388_608.0) / 8_388_608.0
    }
}

/// A network of noise, whose features stay of an ordinary size.
fn noisy(architecture: Architecture, sides: &[u8], seed: u64) -> NetworkWeights {
    let mut noise = noise(seed);
    let mut some = |count: usize, scale: f32| (0..count).map(|_| noise() * scale).collect::<Vec<f32>>();
    let layers = architecture.layers().into_iter();
    let dense = layers.map(|(inputs, outputs)| Dense {
        inputs,
        outputs,
        weights: some(inputs * outputs, (3.0 / inputs as f32).sqrt()),
        bias: some(outputs, 0.5),
    });
    let dense = dense.collect();
    let width = usize::from(architecture.width);
    let norms = (0..NORMS).map(|_| Norm { gamma: some(width, 2.0), beta: some(width, 1.0) }).collect();
    let size = |&side: &u8| NetworkSize {
        ppem: side.into(),
        side,
        origin: [0, side.into()],
        crop: [0, 0, side, side],
    };
    NetworkWeights { architecture, sizes: sides.iter().map(size).collect(), dense, norms }
}

fn sum(dense: &Dense, inputs: std::ops::Range<usize>, x: &[f32], output: usize) -> f32 {
    inputs.zip(x).fold(0.0, |sum, (input, x)| sum + x * dense.weights[input * dense.outputs + output])
}

fn positive(value: f32) -> f32 {
    if value > 0.0 { value } else { 0.0 }
}

/// Σ + b of all outputs.
fn affine(dense: &Dense, x: &[f32]) -> Vec<f32> {
    (0..dense.outputs).map(|output| sum(dense, 0..dense.inputs, x, output) + dense.bias[output]).collect()
}

/// The scores of all pixels, as the specification has them, number by number.
fn twin(weights: &NetworkWeights, index: usize) -> Vec<[f32; CLASSES]> {
    let architecture = &weights.architecture;
    let side = usize::from(weights.sizes[index].side);
    let (encoder, trunk) = weights.dense.split_at(weights.dense.len() - TRUNK_LAYERS);
    let mut latent = Vec::new();
    if let Some((last, layers)) = encoder.split_last() {
        latent = condition(architecture, index, weights.sizes.len());
        for dense in layers {
            latent = affine(dense, &latent).into_iter().map(positive).collect();
        }
        latent = affine(last, &latent).into_iter().map(|v| tanh(f64::from(v)) as f32).collect();
    }
    let mut pixels: Vec<Vec<f32>> =
        (0..side * side).map(|p| positions(architecture, p / side, p % side, side)).collect();
    for (number, dense) in trunk.iter().enumerate() {
        let residual = architecture.residual && (2..=10).contains(&number) && number != 5;
        for x in &mut pixels {
            let own = if number == 0 || number == 5 { dense.inputs - latent.len() } else { dense.inputs };
            let outputs = (0..dense.outputs).map(|output| {
                let base = sum(dense, own..dense.inputs, &latent, output) + dense.bias[output];
                let sum = sum(dense, 0..own, x, output)
                    + if own < dense.inputs { base } else { dense.bias[output] };
                match number {
                    11 => sum,
                    _ if residual => x[output] + positive(sum),
                    _ => positive(sum),
                }
            });
            *x = outputs.collect();
        }
        if let Some(norm) = [1, 4, 8].iter().position(|behind| *behind == number) {
            twin_norm(&weights.norms[norm], &mut pixels);
        }
    }
    pixels.into_iter().map(|x| x.try_into().unwrap()).collect()
}

fn twin_norm(norm: &Norm, pixels: &mut [Vec<f32>]) {
    let count = pixels.len() as f64;
    for feature in 0..norm.gamma.len() {
        let values = || pixels.iter().map(|x| f64::from(x[feature]));
        let mean = values().fold(0.0, |sum, v| sum + v) / count;
        let variance = values().fold(0.0, |sum, v| sum + (v - mean) * (v - mean)) / count;
        let scale = (f64::from(norm.gamma[feature]) / (variance + 1e-3).sqrt()) as f32;
        for x in pixels.iter_mut() {
            x[feature] = (x[feature] - mean as f32) * scale + norm.beta[feature];
        }
    }
}

fn bits(scores: &[[f32; CLASSES]]) -> Vec<u32> {
    // One that is not a number may be any such.
    scores.iter().flatten().map(|s| if s.is_nan() { u32::MAX } else { s.to_bits() }).collect()
}

fn architecture() -> impl Strategy<Value = Architecture> {
    (1u16..40, 0u16..12, 1u16..10, any::<[bool; 2]>()).prop_map(
        |(width, latent, encoder, [frequencies, residual])| Architecture {
            width,
            latent,
            encoder,
            frequencies,
            residual,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(48) })]

    #[test]
    fn blocks_and_lanes_draw_the_same_bits_as_pixel_by_pixel(
        architecture in architecture(), sides in [1u8..12, 12..27], seed in any::<u64>(), loud in 0..4,
    ) {
        let mut weights = noisy(architecture, &sides, seed);
        if loud == 0 {
            // Large enough that sums become infinite, and differences no numbers.
            weights.dense[0].weights.iter_mut().for_each(|w| *w = w.clamp(-1.0, 1.0) * 3e38);
        }
        let network = Network::new(weights.clone()).unwrap();
        for index in 0..2 {
            prop_assert_eq!(bits(&network.scores(index).unwrap()), bits(&twin(&weights, index)));
        }
    }
}

/// A network all of whose numbers are 0.
fn zero(architecture: Architecture, sides: &[u8]) -> NetworkWeights {
    let mut weights = noisy(architecture, sides, 1);
    let dense = weights.dense.iter_mut().flat_map(|dense| [&mut dense.weights, &mut dense.bias]);
    let norms = weights.norms.iter_mut().flat_map(|norm| [&mut norm.gamma, &mut norm.beta]);
    dense.chain(norms).for_each(|numbers| numbers.fill(0.0));
    weights
}

const TINY: Architecture =
    Architecture { width: 1, latent: 0, encoder: 0, frequencies: false, residual: true };

#[test]
fn a_network_of_one_feature_does_as_computed_by_hand() {
    let mut weights = zero(TINY, &[2]);
    // relu(y + 2x) of the pixels (−½, −½), (−½, ½), (½, −½), (½, ½): 0, ½, 0, 1½. The next layer doubles: 0, 1, 0, 3.
    weights.dense[0].weights = vec![1.0, 2.0];
    weights.dense[1].weights = vec![2.0];
    // Mean 1, variance 1.5.
    weights.norms[0] = Norm { gamma: vec![1.0], beta: vec![0.25] };
    // Residuals of 0 leave that as it is; norms that make it 0 and then ½.
    weights.norms[1] = Norm { gamma: vec![0.0], beta: vec![0.0] };
    weights.norms[2] = Norm { gamma: vec![0.0], beta: vec![0.5] };
    let classes = |weights: &NetworkWeights| Network::new(weights.clone()).unwrap().scores(0).unwrap();
    weights.dense[11].weights = (0..21).map(|class| class as f32).collect();
    weights.dense[11].bias[3] = 0.125;
    for scores in classes(&weights) {
        assert_eq!((scores[0], scores[3], scores[20]), (0.0, 1.625, 10.0));
    }
    // Norms of gamma 1 hand on what the first one made, once more centred: of mean 0 and variance near 1.
    for norm in &mut weights.norms {
        *norm = Norm { gamma: vec![1.0], beta: vec![0.0] };
    }
    weights.dense[5].weights = vec![1.0];
    let by_hand = |values: [f64; 4]| {
        let mean = values.iter().sum::<f64>() / 4.0;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4.0;
        values.map(|v| (v - mean) / (variance + 0.001).sqrt())
    };
    let expected = by_hand(by_hand(by_hand([0.0, 1.0, 0.0, 3.0])).map(|v| v.max(0.0)));
    for (scores, expected) in classes(&weights).iter().zip(expected) {
        assert!((f64::from(scores[1]) - expected).abs() < 1e-6, "{} for {expected}", scores[1]);
    }
}

#[test]
fn the_first_of_equal_classes_is_drawn() {
    let mut weights = zero(TINY, &[3]);
    let coverage = |weights: &NetworkWeights| Network::new(weights.clone()).unwrap().coverage(0).unwrap();
    assert_eq!(coverage(&weights), [0; 9]);
    weights.dense[11].bias[7] = 1.0;
    weights.dense[11].bias[20] = 1.0;
    assert_eq!(coverage(&weights), [89; 9]);
    weights.dense[11].bias[20] = 1.5;
    assert_eq!(coverage(&weights), [255; 9]);
}

#[test]
fn the_size_reaches_the_pixels_through_the_encoder() {
    let architecture = Architecture { width: 8, latent: 4, encoder: 6, frequencies: true, residual: true };
    // The boxes are the same: only the number of the size differs.
    let network = Network::new(noisy(architecture, &[9, 9], 5)).unwrap();
    assert_ne!(network.scores(0).unwrap(), network.scores(1).unwrap());
    assert!(network.scores(2).is_none());
}

#[test]
fn weights_that_contradict_themselves_are_refused() {
    let architecture = Architecture { width: 3, latent: 2, encoder: 2, frequencies: false, residual: false };
    let good = noisy(architecture, &[4, 5], 2);
    assert_eq!(good.check(), Ok(()));
    let refused = |change: &dyn Fn(&mut NetworkWeights)| {
        let mut weights = good.clone();
        change(&mut weights);
        Network::new(weights).err()
    };
    let wrong: [&dyn Fn(&mut NetworkWeights); 16] = [
        &|w| w.architecture.width = 0,
        &|w| w.architecture.encoder = 0,
        &|w| drop(w.dense.pop()),
        &|w| drop(w.norms.pop()),
        &|w| w.dense[4].weights.truncate(1),
        &|w| w.dense[4].bias.clear(),
        &|w| w.norms[1].beta.clear(),
        &|w| w.dense[7].inputs = 4,
        &|w| w.dense[7].weights[1] = f32::NAN,
        &|w| w.norms[2].gamma[0] = f32::INFINITY,
        &|w| w.sizes.clear(),
        &|w| w.sizes.reverse(),
        &|w| w.sizes[0].ppem = 0,
        &|w| w.sizes[0].side = 0,
        &|w| w.sizes[1].side = MAX_BOX + 1,
        &|w| w.sizes[1].crop = [2, 0, 4, 1],
    ];
    for (k, change) in wrong.iter().enumerate() {
        assert!(matches!(refused(change), Some(Damage::Malformed(_))), "{k}");
    }
    let large: [&dyn Fn(&mut NetworkWeights); 3] =
        [&|w| w.architecture.width = MAX_WIDTH + 1, &|w| w.architecture.latent = MAX_LATENT + 1, &|w| {
            w.architecture.encoder = MAX_ENCODER + 1;
        }];
    for (k, change) in large.iter().enumerate() {
        assert!(matches!(refused(change), Some(Damage::TooLarge { .. })), "{k}");
    }
}

#[test]
fn the_layers_are_those_of_the_paper() {
    let layers = |latent, frequencies| {
        Architecture { width: 50, latent, encoder: 30, frequencies, residual: true }.layers()
    };
    let plain = layers(0, true);
    assert_eq!((plain.len(), plain[0], plain[5], plain[11]), (12, (130, 50), (50, 50), (50, 21)));
    let sized = layers(40, false);
    let encoder = [(1, 30), (30, 30), (30, 30), (30, 30), (30, 30), (30, 40)];
    assert_eq!((&sized[..6], sized[6], sized[11], sized.len()), (&encoder[..], (42, 50), (90, 50), 18));
}

#[test]
fn the_specification_names_the_limits_of_networks() {
    let page = include_str!("../../spec/nfrt.md");
    for words in [
        format!("| *W*, 1 to {MAX_WIDTH}. |"),
        format!("| *E*, 0 to {MAX_LATENT}; 0:"),
        format!("| *H*, 0 to {MAX_ENCODER}, and"),
        format!("| *n*, 1 to {MAX_SIZES}. |"),
        format!("| ppem, 1 to {MAX_TRAINED_PPEM}. Of"),
        format!("in pixels, 1 to {MAX_BOX}. |"),
        format!("| Out | W | {CLASSES} | nothing |"),
        format!("the {ENCODED} numbers encode(v)"),
        format!("var + {})", norm::EPSILON),
    ] {
        assert!(page.contains(&words), "spec/nfrt.md does not say {words:?}");
    }
}
