//! Coordinates: font units, 1/64 pixel, in which hints move points, and units of 1/256 pixel, in which outlines are drawn.

use crate::number::{UNIT_BITS, div_fixed, round};

/// The factor from font units to 1/64 pixel, in 1/65536, as FreeType computes it. Sizes are rounded to 1/64 pixel.
pub fn scale_of(ppem: f32, units_per_em: u16) -> i32 {
    div_fixed(round(ppem * 64.0), units_per_em.into())
}

/// A coordinate in 1/64 pixel, rounded down as FreeType does it where it hints PostScript outlines: the scale becomes one of whole
/// pixels first (`cf2_getScaleAndHintFlag` and `cf2_builder_lineTo`).
pub fn rounded_down(units: i32, scale: i32) -> i32 {
    ((i64::from(units) * ((i64::from(scale) + 32) / 64)) >> 10) as i32
}

/// Units in 1/64 pixel, as a shift.
const FRACTION_BITS: i32 = UNIT_BITS - 6;

/// From 1/64 pixel to units of 1/256 pixel.
pub fn in_units(position: i32) -> i32 {
    position.wrapping_shl(FRACTION_BITS as u32)
}

/// From units of 1/256 pixel to 1/64 pixel, to the nearest, halves up.
pub fn in_64ths(position: i32) -> i32 {
    position.wrapping_add(1 << (FRACTION_BITS - 1)) >> FRACTION_BITS
}
