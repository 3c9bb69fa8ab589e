//! The table's header and constants.

use read_fonts::types::Tag;

use crate::model::sizes::{Origin, Scale};
use crate::target::Target;

/// The table's tag.
pub const TAG: Tag = Tag::new(b"Nfrt");
/// The layout that this crate reads and writes. Readers refuse other major versions.
pub const MAJOR_VERSION: u16 = 2;
/// Additions that older readers can ignore count this up. A table says what it has: this, or
/// [`NETWORK_MINOR_VERSION`].
pub const MINOR_VERSION: u16 = 0;
/// The minor version of a table that has networks.
pub const NETWORK_MINOR_VERSION: u16 = 1;
/// Bytes before the arrays.
pub const HEADER_LEN: usize = 52;
/// The table has the offset of the first of so many models.
pub const BLOCK: usize = 64;
/// The flag that says that outlines were dropped.
pub const OUTLINES_DROPPED: u8 = 1;
/// The flag that says that networks follow the grid offsets.
pub const NETWORKS: u8 = 2;
/// The flag that says that outline models follow the networks.
pub const OUTLINE_MODELS: u8 = 4;
/// The flag that says that a certificate follows the outline models.
pub const CERTIFICATE: u8 = 8;
/// The flag that says that the modes of drop-out control follow the certificate.
pub const DROPOUT: u8 = 16;
/// The flag that says that the outlines had cubic curves.
pub const CUBIC: u8 = 32;
/// The flag that says that the hints were those of PostScript outlines.
pub const POSTSCRIPT: u8 = 64;
/// The most parts of a composed glyph.
pub const MAX_PARTS: usize = 16;
/// The most bytes that the grid offsets of parts take, decoded.
pub const MAX_GRID_OFFSET_BYTES: usize = 1 << 20;

/// What a conversion was asked for, as the table records it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Header {
    /// What the teacher hinted for.
    pub target: Target,
    /// The smallest trained size in pixels per em.
    pub first_ppem: u16,
    /// The largest trained size.
    pub last_ppem: u16,
    /// FNV-1a of the outlines that the models were trained from.
    pub outline_hash: u64,
    /// Whether the font has no outlines of the glyphs that it has models for.
    pub outlines_dropped: bool,
    /// Where the outlines and the hints come from.
    pub origin: Origin,
    /// The seed of the training.
    pub seed: u64,
    /// Optimiser steps.
    pub steps: u16,
    /// The most knots of an axis.
    pub knots: u8,
    /// The deformation's rank.
    pub rank: u8,
    /// Edge of a field cell in 1/10000 em.
    pub cell: u16,
    /// The glyphs of the font that the models are numbered for; 0 if the table does not say.
    pub glyph_count: u16,
}

impl Header {
    /// The number that stands for the target in the table.
    pub fn target_number(&self) -> u8 {
        match self.target {
            Target::Smooth => 0,
            Target::Mono => 1,
            Target::Lcd => 2,
        }
    }

    /// The flags that stand for the origin in the table.
    pub fn origin_flags(&self) -> u8 {
        match self.origin {
            Origin::TrueType => 0,
            Origin::Cubic => CUBIC,
            Origin::PostScript => CUBIC | POSTSCRIPT,
        }
    }

    /// The origin that flags stand for.
    pub(super) fn origin_of(flags: u8) -> Origin {
        match flags & (CUBIC | POSTSCRIPT) {
            0 => Origin::TrueType,
            CUBIC => Origin::Cubic,
            _ => Origin::PostScript,
        }
    }

    /// The trained sizes as models know them; `None` for units or sizes that the format does not allow.
    pub fn scale(&self, units_per_em: u16) -> Option<Scale> {
        let scale = Scale::new(units_per_em, self.first_ppem, self.last_ppem)?;
        Some(scale.with_origin(self.origin))
    }
}

/// The FNV-1a hash of nothing.
pub const FNV_BASIS: u64 = 0xCBF2_9CE4_8422_2325;

/// FNV-1a, 64 bits, over a byte string; `state` is the hash so far.
pub fn fnv1a(state: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(state, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01B3))
}

/// The value that ties a table to its font's outlines: FNV-1a over `unitsPerEm` (big-endian) and the bytes of
/// the `glyf` table.
pub fn outline_hash(units_per_em: u16, glyf: &[u8]) -> u64 {
    fnv1a(fnv1a(FNV_BASIS, &units_per_em.to_be_bytes()), glyf)
}
