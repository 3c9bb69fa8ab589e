//! The exports, called as the script calls them.

#![allow(unsafe_code, reason = "the exports take pointers")]

use nfr_web::*;

static FONT: &[u8] = include_bytes!("../../../spec/vectors/outline.ttf");

/// A handle, freed in the end.
struct Opened(*mut Handle);

impl Opened {
    fn new(bytes: &[u8], missing: u32) -> Self {
        let at = nfr_alloc(bytes.len());
        assert!(!at.is_null());
        // SAFETY: `nfr_alloc` gave this many bytes, and they are given to `nfr_open` once.
        Self(unsafe {
            at.copy_from_nonoverlapping(bytes.as_ptr(), bytes.len());
            nfr_open(at, bytes.len(), 0, missing)
        })
    }

    fn results(&self) -> Results {
        // SAFETY: the handle is freed when this value is dropped.
        unsafe { &*self.0 }.results()
    }

    fn message(&self) -> String {
        let Results { message, message_len, .. } = self.results();
        // SAFETY: the message is the handle's until the next call.
        String::from_utf8_lossy(unsafe { std::slice::from_raw_parts(message, message_len) }).into_owned()
    }
}

impl Drop for Opened {
    fn drop(&mut self) {
        // SAFETY: `nfr_open` made the handle, and it is freed once.
        unsafe { nfr_free(self.0) }
    }
}

#[test]
fn a_glyph_is_drawn_as_the_library_draws_it() {
    let font = nfr::Font::new(FONT).unwrap_or_else(|e| panic!("{e}"));
    let opened = Opened::new(FONT, 0);
    for hinting in [true, false] {
        // SAFETY: the handle was not freed.
        let (glyph, status) = unsafe {
            let glyph = nfr_glyph_for_char(opened.0, 'g'.into());
            (glyph, nfr_draw(opened.0, glyph, 13.0, 0.25, 0.0, hinting))
        };
        assert_eq!(status, 0);
        let options = nfr::DrawOptions::new(13.0).with_offset([0.25, 0.0]).with_hinting(hinting);
        let bitmap = nfr::Rasterizer::new(&font).render(glyph, options).unwrap_or_else(|e| panic!("{e}"));
        let Results { left, top, width, height, pixels, .. } = opened.results();
        assert_eq!(nfr::Placement { left, top, width, height }, bitmap.placement);
        // SAFETY: the pixels are the handle's until the next call.
        assert_eq!(unsafe { std::slice::from_raw_parts(pixels, bitmap.pixels.len()) }, bitmap.pixels);
    }
}

#[test]
fn a_font_that_cannot_be_opened_has_a_handle_that_says_why() {
    let opened = Opened::new(b"no font", 0);
    assert_eq!((opened.results().status, opened.message().as_str()), (3, "the bytes are no OpenType font"));
    // SAFETY: the handle was not freed.
    unsafe {
        assert_eq!(nfr_glyph_count(opened.0), 0);
        assert_eq!(nfr_draw(opened.0, 1, 13.0, 0.0, 0.0, true), 2);
    }
    assert_eq!(Opened::new(b"", 0).results().status, 3);
}

#[test]
fn a_call_after_an_error_succeeds() {
    let opened = Opened::new(FONT, 0);
    // SAFETY: the handle was not freed.
    unsafe {
        assert_eq!(nfr_draw(opened.0, 9999, 13.0, 0.0, 0.0, true), 10);
        assert_eq!(opened.message(), "the font has no glyph 9999");
        assert_eq!(nfr_line_metrics(opened.0, f32::NAN), 12);
        assert_eq!(nfr_hinted_advance(opened.0, 1, 16.0), 0);
    }
    assert_eq!(opened.results().status, 0);
    assert_eq!(opened.results().numbers[0].fract(), 0.0);
}
