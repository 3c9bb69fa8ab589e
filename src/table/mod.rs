//! The `Nfrt` table: layout, zero-copy reader, and the coding of models. `spec/nfrt.md` describes the bytes.

pub mod codec;
pub mod composed;
pub mod context_model;
mod damage;
pub mod elements;
mod gids;
mod header;
pub mod logistic;
mod network_index;
pub mod outline;
pub mod part_offsets;
mod planes;
pub mod priors;
pub mod range;
mod reader;
mod warp;

pub use gids::Gids;
pub use header::*;
pub use reader::Table;
