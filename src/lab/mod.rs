//! The models and experiments of the paper "Neural Font Rendering" (Anderson, Shamir, Fried), and our model beside
//! them on the same bitmaps.

/// One ground-truth bitmap of a glyph, or a model's picture of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Square {
    /// Pixels along a side of the box, *s* in the paper.
    pub side: usize,
    /// Coverage 0–255, top row first, `side`² bytes.
    pub pixels: Vec<u8>,
}
