//! The implicit network of the paper "Neural Font Rendering" (Anderson, Shamir, Fried): a function from the position of a
//! pixel, and the index of a size, to the pixel's coverage, for one glyph at some sizes.
//!
//! [`NetworkWeights`] are plain numbers, as training makes them; [`encode`] packs and [`decode`] unpacks them;
//! [`Network`] evaluates them. `spec/nfrt.md` describes the bytes (section 6.1) and the evaluation. Every operation in here
//! is an IEEE 754 one in a fixed order, so that the pixels are the same on every machine.
//!
//! Without the feature `networks` there is only what tells how weights are stored.

#[cfg(feature = "networks")]
mod dense;
#[cfg(feature = "networks")]
mod draw;
#[cfg(feature = "networks")]
mod encoding;
#[cfg(feature = "networks")]
mod eval;
#[cfg(feature = "networks")]
mod head;
#[cfg(feature = "networks")]
mod layout;
#[cfg(feature = "networks")]
mod norm;
#[cfg(feature = "networks")]
mod numbers;
mod precision;
#[cfg(all(test, feature = "networks"))]
#[allow(clippy::unwrap_used)]
mod tests;

#[cfg(feature = "networks")]
pub use encoding::{ENCODED, FREQUENCY_COUNT, encode as encode_coordinate};
#[cfg(feature = "networks")]
pub use eval::{Network, condition, coordinate, positions};
#[cfg(feature = "networks")]
pub use head::Head;
#[cfg(feature = "networks")]
pub use layout::*;
#[cfg(feature = "networks")]
pub use norm::EPSILON as NORM_EPSILON;
#[cfg(feature = "networks")]
pub use numbers::{Encoded, decode, encode};
pub use precision::{Precision, precision};
