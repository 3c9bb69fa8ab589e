//! What the programs share: a heap that counts, a stack that shows how deep it went, a clock, and an exit that the machine that
//! runs qemu sees.

#![no_std]

pub mod clock;
pub mod heap;
pub mod stack;

use cortex_m_semihosting::debug;

/// A converted font: printable ASCII of Liberation Sans for 10–24 pixels per em.
pub static FONT: &[u8] = include_bytes!("../../fonts/ascii.nfr.ttf");

/// Ends the program: with status 0 if all went well.
pub fn exit(good: bool) -> ! {
    debug::exit(if good { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    loop {}
}

/// Ends the program with an error when it panics. Without allocation left, it does, too: `alloc` calls `handle_alloc_error`, which panics.
#[macro_export]
macro_rules! panics {
    ($($name:ident => $print:expr)?) => {
        #[panic_handler]
        fn panic(_info: &core::panic::PanicInfo) -> ! {
            $(let $name = _info; $print;)?
            $crate::exit(false)
        }
    };
}
