//! Bounds that several modules check.

/// The largest trained size, in pixels per em.
pub const MAX_TRAINED_PPEM: u16 = 1024;
/// The largest size that is drawn, in pixels per em.
pub const MAX_PPEM: f32 = 2048.0;
/// The largest subpixel offset either way, in pixels.
pub(crate) const MAX_OFFSET: f32 = 1024.0;
/// The longest side of a bitmap in pixels.
pub const MAX_SIDE: u32 = 8192;
