//! FreeType's bitmaps, for the tests and examples that compare with them.
#![allow(dead_code, reason = "every file uses a part of it")]

use freetype::face::LoadFlag;
use freetype::{Error, Face, RenderMode};
use nfr::{Bitmap, Placement};

/// FreeType's grey bitmap of a glyph that is loaded with `flags`, over the box that FreeType gives it.
pub(crate) fn freetype_bitmap(face: &Face, gid: u16, ppem: u16, flags: LoadFlag) -> Result<Bitmap, Error> {
    face.set_pixel_sizes(0, ppem.into())?;
    face.load_glyph(gid.into(), flags | LoadFlag::NO_BITMAP)?;
    rendered(face, RenderMode::Normal)
}

/// What FreeType draws of the glyph that is loaded, a byte a sample: three of them may be a pixel.
pub(crate) fn rendered(face: &Face, mode: RenderMode) -> Result<Bitmap, Error> {
    let slot = face.glyph();
    slot.render_glyph(mode)?;
    let bitmap = slot.bitmap();
    let (width, height) = (bitmap.width() as usize, bitmap.rows() as usize);
    let placement = Placement {
        left: slot.bitmap_left(),
        top: slot.bitmap_top(),
        width: width as u32,
        height: height as u32,
    };
    let rows = bitmap.buffer().chunks(bitmap.pitch().max(1) as usize).take(height);
    Ok(Bitmap { placement, pixels: rows.flat_map(|row| &row[..width]).copied().collect() })
}
