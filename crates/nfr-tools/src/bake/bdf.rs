//! BDF 2.1 (Adobe, "Glyph Bitmap Distribution Format", 1993), and for more than one bit a pixel the fourth number of `SIZE` that FreeType
//! reads, with so many bits a pixel in the rows.

use std::fmt::Write;

use super::face::Face;
use super::strike::{Glyph, Strike, packed};

/// Points are pixels at this resolution, so that sizes are whole numbers of both.
const DPI: u32 = 72;
/// The replacement character, and what else stands for a character that a font lacks.
const DEFAULTS: [u32; 3] = [0xfffd, '?' as u32, ' ' as u32];
/// Units in an em of `SWIDTH`.
const EM: f32 = 1000.0;

/// A file for one size. Glyphs without a character have the encoding -1, and a glyph that stands for several is there for each of them;
/// `.notdef` has 0.
pub(super) fn bdf(strike: &Strike, face: &Face) -> String {
    let glyphs = encoded(strike, face);
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = write_file(&mut out, strike, face, &glyphs);
    out
}

/// The glyphs with their encodings: those with characters in the order of these, then the others.
fn encoded<'s>(strike: &'s Strike, face: &Face) -> Vec<(i64, &'s Glyph)> {
    let glyph = |gid: u16| {
        strike.glyphs.binary_search_by_key(&gid, |glyph| glyph.gid).ok().map(|at| &strike.glyphs[at])
    };
    let notdef = glyph(0).filter(|_| !face.characters.contains_key(&0));
    let with = face.characters.iter().filter_map(|(code, gid)| Some((i64::from(*code), glyph(*gid)?)));
    let is_encoded = |glyph: &&Glyph| glyph.gid == 0 || !face.characters_of(glyph.gid).is_empty();
    let without = strike.glyphs.iter().filter(|glyph| !is_encoded(glyph)).map(|glyph| (-1, glyph));
    notdef.map(|glyph| (0, glyph)).into_iter().chain(with).chain(without).collect()
}

fn write_file(out: &mut String, strike: &Strike, face: &Face, glyphs: &[(i64, &Glyph)]) -> std::fmt::Result {
    let (ppem, bits) = (strike.ppem, strike.bits);
    let bounds = strike.bounds();
    writeln!(out, "STARTFONT 2.1")?;
    writeln!(out, "FONT {}", long_name(strike, face))?;
    let depth = if bits > 1 { format!(" {bits}") } else { String::new() };
    writeln!(out, "SIZE {ppem} {DPI} {DPI}{depth}")?;
    let bottom = bounds.top - bounds.height as i32;
    writeln!(out, "FONTBOUNDINGBOX {} {} {} {bottom}", bounds.width, bounds.height, bounds.left)?;
    let properties = properties(strike, face, glyphs);
    writeln!(out, "STARTPROPERTIES {}", properties.len())?;
    for (key, value) in properties {
        writeln!(out, "{key} {value}")?;
    }
    writeln!(out, "ENDPROPERTIES\nCHARS {}", glyphs.len())?;
    for (encoding, glyph) in glyphs {
        write_glyph(out, strike, face, *encoding, glyph)?;
    }
    writeln!(out, "ENDFONT")
}

fn write_glyph(
    out: &mut String,
    strike: &Strike,
    face: &Face,
    encoding: i64,
    glyph: &Glyph,
) -> std::fmt::Result {
    let name = match (encoding, face.glyph_name(glyph.gid)) {
        // Encodings beside the first one have names of their own.
        (code, Some(name)) if code <= 0 || is_first(face, code, glyph.gid) => name.to_owned(),
        (code, _) if code > 0xffff => format!("u{code:X}"),
        (code, _) if code > 0 => format!("uni{code:04X}"),
        _ => format!("glyph{}", glyph.gid),
    };
    let scalable = (glyph.advance * EM / f32::from(strike.ppem)).round();
    let place = glyph.place;
    let bottom = if place.area() > 0 { glyph.bottom() } else { 0 };
    writeln!(out, "STARTCHAR {name}\nENCODING {encoding}")?;
    writeln!(out, "SWIDTH {scalable} 0\nDWIDTH {} 0", glyph.whole_advance())?;
    writeln!(out, "BBX {} {} {} {bottom}\nBITMAP", place.width, place.height, place.left)?;
    for row in glyph.rows() {
        for byte in packed(row, strike.bits) {
            write!(out, "{byte:02X}")?;
        }
        out.push('\n');
    }
    writeln!(out, "ENDCHAR")
}

/// Whether a glyph has no character before this one.
fn is_first(face: &Face, code: i64, gid: u16) -> bool {
    face.characters_of(gid).first().is_some_and(|first| i64::from(*first) == code)
}

/// The properties of X fonts, in the order of the X Logical Font Description (X Consortium Standard, version 1.5), then the others.
fn properties(strike: &Strike, face: &Face, glyphs: &[(i64, &Glyph)]) -> Vec<(&'static str, String)> {
    let [family, weight, slant, spacing] = style(face);
    let (ascent, descent) = strike.line_extent();
    let has = |code: &i64| glyphs.iter().any(|(encoding, _)| encoding == code);
    let first = glyphs.iter().map(|(encoding, _)| *encoding).find(|encoding| *encoding >= 0);
    let default = std::iter::once(0).chain(DEFAULTS.map(i64::from)).find(has).or(first);
    let mut properties = vec![
        ("FOUNDRY", quoted("nfr")),
        ("FAMILY_NAME", quoted(&family)),
        ("WEIGHT_NAME", quoted(&weight)),
        ("SLANT", quoted(&slant)),
        ("SETWIDTH_NAME", quoted("Normal")),
        ("ADD_STYLE_NAME", quoted("")),
        ("PIXEL_SIZE", strike.ppem.to_string()),
        ("POINT_SIZE", (u32::from(strike.ppem) * 10).to_string()),
        ("RESOLUTION_X", DPI.to_string()),
        ("RESOLUTION_Y", DPI.to_string()),
        ("SPACING", quoted(&spacing)),
        ("AVERAGE_WIDTH", average_width(strike).to_string()),
        ("CHARSET_REGISTRY", quoted("ISO10646")),
        ("CHARSET_ENCODING", quoted("1")),
        ("FONT_ASCENT", ascent.to_string()),
        ("FONT_DESCENT", descent.to_string()),
        ("FACE_NAME", quoted(&face.full_name)),
    ];
    properties.extend(face.copyright.as_deref().map(|text| ("COPYRIGHT", quoted(text))));
    properties.extend(default.map(|code| ("DEFAULT_CHAR", code.to_string())));
    properties
}

/// The X Logical Font Description.
fn long_name(strike: &Strike, face: &Face) -> String {
    let [family, weight, slant, spacing] = style(face);
    let (ppem, average) = (strike.ppem, average_width(strike));
    let tenths = u32::from(ppem) * 10;
    format!(
        "-nfr-{family}-{weight}-{slant}-Normal--{ppem}-{tenths}-{DPI}-{DPI}-{spacing}-{average}-ISO10646-1"
    )
}

/// Family, weight, slant and spacing. A hyphen would end a field of the font's name.
fn style(face: &Face) -> [String; 4] {
    let family: String = ascii(&face.family).chars().map(|c| if c == '-' { ' ' } else { c }).collect();
    let weight = if face.is_bold { "Bold" } else { "Medium" };
    let slant = if face.is_italic { "I" } else { "R" };
    let spacing = if face.is_monospaced { "M" } else { "P" };
    [family, weight.into(), slant.into(), spacing.into()]
}

/// The mean advance width in tenths of a pixel.
fn average_width(strike: &Strike) -> i64 {
    let sum: i64 = strike.glyphs.iter().map(|glyph| i64::from(glyph.whole_advance())).sum();
    (sum as f64 * 10.0 / strike.glyphs.len().max(1) as f64).round() as i64
}

fn ascii(text: &str) -> String {
    let ascii = |c: char| match c {
        c if c.is_ascii_graphic() => c,
        c if c.is_whitespace() => ' ',
        _ => '?',
    };
    text.chars().map(ascii).collect()
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", ascii(text).replace('"', "\"\""))
}
