//! Rasterizers: drawing, and what drawing may take.

use nfr::{DrawOptions, Error, Limits, MissingModel, Rasterizer};

use crate::font::nfr_font;
use crate::pointers::{Out, buffer, exclusive, shared};
use crate::status::{Failure, call, nfr_status, value};
use crate::values::{nfr_limits, nfr_missing_model, nfr_placement};

/// Draws the glyphs of a font. It keeps decoded models and its working memory. One thread at a time may use it; each
/// thread may have its own for the same font.
pub struct nfr_rasterizer(Rasterizer);

/// A rasterizer with a cache of 8 MiB and the default limits, for which a glyph without a model is an error.
///
/// font: a font, which may be freed before the rasterizer. rasterizer: receives it, to be freed with
/// nfr_rasterizer_free, or NULL on failure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_new(
    font: *const nfr_font,
    rasterizer: *mut *mut nfr_rasterizer,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for a pointer to write to.
        let out = unsafe { Out::new(rasterizer, "rasterizer") }?;
        out.set(std::ptr::null_mut());
        // SAFETY: the header asks for NULL or a font.
        let font = unsafe { shared(font, "font") }?;
        out.set(Box::into_raw(Box::new(nfr_rasterizer(Rasterizer::new(&font.0)))));
        Ok(())
    })
}

/// Frees a rasterizer, and the pixels that it lends.
///
/// rasterizer: from nfr_rasterizer_new and not freed yet, or NULL, which does nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_free(rasterizer: *mut nfr_rasterizer) {
    value((), || {
        if !rasterizer.is_null() {
            // SAFETY: the header asks for a rasterizer that nfr_rasterizer_new made and that is freed once.
            drop(unsafe { Box::from_raw(rasterizer) });
        }
    });
}

/// Changes a rasterizer's settings, which the library takes by value.
///
/// # Safety
///
/// `rasterizer` is NULL, or a rasterizer that nothing else uses in this call.
unsafe fn change(
    rasterizer: *mut nfr_rasterizer,
    with: impl FnOnce(Rasterizer) -> Rasterizer,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    let held = &mut unsafe { exclusive(rasterizer, "rasterizer") }?.0;
    // Fresh ones are empty: this allocates nothing.
    let fresh = Rasterizer::new(held.font());
    *held = with(std::mem::replace(held, fresh));
    Ok(())
}

/// Keeps decoded models of at most so many bytes, and always at least the last one. What is kept is dropped.
///
/// rasterizer: a rasterizer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_set_cache(
    rasterizer: *mut nfr_rasterizer,
    bytes: usize,
) -> nfr_status {
    // SAFETY: the header asks for NULL or a rasterizer of this thread.
    call(|| unsafe { change(rasterizer, |rasterizer| rasterizer.with_cache(bytes)) })
}

/// The default limits.
///
/// limits: receives them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_limits_default(limits: *mut nfr_limits) -> nfr_status {
    call(|| {
        let Limits { bitmap_side, decoded_bytes, work, .. } = Limits::default();
        // SAFETY: the header asks for a pointer to write to.
        unsafe { Out::new(limits, "limits") }?.set(nfr_limits { bitmap_side, decoded_bytes, work });
        Ok(())
    })
}

/// Sets what drawing a glyph may take. What the cache keeps is dropped.
///
/// rasterizer: a rasterizer. limits: read in this call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_set_limits(
    rasterizer: *mut nfr_rasterizer,
    limits: *const nfr_limits,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for NULL or limits.
        let wanted = *unsafe { shared(limits, "limits") }?;
        let mut limits = Limits::default();
        limits.bitmap_side = wanted.bitmap_side;
        limits.decoded_bytes = wanted.decoded_bytes;
        limits.work = wanted.work;
        // SAFETY: the header asks for NULL or a rasterizer of this thread.
        unsafe { change(rasterizer, |rasterizer| rasterizer.with_limits(limits)) }
    })
}

/// Chooses what is drawn for a glyph without a model: a value of nfr_missing_model, else NFR_INVALID_ARGUMENT.
///
/// rasterizer: a rasterizer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_set_missing_model(
    rasterizer: *mut nfr_rasterizer,
    missing: u32,
) -> nfr_status {
    const ERROR: u32 = nfr_missing_model::NFR_MISSING_MODEL_ERROR as u32;
    const BLANK: u32 = nfr_missing_model::NFR_MISSING_MODEL_BLANK as u32;
    const OUTLINE: u32 = nfr_missing_model::NFR_MISSING_MODEL_OUTLINE as u32;
    call(|| {
        let missing = match missing {
            ERROR => MissingModel::Error,
            BLANK => MissingModel::Blank,
            OUTLINE => MissingModel::Outline,
            _ => return Err(Failure::Argument("the choice for missing models is no nfr_missing_model")),
        };
        // SAFETY: the header asks for NULL or a rasterizer of this thread.
        unsafe { change(rasterizer, |rasterizer| rasterizer.with_missing_model(missing)) }
    })
}

/// The hinted advance width in pixels: a whole number at the sizes of nfr_font_ppem_range, and nfr_font_advance at others
/// and for glyphs whose models do not know it.
///
/// rasterizer: a rasterizer. advance: receives the width.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_hinted_advance(
    rasterizer: *mut nfr_rasterizer,
    glyph: u32,
    ppem: f32,
    advance: *mut f32,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for NULL or a rasterizer of this thread, and for a pointer to write to.
        let (held, out) = unsafe { (exclusive(rasterizer, "rasterizer")?, Out::new(advance, "advance")?) };
        out.set(held.0.hinted_advance(glyph, ppem)?);
        Ok(())
    })
}

/// Where a glyph's bitmap lies, without drawing it. The size is in pixels per em and may be fractional; the offset moves
/// the glyph by parts of a pixel, x to the right and y up, and is 0, 0 for text at whole pixels.
///
/// rasterizer: a rasterizer. placement: receives it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_placement(
    rasterizer: *mut nfr_rasterizer,
    glyph: u32,
    ppem: f32,
    offset_x: f32,
    offset_y: f32,
    placement: *mut nfr_placement,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for NULL or a rasterizer of this thread, and for a pointer to write to.
        let (held, out) =
            unsafe { (exclusive(rasterizer, "rasterizer")?, Out::new(placement, "placement")?) };
        out.set(held.0.placement(glyph, options(ppem, offset_x, offset_y))?.into());
        Ok(())
    })
}

/// Draws a glyph into the application's memory: coverage 0-255, top row first, rows `stride` bytes apart. Bytes beside
/// and behind the bitmap are left alone. Size and offset are as in nfr_rasterizer_placement.
///
/// If it returns NFR_BUFFER_TOO_SMALL, nothing was drawn and the placement tells what is needed: a stride of at least
/// width, and (height - 1) * stride + width bytes. A glyph without ink needs none.
///
/// rasterizer: a rasterizer. pixels: `len` bytes to write in this call, or NULL if len is 0. placement: receives it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_render_into(
    rasterizer: *mut nfr_rasterizer,
    glyph: u32,
    ppem: f32,
    offset_x: f32,
    offset_y: f32,
    pixels: *mut u8,
    len: usize,
    stride: usize,
    placement: *mut nfr_placement,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for NULL or a rasterizer of this thread, and for a pointer to write to.
        let (held, out) =
            unsafe { (exclusive(rasterizer, "rasterizer")?, Out::new(placement, "placement")?) };
        // SAFETY: the header asks for memory that is written in this call alone.
        let pixels = unsafe { buffer(pixels, len) }?;
        let drawn = held.0.render_into(glyph, options(ppem, offset_x, offset_y), pixels, stride);
        if let Err(Error::BufferTooSmall { placement, .. }) = drawn {
            out.set(placement.into());
        }
        out.set(drawn?.into());
        Ok(())
    })
}

/// Draws a glyph into memory of the rasterizer's, and lends it: placement.height rows of placement.width bytes, coverage
/// 0-255, top row first. Size and offset are as in nfr_rasterizer_placement.
///
/// rasterizer: a rasterizer. pixels: receives a pointer that is never NULL on success, and valid until the next call with
/// this rasterizer. placement: receives it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_draw(
    rasterizer: *mut nfr_rasterizer,
    glyph: u32,
    ppem: f32,
    offset_x: f32,
    offset_y: f32,
    pixels: *mut *const u8,
    placement: *mut nfr_placement,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for NULL or a rasterizer of this thread, and for pointers to write to.
        let (held, lent, out) = unsafe {
            let held = exclusive(rasterizer, "rasterizer")?;
            (held, Out::new(pixels, "pixels")?, Out::new(placement, "placement")?)
        };
        let bitmap = held.0.draw(glyph, options(ppem, offset_x, offset_y))?;
        out.set(bitmap.placement.into());
        lent.set(bitmap.pixels.as_ptr());
        Ok(())
    })
}

/// Draws a glyph in black and white into memory of the rasterizer's, and lends it: placement.height rows of
/// (placement.width + 7) / 8 bytes, one bit a pixel, top row first, the first pixel of a byte in its highest bit. Drop-out
/// control fills the gaps of thin strokes as FreeType's FT_RENDER_MODE_MONO does. Size and offset are as in
/// nfr_rasterizer_placement, whose box is that of coverage; this one may be smaller.
///
/// rasterizer: a rasterizer. bits: receives a pointer that is never NULL on success, and valid until the next call with
/// this rasterizer. placement: receives it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_rasterizer_draw_mono(
    rasterizer: *mut nfr_rasterizer,
    glyph: u32,
    ppem: f32,
    offset_x: f32,
    offset_y: f32,
    bits: *mut *const u8,
    placement: *mut nfr_placement,
) -> nfr_status {
    call(|| {
        // SAFETY: the header asks for NULL or a rasterizer of this thread, and for pointers to write to.
        let (held, lent, out) = unsafe {
            let held = exclusive(rasterizer, "rasterizer")?;
            (held, Out::new(bits, "bits")?, Out::new(placement, "placement")?)
        };
        let bitmap = held.0.draw_mono(glyph, options(ppem, offset_x, offset_y))?;
        out.set(bitmap.placement.into());
        lent.set(bitmap.bits.as_ptr());
        Ok(())
    })
}

fn options(ppem: f32, x: f32, y: f32) -> DrawOptions {
    DrawOptions::new(ppem).with_offset([x, y])
}
