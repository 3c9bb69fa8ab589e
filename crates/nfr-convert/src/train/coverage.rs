//! The coverage that training computes: a few subpixel samples in each pixel, each cut by a straight edge. Unlike exact
//! areas it has a gradient everywhere near edges.

/// Half the distance (in samples) over which the warp's slope is taken.
pub(super) const SLOPE_REACH: f32 = 0.25;
/// Gradients (em per em) below this are raised to it; it bounds how steep an edge of a flat field can look.
pub(super) const MIN_GRADIENT: f32 = 0.03;
/// The smaller component of the gradient is at least this share of the larger one.
pub(super) const MIN_SKEW: f32 = 0.02;

/// The number of samples in a pixel along each axis: small sizes are supersampled.
pub(super) fn samples_per_pixel(ppem: f32) -> usize {
    match ppem {
        s if s < 11.0 => 6,
        s if s < 16.0 => 4,
        s if s < 24.0 => 3,
        s if s < 96.0 => 2,
        _ => 1,
    }
}
