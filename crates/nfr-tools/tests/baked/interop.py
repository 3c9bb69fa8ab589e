#!/usr/bin/env python3
"""Opens a font with baked strikes in fontTools and in FreeType, and compares what the two find.

    python tests/baked/interop.py BAKED

needs the packages fonttools and freetype-py. Exits with 1 if they differ.
"""

import io
import sys

import freetype
from fontTools.ttLib import TTFont

# FreeType's pixel modes, and their bits a pixel.
BITS = {1: 1, 2: 8, 3: 2, 4: 4}


def unpacked(data, bits, count):
    value = int.from_bytes(data, "big") if data else 0
    total = 8 * len(data)
    return [value >> (total - bits * (at + 1)) & (1 << bits) - 1 for at in range(count)]


def by_fonttools(strike, depth):
    for name, glyph in strike.items():
        metrics = glyph.metrics
        levels = unpacked(glyph.imageData, depth, metrics.width * metrics.height)
        yield name, (metrics.BearingX, metrics.BearingY, metrics.width, metrics.Advance, levels)


def by_freetype(face, gid):
    face.load_glyph(gid, freetype.FT_LOAD_DEFAULT)
    slot, bitmap = face.glyph, face.glyph.bitmap
    rows = [bitmap.buffer[row * bitmap.pitch : (row + 1) * bitmap.pitch] for row in range(bitmap.rows)]
    levels = [level for row in rows for level in unpacked(bytes(row), BITS[bitmap.pixel_mode], bitmap.width)]
    return slot.bitmap_left, slot.bitmap_top, bitmap.width, slot.advance.x // 64, levels


def main(arguments):
    if len(arguments) != 1:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    font, face = TTFont(arguments[0], checkChecksums=2), freetype.Face(arguments[0])
    sizes = [strike.bitmapSizeTable for strike in font["EBLC"].strikes]
    for number, (size, strike) in enumerate(zip(sizes, font["EBDT"].strikeData)):
        face.select_size(number)
        for name, expected in by_fonttools(strike, size.bitDepth):
            found = by_freetype(face, font.getGlyphID(name))
            if found != expected:
                print(f"FAIL  {name} at {size.ppemY} ppem: fontTools {expected}, FreeType {found}")
                return 1
        print(f"ok    {len(strike)} glyphs at {size.ppemY} ppem, {size.bitDepth} bits")
    again = io.BytesIO()
    font.save(again)
    same = TTFont(again).getTableData("EBDT") == font.reader["EBDT"]
    print("ok    EBDT compiles to the same bytes" if same else "FAIL  EBDT compiles to other bytes")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
