//! The text of a font in C.

use std::fmt::Write;

use super::bitmaps::Bitmaps;
use super::cmaps::Map;
use crate::bake::face::Face;
use crate::bake::strike::{Glyph, Strike};

const BYTES_A_LINE: usize = 16;

/// What a file is written from.
pub(super) struct File<'f> {
    pub(super) strike: &'f Strike,
    pub(super) face: &'f Face,
    pub(super) symbol: &'f str,
    pub(super) glyphs: &'f [(u32, &'f Glyph)],
    pub(super) maps: &'f [Map],
    pub(super) bitmaps: &'f Bitmaps,
    pub(super) is_large: bool,
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

/// Writes the C file.
pub(super) fn write_file(out: &mut String, file: &File<'_>) -> std::fmt::Result {
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
