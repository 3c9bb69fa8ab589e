//! Crisp small text on microcontrollers: [embedded-graphics](embedded_graphics) draws its `Text` from the models of an [`nfr::Font`].
//!
//! ```
//! use embedded_graphics::mock_display::MockDisplay;
//! use embedded_graphics::pixelcolor::Gray8;
//! use embedded_graphics::prelude::*;
//! use embedded_graphics::text::Text;
//! use nfr_embedded::Face;
//!
//! static FONT: &[u8] = include_bytes!("../fonts/ascii.nfr.ttf");
//!
//! let font = nfr::Font::new(FONT)?;
//! let face = Face::new(&font);
//! let style = face.style(12.0, Gray8::WHITE, Gray8::BLACK);
//! let mut display = MockDisplay::new();
//! // The columns of neighbouring glyphs may overlap.
//! display.set_allow_overdraw(true);
//! Text::new("nfr", Point::new(0, 20), style).draw(&mut display).unwrap();
//! assert_eq!(face.problem(), None);
//! # Ok::<(), nfr::Error>(())
//! ```
//!
//! A [`Face`] has the font with its cache, a [`Style`] the size and the colours. A display cannot be read back: partly covered
//! pixels are mixed with a colour that the style names as the background. [`pack`] is for programs that write to the memory of a
//! display themselves: it packs coverage to 1, 2, 4 or 8 bits a pixel.
//!
//! The crate is `no_std` and allocates.

#![no_std]
#![forbid(unsafe_code)]

extern crate alloc;

mod blend;
mod face;
mod ink;
mod pack;
mod renderer;
mod style;

pub use blend::Blend;
pub use face::{Face, Missing, Problem, Reason};
pub use pack::{BufferTooSmall, Depth, pack};
pub use style::Style;

/// Runs the examples of the README as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
