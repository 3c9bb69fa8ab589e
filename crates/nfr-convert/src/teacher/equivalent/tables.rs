//! The tables of a font with other glyphs, and more of them.

use read_fonts::tables::hmtx::LongMetric;
use read_fonts::types::{BigEndian, Tag};
use read_fonts::{FontRef, TableProvider};
use write_fonts::FontBuilder;

use super::composites::NewGlyphs;
use super::glyphs::Glyphs;

/// OpenType 1.9, "head": indexToLocFormat, of which 1 stands for offsets of 32 bits.
const INDEX_TO_LOC_FORMAT: (usize, u16) = (50, 1);
/// OpenType 1.9, "maxp".
const NUM_GLYPHS_AT: usize = 4;
const MAX_SIZE_OF_INSTRUCTIONS_AT: usize = 26;
/// numberOfHMetrics and numOfLongVerMetrics (OpenType 1.9, "hhea" and "vhea").
const NUMBER_OF_METRICS_AT: usize = 34;
/// The tables of fonts with more than 65,535 glyphs, which read-fonts prefers.
const EXTENDED: [&[u8; 4]; 3] = [b"GLYF", b"LOCA", b"MAXP"];

/// A copy of the font with these glyphs. `None` if its tables do not allow that.
pub(super) fn with_glyphs(font: &FontRef<'_>, new: &NewGlyphs) -> Option<Vec<u8>> {
    if EXTENDED.iter().any(|tag| font.data_for_tag(Tag::new(tag)).is_some()) {
        return None;
    }
    let glyphs = Glyphs::of(font)?;
    let sources: Vec<u16> = (0..glyphs.count).chain(new.added.iter().map(|(source, _)| *source)).collect();
    let count = u16::try_from(sources.len()).ok()?;
    let mut builder = FontBuilder::new();
    let mut add = |tag: &[u8; 4], data: Vec<u8>| {
        builder.add_raw(Tag::new(tag), data);
    };
    let (glyf, loca) = outlines(&glyphs, new)?;
    add(b"glyf", glyf);
    add(b"loca", loca);
    add(b"head", patched(font, b"head", &[INDEX_TO_LOC_FORMAT])?);
    // Of the length of the longest program, skrifa only asks whether it is 0.
    add(b"maxp", patched(font, b"maxp", &[(NUM_GLYPHS_AT, count), (MAX_SIZE_OF_INSTRUCTIONS_AT, u16::MAX)])?);
    let hmtx = font.hmtx().ok()?;
    add(b"hmtx", metrics(hmtx.h_metrics(), hmtx.left_side_bearings(), &sources));
    add(b"hhea", patched(font, b"hhea", &[(NUMBER_OF_METRICS_AT, count)])?);
    if let Ok(vmtx) = font.vmtx() {
        add(b"vmtx", metrics(vmtx.v_metrics(), vmtx.top_side_bearings(), &sources));
        add(b"vhea", patched(font, b"vhea", &[(NUMBER_OF_METRICS_AT, count)])?);
    }
    if let Some(hdmx) = device_metrics(font, &sources) {
        add(b"hdmx", hdmx);
    }
    builder.copy_missing_tables(font.clone());
    Some(builder.build())
}

/// `glyf` and its `loca`, with offsets of 32 bits.
fn outlines(glyphs: &Glyphs<'_>, new: &NewGlyphs) -> Option<(Vec<u8>, Vec<u8>)> {
    let (mut glyf, mut loca) = (Vec::new(), vec![0; 4]);
    let mut put = |data: &[u8]| {
        glyf.extend_from_slice(data);
        glyf.resize(glyf.len().next_multiple_of(4), 0);
        loca.extend(u32::try_from(glyf.len()).ok()?.to_be_bytes());
        Some(())
    };
    for gid in 0..glyphs.count {
        match new.replaced.get(&gid) {
            Some(data) => put(data)?,
            None => put(glyphs.bytes(gid)?)?,
        }
    }
    for (_, data) in &new.added {
        put(data)?;
    }
    Some((glyf, loca))
}

/// A table with other 16-bit numbers at these places.
fn patched(font: &FontRef<'_>, tag: &[u8; 4], fields: &[(usize, u16)]) -> Option<Vec<u8>> {
    let mut data = font.data_for_tag(Tag::new(tag))?.as_bytes().to_vec();
    for (at, value) in fields {
        data.get_mut(*at..at + 2)?.copy_from_slice(&value.to_be_bytes());
    }
    Some(data)
}

/// `hmtx` or `vmtx` of glyphs that have the metrics of these.
fn metrics(long: &[LongMetric], bearings: &[BigEndian<i16>], sources: &[u16]) -> Vec<u8> {
    let mut data = Vec::with_capacity(4 * sources.len());
    for source in sources.iter().map(|source| usize::from(*source)) {
        let advance = long.get(source).or(long.last()).map_or(0, LongMetric::advance);
        let bearing = match long.get(source) {
            Some(metric) => metric.side_bearing(),
            None => bearings.get(source - long.len()).map_or(0, |bearing| bearing.get()),
        };
        data.extend(advance.to_be_bytes());
        data.extend(bearing.to_be_bytes());
    }
    data
}

/// `hdmx` of glyphs that have the widths of these. `None` if the font has none.
fn device_metrics(font: &FontRef<'_>, sources: &[u16]) -> Option<Vec<u8>> {
    let hdmx = font.hdmx().ok()?;
    let size = (2 + sources.len()).next_multiple_of(4);
    let mut data = hdmx.version().to_be_bytes().to_vec();
    data.extend(hdmx.num_records().to_be_bytes());
    data.extend(u32::try_from(size).ok()?.to_be_bytes());
    for record in hdmx.records().iter() {
        let record = record.ok()?;
        let start = data.len();
        data.extend([record.pixel_size, record.max_width]);
        data.extend(
            sources.iter().map(|source| record.widths.get(usize::from(*source)).copied().unwrap_or(0)),
        );
        data.resize(start + size, 0);
    }
    Some(data)
}
