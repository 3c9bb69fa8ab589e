"""Types and documentation of the compiled module. tests/stubs.py compares them with it."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal, Protocol, final

from numpy import uint8
from numpy.typing import NDArray
from typing_extensions import Buffer

# The number of a glyph, or a character.
Glyph = int | str

class BinaryFile(Protocol):
    def read(self) -> bytes: ...

@final
class Font:
    """A font with models, and what draws it.

    file: a path, the file's bytes (any object with the buffer protocol; bytes are not copied), or a file open in binary mode.
    index: which font of a collection, counted from 0.
    missing_model: what is drawn for a glyph that has no model: "error" raises MissingModelError, "blank" draws nothing,
    "outline" draws the plain outline, without hinting.
    limits: what drawing a glyph may take.
    cache_bytes: the memory for decoded models, for each thread that draws at the same time.

    Threads may use one font at the same time without a lock. The GIL is released while it draws.

    Raises FontError for a file that is no font, has no models, or is damaged; OSError for one that cannot be read.
    """

    def __new__(
        cls,
        file: str | PathLike[str] | Buffer | BinaryFile,
        index: int = 0,
        *,
        missing_model: Literal["error", "blank", "outline"] = "error",
        limits: Limits | None = None,
        cache_bytes: int = 8388608,
    ) -> Font: ...

    def draw(
        self, glyph: Glyph, ppem: float, *, offset: Sequence[float] = (0.0, 0.0), hinting: bool = True
    ) -> Bitmap:
        """Draws a glyph.

        glyph: its number, or a character, which may have a variation selector behind it.
        ppem: the size in pixels per em, above 0 and at most 2048; it may be fractional.
        offset: how far the glyph is moved in pixels, x to the right and y up: the part of a position that is below a pixel.
        hinting: False draws the plain outline.

        Raises GlyphError for a glyph that the font lacks or whose model is damaged, MissingModelError for one without a
        model, LimitError, and ArgumentError, which is a ValueError, for a size or an offset out of range.
        """

    def draw_lcd(
        self,
        glyph: Glyph,
        ppem: float,
        *,
        offset: Sequence[float] = (0.0, 0.0),
        hinting: bool = True,
        order: Literal["rgb", "bgr", "v-rgb", "v-bgr"] = "rgb",
        filter: Literal["shifted", "light", "fir5", "none"] = "shifted",
    ) -> Bitmap:
        """Draws the red, green and blue subpixels of a glyph, for LCD panels. The bitmap's pixels have the shape (height, width, 3).

        glyph, ppem, offset, hinting: as in draw.
        order: how the subpixels lie, "rgb" or "bgr" from left to right, "v-rgb" or "v-bgr" from top to bottom.
        filter: "shifted" (as FreeType does by default), "light" or "fir5" (FreeType's filters), or "none".

        Raises as draw, and ValueError for another order or filter.
        """

    def draw_text(
        self, text: str, ppem: float, *, hinting: bool = True, hinted_advances: bool | None = None
    ) -> Bitmap:
        """Draws a line of text, glyph after glyph, as its characters map to them: no kerning, no ligatures, left to right.

        The bitmap is the box of all ink; left and top are relative to the beginning of the line on its baseline. For a
        character that the font lacks glyph 0 is drawn. Where glyphs overlap, coverage is combined as paint over paint.

        ppem, hinting: as in draw.
        hinted_advances: whether the pen moves by hinted advance widths, as hinted_advance has them, or by linear ones, with
        glyphs at parts of a pixel. By default as hinting.

        Raises as draw, and ValueError for a line break in the text.
        """

    def text_advance(self, text: str, ppem: float, *, hinted_advances: bool = True) -> float:
        """How far the pen moves over a line of text that draw_text draws, in pixels."""

    def advance(self, glyph: Glyph, ppem: float) -> float:
        """The advance width of a glyph in pixels, linear in the size."""

    def hinted_advance(self, glyph: Glyph, ppem: float) -> float:
        """The hinted advance width of a glyph in pixels: a whole number at sizes that round to those of ppem_range, and the linear
        one at others and for glyphs whose models do not know it.
        """

    def hinted_side_bearing(self, glyph: Glyph, ppem: float) -> float:
        """The hinted left side bearing of a glyph in pixels: from its origin to the leftmost point of its outline, control points
        included. It is the linear one for glyphs without an outline and for those whose models do not know it.
        """

    def line_metrics(self, ppem: float) -> LineMetrics:
        """Metrics of a line of text at a size in pixels per em."""

    def glyph_for_char(self, character: str) -> int | None:
        """The glyph of a character, which may have a variation selector behind it; None if the font has none."""

    def glyph_for_name(self, name: str) -> int | None:
        """The glyph with a name of the font's table post; None if there is none."""

    def glyph_name(self, glyph: Glyph) -> str:
        """The name of a glyph; gid7 for glyph 7 where the font has none."""

    def has_model(self, glyph: Glyph) -> bool:
        """Whether a glyph has a model."""

    def characters(self) -> dict[str, int]:
        """The characters of the font with their glyphs."""

    def modelled_glyphs(self) -> list[int]:
        """The glyphs that have models, ascending."""

    def info(self) -> dict[str, Any]:
        """What the table of models says, with the keys of `nfr info --json`."""

    @property
    def glyph_count(self) -> int:
        """The number of glyphs in the font, with a model or without."""

    @property
    def units_per_em(self) -> int:
        """Font units in an em."""

    @property
    def target(self) -> str:
        """What the models were made for: 'smooth', 'mono' or 'lcd'."""

    @property
    def ppem_range(self) -> tuple[int, int]:
        """The first and the last size that the models know, in pixels per em."""

    @property
    def data(self) -> bytes:
        """The file's bytes, for a shaper or another renderer."""

@final
class Bitmap:
    """Coverage of pixels, and where they lie relative to the origin: the glyph's, or the beginning of a line on its baseline."""

    @property
    def pixels(self) -> NDArray[uint8]:
        """Coverage 0-255: a numpy array of uint8 with the shape (height, width), top row first, or (height, width, 3) for red, green
        and blue. It belongs to the caller.
        """

    @property
    def left(self) -> int:
        """Pixels from the origin to the left edge of the left column."""

    @property
    def top(self) -> int:
        """Pixels from the baseline up to the top edge of the top row."""

    @property
    def width(self) -> int:
        """Columns."""

    @property
    def height(self) -> int:
        """Rows."""

    def __array__(self, *args: Any, **kwargs: Any) -> NDArray[Any]:
        """What numpy.asarray(bitmap) calls: the pixels."""

@final
class Limits:
    """What drawing a glyph may take. A font file cannot ask for more."""

    def __new__(cls, *, bitmap_side: int = 8192, decoded_bytes: int = 8388608, work: int = 268435456) -> Limits: ...

    @property
    def bitmap_side(self) -> int:
        """The longest side of a bitmap in pixels. A line of text has at most the square of it in pixels."""

    @property
    def decoded_bytes(self) -> int:
        """The memory that a decoded glyph may take, in bytes."""

    @property
    def work(self) -> int:
        """The steps that drawing a glyph may take, about one multiplication each."""

@final
class LineMetrics:
    """Metrics of a line of text in pixels, y up, linear in the size."""

    @property
    def ascent(self) -> float:
        """From the baseline up to the top of the line."""

    @property
    def descent(self) -> float:
        """From the baseline up to the bottom of the line: a negative number in most fonts."""

    @property
    def line_gap(self) -> float:
        """What is left free between two lines. Baselines are ascent - descent + line_gap apart."""

    @property
    def underline_position(self) -> float:
        """From the baseline up to the top of the underline: a negative number in most fonts."""

    @property
    def underline_thickness(self) -> float:
        """The underline's thickness."""
