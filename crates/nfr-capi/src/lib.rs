//! The C interface of nfr: `include/nfr.h` describes it for C, and is made from these sources.
//!
//! Names are those that C sees. A panic never leaves a function: it becomes [`nfr_status::NFR_INTERNAL`].

#![allow(unsafe_code, reason = "a C interface takes pointers on trust; each block says on which")]
#![allow(non_camel_case_types, reason = "the names of the C interface")]
#![allow(
    clippy::missing_safety_doc,
    reason = "the head of nfr.h and each comment have the rules for pointers"
)]
#![deny(unsafe_op_in_unsafe_fn, clippy::undocumented_unsafe_blocks)]

mod bytes;
mod font;
mod pointers;
mod rasterizer;
mod status;
mod values;

pub use bytes::nfr_release;
pub use font::*;
pub use rasterizer::*;
pub use status::*;
pub use values::*;
