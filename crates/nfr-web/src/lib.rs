//! The exports of `nfr.wasm`, which `web/nfr/nfr.js` calls. They are no interface of their own: module and script are of one version.
//!
//! A call takes a font's handle, writes its results to the memory that the handle points to (see [`Handle`]), and returns a status.
//! On wasm32 a panic is a trap: the script gives up the instance then.

#![cfg_attr(target_arch = "wasm32", no_std)]
#![allow(unsafe_code, reason = "the script passes pointers; each block says what it promises")]
#![allow(clippy::missing_safety_doc, reason = "each function's last paragraph has the rules for its pointer")]
#![deny(unsafe_op_in_unsafe_fn, clippy::undocumented_unsafe_blocks)]

extern crate alloc;

mod font;
mod handle;
mod status;

pub use font::*;
pub use handle::*;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: dlmalloc::GlobalDlmalloc = dlmalloc::GlobalDlmalloc;

#[cfg(target_arch = "wasm32")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
