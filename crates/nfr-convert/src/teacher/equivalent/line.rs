//! Vertical phantom points of a font without `vmtx`. They stand at the ascender and the descender: those of `OS/2` in
//! FreeType, those of `hhea` in skrifa, unless the font asks for those of `OS/2`.

use read_fonts::tables::os2::SelectionFlags;
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};

/// Where `OS/2` has fsSelection (OpenType 1.9, "OS/2").
const FS_SELECTION_AT: usize = 62;

/// The font's bytes with `USE_TYPO_METRICS` set, if that moves vertical phantom points.
pub(super) fn with_typo_line(font: &FontRef<'_>) -> Option<Vec<u8>> {
    if !has_another_line(font) {
        return None;
    }
    let record =
        font.table_directory().table_records().iter().find(|record| record.tag() == Tag::new(b"OS/2"))?;
    let at = usize::try_from(record.offset()).ok()?.checked_add(FS_SELECTION_AT)?;
    let mut data = font.data().as_bytes().to_vec();
    let selection = data.get_mut(at..)?.first_chunk_mut()?;
    let flags = u16::from_be_bytes(*selection) | SelectionFlags::USE_TYPO_METRICS.bits();
    *selection = flags.to_be_bytes();
    Some(data)
}

/// Whether skrifa would put the phantom points elsewhere than FreeType.
fn has_another_line(font: &FontRef<'_>) -> bool {
    let (Err(_), Ok(os2), Ok(hhea)) = (font.vmtx(), font.os2(), font.hhea()) else { return false };
    let hhea = [hhea.ascender().to_i16(), hhea.descender().to_i16()];
    // skrifa does not take a line of no height.
    let same = hhea == [os2.s_typo_ascender(), os2.s_typo_descender()] && hhea != [0, 0];
    !same && !os2.fs_selection().contains(SelectionFlags::USE_TYPO_METRICS)
}
