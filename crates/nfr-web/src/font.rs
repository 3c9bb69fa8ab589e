//! The exports.

use alloc::alloc::{Layout, alloc};
use alloc::boxed::Box;
use alloc::vec::Vec;

use nfr::{DrawOptions, Error, Font, MissingModel, Rasterizer, Target};

use crate::handle::{Handle, Opened};

/// Memory for a font file, to be filled and given to [`nfr_open`]; NULL if there is not as much.
#[unsafe(no_mangle)]
pub extern "C" fn nfr_alloc(len: usize) -> *mut u8 {
    match Layout::array::<u8>(len.max(1)) {
        // SAFETY: the size is not 0.
        Ok(layout) => unsafe { alloc(layout) },
        Err(_) => core::ptr::null_mut(),
    }
}

/// Opens a font, and always returns a handle: its status says whether a font is behind it. `missing` chooses what is drawn for a
/// glyph without a model: 0 nothing, with an error; 1 an empty bitmap; else the plain outline.
///
/// `data` is from `nfr_alloc(len)`, `len` bytes were written there, and it is given once. The handle goes to [`nfr_free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_open(data: *mut u8, len: usize, index: u32, missing: u32) -> *mut Handle {
    // SAFETY: the script gives what `nfr_alloc` gave, which had this capacity, and has written `len` bytes.
    let bytes = unsafe { Vec::from_raw_parts(data, len, len.max(1)) };
    Box::into_raw(Handle::new(open(bytes, index, missing)))
}

fn open(bytes: Vec<u8>, index: u32, missing: u32) -> Result<Opened, Error> {
    let font = Font::from_index(bytes, index)?;
    let missing = match missing {
        0 => MissingModel::Error,
        1 => MissingModel::Blank,
        _ => MissingModel::Outline,
    };
    let rasterizer = Rasterizer::new(&font).with_missing_model(missing);
    Ok(Opened { font, rasterizer })
}

/// Frees a handle.
///
/// `handle` is from [`nfr_open`] and is given once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_free(handle: *mut Handle) {
    // SAFETY: `nfr_open` made it of a box.
    drop(unsafe { Box::from_raw(handle) });
}

/// The number of glyphs.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_glyph_count(handle: *const Handle) -> u32 {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(0, Font::glyph_count)
}

/// The number of glyphs that have models.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_model_count(handle: *const Handle) -> usize {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(0, |font| font.modelled_glyphs().len())
}

/// The bytes of the table of models.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_table_len(handle: *const Handle) -> usize {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(0, Font::table_len)
}

/// Font units in an em.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_units_per_em(handle: *const Handle) -> u32 {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(0, |font| font.units_per_em().into())
}

/// What the models were made for: 1 smooth, 2 mono, 3 lcd, 0 another.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_target(handle: *const Handle) -> u32 {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(0, |font| match font.target() {
        Target::Smooth => 1,
        Target::Mono => 2,
        Target::Lcd => 3,
        _ => 0,
    })
}

/// The smallest size that the models know, and the largest times 65536.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_ppem_range(handle: *const Handle) -> u32 {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(0, |font| {
        let (first, last) = font.ppem_range();
        u32::from(first) | u32::from(last) << 16
    })
}

/// Whether the glyphs that have models have no outlines.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_outlines_dropped(handle: *const Handle) -> bool {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(false, Font::outlines_dropped)
}

/// Whether a glyph has a model.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_has_model(handle: *const Handle, glyph: u32) -> bool {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(false, |font| font.has_model(glyph))
}

/// The glyph of a code point; 0, the glyph for what is missing, if the font has none.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_glyph_for_char(handle: *const Handle, code_point: u32) -> u32 {
    let of = |font: &Font| font.glyph_for_char(char::from_u32(code_point)?);
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(0, |font| of(font).unwrap_or(0))
}

/// The advance width in pixels, linear in the size.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_advance(handle: *const Handle, glyph: u32, ppem: f32) -> f32 {
    // SAFETY: the handle was not freed.
    unsafe { &*handle }.property(0.0, |font| font.advance(glyph, ppem))
}

/// The hinted advance width in pixels, in the first number.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_hinted_advance(handle: *mut Handle, glyph: u32, ppem: f32) -> u32 {
    // SAFETY: the handle was not freed, and nothing else uses it in this call.
    unsafe { &mut *handle }.call(|results, opened| {
        results.numbers[0] = opened.rasterizer.hinted_advance(glyph, ppem)?;
        Ok(())
    })
}

/// Metrics of a line, in the numbers: ascent, descent, gap, and the underline's position and thickness.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_line_metrics(handle: *mut Handle, ppem: f32) -> u32 {
    // SAFETY: the handle was not freed, and nothing else uses it in this call.
    unsafe { &mut *handle }.call(|results, opened| {
        if !(ppem > 0.0 && ppem <= DrawOptions::MAX_PPEM) {
            return Err(Error::InvalidSize(ppem));
        }
        results.set_line(opened.font.line_metrics(ppem));
        Ok(())
    })
}

/// Draws a glyph into memory of the rasterizer's, and lends it until the next call with this handle.
///
/// `handle` is from [`nfr_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nfr_draw(
    handle: *mut Handle,
    glyph: u32,
    ppem: f32,
    offset_x: f32,
    offset_y: f32,
    hinting: bool,
) -> u32 {
    let options = DrawOptions::new(ppem).with_offset([offset_x, offset_y]).with_hinting(hinting);
    // SAFETY: the handle was not freed, and nothing else uses it in this call.
    unsafe { &mut *handle }.call(|results, opened| {
        results.set_bitmap(opened.rasterizer.draw(glyph, options)?);
        Ok(())
    })
}
