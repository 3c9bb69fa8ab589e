//! The precision of positions between scan lines.

/// Positions are counted in units of 1/4096 pixel, or of 1/64, from the centre of the first pixel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Grid {
    /// A pixel has two to the power of this many units.
    bits: u32,
}

impl Grid {
    /// The first size in pixels per em that is drawn with units of 1/64 pixel (FreeType's `FT_OUTLINE_HIGH_PRECISION`).
    const FIRST_COARSE_PPEM: f32 = 24.0;

    /// The grid that FreeType takes for a size in pixels per em.
    pub(super) fn for_size(ppem: f32) -> Self {
        // FreeType rounds fractional sizes before it compares.
        Self { bits: if ppem + 0.5 < Self::FIRST_COARSE_PPEM { 12 } else { 6 } }
    }

    /// Units of a pixel.
    pub(super) fn one(self) -> i32 {
        1 << self.bits
    }

    /// Arcs of at most so many units along and across the scan lines count as straight.
    pub(super) fn step(self) -> i32 {
        if self.bits == 12 { 256 } else { 32 }
    }

    /// Where a position lies that is in 1/64 pixel from the lower left corner of the first pixel.
    pub(super) fn position(self, v: i32) -> i32 {
        v * (self.one() / 64) - self.one() / 2
    }

    pub(super) fn floor(self, v: i32) -> i32 {
        v & -self.one()
    }

    pub(super) fn ceil(self, v: i32) -> i32 {
        self.floor(v + self.one() - 1)
    }

    /// The number of the pixel or scan line that begins with this position, or that holds it.
    pub(super) fn pixel(self, v: i32) -> i32 {
        v >> self.bits
    }

    /// How far a position lies above a pixel's centre.
    pub(super) fn fraction(self, v: i32) -> i32 {
        v & (self.one() - 1)
    }

    /// Whether a position lies half a pixel or more below the next scan line.
    pub(super) fn is_far_below(self, v: i32) -> bool {
        self.ceil(v) - v >= self.one() / 2
    }

    /// Whether a position lies half a pixel or more above the last scan line.
    pub(super) fn is_far_above(self, v: i32) -> bool {
        self.fraction(v) >= self.one() / 2
    }

    /// The pixel centre closest to the middle of two positions. Middles at the same distance from two centres take the lower one
    /// in either precision.
    pub(super) fn middle(self, a: i32, b: i32) -> i32 {
        self.floor((a + b + self.one() * 63 / 64) >> 1)
    }
}
