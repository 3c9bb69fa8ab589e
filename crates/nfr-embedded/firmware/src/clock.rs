//! Instructions, counted by the SysTick timer. qemu's `-icount shift=0` takes one nanosecond for each instruction, and the timer ticks
//! at 25 MHz of that time, once in 40 instructions. `calibrate` checks it on a loop of known length.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// Instructions a tick.
pub const PER_TICK: u32 = 40;

/// A running timer.
pub struct Clock(SYST);

impl Clock {
    /// Starts the timer of the core.
    pub fn start(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(0x00FF_FFFF);
        timer.clear_current();
        timer.enable_counter();
        Self(timer)
    }

    /// The instructions of a piece of work, to 40 of them, at most 671 million.
    pub fn count<T>(&self, work: impl FnOnce() -> T) -> (u32, T) {
        let _ = &self.0;
        let before = SYST::get_current();
        let result = work();
        let after = SYST::get_current();
        ((before.wrapping_sub(after) & 0x00FF_FFFF) * PER_TICK, result)
    }

    /// What the clock counts for a loop of a million instructions.
    pub fn calibrate(&self) -> u32 {
        // Each turn is a subtraction and a branch.
        self.count(|| cortex_m::asm::delay(500_000)).0
    }
}
