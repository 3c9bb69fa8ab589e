#!/usr/bin/env python3
"""Makes the small fonts of this directory from fonts/: tests/inputs/make.py. Needs fontTools 4.68 and brotli.

All have the glyphs .notdef, space, A, g and o of Liberation Sans with their hints, under another name, as its licence asks for
(SIL OFL 1.1, fonts/LICENSE-Liberation.txt); the copyright and the licence are in their `name` tables.
"""

import math
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont, newTable
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.ttLib.tables._f_v_a_r import Axis, NamedInstance

HERE = Path(__file__).resolve().parent
LIBERATION = HERE.parents[3] / "fonts/LiberationSans-Regular.ttf"
NAME = "Nfr Inputs"
# The files are the same on another day.
TIME = 3_600_000_000


def small():
    """A few glyphs of Liberation Sans, hinted."""
    options = subset.Options(
        hinting=True, layout_features=[], glyph_names=True, notdef_outline=True, name_IDs=[0, 13], recalc_timestamp=False
    )
    font = subset.load_font(str(LIBERATION), options)
    subsetter = subset.Subsetter(options)
    subsetter.populate(text=" Ago")
    subsetter.subset(font)
    for name, text in ((1, NAME), (2, "Regular"), (4, NAME), (6, NAME.replace(" ", ""))):
        font["name"].setName(text, name, 3, 1, 0x409)
    font["head"].created = font["head"].modified = TIME
    font.recalcTimestamp = False
    return font


def axis(font, tag, name, low, default, high):
    axis = Axis()
    axis.axisTag, axis.axisNameID = tag, font["name"].addName(name, platforms=((3, 1, 0x409),))
    axis.minValue, axis.defaultValue, axis.maxValue = low, default, high
    return axis


def instance(font, name, **coordinates):
    instance = NamedInstance()
    instance.subfamilyNameID = font["name"].addName(name, platforms=((3, 1, 0x409),))
    instance.coordinates = coordinates
    return instance


def variable():
    """Two axes: wght moves points along a wave and changes control values, wdth scales along x."""
    font = small()
    fvar = font["fvar"] = newTable("fvar")
    fvar.axes = [axis(font, "wght", "Weight", 400, 400, 700), axis(font, "wdth", "Width", 75, 100, 100)]
    fvar.instances = [
        instance(font, "Regular", wght=400, wdth=100),
        instance(font, "Semibold", wght=600, wdth=100),
        instance(font, "Condensed Bold", wght=700, wdth=75),
    ]
    gvar = font["gvar"] = newTable("gvar")
    gvar.version, gvar.reserved, gvar.variations = 1, 0, {}
    glyf, hmtx = font["glyf"], font["hmtx"]
    for glyph in font.getGlyphOrder():
        points = glyf._getCoordinatesAndControls(glyph, hmtx.metrics)[0]
        bolder = [(round(30 * math.sin(x / 200)), round(20 * math.cos(y / 200))) for x, y in points[:-4]]
        narrower = [(round(-0.2 * x), 0) for x, _ in points[:-4]]
        width = round(0.2 * hmtx[glyph][0])
        gvar.variations[glyph] = [
            TupleVariation({"wght": (0, 1, 1)}, bolder + [(0, 0), (40, 0), (0, 0), (0, 0)]),
            TupleVariation({"wdth": (-1, -1, 0)}, narrower + [(0, 0), (-width, 0), (0, 0), (0, 0)]),
        ]
    cvar = font["cvar"] = newTable("cvar")
    cvar.majorVersion, cvar.minorVersion = 1, 0
    cvar.variations = [TupleVariation({"wght": (0, 1, 1)}, [8 * (index % 7) for index in range(len(font["cvt "].values))])]
    return font


small().save(HERE / "small.ttf")
for flavor in ("woff", "woff2"):
    font = TTFont(HERE / "small.ttf", recalcTimestamp=False)
    font.flavor = flavor
    font.save(HERE / f"small.{flavor}")
variable().save(HERE / "variable.ttf")
