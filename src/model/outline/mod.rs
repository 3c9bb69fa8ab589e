//! The outline model: the font's own outline, grid-fitted as TrueType's programs, or PostScript's hints, do it. Some points, those of a
//! *track*, are moved to hinted positions; the others are interpolated between them, along their contour (TrueType's `IUP`) or by their
//! heights (PostScript's stems), and a few are corrected one by one.

mod hint;
mod iup;
mod levels;
mod places;
mod points;
mod weights;

pub use hint::{Interpolation, Tracks, hint};
pub use iup::interpolated;
pub use places::{in_64ths, in_units, rounded_down, scale_of};
pub use points::OutlinePoints;
pub use weights::{AxisHints, Correction, MAX_TRACKS, OutlineModel, OutlineWeights, UNTOUCHED};
