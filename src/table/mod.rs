//! The `Nfrt` table: layout, zero-copy reader, and the coding of models. `spec/nfrt.md` describes the bytes.

mod certificate;
pub mod codec;
pub mod composed;
pub mod context_model;
mod damage;
mod dropout;
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

pub use certificate::{Bound, Certificate, CertifiedErrors};
pub use dropout::{Dropout, DropoutException, DropoutModes};
pub use gids::Gids;
pub use header::*;
pub use reader::Table;
