//! Handles: a font, its rasterizer, and the results of the last call with it.

use alloc::boxed::Box;
use alloc::string::{String, ToString};

use nfr::{BitmapRef, Error, Font, LineMetrics, Rasterizer};

use crate::status::{INVALID_ARGUMENT, OK, of};

/// What a handle points to. It begins with the results, which the script reads.
#[repr(C)]
#[derive(Debug)]
pub struct Handle {
    results: Results,
    opened: Option<Opened>,
    text: String,
}

/// The results of a call, in 32-bit words where memory has 32-bit addresses.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Results {
    /// What the last call came to.
    pub status: u32,
    /// Why it failed, in UTF-8.
    pub message: *const u8,
    /// The message's length in bytes.
    pub message_len: usize,
    /// Where a bitmap's left edge is.
    pub left: i32,
    /// Where its top edge is.
    pub top: i32,
    /// Its columns.
    pub width: u32,
    /// Its rows.
    pub height: u32,
    /// Its coverage: valid until the next call with this handle.
    pub pixels: *const u8,
    /// A width, or the metrics of a line.
    pub numbers: [f32; 5],
}

/// A font that could be opened.
#[derive(Debug)]
pub(crate) struct Opened {
    pub(crate) font: Font,
    pub(crate) rasterizer: Rasterizer,
}

impl Handle {
    pub(crate) fn new(opened: Result<Opened, Error>) -> Box<Self> {
        let results = Results {
            status: OK,
            message: core::ptr::null(),
            message_len: 0,
            left: 0,
            top: 0,
            width: 0,
            height: 0,
            pixels: core::ptr::null(),
            numbers: [0.0; 5],
        };
        let error = opened.as_ref().err().copied();
        let mut handle = Box::new(Self { results, opened: opened.ok(), text: String::new() });
        if let Some(error) = error {
            handle.fail(of(&error), error.to_string());
        }
        handle
    }

    /// What the last call came to.
    pub fn results(&self) -> Results {
        self.results
    }

    /// Does the work of a call, and keeps status and message.
    pub(crate) fn call(&mut self, work: impl FnOnce(&mut Results, &mut Opened) -> Result<(), Error>) -> u32 {
        let Some(opened) = &mut self.opened else {
            return self.fail(INVALID_ARGUMENT, "the font could not be opened".to_string());
        };
        match work(&mut self.results, opened) {
            Ok(()) => {
                self.results.status = OK;
                OK
            }
            Err(error) => self.fail(of(&error), error.to_string()),
        }
    }

    /// A property of the font; `default` if it could not be opened.
    pub(crate) fn property<T>(&self, default: T, of: impl FnOnce(&Font) -> T) -> T {
        self.opened.as_ref().map_or(default, |opened| of(&opened.font))
    }

    fn fail(&mut self, status: u32, text: String) -> u32 {
        self.text = text;
        self.results.message = self.text.as_ptr();
        self.results.message_len = self.text.len();
        self.results.status = status;
        status
    }
}

impl Results {
    pub(crate) fn set_bitmap(&mut self, bitmap: BitmapRef<'_>) {
        let place = bitmap.placement;
        (self.left, self.top, self.width, self.height) = (place.left, place.top, place.width, place.height);
        self.pixels = bitmap.pixels.as_ptr();
    }

    pub(crate) fn set_line(&mut self, line: LineMetrics) {
        self.numbers =
            [line.ascent, line.descent, line.line_gap, line.underline_position, line.underline_thickness];
    }
}
