//! The outline model: the font's own outline, grid-fitted as TrueType's programs do it. Some points, those of a *track*, are
//! moved to hinted positions; the others are interpolated between them (TrueType's `IUP`), and a few are corrected one by
//! one.

mod hint;
mod levels;
mod points;
mod weights;

pub use hint::{Interpolation, Tracks, hint, in_64ths, in_units, interpolated, rounded_down, scale_of};
pub use points::OutlinePoints;
pub use weights::{AxisHints, Correction, MAX_TRACKS, OutlineModel, OutlineWeights, UNTOUCHED};
