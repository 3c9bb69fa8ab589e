//! How deep the stack went: what is below it is painted, and what is no longer painted was used.

use core::ptr;

const PAINT: u32 = 0xC5C5_C5C5;
/// How much is painted, in words.
const WORDS: usize = 16 << 10;
/// The frames of the functions here are below the caller's: they are not painted, in words.
const SPARED: usize = 64;

/// The painted part of the stack.
pub struct Paint {
    bottom: *mut u32,
    top: *const u32,
}

/// The stack pointer.
fn here() -> usize {
    cortex_m::register::msp::read() as usize
}

/// Paints the stack below the caller.
#[inline(never)]
pub fn paint() -> Paint {
    let top = (here() & !3) - 4 * SPARED;
    let bottom = (top - 4 * WORDS) as *mut u32;
    for at in 0..WORDS {
        // SAFETY: the stack grows down from the end of 4 MB of memory, so this is memory below every frame in use.
        unsafe { ptr::write_volatile(bottom.add(at), PAINT) }
    }
    Paint { bottom, top: top as *const u32 }
}

impl Paint {
    /// The most bytes that were used below the caller of [`paint`] since.
    pub fn depth(&self) -> usize {
        // SAFETY: the memory that `paint` wrote.
        let painted =
            (0..WORDS).take_while(|at| unsafe { ptr::read_volatile(self.bottom.add(*at)) } == PAINT);
        self.top as usize + 4 * SPARED - (self.bottom as usize + 4 * painted.count())
    }
}
