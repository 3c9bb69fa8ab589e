//! The tables of a TrueType font in place of those of a PostScript one.

use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use write_fonts::FontBuilder;
use write_fonts::dump_table;
use write_fonts::tables::glyf::{Bbox, Contour, GlyfLocaBuilder, Glyph, SimpleGlyph};
use write_fonts::tables::loca::LocaFormat;
use write_fonts::tables::maxp::Maxp;
use write_fonts::tables::post::Post;

use super::outline::QuadraticGlyph;
use crate::error::Error;
use crate::input::select::glyph_names;

/// Tables that are not copied: the outlines, what belongs to them, and, as only the default instance is kept, variations.
const DROPPED: [&[u8; 4]; 11] =
    [b"CFF ", b"CFF2", b"VORG", b"fvar", b"avar", b"HVAR", b"VVAR", b"MVAR", b"STAT", b"gvar", b"cvar"];

/// OpenType 1.9, "head".
const HEAD_BOUNDS_AT: usize = 36;
const HEAD_INDEX_TO_LOC_FORMAT_AT: usize = 50;
const HEAD_BYTES: usize = 54;

/// Writes the font with these glyphs, one for each of its own.
pub(super) fn true_type(font: &FontRef<'_>, glyphs: &[&QuadraticGlyph]) -> Result<Vec<u8>, Error> {
    let mut builder = FontBuilder::new();
    for record in font.table_directory().table_records() {
        let tag = record.tag();
        if let Some(data) = font.table_data(tag).filter(|_| !DROPPED.iter().any(|d| Tag::new(d) == tag)) {
            builder.add_raw(tag, data.as_bytes());
        }
    }
    let simple: Vec<SimpleGlyph> = glyphs.iter().map(|glyph| simple_glyph(glyph)).collect();
    let (glyf, loca, format) = glyf(&simple)?;
    builder.add_raw(Tag::new(b"glyf"), glyf).add_raw(Tag::new(b"loca"), loca);
    builder.add_raw(Tag::new(b"head"), head(font, &simple, format == LocaFormat::Long)?);
    builder.add_raw(Tag::new(b"maxp"), maxp(&simple)?);
    builder.add_raw(Tag::new(b"hmtx"), hmtx(font, &simple)?);
    if let Some(post) = post(font, glyphs.len())? {
        builder.add_raw(Tag::new(b"post"), post);
    }
    Ok(builder.build())
}

fn unwritable(table: &str, error: impl std::fmt::Display) -> Error {
    Error::LimitExceeded(format!(
        "the glyphs do not fit table '{table}' ({error}); leave some out of the font"
    ))
}

fn unreadable(table: &str, error: impl std::fmt::Display) -> Error {
    Error::Malformed(format!("table '{table}' cannot be read ({error}); repair the font"))
}

fn simple_glyph(glyph: &QuadraticGlyph) -> SimpleGlyph {
    use read_fonts::tables::glyf::CurvePoint;
    let contour = |range: &std::ops::Range<usize>| {
        let point =
            |at: usize| CurvePoint::new(glyph.points[at][0], glyph.points[at][1], glyph.is_on_curve(at));
        Contour::from(range.clone().map(point).collect::<Vec<_>>())
    };
    let mut simple =
        SimpleGlyph { contours: glyph.contours.iter().map(contour).collect(), ..SimpleGlyph::default() };
    simple.recompute_bounding_box();
    simple
}

fn glyf(glyphs: &[SimpleGlyph]) -> Result<(Vec<u8>, Vec<u8>, LocaFormat), Error> {
    let mut builder = GlyfLocaBuilder::new();
    for glyph in glyphs {
        let glyph = if glyph.contours.is_empty() { Glyph::Empty } else { Glyph::Simple(glyph.clone()) };
        builder.add_glyph(&glyph).map_err(|e| unwritable("glyf", e))?;
    }
    let (glyf, loca, format) = builder.build();
    let glyf = dump_table(&glyf).map_err(|e| unwritable("glyf", e))?;
    Ok((glyf, dump_table(&loca).map_err(|e| unwritable("loca", e))?, format))
}

/// `head` with the format of `loca` and the box around all glyphs.
fn head(font: &FontRef<'_>, glyphs: &[SimpleGlyph], is_long: bool) -> Result<Vec<u8>, Error> {
    let mut head = font.table_data(Tag::new(b"head")).map_or_else(Vec::new, |data| data.as_bytes().to_vec());
    if head.len() < HEAD_BYTES {
        return Err(unreadable("head", format!("{} bytes instead of {HEAD_BYTES}", head.len())));
    }
    let inked = || glyphs.iter().filter(|glyph| !glyph.contours.is_empty()).map(|glyph| glyph.bbox);
    let bounds = inked().reduce(|a, b| Bbox {
        x_min: a.x_min.min(b.x_min),
        y_min: a.y_min.min(b.y_min),
        x_max: a.x_max.max(b.x_max),
        y_max: a.y_max.max(b.y_max),
    });
    let bounds = bounds.unwrap_or_default();
    for (at, v) in [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].into_iter().enumerate() {
        head[HEAD_BOUNDS_AT + 2 * at..][..2].copy_from_slice(&v.to_be_bytes());
    }
    head[HEAD_INDEX_TO_LOC_FORMAT_AT..][..2].copy_from_slice(&u16::from(is_long).to_be_bytes());
    Ok(head)
}

fn maxp(glyphs: &[SimpleGlyph]) -> Result<Vec<u8>, Error> {
    let points = |glyph: &SimpleGlyph| glyph.contours.iter().map(Contour::len).sum::<usize>();
    let most = |of: &dyn Fn(&SimpleGlyph) -> usize| {
        Some(glyphs.iter().map(of).max().unwrap_or(0).try_into().unwrap_or(u16::MAX))
    };
    let maxp = Maxp {
        num_glyphs: glyphs.len().try_into().map_err(|e| unwritable("maxp", e))?,
        max_points: most(&points),
        max_contours: most(&|glyph| glyph.contours.len()),
        max_composite_points: Some(0),
        max_composite_contours: Some(0),
        // 1: programs do not use the twilight zone. 0 is not a legal value.
        max_zones: Some(1),
        max_twilight_points: Some(0),
        max_storage: Some(0),
        max_function_defs: Some(0),
        max_instruction_defs: Some(0),
        max_stack_elements: Some(0),
        max_size_of_instructions: Some(0),
        max_component_elements: Some(0),
        max_component_depth: Some(0),
    };
    dump_table(&maxp).map_err(|e| unwritable("maxp", e))
}

/// `hmtx` whose side bearings are the left edges of the glyphs, on which TrueType's readers build.
fn hmtx(font: &FontRef<'_>, glyphs: &[SimpleGlyph]) -> Result<Vec<u8>, Error> {
    let hmtx = font.hmtx().map_err(|e| unreadable("hmtx", e))?;
    let metrics = hmtx.h_metrics();
    let mut out = Vec::with_capacity(2 * (glyphs.len() + metrics.len()));
    for (gid, glyph) in glyphs.iter().enumerate() {
        if let Some(metric) = metrics.get(gid) {
            out.extend(metric.advance().to_be_bytes());
        }
        out.extend(glyph.bbox.x_min.to_be_bytes());
    }
    // Readers that count the metrics in `hhea` expect as many here.
    for metric in metrics.iter().skip(glyphs.len()) {
        out.extend(metric.advance().to_be_bytes());
        out.extend(metric.side_bearing().to_be_bytes());
    }
    Ok(out)
}

/// `post` with the names that 'CFF ' has. None if there are none, or not one for each glyph, or if they cannot be written.
fn post(font: &FontRef<'_>, count: usize) -> Result<Option<Vec<u8>>, Error> {
    let names = glyph_names(font)?;
    let order: Option<Vec<&str>> = (0..count)
        .map(|gid| Some(names.get(&u16::try_from(gid).ok()?)?.as_str()).filter(|name| name.len() <= 63))
        .collect();
    let (Some(order), Ok(old)) = (order, font.post()) else { return Ok(None) };
    let post = Post {
        italic_angle: old.italic_angle(),
        underline_position: old.underline_position(),
        underline_thickness: old.underline_thickness(),
        is_fixed_pitch: old.is_fixed_pitch(),
        ..Post::new_v2(order)
    };
    Ok(dump_table(&post).ok())
}
