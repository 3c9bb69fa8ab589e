//! The uncompressed part of a packed network.

use alloc::vec::Vec;

use super::layout::{Architecture, NORMS, NetworkSize, check_sizes};
use super::precision::{Precision, precision};
use crate::error::Damage;

/// Flags of an architecture.
const FREQUENCIES: u8 = 1;
const RESIDUAL: u8 = 2;
/// Bytes before the sizes, and of a size.
const SIZES_AT: usize = 9;
const SIZE_LEN: usize = 11;

/// The uncompressed part of a packed network.
#[derive(Debug, Clone, PartialEq)]
pub struct Head {
    /// How its weights are stored.
    pub precision: Precision,
    /// How it is built.
    pub architecture: Architecture,
    /// The sizes that it was trained for.
    pub sizes: Vec<NetworkSize>,
}

impl Head {
    /// Reads a network's head. Returns the bytes that follow, the frame with its numbers, too.
    ///
    /// # Errors
    ///
    /// `TooLarge` for a network that is larger than any writer makes, `Malformed` for bytes that contradict
    /// themselves.
    pub fn parse(bytes: &[u8]) -> Result<(Self, &[u8]), Damage> {
        let precision = precision(bytes)?;
        let mut reader = Reader { bytes };
        let [flags, _] = reader.bytes()?;
        if flags & !(FREQUENCIES | RESIDUAL) != 0 {
            return Err(Damage::Malformed("has unknown flags"));
        }
        let architecture = Architecture {
            frequencies: flags & FREQUENCIES != 0,
            residual: flags & RESIDUAL != 0,
            width: reader.u16()?,
            latent: reader.u16()?,
            encoder: reader.u16()?,
        };
        architecture.check()?;
        let [count] = reader.bytes()?;
        let sizes = (0..count).map(|_| reader.size()).collect::<Result<Vec<_>, _>>()?;
        check_sizes(&sizes)?;
        Ok((Self { precision, architecture, sizes }, reader.bytes))
    }

    /// The head as bytes.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let flag = |set: bool, flag: u8| if set { flag } else { 0 };
        let architecture = &self.architecture;
        let flags = flag(architecture.frequencies, FREQUENCIES) | flag(architecture.residual, RESIDUAL);
        let mut out = Vec::with_capacity(SIZES_AT + self.sizes.len() * SIZE_LEN);
        out.extend([flags, self.precision.bits()]);
        out.extend(
            [architecture.width, architecture.latent, architecture.encoder]
                .into_iter()
                .flat_map(u16::to_be_bytes),
        );
        out.push(self.sizes.len() as u8);
        for size in &self.sizes {
            out.extend(size.ppem.to_be_bytes());
            out.push(size.side);
            out.extend(size.origin.into_iter().flat_map(i16::to_be_bytes));
            out.extend(size.crop);
        }
        out
    }

    /// How many f32 and how many weights the network has. The f32 are the scale and the bias of every output of a dense
    /// layer, and those of the batch norms.
    pub(super) fn counts(&self) -> (usize, usize) {
        let layers = self.architecture.layers();
        let outputs: usize = layers.iter().map(|(_, outputs)| outputs).sum();
        let weights = layers.iter().map(|(inputs, outputs)| inputs * outputs).sum();
        (2 * outputs + NORMS * 2 * usize::from(self.architecture.width), weights)
    }

    /// The memory that the network takes when it is unpacked, about, in bytes.
    pub fn memory(&self) -> usize {
        let (floats, weights) = self.counts();
        (floats + weights) * size_of::<f32>()
    }

    /// The length of the network's numbers, unpacked, in bytes. The limits of a architecture keep it below 2^26.
    pub fn numbers_len(&self) -> usize {
        let (floats, weights) = self.counts();
        floats * size_of::<f32>() + weights * usize::from(self.precision.bits() / 8)
    }
}

/// Takes numbers off the front.
struct Reader<'a> {
    bytes: &'a [u8],
}

impl Reader<'_> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Damage> {
        let (taken, rest) = self.bytes.split_first_chunk().ok_or(Damage::Malformed("ends early"))?;
        self.bytes = rest;
        Ok(*taken)
    }

    fn u16(&mut self) -> Result<u16, Damage> {
        self.bytes().map(u16::from_be_bytes)
    }

    fn size(&mut self) -> Result<NetworkSize, Damage> {
        let ppem = self.u16()?;
        let [side] = self.bytes()?;
        let origin = [self.u16()? as i16, self.u16()? as i16];
        Ok(NetworkSize { ppem, side, origin, crop: self.bytes()? })
    }
}
