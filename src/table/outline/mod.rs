//! The coding of outline models.

mod codec;
mod corrections;
mod index;
mod parts;
mod positions;
mod rules;
mod scores;
mod sections;
mod shared;
mod shifts;
mod structure;
mod votes;

pub use codec::*;
pub use index::{OutlineIndex, pack};
pub use parts::*;
pub use positions::{Choose, Price, Question};
pub use sections::sizes_for;
pub use shared::{Shared, SharedMoves, Source};
