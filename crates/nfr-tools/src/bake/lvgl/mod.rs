//! A font for LVGL 9 as a C file, in the layout of lv_font_conv: uncompressed bitmaps without padding, no kerning.

mod cmaps;

use std::collections::HashMap;
use std::fmt::Write;

use cmaps::{MAX_MAPS, Map, maps};

use super::face::Face;
use super::strike::{Glyph, Strike, packed};
use crate::failure::Failure;

/// Bitmaps' offsets have 20 bits without `LV_FONT_FMT_TXT_LARGE`, advance widths 12, of which 4 are fractions.
const SMALL_BITMAPS: usize = 1 << 20;
const SMALL_ADVANCE: i32 = 1 << 8;
/// What the structures take where pointers have 32 bits: a glyph's, one's of a large font, a map's, and the font's two.
const GLYPH_BYTES: usize = 8;
const LARGE_GLYPH_BYTES: usize = 16;
const MAP_BYTES: usize = 24;
const FONT_BYTES: usize = 24 + 36;
const BYTES_A_LINE: usize = 16;

/// A C file.
#[derive(Debug)]
pub(super) struct CFile {
    pub(super) text: String,
    pub(super) characters: usize,
    /// Glyphs that no character stands for, which LVGL cannot find.
    pub(super) left_out: usize,
    /// What the font takes in a device's memory, with pointers of 32 bits.
    pub(super) bytes: usize,
    /// Whether LVGL has to be built with `LV_FONT_FMT_TXT_LARGE`.
    pub(super) is_large: bool,
}

/// The name of the font's variable, made from a file's name without its extension.
pub(super) fn symbol(stem: &str) -> String {
    let name: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        name
    } else {
        format!("font_{name}")
    }
}

/// Writes a strike.
///
/// # Errors
///
/// No glyph that has a character, and more ranges of characters than a font of LVGL has.
pub(super) fn lvgl(strike: &Strike, face: &Face, symbol: &str) -> Result<CFile, Failure> {
    let glyph = |gid: &u16| {
        strike.glyphs.binary_search_by_key(gid, |glyph| glyph.gid).ok().map(|at| &strike.glyphs[at])
    };
    // LVGL takes U+0000 for the end of a text.
    let with = face.characters.iter().filter(|(code, _)| **code > 0);
    let glyphs: Vec<(u32, &Glyph)> = with.filter_map(|(code, gid)| Some((*code, glyph(gid)?))).collect();
    if glyphs.is_empty() {
        return Err(Failure::failed(
            "no glyph that is selected stands for a character, and LVGL finds glyphs by their characters; select some with --text or --unicodes",
        ));
    }
    let characters: Vec<u32> = glyphs.iter().map(|(code, _)| *code).collect();
    let maps = maps(&characters);
    if maps.len() > MAX_MAPS {
        return Err(Failure::failed(format!(
            "the characters fall into {} ranges, and a font of LVGL has {MAX_MAPS} at most; choose fewer with --text or --unicodes",
            maps.len()
        )));
    }
    let bitmaps = Bitmaps::new(&glyphs, strike.bits);
    let is_large = bitmaps.length >= SMALL_BITMAPS || glyphs.iter().any(|(_, glyph)| !is_small(glyph));
    let glyph_bytes = if is_large { LARGE_GLYPH_BYTES } else { GLYPH_BYTES };
    let lists: usize = maps.iter().filter(|map| !map.is_dense).map(|map| 2 * map.characters.len()).sum();
    let bytes =
        bitmaps.length + (glyphs.len() + 1) * glyph_bytes + maps.len() * MAP_BYTES + lists + FONT_BYTES;
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write_file(
        &mut text,
        &File { strike, face, symbol, glyphs: &glyphs, maps: &maps, bitmaps: &bitmaps, is_large },
    );
    let found: std::collections::BTreeSet<u16> = glyphs.iter().map(|(_, glyph)| glyph.gid).collect();
    let left_out = strike.glyphs.len() - found.len();
    Ok(CFile { text, characters: glyphs.len(), left_out, bytes, is_large })
}

/// Whether a glyph fits into the fields of a font that is not large.
fn is_small(glyph: &Glyph) -> bool {
    let (side, offset) = (u32::from(u8::MAX), i32::from(i8::MIN)..=i32::from(i8::MAX));
    glyph.place.width <= side
        && glyph.place.height <= side
        && offset.contains(&glyph.place.left)
        && offset.contains(&glyph.bottom())
        && glyph.whole_advance() < SMALL_ADVANCE
}

/// Where the bitmaps are. A glyph that stands for several characters has one.
struct Bitmaps {
    /// The character that each bitmap is written for, and its bytes.
    images: Vec<(u32, Vec<u8>)>,
    offsets: HashMap<u16, usize>,
    length: usize,
}

impl Bitmaps {
    fn new(glyphs: &[(u32, &Glyph)], bits: u8) -> Self {
        let mut bitmaps = Self { images: Vec::new(), offsets: HashMap::new(), length: 0 };
        for (code, glyph) in glyphs {
            if bitmaps.offsets.contains_key(&glyph.gid) {
                continue;
            }
            bitmaps.offsets.insert(glyph.gid, bitmaps.length);
            let image = packed(&glyph.levels, bits);
            bitmaps.length += image.len();
            bitmaps.images.push((*code, image));
        }
        bitmaps
    }
}

/// What a file is written from.
struct File<'f> {
    strike: &'f Strike,
    face: &'f Face,
    symbol: &'f str,
    glyphs: &'f [(u32, &'f Glyph)],
    maps: &'f [Map],
    bitmaps: &'f Bitmaps,
    is_large: bool,
}

const INCLUDE: &str = r#"#ifdef __has_include
    #if __has_include("lvgl.h")
        #ifndef LV_LVGL_H_INCLUDE_SIMPLE
            #define LV_LVGL_H_INCLUDE_SIMPLE
        #endif
    #endif
#endif

#ifdef LV_LVGL_H_INCLUDE_SIMPLE
    #include "lvgl.h"
#else
    #include "lvgl/lvgl.h"
#endif
"#;

fn write_file(out: &mut String, file: &File<'_>) -> std::fmt::Result {
    let File { strike, symbol, .. } = file;
    let guard = symbol.to_ascii_uppercase();
    writeln!(out, "/*\n * {}", file.face.full_name.replace("*/", ""))?;
    writeln!(out, " * Size: {} px\n * Bpp: {}\n * Written by nfr bake\n */\n", strike.ppem, strike.bits)?;
    writeln!(out, "{INCLUDE}\n#ifndef {guard}\n    #define {guard} 1\n#endif\n\n#if {guard}\n")?;
    if file.is_large {
        writeln!(out, "#if (LV_FONT_FMT_TXT_LARGE == 0)")?;
        writeln!(
            out,
            "    #error \"{symbol} is too large; enable LV_FONT_FMT_TXT_LARGE in lv_conf.h\"\n#endif\n"
        )?;
    }
    write_bitmaps(out, file)?;
    write_glyphs(out, file)?;
    write_maps(out, file)?;
    write_font(out, file)?;
    writeln!(out, "#endif /*#if {guard}*/")
}

fn write_bitmaps(out: &mut String, file: &File<'_>) -> std::fmt::Result {
    writeln!(out, "static LV_ATTRIBUTE_LARGE_CONST const uint8_t glyph_bitmap[] = {{")?;
    for (code, image) in &file.bitmaps.images {
        let character = char::from_u32(*code).filter(|c| c.is_ascii_graphic() || *c == ' ');
        let shown = character.map(|c| format!(" \"{c}\"")).unwrap_or_default();
        writeln!(out, "    /* U+{code:04X}{shown} */")?;
        for line in image.chunks(BYTES_A_LINE) {
            let bytes: Vec<String> = line.iter().map(|byte| format!("0x{byte:x}")).collect();
            writeln!(out, "    {},", bytes.join(", "))?;
        }
    }
    // C has no array without elements, which a font of blank glyphs would have.
    if file.bitmaps.length == 0 {
        writeln!(out, "    0x0,")?;
    }
    writeln!(out, "}};\n")
}

fn write_glyphs(out: &mut String, file: &File<'_>) -> std::fmt::Result {
    writeln!(out, "static const lv_font_fmt_txt_glyph_dsc_t glyph_dsc[] = {{")?;
    let fields = |at: usize, advance: i32, [width, height, left, bottom]: [i32; 4]| {
        format!(
            "    {{.bitmap_index = {at}, .adv_w = {advance}, .box_w = {width}, .box_h = {height}, .ofs_x = {left}, .ofs_y = {bottom}}},"
        )
    };
    writeln!(out, "{} /* id = 0 reserved */", fields(0, 0, [0; 4]))?;
    for (_, glyph) in file.glyphs {
        let place = glyph.place;
        let bottom = if place.area() > 0 { glyph.bottom() } else { 0 };
        let at = file.bitmaps.offsets.get(&glyph.gid).copied().unwrap_or(0);
        // Sixteenths of a pixel.
        let advance = glyph.whole_advance() * 16;
        writeln!(
            out,
            "{}",
            fields(at, advance, [place.width as i32, place.height as i32, place.left, bottom])
        )?;
    }
    writeln!(out, "}};\n")
}

fn write_maps(out: &mut String, file: &File<'_>) -> std::fmt::Result {
    for (number, map) in file.maps.iter().enumerate().filter(|(_, map)| !map.is_dense) {
        writeln!(out, "static const uint16_t unicode_list_{number}[] = {{")?;
        for line in map.characters.chunks(BYTES_A_LINE) {
            let offsets: Vec<String> =
                line.iter().map(|code| format!("0x{:x}", code - map.start())).collect();
            writeln!(out, "    {},", offsets.join(", "))?;
        }
        writeln!(out, "}};\n")?;
    }
    writeln!(out, "static const lv_font_fmt_txt_cmap_t cmaps[] = {{")?;
    for (number, map) in file.maps.iter().enumerate() {
        let (list, length, format) = if map.is_dense {
            ("NULL".to_owned(), 0, "FORMAT0_TINY")
        } else {
            (format!("unicode_list_{number}"), map.characters.len(), "SPARSE_TINY")
        };
        writeln!(
            out,
            "    {{\n        .range_start = {}, .range_length = {}, .glyph_id_start = {},\n        .unicode_list = {list}, .glyph_id_ofs_list = NULL, .list_length = {length}, .type = LV_FONT_FMT_TXT_CMAP_{format}\n    }},",
            map.start(),
            map.length(),
            map.first_glyph
        )?;
    }
    writeln!(out, "}};\n")
}

fn write_font(out: &mut String, file: &File<'_>) -> std::fmt::Result {
    let File { strike, symbol, .. } = file;
    // Any text fits into LVGL's line.
    let (ascent, descent) = strike.line_extent();
    let inked = || file.glyphs.iter().map(|(_, glyph)| glyph).filter(|glyph| glyph.place.area() > 0);
    let above = inked().map(|glyph| glyph.place.top).fold(ascent, i32::max);
    let below = inked().map(|glyph| -glyph.bottom()).fold(descent, i32::max);
    // An underline does not touch the baseline, however small the size.
    let underline = strike.line.underline_position;
    let underline = if underline < 0.0 { underline.round().min(-1.0) } else { underline.round() } as i32;
    let thickness = (strike.line.underline_thickness.round() as i32).max(1);
    writeln!(
        out,
        "static const lv_font_fmt_txt_dsc_t font_dsc = {{
    .glyph_bitmap = glyph_bitmap,
    .glyph_dsc = glyph_dsc,
    .cmaps = cmaps,
    .kern_dsc = NULL,
    .kern_scale = 0,
    .cmap_num = {},
    .bpp = {},
    .kern_classes = 0,
    .bitmap_format = LV_FONT_FMT_TXT_PLAIN,
}};

const lv_font_t {symbol} = {{
    .get_glyph_dsc = lv_font_get_glyph_dsc_fmt_txt,
    .get_glyph_bitmap = lv_font_get_bitmap_fmt_txt,
    .line_height = {},
    .base_line = {below}, /* from the bottom of the line */
    .subpx = LV_FONT_SUBPX_NONE,
    .underline_position = {},
    .underline_thickness = {},
    .dsc = &font_dsc,
    .fallback = NULL,
    .user_data = NULL,
}};
",
        file.maps.len(),
        strike.bits,
        above + below,
        underline.clamp(i8::MIN.into(), i8::MAX.into()),
        thickness.min(i8::MAX.into())
    )
}
