//! The grid-fit model: what it stores, and how it is evaluated.

pub mod compose;
pub mod contour;
pub mod grid;
pub(crate) mod gridfit;
pub mod hinting;
pub mod sizes;
