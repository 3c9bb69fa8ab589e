//! One network as bytes: a head that says how it is built, for which sizes and how precisely it is stored, and its
//! numbers in a zstd frame. `spec/nfrt.md`, section 6.1, describes them.
//!
//! Reading the numbers needs the feature `networks`; which glyphs have a network, and how many bytes it takes, can be
//! asked without it.

#[cfg(feature = "networks")]
mod head;
#[cfg(feature = "networks")]
mod numbers;

#[cfg(feature = "networks")]
pub use head::Head;
#[cfg(feature = "networks")]
pub use numbers::{Encoded, decode, encode};

use crate::error::Damage;

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
}

/// How a packed network's weights are stored.
///
/// # Errors
///
/// `Malformed` for bytes that are no network.
pub fn precision(bytes: &[u8]) -> Result<Precision, Damage> {
    match bytes.get(1) {
        Some(8) => Ok(Precision::Eight),
        Some(16) => Ok(Precision::Sixteen),
        _ => Err(Damage::Malformed("has weights of neither 8 nor 16 bits")),
    }
}
