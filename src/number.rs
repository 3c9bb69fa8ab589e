//! Arithmetic that gives the same result on every machine, with and without the standard library.

/// Fixed-point coordinates count this many units in a pixel.
pub(crate) const UNIT: i32 = 1 << UNIT_BITS;
/// The same as a power of two.
pub(crate) const UNIT_BITS: i32 = 8;

/// The largest integer that is not above `v`; `f32::floor` is slow where the baseline has no instruction for it.
pub(crate) fn floor(v: f32) -> i32 {
    let whole = v as i32;
    whole.saturating_sub(i32::from(whole as f32 > v))
}

/// The nearest integer to a number of at most 2²² either way; ties go to the even one.
#[inline]
pub(crate) fn round(v: f32) -> i32 {
    // The sum has no bits left for a fraction, and its lowest bits are the integer.
    const SHIFTER: f32 = (3 << 22) as f32;
    (v + SHIFTER).to_bits() as i32 - SHIFTER.to_bits() as i32
}

/// The square root, correctly rounded.
pub(crate) fn sqrt_f32(v: f32) -> f32 {
    #[cfg(feature = "std")]
    return v.sqrt();
    #[cfg(not(feature = "std"))]
    return libm::sqrtf(v);
}

/// The square root, correctly rounded.
#[cfg(feature = "networks")]
pub(crate) fn sqrt_f64(v: f64) -> f64 {
    #[cfg(feature = "std")]
    return v.sqrt();
    #[cfg(not(feature = "std"))]
    return libm::sqrt(v);
}

/// A product with a number in 1/65536, as FreeType's `FT_MulFix` rounds it: to the nearest integer, halves away from 0.
#[inline]
pub fn mul_fixed(value: i32, by: i32) -> i32 {
    let product = i64::from(value) * i64::from(by);
    ((product + 0x8000 - i64::from(product < 0)) >> 16) as i32
}

/// A quotient in 1/65536, as FreeType's `FT_DivFix` rounds it. Division by 0 gives the largest number.
#[inline]
pub(crate) fn div_fixed(value: i32, by: i32) -> i32 {
    let negative = (value < 0) != (by < 0);
    let (value, by) = (value.unsigned_abs(), by.unsigned_abs());
    let quotient = if value < 1 << 15 && by < 1 << 16 {
        // 32 bits are enough, and a shorter division is a faster one.
        ((value << 16) + (by >> 1)).checked_div(by).map_or(i32::MAX, |q| q.min(i32::MAX as u32) as i32)
    } else {
        let (value, by) = (u64::from(value), u64::from(by));
        ((value << 16) + (by >> 1)).checked_div(by).map_or(i32::MAX, |q| q.min(i32::MAX as u64) as i32)
    };
    if negative { -quotient } else { quotient }
}

#[cfg(test)]
mod tests;
