//! Square roots, correctly rounded with and without the standard library.

pub(super) fn root_f32(v: f32) -> f32 {
    #[cfg(feature = "std")]
    return v.sqrt();
    #[cfg(not(feature = "std"))]
    return libm::sqrtf(v);
}

#[cfg(feature = "networks")]
pub(super) fn root_f64(v: f64) -> f64 {
    #[cfg(feature = "std")]
    return v.sqrt();
    #[cfg(not(feature = "std"))]
    return libm::sqrt(v);
}
