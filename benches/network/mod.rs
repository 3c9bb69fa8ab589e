//! A network of random numbers.

use nfr::internals::network::{Architecture, Dense, NORMS, NetworkSize, NetworkWeights, Norm};

/// A network whose numbers look random, with a size for each ppem, in a box two pixels wider that it fills but for a
/// border of one pixel.
pub(crate) fn network(architecture: Architecture, ppems: &[u16], seed: u64) -> NetworkWeights {
    let mut state = seed;
    let mut noise = |scale: f32| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) as f32 / 8_388_608.0 - 1.0) * scale
    };
    let dense = architecture.layers().into_iter().map(|(inputs, outputs)| Dense {
        inputs,
        outputs,
        weights: (0..inputs * outputs).map(|_| noise((3.0 / inputs as f32).sqrt())).collect(),
        bias: (0..outputs).map(|_| noise(0.5)).collect(),
    });
    let dense = dense.collect();
    let mut features = |least: f32| (0..architecture.width).map(|_| least + noise(1.0)).collect::<Vec<_>>();
    let norms = (0..NORMS).map(|_| Norm { gamma: features(1.0), beta: features(0.0) }).collect();
    let size = |&ppem: &u16| {
        let side = ppem as u8 + 2;
        NetworkSize { ppem, side, origin: [2, i16::from(side) - 3], crop: [1, 1, side - 2, side - 2] }
    };
    NetworkWeights { architecture, sizes: ppems.iter().map(size).collect(), dense, norms }
}
