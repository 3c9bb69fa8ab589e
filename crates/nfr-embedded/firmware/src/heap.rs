//! A heap that knows how much of it was ever in use.

use core::alloc::{GlobalAlloc, Layout};
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use embedded_alloc::LlffHeap;

/// Where the board has 16 MB that nothing else uses.
const START: usize = 0x2100_0000;
/// The whole of it.
pub const ALL: usize = 16 << 20;
/// The allocator gives blocks of such sizes.
const BLOCK: usize = 8;

struct Counting(LlffHeap);

#[global_allocator]
static HEAP: Counting = Counting(LlffHeap::empty());

static USED: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
static END: AtomicUsize = AtomicUsize::new(START);

// SAFETY: every request goes to the heap below as it is; only its size is counted.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise is the heap's condition.
        let start = unsafe { self.0.alloc(layout) };
        if !start.is_null() {
            let size = layout.size().next_multiple_of(BLOCK);
            let used = USED.fetch_add(size, Relaxed) + size;
            PEAK.fetch_max(used, Relaxed);
            END.fetch_max(start as usize + size, Relaxed);
        }
        start
    }

    unsafe fn dealloc(&self, start: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size().next_multiple_of(BLOCK), Relaxed);
        // SAFETY: the caller's promise is the heap's condition.
        unsafe { self.0.dealloc(start, layout) }
    }
}

/// Gives the allocator `size` bytes; to be called once, before anything is allocated.
pub fn init(size: usize) {
    // SAFETY: the memory exists, no linker script names it, and this is called once.
    unsafe { HEAP.0.init(START, size.min(ALL)) }
}

/// Forgets the peak and the extent, for the next measurement.
pub fn reset() {
    PEAK.store(used(), Relaxed);
    END.store(START, Relaxed);
}

/// The bytes in use.
pub fn used() -> usize {
    USED.load(Relaxed)
}

/// The most bytes that were in use at once, in whole blocks.
pub fn peak() -> usize {
    PEAK.load(Relaxed)
}

/// How far into the memory the heap went: the peak, and the gaps that it could not fill.
pub fn extent() -> usize {
    END.load(Relaxed) - START
}
