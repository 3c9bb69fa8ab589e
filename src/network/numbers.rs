//! A network's numbers: f32 by bytes of the same significance, weights as integers with a scale for each output.

use alloc::vec;
use alloc::vec::Vec;

use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

use super::head::Head;
use super::layout::{Dense, NORMS, NetworkWeights, Norm};
use super::precision::Precision;
use crate::error::Damage;

impl Precision {
    /// The most steps either way that are written.
    fn most(self) -> f32 {
        match self {
            Self::Eight => 127.0,
            Self::Sixteen => 32767.0,
        }
    }

    /// The most steps that can be read, which are below 0.
    fn least(self) -> f32 {
        match self {
            Self::Eight => -128.0,
            Self::Sixteen => -32768.0,
        }
    }
}

/// Reads a network. What is allocated is in proportion to the numbers that the frame really holds, and these are no more
/// than the head says.
///
/// # Errors
///
/// `TooLarge` for a network that is larger than any writer makes, `Malformed` for bytes that contradict themselves.
pub fn decode(bytes: &[u8]) -> Result<NetworkWeights, Damage> {
    let (head, frame) = Head::parse(bytes)?;
    let numbers = unpack(frame, head.numbers_len())?;
    let (floats, weights) = head.counts();
    let (planes, steps) = numbers.split_at(floats * size_of::<f32>());
    let floats = joined(planes, floats)?;
    let (steps, low) = match head.precision {
        Precision::Eight => (steps, None),
        Precision::Sixteen => {
            let (high, low) = steps.split_at(weights);
            (high, Some(low))
        }
    };
    let mut numbers = Numbers { floats: &floats, steps, low, least: head.precision.least() };
    let dense =
        head.architecture.layers().into_iter().map(|layer| numbers.dense(layer)).collect::<Result<_, _>>()?;
    let width = usize::from(head.architecture.width);
    let norms =
        (0..NORMS).map(|_| Norm { gamma: numbers.floats(width), beta: numbers.floats(width) }).collect();
    Ok(NetworkWeights { architecture: head.architecture, sizes: head.sizes, dense, norms })
}

/// Unpacks a zstd frame that says itself that it holds `length` bytes, and that refers no farther back.
fn unpack(mut frame: &[u8], length: usize) -> Result<Vec<u8>, Damage> {
    let wrong = || Damage::Malformed("has numbers that cannot be unpacked");
    let mut decoder = FrameDecoder::new();
    decoder.set_max_window_size(length as u64);
    decoder.init(&mut frame).map_err(|_| wrong())?;
    if decoder.content_size() != length as u64 {
        return Err(Damage::Malformed("has not as many numbers as its shape needs"));
    }
    let mut plain = Vec::new();
    while !decoder.is_finished() {
        // A block unpacks to 128 KiB at most, so a frame that holds more than it says is noticed soon.
        decoder.decode_blocks(&mut frame, BlockDecodingStrategy::UptoBlocks(1)).map_err(|_| wrong())?;
        decoder.collect_to_writer(&mut plain).map_err(|_| wrong())?;
        if plain.len() > length {
            return Err(Damage::Malformed("has more numbers than it says"));
        }
    }
    if plain.len() < length || !frame.is_empty() {
        return Err(Damage::Malformed("has fewer numbers than it says, or bytes behind them"));
    }
    Ok(plain)
}

/// The f32 of four byte planes: all first bytes, then all second, third and fourth ones.
fn joined(planes: &[u8], count: usize) -> Result<Vec<f32>, Damage> {
    let at = |k: usize| f32::from_be_bytes([0, 1, 2, 3].map(|plane| planes[plane * count + k]));
    let floats: Vec<f32> = (0..count).map(at).collect();
    if floats.iter().all(|number| number.is_finite()) {
        Ok(floats)
    } else {
        Err(Damage::Malformed("has numbers that are not finite"))
    }
}

/// Takes numbers off the front. There are as many as the layers and the norms need.
struct Numbers<'a> {
    floats: &'a [f32],
    /// Of 8-bit weights all bytes; of 16-bit ones the high bytes, and the low ones in `low`.
    steps: &'a [u8],
    low: Option<&'a [u8]>,
    /// The most negative number of steps.
    least: f32,
}

impl Numbers<'_> {
    fn floats(&mut self, count: usize) -> Vec<f32> {
        let (taken, rest) = self.floats.split_at(count);
        self.floats = rest;
        taken.to_vec()
    }

    fn dense(&mut self, (inputs, outputs): (usize, usize)) -> Result<Dense, Damage> {
        let (scales, bias) = (self.floats(outputs), self.floats(outputs));
        if scales.iter().any(|scale| !(scale * self.least).is_finite()) {
            return Err(Damage::Malformed("has weights that are not finite"));
        }
        let (steps, rest) = self.steps.split_at(inputs * outputs);
        self.steps = rest;
        let scaled = |(step, scale): (f32, &f32)| step * scale;
        let scales = scales.iter().cycle();
        let weights = match &mut self.low {
            None => steps.iter().map(|step| f32::from(*step as i8)).zip(scales).map(scaled).collect(),
            Some(all) => {
                let (low, rest) = all.split_at(steps.len());
                *all = rest;
                let steps = steps.iter().zip(low);
                let steps = steps.map(|(high, low)| f32::from(i16::from_be_bytes([*high, *low])));
                steps.zip(scales).map(scaled).collect()
            }
        };
        Ok(Dense { inputs, outputs, weights, bias })
    }
}

/// A network's bytes, not packed yet. In the table stands `head` and then a zstd frame of `numbers`, which states its
/// content's size and whose window is no larger than that; zstd's one-shot compression makes such frames.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Encoded {
    /// What is stored as it is.
    pub head: Vec<u8>,
    /// What is compressed.
    pub numbers: Vec<u8>,
}

/// Turns a network into bytes. What [`decode`] gives back has every weight to within half a step, and what an f32 rounds,
/// and all other numbers as they are. A step is the largest weight of the output divided by 127 or by 32767.
///
/// # Errors
///
/// As [`NetworkWeights::check`].
pub fn encode(weights: &NetworkWeights, precision: Precision) -> Result<Encoded, Damage> {
    weights.check()?;
    let head = Head { precision, architecture: weights.architecture, sizes: weights.sizes.clone() };
    let (mut floats, mut steps) = (Vec::<f32>::new(), Vec::new());
    for dense in &weights.dense {
        let scales = scales(dense, precision);
        steps.extend(
            dense.weights.iter().zip(scales.iter().cycle()).map(|(w, scale)| step(*w, *scale, precision)),
        );
        floats.extend(scales.iter().chain(&dense.bias));
    }
    floats.extend(weights.norms.iter().flat_map(|norm| norm.gamma.iter().chain(&norm.beta)));
    let mut numbers = Vec::with_capacity(head.numbers_len());
    numbers
        .extend((0..size_of::<f32>()).flat_map(|plane| floats.iter().map(move |f| f.to_be_bytes()[plane])));
    match precision {
        Precision::Eight => numbers.extend(steps.iter().map(|step| *step as u8)),
        Precision::Sixteen => {
            numbers.extend((0..2).flat_map(|plane| steps.iter().map(move |step| step.to_be_bytes()[plane])));
        }
    }
    debug_assert_eq!(numbers.len(), head.numbers_len());
    Ok(Encoded { head: head.to_bytes(), numbers })
}

/// A step for each output.
fn scales(dense: &Dense, precision: Precision) -> Vec<f32> {
    let mut largest = vec![0f32; dense.outputs];
    for row in dense.weights.chunks_exact(dense.outputs) {
        largest.iter_mut().zip(row).for_each(|(largest, weight)| *largest = largest.max(weight.abs()));
    }
    // Readers refuse a scale whose product with the least number of steps is not finite.
    let limit = f32::MAX / -precision.least();
    largest.iter().map(|largest| (largest / precision.most()).min(limit)).collect()
}

fn step(weight: f32, scale: f32, precision: Precision) -> i16 {
    // A scale is 0 only if all weights of the output are (nearly) 0.
    if scale > 0.0 {
        libm::roundf(weight / scale).clamp(-precision.most(), precision.most()) as i16
    } else {
        0
    }
}
