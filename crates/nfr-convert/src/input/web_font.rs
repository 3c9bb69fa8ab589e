//! Fonts that are packed for the web: WOFF 1.0 and 2.0 (W3C Recommendations).

use std::borrow::Cow;
use std::panic::{AssertUnwindSafe, catch_unwind};

use read_fonts::FontRef;
use read_fonts::tables::compute_checksum;
use read_fonts::types::Tag;
use wuff::{decompress_woff1, decompress_woff2};

use crate::error::Error;

/// The most bytes that a web font may unpack to: a few times the largest fonts of all Chinese characters. wuff has the same limit
/// for WOFF 2.0, and another for the factor of compression.
pub const MAX_UNPACKED_BYTES: usize = 128 << 20;

// WOFF 1.0, "WOFFHeader" and "TableDirectoryEntry"; the length and the number of tables are at the same place in 2.0.
const LENGTH_AT: usize = 8;
const TABLES_AT: usize = 12;
const DIRECTORY_AT: usize = 44;
const ENTRY_BYTES: usize = 20;
const ORIGINAL_LENGTH_AT: usize = 12;

/// Whether a file is packed for the web.
pub fn is_packed(data: &[u8]) -> bool {
    matches!(data.get(..4), Some(b"wOFF" | b"wOF2"))
}

/// The font file, or the collection, that is packed in a web font. Any other file is returned as it is.
///
/// # Errors
///
/// `Malformed` for a file that was cut off or is damaged, `LimitExceeded` for one that would unpack to more than
/// [`MAX_UNPACKED_BYTES`].
pub fn unpack(data: &[u8]) -> Result<Cow<'_, [u8]>, Error> {
    let (version, unpack): (_, fn(&[u8]) -> _) = match data.get(..4) {
        Some(b"wOFF") => (1, decompress_woff1),
        Some(b"wOF2") => (2, decompress_woff2),
        _ => return Ok(Cow::Borrowed(data)),
    };
    check_length(data)?;
    if version == 1 {
        check_directory(data)?;
    }
    // A font may find a panic in what reads it.
    let unpacked = catch_unwind(AssertUnwindSafe(|| unpack(data)));
    let Ok(Ok(font)) = unpacked else {
        return Err(damaged(&format!("its WOFF {version}.0 data cannot be unpacked")));
    };
    if version == 1 {
        check_sums(&font)?;
    }
    Ok(Cow::Owned(font))
}

fn damaged(what: &str) -> Error {
    Error::Malformed(format!("{what}: the file is damaged; get it again"))
}

fn number(data: &[u8], at: usize) -> Option<u32> {
    let bytes = data.get(at..)?.first_chunk()?;
    Some(u32::from_be_bytes(*bytes))
}

/// Compares the file's length with what its header says.
fn check_length(data: &[u8]) -> Result<(), Error> {
    let stated = number(data, LENGTH_AT).map_or(DIRECTORY_AT, |length| length as usize);
    if data.len() < stated {
        return Err(Error::Malformed(format!(
            "the web font has {} bytes, and {stated} are needed: it is truncated; get the file again",
            data.len()
        )));
    }
    if data.len() > stated {
        return Err(damaged(&format!(
            "the web font says that it has {stated} bytes, and the file has {}",
            data.len()
        )));
    }
    Ok(())
}

/// Refuses a WOFF 1.0 file that would unpack to too much: tables may share bytes, and each is unpacked by itself.
fn check_directory(data: &[u8]) -> Result<(), Error> {
    let tables =
        data.get(TABLES_AT..).and_then(|rest| rest.first_chunk()).map_or(0, |n| u16::from_be_bytes(*n));
    let mut unpacked = 0u64;
    for entry in 0..usize::from(tables) {
        let at = DIRECTORY_AT + entry * ENTRY_BYTES;
        let [length, original] = [8, ORIGINAL_LENGTH_AT].map(|field| number(data, at + field).unwrap_or(0));
        unpacked += u64::from(length.max(original));
    }
    if unpacked > MAX_UNPACKED_BYTES as u64 {
        return Err(Error::LimitExceeded(format!(
            "the web font says that it unpacks to {unpacked} bytes, and {MAX_UNPACKED_BYTES} are allowed; unpack it with another \
             program if that is true"
        )));
    }
    Ok(())
}

/// Compares each table with the checksum that WOFF 1.0 keeps of it: what is stored uncompressed has no other check.
fn check_sums(font: &[u8]) -> Result<(), Error> {
    const HEAD: Tag = Tag::new(b"head");
    // A file without a table directory is refused by whoever opens it.
    let Ok(font) = FontRef::new(font) else { return Ok(()) };
    for record in font.table_directory().table_records() {
        let Some(table) = font.table_data(record.tag()) else { continue };
        let mut table = Cow::Borrowed(table.as_bytes());
        if record.tag() == HEAD
            && let Some(adjustment) = table.to_mut().get_mut(8..12)
        {
            adjustment.fill(0);
        }
        if compute_checksum(&table) != record.checksum() {
            return Err(damaged(&format!(
                "table '{}' does not have the checksum that the web font states",
                record.tag()
            )));
        }
    }
    Ok(())
}
