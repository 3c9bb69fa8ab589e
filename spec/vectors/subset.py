"""Makes a small hinted font of some characters, under a name of its own.

    python subset.py FONT.ttf OUT.ttf NAME CHARACTERS whole|fractional

What is left is what drawing needs; copyright and licence stay in the name table. The same font gives the same bytes. `whole` and `fractional` say whether
hinted sizes are whole along x too (bit 3 of `head.flags`).
"""

import sys

from fontTools import subset
from fontTools.ttLib import TTFont

# OpenType 1.9, "name".
COPYRIGHT, FAMILY, STYLE, UNIQUE, FULL, VERSION, POSTSCRIPT = range(7)
DESCRIPTION, LICENCE, LICENCE_URL = 10, 13, 14
WINDOWS, UNICODE, ENGLISH = 3, 1, 0x409
WHOLE_SIZES = 1 << 3


def options():
    options = subset.Options()
    options.drop_tables += ["FFTM"]
    options.glyph_names = False
    options.hinting = True
    options.layout_features = []
    options.name_IDs = [COPYRIGHT, LICENCE, LICENCE_URL]
    options.notdef_outline = True
    options.recalc_timestamp = False
    return options


def main(source, out, name, characters, sizes):
    font = TTFont(source, recalcTimestamp=False)
    original, version = (font["name"].getDebugName(entry) for entry in (FULL, VERSION))
    subsetter = subset.Subsetter(options())
    subsetter.populate(text=characters)
    subsetter.subset(font)
    if sizes == "whole":
        font["head"].flags |= WHOLE_SIZES
    else:
        font["head"].flags &= ~WHOLE_SIZES
    names = {
        FAMILY: name,
        STYLE: "Regular",
        UNIQUE: f"{name}, {version}",
        FULL: name,
        VERSION: version,
        POSTSCRIPT: name.replace(" ", ""),
        DESCRIPTION: f"Some glyphs of {original}, changed to test renderers.",
    }
    for entry, text in names.items():
        font["name"].setName(text, entry, WINDOWS, UNICODE, ENGLISH)
    font.save(out)


main(*sys.argv[1:])
