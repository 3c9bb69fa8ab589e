//! Arithmetic that gives the same result on every machine, with and without the standard library.

/// Fixed-point coordinates count this many units in a pixel.
pub(crate) const UNIT: i32 = 1 << UNIT_BITS;
/// The same as a power of two.
pub(crate) const UNIT_BITS: i32 = 9;

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
