//! Working memory.

use alloc::vec::Vec;

use super::area::Area;
use super::flatten;
#[cfg(feature = "fields")]
use crate::model::contour::{Polygons, Tracer};
#[cfg(feature = "fields")]
use crate::model::hinting::Hinting;

/// Working memory that drawing reuses.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    pub(super) area: Area,
    /// Of fields: what moves their vertices.
    #[cfg(feature = "fields")]
    pub(super) hinting: Hinting,
    /// Vertices in units from the bitmap's upper left corner, y down: coordinates along x and y.
    #[cfg(feature = "fields")]
    pub(super) points: [Vec<i32>; 2],
    #[cfg(feature = "fields")]
    pub(super) tracer: Tracer,
    #[cfg(feature = "fields")]
    pub(super) fresh: Polygons,
    /// Of outlines: hinted points in 1/64 pixel.
    pub(super) outline: [Vec<i32>; 2],
    pub(super) polygons: flatten::Polygons,
    /// Of subpixels: their coverage, before it is filtered or joined, and the pixels that they make.
    pub(super) subpixels: Vec<u8>,
    pub(super) lcd: Vec<[u8; 3]>,
}
