"""Hinted glyphs from small models in the font, drawn to numpy arrays.

    font = nfr.Font("FONT.nfr.ttf")
    font.draw("g", 16).pixels  # coverage 0-255, a numpy array of uint8, top row first

Where fontTools is installed, `import nfr` makes it know the table `Nfrt`: its subsetter keeps and renumbers it, and `ttx` writes
and reads it.
"""

from typing import TYPE_CHECKING

from .errors import ArgumentError, Error, FontError, GlyphError, LimitError, MissingModelError

__all__ = [
    "ArgumentError",
    "Bitmap",
    "Error",
    "Font",
    "FontError",
    "GlyphError",
    "LimitError",
    "Limits",
    "LineMetrics",
    "MissingModelError",
]

if TYPE_CHECKING:
    from ._nfr import Bitmap, Font, Limits, LineMetrics
else:
    try:
        from ._nfr import Bitmap, Font, Limits, LineMetrics
    except ModuleNotFoundError as missing:
        if missing.name != "nfr._nfr":
            raise

        # A checkout, which is enough for fontTools.
        def __getattr__(name):
            if name in __all__:
                raise ImportError(f"nfr.{name} needs the compiled module, which this copy of nfr lacks: pip install nfr")
            raise AttributeError(f"module 'nfr' has no attribute {name!r}")


try:
    from fontTools.ttLib import registerCustomTableClass
except ModuleNotFoundError as missing:
    if missing.name != "fontTools":
        raise
else:
    registerCustomTableClass("Nfrt", "nfr.table", "table_N__f_r_t")
    del registerCustomTableClass
