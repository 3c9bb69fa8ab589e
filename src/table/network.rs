//! One network as bytes: its shape, its sizes, and its numbers, weights as integers with a scale for each output.
//!
//! They are not coded any further. What training leaves of a network's weights is close to noise, of which a coder would
//! save some percent, and the arithmetic coder's speed is made for models a thousandth as large.

use crate::error::Error;
use crate::model::network::{Dense, NORMS, NetworkSize, NetworkWeights, Norm, Shape, sizes_problem};

/// How weights are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord, Hash)]
pub enum Precision {
    /// In 8 bits, −127 to 127 steps.
    #[default]
    Eight,
    /// In 16 bits, −32767 to 32767 steps.
    Sixteen,
}

impl Precision {
    /// The bits of a weight.
    pub fn bits(self) -> u8 {
        match self {
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    fn bytes(self) -> usize {
        usize::from(self.bits() / 8)
    }

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

/// Flags of a shape.
const FREQUENCIES: u8 = 1;
const RESIDUAL: u8 = 2;
/// Bytes before the sizes, and of a size.
const SIZES_AT: usize = 9;
const SIZE_LEN: usize = 11;

fn damaged(what: impl std::fmt::Display) -> Error {
    Error::Malformed(format!("a glyph's network has {what}; convert the font again"))
}

/// How a packed network's weights are stored.
///
/// # Errors
///
/// `Malformed` for bytes that are no network.
pub fn precision(bytes: &[u8]) -> Result<Precision, Error> {
    match bytes.get(1) {
        Some(8) => Ok(Precision::Eight),
        Some(16) => Ok(Precision::Sixteen),
        Some(bits) => Err(damaged(format!("weights of {bits} bits, which are 8 or 16"))),
        None => Err(damaged("no precision")),
    }
}

/// Reads a network's numbers. What is allocated is in proportion to the bytes.
///
/// # Errors
///
/// `LimitExceeded` for a network that is larger than any writer makes, `Malformed` for bytes that contradict themselves.
pub fn decode(bytes: &[u8]) -> Result<NetworkWeights, Error> {
    let precision = precision(bytes)?;
    let mut reader = Reader { bytes };
    let [flags, _] = reader.bytes()?;
    if flags & !(FREQUENCIES | RESIDUAL) != 0 {
        return Err(damaged(format!("unknown flags {flags:#x}")));
    }
    let shape = Shape {
        frequencies: flags & FREQUENCIES != 0,
        residual: flags & RESIDUAL != 0,
        width: reader.u16()?,
        latent: reader.u16()?,
        encoder: reader.u16()?,
    };
    shape.check()?;
    let layers = shape.layers();
    let [count] = reader.bytes()?.map(usize::from);
    let length = SIZES_AT + count * SIZE_LEN + numbers_len(&shape, &layers, precision);
    if bytes.len() != length {
        return Err(damaged(format!("{} bytes instead of {length}", bytes.len())));
    }
    let sizes = (0..count).map(|_| reader.size()).collect::<Result<Vec<_>, _>>()?;
    if let Some(problem) = sizes_problem(&sizes) {
        return Err(damaged(problem));
    }
    let dense = layers.iter().map(|layer| reader.dense(*layer, precision)).collect::<Result<_, _>>()?;
    let width = usize::from(shape.width);
    let norms = (0..NORMS).map(|_| Ok(Norm { gamma: reader.floats(width)?, beta: reader.floats(width)? }));
    let norms = norms.collect::<Result<_, Error>>()?;
    Ok(NetworkWeights { shape, sizes, dense, norms })
}

/// The bytes of all layers and norms.
fn numbers_len(shape: &Shape, layers: &[(usize, usize)], precision: Precision) -> usize {
    let dense =
        layers.iter().map(|(inputs, outputs)| outputs * (2 * size_of::<f32>() + inputs * precision.bytes()));
    dense.sum::<usize>() + NORMS * 2 * usize::from(shape.width) * size_of::<f32>()
}

/// Takes numbers off the front.
struct Reader<'a> {
    bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Error> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or_else(|| damaged("an early end"))?;
        self.bytes = rest;
        Ok(taken)
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        self.take(N)?.first_chunk().copied().ok_or_else(|| damaged("an early end"))
    }

    fn u16(&mut self) -> Result<u16, Error> {
        self.bytes().map(u16::from_be_bytes)
    }

    fn size(&mut self) -> Result<NetworkSize, Error> {
        let ppem = self.u16()?;
        let [side] = self.bytes()?;
        let origin = [self.u16()? as i16, self.u16()? as i16];
        Ok(NetworkSize { ppem, side, origin, crop: self.bytes()? })
    }

    fn floats(&mut self, count: usize) -> Result<Vec<f32>, Error> {
        let bytes = self.take(count * size_of::<f32>())?.as_chunks().0;
        let floats: Vec<f32> = bytes.iter().map(|bytes| f32::from_be_bytes(*bytes)).collect();
        if floats.iter().all(|number| number.is_finite()) {
            Ok(floats)
        } else {
            Err(damaged("numbers that are not finite"))
        }
    }

    fn dense(&mut self, (inputs, outputs): (usize, usize), precision: Precision) -> Result<Dense, Error> {
        let scales = self.floats(outputs)?;
        if scales.iter().any(|scale| !(scale * precision.least()).is_finite()) {
            return Err(damaged("weights that are not finite"));
        }
        let steps = self.take(inputs * outputs * precision.bytes())?;
        let scaled = |(step, scale): (f32, &f32)| step * scale;
        let weights = match precision {
            Precision::Eight => {
                let steps = steps.iter().map(|step| f32::from(*step as i8));
                steps.zip(scales.iter().cycle()).map(scaled).collect()
            }
            Precision::Sixteen => {
                let steps = steps.as_chunks().0.iter().map(|step| f32::from(i16::from_be_bytes(*step)));
                steps.zip(scales.iter().cycle()).map(scaled).collect()
            }
        };
        Ok(Dense { inputs, outputs, weights, bias: self.floats(outputs)? })
    }
}

/// Turns a network's numbers into bytes. What [`decode`] gives back has every weight to within half a step, and what an
/// f32 rounds, and all other numbers as they are. A step is the largest weight of the output divided by 127 or by 32767.
///
/// # Errors
///
/// As [`NetworkWeights::check`].
pub fn encode(weights: &NetworkWeights, precision: Precision) -> Result<Vec<u8>, Error> {
    weights.check()?;
    let shape = &weights.shape;
    let flag = |set: bool, flag: u8| if set { flag } else { 0 };
    let flags = flag(shape.frequencies, FREQUENCIES) | flag(shape.residual, RESIDUAL);
    let mut out = Vec::with_capacity(
        SIZES_AT + weights.sizes.len() * SIZE_LEN + numbers_len(shape, &shape.layers(), precision),
    );
    out.extend([flags, precision.bits()]);
    out.extend([shape.width, shape.latent, shape.encoder].into_iter().flat_map(u16::to_be_bytes));
    out.push(weights.sizes.len() as u8);
    for size in &weights.sizes {
        out.extend(size.ppem.to_be_bytes());
        out.push(size.side);
        out.extend(size.origin.into_iter().flat_map(i16::to_be_bytes));
        out.extend(size.crop);
    }
    for dense in &weights.dense {
        put_dense(&mut out, dense, precision);
    }
    for numbers in weights.norms.iter().flat_map(|norm| [&norm.gamma, &norm.beta]) {
        out.extend(numbers.iter().flat_map(|number| number.to_be_bytes()));
    }
    Ok(out)
}

fn put_dense(out: &mut Vec<u8>, dense: &Dense, precision: Precision) {
    let mut largest = vec![0f32; dense.outputs];
    for row in dense.weights.chunks_exact(dense.outputs) {
        largest.iter_mut().zip(row).for_each(|(largest, weight)| *largest = largest.max(weight.abs()));
    }
    let most = precision.most();
    // Readers refuse a scale whose product with the least number of steps is not finite.
    let limit = f32::MAX / -precision.least();
    let scales: Vec<f32> = largest.iter().map(|largest| (largest / most).min(limit)).collect();
    out.extend(scales.iter().flat_map(|scale| scale.to_be_bytes()));
    for (weight, scale) in dense.weights.iter().zip(scales.iter().cycle()) {
        // A scale may be 0, and then nothing is lost that an f32 could hold.
        let step = if *scale > 0.0 { (weight / scale).round().clamp(-most, most) } else { 0.0 };
        match precision {
            Precision::Eight => out.extend((step as i8).to_be_bytes()),
            Precision::Sixteen => out.extend((step as i16).to_be_bytes()),
        }
    }
    out.extend(dense.bias.iter().flat_map(|bias| bias.to_be_bytes()));
}
