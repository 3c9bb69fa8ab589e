//! How the weights of networks are stored.

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
