//! Fonts: opening, looking glyphs up, metrics.

use std::ffi::c_void;

use nfr::Font;

use crate::bytes::{Borrowed, Release, nfr_release};
use crate::pointers::{Out, bytes, shared};
use crate::status::{Failure, call, nfr_status, value};
use crate::values::{nfr_line_metrics, nfr_target};

/// A font with models. Threads may use one font at the same time.
pub struct nfr_font(pub(crate) Font);

/// Opens a font from a copy of a file's bytes. `index` counts the fonts of a collection and is 0 for a plain font.
///
/// data: `len` bytes to read in this call. font: receives the font, to be freed with nfr_font_free, or NULL on failure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_new(
    data: *const u8,
    len: usize,
    index: u32,
    font: *mut *mut nfr_font,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for a pointer to write to.
        let out = unsafe { Out::new(font, "font") }?;
        out.set(std::ptr::null_mut());
        // SAFETY: the header asks for bytes to read in this call.
        let copy = unsafe { bytes(data, len) }?.to_vec();
        out.set(handle(Font::from_index(copy, index)?));
        Ok(())
    })
}

/// Opens a font from bytes that stay where they are, as in flash memory or a mapped file: nothing is copied.
///
/// data: `len` bytes that must stay readable and unchanged until `release` is called; without one, until the font and all
/// rasterizers of it are freed. release: called with `user` exactly once, and in this call if it fails, for whatever
/// reason; on the thread that frees the last of the font and its rasterizers. It may be NULL. font: as in nfr_font_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_new_borrowed(
    data: *const u8,
    len: usize,
    index: u32,
    release: nfr_release,
    user: *mut c_void,
    font: *mut *mut nfr_font,
) -> nfr_status {
    call(|| {
        let release = Release { function: release, user };
        // SAFETY: the header asks for a pointer to write to.
        let out = unsafe { Out::new(font, "font") }?;
        out.set(std::ptr::null_mut());
        // SAFETY: the header asks for bytes to read; this checks pointer and length.
        unsafe { bytes(data, len) }?;
        // SAFETY: the header asks for bytes that stay until `release` is called.
        let borrowed = unsafe { Borrowed::new(data, len, release) };
        out.set(handle(Font::from_index(borrowed, index)?));
        Ok(())
    })
}

fn handle(font: Font) -> *mut nfr_font {
    Box::into_raw(Box::new(nfr_font(font)))
}

/// Frees a font. Its rasterizers stay valid.
///
/// font: from nfr_font_new or nfr_font_new_borrowed and not freed yet, or NULL, which does nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_free(font: *mut nfr_font) {
    value((), || {
        if !font.is_null() {
            // SAFETY: the header asks for a font that was made by `handle` and is freed once.
            drop(unsafe { Box::from_raw(font) });
        }
    });
}

/// A property of a font; `default` without one.
///
/// # Safety
///
/// `font` is NULL or a font that is not freed.
unsafe fn property<T: Copy>(font: *const nfr_font, default: T, of: impl FnOnce(&Font) -> T) -> T {
    // SAFETY: the caller's promise.
    value(default, || unsafe { font.as_ref() }.map_or(default, |font| of(&font.0)))
}

/// The number of glyphs in the font, with a model or without; 0 if font is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_glyph_count(font: *const nfr_font) -> u32 {
    // SAFETY: the header asks for NULL or a font.
    unsafe { property(font, 0, Font::glyph_count) }
}

/// Font units in an em; 0 if font is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_units_per_em(font: *const nfr_font) -> u16 {
    // SAFETY: the header asks for NULL or a font.
    unsafe { property(font, 0, Font::units_per_em) }
}

/// What the models were made for; NFR_TARGET_UNKNOWN if font is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_target(font: *const nfr_font) -> nfr_target {
    // SAFETY: the header asks for NULL or a font.
    unsafe { property(font, nfr_target::NFR_TARGET_UNKNOWN, |font| font.target().into()) }
}

/// The models know every whole size from `first` to `last`, in pixels per em; glyphs that a network draws, some of them.
///
/// font: a font. first, last: receive the sizes; either may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_ppem_range(
    font: *const nfr_font,
    first: *mut u16,
    last: *mut u16,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for NULL or a font.
        let range = unsafe { shared(font, "font") }?.0.ppem_range();
        for (pointer, size) in [(first, range.0), (last, range.1)] {
            if !pointer.is_null() {
                // SAFETY: the header asks for NULL or a pointer to write to.
                unsafe { pointer.write(size) };
            }
        }
        Ok(())
    })
}

/// Whether a glyph has a model; false if font is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_has_model(font: *const nfr_font, glyph: u32) -> bool {
    // SAFETY: the header asks for NULL or a font.
    unsafe { property(font, false, |font| font.has_model(glyph)) }
}

/// Whether the glyphs that have models have no outlines in this font, so that no other renderer draws them; false if font
/// is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_outlines_dropped(font: *const nfr_font) -> bool {
    // SAFETY: the header asks for NULL or a font.
    unsafe { property(font, false, Font::outlines_dropped) }
}

/// The glyph of a Unicode code point; 0, the glyph for what is missing, if the font has none or font is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_glyph_for_char(font: *const nfr_font, code_point: u32) -> u32 {
    let of = |font: &Font| char::from_u32(code_point).and_then(|c| font.glyph_for_char(c)).unwrap_or(0);
    // SAFETY: the header asks for NULL or a font.
    unsafe { property(font, 0, of) }
}

/// The glyph of a code point with a variation selector behind it, U+FE00-FE0F or U+E0100-E01EF; 0 if the font does not
/// list them or font is NULL. nfr_font_glyph_for_char has the glyph then, and nothing is drawn for the selector.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_glyph_for_variation(
    font: *const nfr_font,
    code_point: u32,
    selector: u32,
) -> u32 {
    let of = |font: &Font| font.glyph_for_variation(char::from_u32(code_point)?, char::from_u32(selector)?);
    // SAFETY: the header asks for NULL or a font.
    unsafe { property(font, 0, |font| of(font).unwrap_or(0)) }
}

/// The advance width in pixels, linear in the size; 0 for a glyph that the font does not have, and if font is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_advance(font: *const nfr_font, glyph: u32, ppem: f32) -> f32 {
    // SAFETY: the header asks for NULL or a font.
    unsafe { property(font, 0.0, |font| font.advance(glyph, ppem)) }
}

/// Metrics of a line of text at a size in pixels per em.
///
/// font: a font. metrics: receives them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_font_line_metrics(
    font: *const nfr_font,
    ppem: f32,
    metrics: *mut nfr_line_metrics,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for NULL or a font, and for a pointer to write to.
        let (font, out) = unsafe { (shared(font, "font")?, Out::new(metrics, "metrics")?) };
        if !(ppem > 0.0 && ppem <= nfr::DrawOptions::MAX_PPEM) {
            return Err(Failure::Nfr(nfr::Error::InvalidSize(ppem)));
        }
        out.set(font.0.line_metrics(ppem).into());
        Ok(())
    })
}
