//! The smallest program with a heap: what `text` has beside the renderer.

#![no_std]
#![no_main]

extern crate alloc;

use alloc::vec::Vec;

use nfr_firmware::{exit, heap};

nfr_firmware::panics!();

#[cortex_m_rt::entry]
fn main() -> ! {
    heap::init(heap::ALL);
    let mut bytes = Vec::new();
    for at in 0..core::hint::black_box(100u8) {
        bytes.push(at);
    }
    exit(core::hint::black_box(&bytes).len() == 100)
}
