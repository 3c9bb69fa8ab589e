//! FreeType's bitmaps in black and white: of a font's glyphs, and of other points.
#![allow(dead_code, reason = "every file uses a part of it")]
#![allow(unsafe_code, reason = "freetype-rs does not let outlines be made or changed")]

use freetype::face::LoadFlag;
use freetype::{Error, Face, Library, RenderMode, ffi};
use nfr::internals::HintedOutline;
use nfr::internals::table::Dropout;
use nfr::{MonoBitmap, Placement};

/// FreeType's bitmap of a glyph, hinted for and drawn in black and white.
pub(crate) fn monochrome(face: &Face, gid: u16, ppem: u16, flags: LoadFlag) -> Result<MonoBitmap, Error> {
    load(face, gid, ppem, flags)?;
    drawn(face)
}

/// FreeType's bitmap of a glyph whose points are moved to those of another outline. None if that has not as many.
pub(crate) fn moved(
    face: &Face,
    gid: u16,
    ppem: u16,
    outline: &HintedOutline,
) -> Result<Option<MonoBitmap>, Error> {
    load(face, gid, ppem, LoadFlag::TARGET_MONO)?;
    let slot = &face.glyph().raw().outline;
    if slot.n_points as usize != outline.on_curve.len() {
        return Ok(None);
    }
    if slot.n_points > 0 {
        // SAFETY: the slot of the face has so many points until another glyph is loaded, and nothing else refers to them.
        let points = unsafe { std::slice::from_raw_parts_mut(slot.points, slot.n_points as usize) };
        for (k, point) in points.iter_mut().enumerate() {
            (point.x, point.y) = (outline.points[0][k].into(), outline.points[1][k].into());
        }
    }
    drawn(face).map(Some)
}

fn load(face: &Face, gid: u16, ppem: u16, flags: LoadFlag) -> Result<(), Error> {
    face.set_pixel_sizes(0, ppem.into())?;
    face.load_glyph(gid.into(), flags | LoadFlag::NO_BITMAP)
}

/// What FreeType draws of the glyph that is loaded.
fn drawn(face: &Face) -> Result<MonoBitmap, Error> {
    let slot = face.glyph();
    slot.render_glyph(RenderMode::Mono)?;
    let bitmap = slot.bitmap();
    let placement = Placement {
        left: slot.bitmap_left(),
        top: slot.bitmap_top(),
        width: bitmap.width() as u32,
        height: bitmap.rows() as u32,
    };
    Ok(packed(placement, bitmap.buffer(), bitmap.pitch()))
}

/// Rows as short as ours, which FreeType pads to an even number of bytes.
fn packed(placement: Placement, buffer: &[u8], pitch: i32) -> MonoBitmap {
    let (length, height) = (placement.width.div_ceil(8) as usize, placement.height as usize);
    let rows = buffer.chunks(pitch.max(1) as usize).take(height);
    MonoBitmap { placement, bits: rows.flat_map(|row| &row[..length]).copied().collect() }
}

/// What FreeType's rasteriser makes of an outline over a box.
pub(crate) fn rasterised(
    library: &Library,
    outline: &HintedOutline,
    placement: Placement,
    ppem: u16,
    mode: Dropout,
) -> MonoBitmap {
    let Placement { left, top, width, height } = placement;
    let bottom = top - height as i32;
    let [x, y] = [(0, left), (1, bottom)].map(|(axis, from)| {
        outline.points[axis].iter().map(move |v| i64::from(v - 64 * from)).collect::<Vec<i64>>()
    });
    let mut points: Vec<ffi::FT_Vector> =
        x.into_iter().zip(y).map(|(x, y)| ffi::FT_Vector { x, y }).collect();
    let mut tags: Vec<_> = outline.on_curve.iter().map(|on| std::ffi::c_char::from(*on)).collect();
    let mut ends: Vec<_> = outline.ends.iter().map(|end| *end as std::ffi::c_short - 1).collect();
    let flag = |set: bool, flag| if set { flag } else { 0 };
    let mut raw = ffi::FT_Outline {
        n_contours: ends.len() as _,
        n_points: points.len() as _,
        points: points.as_mut_ptr(),
        tags: tags.as_mut_ptr(),
        contours: ends.as_mut_ptr(),
        flags: flag(ppem < 24, ffi::FT_OUTLINE_HIGH_PRECISION)
            | flag(!mode.is_enabled(), ffi::FT_OUTLINE_IGNORE_DROPOUTS)
            | flag(mode.is_smart(), ffi::FT_OUTLINE_SMART_DROPOUTS)
            | flag(mode.fills_stubs(), ffi::FT_OUTLINE_INCLUDE_STUBS),
    };
    let pitch = width.div_ceil(8) as i32;
    let mut buffer = vec![0u8; pitch as usize * height as usize];
    let bitmap = ffi::FT_Bitmap {
        rows: height as _,
        width: width as _,
        pitch,
        buffer: buffer.as_mut_ptr(),
        num_grays: 2,
        pixel_mode: ffi::FT_PIXEL_MODE_MONO as _,
        palette_mode: 0,
        palette: std::ptr::null_mut(),
    };
    // SAFETY: the outline and the bitmap refer to vectors of the lengths that they say, which outlive the call.
    let error = unsafe { ffi::FT_Outline_Get_Bitmap(library.raw(), &raw mut raw, &raw const bitmap) };
    assert_eq!(error, 0, "FreeType refuses the outline");
    packed(placement, &buffer, pitch)
}
