#!/usr/bin/env python3
"""Makes the small PostScript fonts beside this file from fonts/Cantarell-Regular.otf, with fontTools 4.68.

seac.otf      'a', the acute accent, and 'á' as `endchar` with four operands, which puts the two together
cid.otf       CID-keyed: 'H' and 'o' with two font dictionaries, of which the second has no blue zones
cff2.otf      'H', 'o', 'g' in 'CFF2', with an axis on which nothing varies
unhinted.otf  'o' without hints
"""

from pathlib import Path

from fontTools.cffLib import FDArrayIndex, FDSelect, FontDict, PrivateDict
from fontTools.cffLib.CFFToCFF2 import convertCFFToCFF2
from fontTools.fontBuilder import FontBuilder
from fontTools.misc.psCharStrings import T2CharString
from fontTools.subset import Options, Subsetter
from fontTools.ttLib import TTFont

HERE = Path(__file__).parent
SOURCE = HERE / "../../../../fonts/Cantarell-Regular.otf"


def subset(text):
    font = TTFont(SOURCE, recalcTimestamp=False)
    options = Options()
    options.layout_features = []
    options.drop_tables += ["GDEF", "GPOS", "GSUB"]
    options.name_IDs = []
    options.glyph_names = True
    options.desubroutinize = False
    subsetter = Subsetter(options)
    subsetter.populate(text=text)
    subsetter.subset(font)
    return font


def cff(font):
    return font["CFF "].cff.topDictIndex[0]


def seac():
    font = subset("aá´")
    top = cff(font)
    strings = top.CharStrings
    # Standard encoding: 97 is 'a', 194 'acute'. The operand before them is the accent's offset.
    name = font.getBestCmap()[ord("á")]
    program = [20, 0, 97, 194, "endchar"]
    width = font["hmtx"][name][0] - top.Private.nominalWidthX
    strings[name] = T2CharString(program=[width] + program, private=top.Private, globalSubrs=top.GlobalSubrs)
    return font


def cid():
    font = subset("Ho")
    top = cff(font)
    private = top.Private
    numbered = {name: "cid%05d" % at if at else name for at, name in enumerate(font.getGlyphOrder())}
    rename(font, top, numbered)
    names = font.getGlyphOrder()
    top.ROS = ("Adobe", "Identity", 0)
    top.CIDCount = len(names)
    top.FDArray = FDArrayIndex()
    for blues in (True, False):
        part = private if blues else without_blue_zones(private)
        dictionary = FontDict()
        dictionary.FontName = "Part%d" % blues
        dictionary.Private = part
        top.FDArray.append(dictionary)
    top.FDSelect = FDSelect()
    top.FDSelect.format = 3
    top.FDSelect.gidArray = [index % 2 for index in range(len(names))]
    for name in names:
        top.CharStrings[name].decompile()
    top.CharStrings.fdArray = top.FDArray
    top.CharStrings.fdSelect = top.FDSelect
    del top.rawDict["Private"]
    if hasattr(top, "Private"):
        del top.Private
    if "Encoding" in top.rawDict:
        del top.rawDict["Encoding"]
    if hasattr(top, "Encoding"):
        del top.Encoding
    return font


def rename(font, top, names):
    strings = {names[name]: top.CharStrings[name] for name in font.getGlyphOrder()}
    metrics = {names[name]: metric for name, metric in font["hmtx"].metrics.items()}
    for table in font["cmap"].tables:
        table.cmap = {code: names[name] for code, name in table.cmap.items()}
    order = [names[name] for name in font.getGlyphOrder()]
    font.setGlyphOrder(order)
    font["hmtx"].metrics = metrics
    top.charset = order
    top.CharStrings.charStrings = strings
    top.CharStrings.charStringsAreIndexed = 0


def without_blue_zones(old):
    """A private dictionary without blue zones."""
    private = PrivateDict()
    for key in ("defaultWidthX", "nominalWidthX"):
        setattr(private, key, getattr(old, key))
    if hasattr(old, "Subrs"):
        private.Subrs = old.Subrs
    return private


def cff2():
    font = subset("Hog")
    convertCFFToCFF2(font)
    builder = FontBuilder(font=font)
    builder.setupFvar([("wght", 400, 400, 700, "Weight")], [])
    return font


def unhinted():
    font = subset("o")
    font["CFF "].cff.remove_hints()
    return font


for name, make in (("unhinted", unhinted), ("seac", seac), ("cid", cid), ("cff2", cff2)):
    font = make()
    font.save(HERE / f"{name}.otf")
    print(name, (HERE / f"{name}.otf").stat().st_size, font.getGlyphOrder())
