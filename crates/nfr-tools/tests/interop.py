#!/usr/bin/env python3
"""Opens a converted font with other people's software and compares it with its original.

    python tests/interop.py CONVERTED ORIGINAL

needs the packages fonttools, freetype-py and uharfbuzz. Prints a line for each check; exits with 1 if one
of them fails, with 2 on wrong usage.
"""

import io
import sys

import freetype
import uharfbuzz
from fontTools.ttLib import TTFont

HINT_TABLES = ("fpgm", "prep", "cvt ", "cvar", "hdmx", "VDMX", "LTSH", "DSIG")
# Kerning, ligatures, a combining mark; scripts that a font lacks shape to its glyph 0.
TEXTS = ("AVATAR To fly: office, affine; e\u0301 0123", "Δοκιμή Ά", "Проверка", "שלום עולם", "Tiếng Việt")
# The size in pixels per em at which unhinted bitmaps are compared.
BITMAP_PPEM = 16


class Difference(Exception):
    """What a check found to differ."""


def expect_equal(what, original, converted):
    if original != converted:
        raise Difference(f"{what}: {shorten(original)} became {shorten(converted)}")


def shorten(value):
    text = repr(value)
    return text if len(text) <= 100 else text[:97] + "..."


def expect_equal_items(what, original, converted):
    """Compares two mappings and names the first key at which they differ."""
    expect_equal(f"keys of {what}", sorted(original), sorted(converted))
    for key in original:
        expect_equal(f"{what} {key!r}", original[key], converted[key])
    return f"{len(original)} equal"


def tables_load(original, converted):
    font = TTFont(converted, lazy=False, checkChecksums=2)
    for tag in font.reader.keys():
        font[tag]
    kept = set(TTFont(original).reader.keys()) - set(HINT_TABLES)
    expect_equal("tables", sorted(kept | {"Nfrt", "gasp"}), sorted(font.reader.keys()))
    return f"{len(font.reader.keys())} tables"


def tables_compile_again(_, converted):
    font = TTFont(converted, lazy=False)
    models = font.getTableData("Nfrt")
    for tag in font.reader.keys():
        font[tag]
    again = io.BytesIO()
    font.save(again)
    expect_equal("Nfrt after compiling", models, TTFont(again).getTableData("Nfrt"))
    return f"{again.tell()} bytes"


def cmap(original, converted):
    def subtables(path):
        return {(t.platformID, t.platEncID, t.format): getattr(t, "cmap", None) for t in TTFont(path)["cmap"].tables}

    expect_equal_items("subtable", subtables(original), subtables(converted))
    return f"{len(TTFont(converted).getBestCmap())} characters"


def hmtx(original, converted):
    return expect_equal_items("metrics of", TTFont(original)["hmtx"].metrics, TTFont(converted)["hmtx"].metrics)


def outlines(original, converted):
    def coordinates(path):
        font = TTFont(path)
        glyf = font["glyf"]
        result = {}
        for name in font.getGlyphOrder():
            points, ends, flags = glyf[name].getCoordinates(glyf)
            parts = glyf[name].components if glyf[name].isComposite() else []
            result[name] = (list(points), list(ends), bytes(flags), [without_program_flag(part) for part in parts])
        return result

    return expect_equal_items("outline of", coordinates(original), coordinates(converted))


def without_program_flag(component):
    we_have_instructions = 0x0100
    return {**vars(component), "flags": component.flags & ~we_have_instructions}


def programs_are_gone(_, converted):
    font = TTFont(converted)
    for name in font.getGlyphOrder():
        program = getattr(font["glyf"][name], "program", None)
        if program is not None and program.getBytecode():
            raise Difference(f"glyph {name!r} still has a program")
    expect_equal("maxp.maxSizeOfInstructions", 0, font["maxp"].maxSizeOfInstructions)
    return "no programs"


def freetype_outlines(original, converted):
    def load(path):
        face = freetype.Face(path)
        result = {}
        for gid in range(face.num_glyphs):
            face.load_glyph(gid, freetype.FT_LOAD_NO_SCALE | freetype.FT_LOAD_NO_HINTING)
            outline = face.glyph.outline
            result[gid] = (outline.points, outline.tags, outline.contours, face.glyph.advance.x)
        return result

    return expect_equal_items("glyph", load(original), load(converted))


def freetype_bitmaps(original, converted):
    def render(path):
        face = freetype.Face(path)
        face.set_pixel_sizes(0, BITMAP_PPEM)
        result = {}
        for character in map(chr, range(0x20, 0x7F)):
            face.load_char(character, freetype.FT_LOAD_RENDER | freetype.FT_LOAD_NO_HINTING)
            glyph = face.glyph
            result[character] = (glyph.bitmap_left, glyph.bitmap_top, glyph.bitmap.width, bytes(glyph.bitmap.buffer))
        return result

    return expect_equal_items("unhinted bitmap of", render(original), render(converted))


def harfbuzz_shaping(original, converted):
    def shape(path):
        font = uharfbuzz.Font(uharfbuzz.Face(uharfbuzz.Blob.from_file_path(path)))
        result = {}
        for text in TEXTS:
            buffer = uharfbuzz.Buffer()
            buffer.add_str(text)
            buffer.guess_segment_properties()
            uharfbuzz.shape(font, buffer)
            result[text] = [
                (info.codepoint, info.cluster, *position.position)
                for info, position in zip(buffer.glyph_infos, buffer.glyph_positions)
            ]
        return result

    return expect_equal_items("text", shape(original), shape(converted))


CHECKS = {
    "fontTools loads every table": tables_load,
    "fontTools compiles it again": tables_compile_again,
    "characters": cmap,
    "advances and bearings": hmtx,
    "outlines in fontTools": outlines,
    "glyph programs": programs_are_gone,
    "outlines in FreeType": freetype_outlines,
    f"unhinted bitmaps in FreeType, {BITMAP_PPEM} ppem": freetype_bitmaps,
    "shaping in HarfBuzz": harfbuzz_shaping,
}


def main(arguments):
    if len(arguments) != 2:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    converted, original = arguments
    failed = False
    for name, check in CHECKS.items():
        try:
            print(f"ok    {name}: {check(original, converted)}")
        except Exception as error:  # Whatever a library stumbles over is a finding.
            failed = True
            print(f"FAIL  {name}: {type(error).__name__}: {error}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
