//! Opening a font file. Errors say what to do about a file that does not open.

use read_fonts::{FontRef, TableProvider};
use skrifa::font::Font;

use crate::error::Error;
use nfr::internals::table;

/// Whether the font carries models already.
pub fn has_models(font: &FontRef<'_>) -> bool {
    font.table_directory().table_records().iter().any(|record| record.tag() == table::TAG)
}

/// Opens a font file or one font of a collection.
///
/// # Errors
///
/// `Malformed` for bytes that are no font, for a file that was cut off, or as [`units_per_em`]; `Unsupported` for a
/// compressed web font, which [`unpack`](super::web_font::unpack) makes a font file of; `InvalidParameter` for an index that the file does not have.
pub fn open(data: &[u8], index: u32) -> Result<FontRef<'_>, Error> {
    if let Some(b"wOFF" | b"wOF2") = data.get(..4) {
        return Err(Error::Unsupported(
            "this is a compressed web font (WOFF); unpack it to a .ttf first (woff2_decompress, fonttools)"
                .into(),
        ));
    }
    let font = nfr::internals::open(data, index)?;
    check_complete(&font, data.len())?;
    units_per_em(&font)?;
    Ok(font)
}

/// Font units in an em, of which OpenType allows 16 to 16,384 (1.9, "head").
///
/// # Errors
///
/// `Malformed` for any other number, or if 'head' cannot be read.
pub fn units_per_em(font: &FontRef<'_>) -> Result<u16, Error> {
    Ok(nfr::internals::head_units(font)?)
}

/// Refuses a font whose advance widths cannot be read: nothing could draw text with it.
pub(crate) fn check_metrics(font: &FontRef<'_>) -> Result<(), Error> {
    match font.hmtx() {
        Ok(hmtx) if !hmtx.h_metrics().is_empty() => Ok(()),
        Ok(_) => Err(Error::Malformed("table 'hmtx' has no advance widths; repair the font".into())),
        Err(e) => {
            Err(Error::Malformed(format!("table 'hmtx' or 'hhea' cannot be read ({e}); repair the font")))
        }
    }
}

/// A copy of the font that owns its bytes, for skrifa.
///
/// # Errors
///
/// `Malformed` if its table directory cannot be read.
pub fn owned(font: &FontRef<'_>) -> Result<Font, Error> {
    owned_bytes(font.data().as_bytes().to_vec(), font.ttc_index().unwrap_or(0))
}

/// A font file's bytes, or those of one font of a collection, for skrifa.
///
/// # Errors
///
/// As [`owned`].
pub(crate) fn owned_bytes(data: Vec<u8>, index: u32) -> Result<Font, Error> {
    Font::new(data, index).ok_or_else(|| {
        Error::Malformed("skrifa cannot read the font's table directory; repair the font".into())
    })
}

/// Refuses a file with a table that reaches beyond its end: most often a download that stopped early.
fn check_complete(font: &FontRef<'_>, file_len: usize) -> Result<(), Error> {
    for record in font.table_directory().table_records() {
        let end = u64::from(record.offset()) + u64::from(record.length());
        if end > file_len as u64 {
            return Err(Error::Malformed(format!(
                "table '{}' ends at byte {end}, but the file has {file_len} bytes: it is truncated; get the file again",
                record.tag()
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const SANS: &[u8] = include_bytes!("../../fonts/LiberationSans-Regular.ttf");

    fn refusal(data: &[u8], index: u32) -> String {
        open(data, index).err().unwrap().to_string()
    }

    #[test]
    fn a_whole_font_opens() {
        assert!(!has_models(&open(SANS, 0).unwrap()));
    }

    #[test]
    fn what_is_no_font_is_refused_with_advice() {
        for data in [b"".as_slice(), b"OT", b"not a font at all", &[0; 64]] {
            assert!(refusal(data, 0).contains("pass a .ttf"), "{data:?}");
        }
        assert!(refusal(b"wOF2 and so on", 0).contains("unpack"));
    }

    #[test]
    fn a_truncated_font_is_called_truncated() {
        for len in [SANS.len() - 1, SANS.len() / 2, 1000] {
            assert!(refusal(&SANS[..len], 0).contains("truncated"), "{len}");
        }
    }

    #[test]
    fn a_single_font_has_no_second_one() {
        assert!(refusal(SANS, 1).contains("use index 0"));
    }
}
