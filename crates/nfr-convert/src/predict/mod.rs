//! Prediction of the hinted outlines at sizes that the teacher does not draw.
//!
//! Hint programs consist of a few operations: round a point to the grid, keep a rounded distance from another point,
//! interpolate between two. The hinted outlines at the known sizes are searched for such rules, track by track, and each
//! track follows the likeliest one. Sizes near the wanted one have more weight, because fonts change their rules from size
//! to size.

mod axis;
mod likelihood;
mod placement;
mod predictor;
mod track;
mod zones;

#[cfg(test)]
mod tests;

pub(crate) use predictor::Predictor;
