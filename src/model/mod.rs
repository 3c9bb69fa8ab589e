//! The models, what they store and how they are hinted at a size: the outline model, and the grid-fit field.

pub mod compose;
pub mod contour;
pub mod grid;
pub(crate) mod gridfit;
pub mod hinting;
pub mod outline;
pub mod sizes;
