"""Checks drawing from Python: python draw.py NEURAL.

NEURAL is Liberation Sans with models of some glyphs, of a and g but not of b.
"""

import gc
import io
import mmap
import pickle
import random
import struct
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import nfr
import numpy

ROOT = Path(__file__).parents[2]
FONT = ROOT / "spec/vectors/outline.ttf"
NEURAL = Path(sys.argv[1])
UNCONVERTED = ROOT / "fonts/LiberationSans-Regular.ttf"
BYTES = FONT.read_bytes()
TESTS = []


def test(function):
    TESTS.append(function)
    return function


def raises(kind, work, code=None, values=None, text=""):
    """The exception that work raises, which is of this class, with this code, these values and this text."""
    try:
        result = work()
    except Exception as error:
        found = error
    else:
        raise AssertionError(f"{result!r} instead of {kind.__name__}")
    assert type(found) is kind, f"{type(found).__name__}: {found}"
    assert text in str(found) and str(found), found
    if code:
        assert found.code == code, found.code
    if values is not None:
        assert found.values == values, found.values
    return found


def table(data, tag):
    """Where a table of a font begins and how long it is."""
    for at in range(12, 12 + 16 * struct.unpack(">H", data[4:6])[0], 16):
        if data[at : at + 4] == tag:
            return struct.unpack(">II", data[at + 8 : at + 16])
    raise KeyError(tag)


def with_bytes(tag, offset, new):
    """The font with other bytes in a table."""
    start = table(BYTES, tag)[0] + offset
    return BYTES[:start] + new + BYTES[start + len(new) :]


def same(a, b):
    return (a.left, a.top) == (b.left, b.top) and numpy.array_equal(a.pixels, b.pixels)


@test
def a_font_opens_from_a_path_from_bytes_and_from_a_file():
    font = nfr.Font(FONT)
    expected = font.draw("a", 13)
    with FONT.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as mapped:
        sources = [FONT, str(FONT), BYTES, bytearray(BYTES), memoryview(BYTES), mapped, io.BytesIO(BYTES)]
        sources += [FONT.open("rb"), numpy.frombuffer(BYTES, dtype=numpy.uint8)]
        for source in sources:
            opened = nfr.Font(source)
            assert opened.data == BYTES and same(opened.draw("a", 13), expected), source
    changed = bytearray(BYTES)
    font = nfr.Font(changed)
    changed[:] = bytes(len(changed))
    assert same(font.draw("a", 13), expected), "the font is not its own copy of a bytearray"


@test
def a_bitmap_is_an_array_that_belongs_to_the_caller():
    font = nfr.Font(FONT)
    first = font.draw("a", 16)
    assert first.pixels.shape == (8, 7) == (first.height, first.width) and first.pixels.dtype == numpy.uint8
    assert (first.left, first.top) == (0, 8) and first.pixels.max() > 200
    assert first.pixels[0].argmax() == 4 and first.pixels[-1, -1] == 102, "the top row is not the first"
    assert numpy.asarray(first) is first.pixels and numpy.asarray(first, dtype=float).dtype == float
    before = first.pixels.copy()
    first.pixels[:] = 0
    assert numpy.array_equal(font.draw("a", 16).pixels, before)
    pixels = font.draw("g", 40).pixels
    del font
    gc.collect()
    assert pixels.sum() > 0
    blank = nfr.Font(FONT).draw(" ", 16)
    assert blank.pixels.shape == (0, 0) and blank.pixels.size == 0


@test
def glyphs_go_by_number_character_and_name():
    font = nfr.Font(FONT)
    glyph = font.glyph_for_char("a")
    by_number = font.draw(glyph, 16)
    for key in ("a", numpy.int64(glyph), numpy.uint16(glyph), "a\ufe00"):
        assert same(font.draw(key, 16), by_number), key
    assert font.glyph_for_char("b") is None and font.characters()["a"] == glyph
    assert font.glyph_name(glyph) == f"gid{glyph}" and font.glyph_for_name("a") is None, "this font has no names"
    named = nfr.Font(NEURAL)
    assert named.glyph_for_name("eacute") == named.glyph_for_char("é") and named.glyph_name("é") == "eacute"


@test
def hinting_can_be_left_out():
    font = nfr.Font(FONT)
    assert not same(font.draw("a", 12), font.draw("a", 12, hinting=False))
    assert same(font.draw("a", 200), font.draw("a", 200, hinting=False)), "hints end with the sizes of the models"
    moved = font.draw("a", 16, offset=(1.0, -2.0))
    still = font.draw("a", 16)
    assert (moved.left, moved.top) == (still.left + 1, still.top - 2)
    assert numpy.array_equal(moved.pixels, still.pixels)
    assert not same(font.draw("a", 16, offset=[0.5, 0.0]), still)


@test
def subpixels_have_three_channels():
    font = nfr.Font(FONT)
    third = 21 / 64
    for filter in ["shifted", "light", "fir5", "none"]:
        drawn = font.draw_lcd("g", 20, filter=filter)
        assert drawn.pixels.shape == (drawn.height, drawn.width, 3) and drawn.pixels.any()
        assert (drawn.pixels[:, :, 0] != drawn.pixels[:, :, 2]).any(), "red is blue"
        reversed = font.draw_lcd("g", 20, order="bgr", filter=filter)
        assert (drawn.pixels == reversed.pixels[:, :, ::-1]).all()
        above = font.draw_lcd("g", 20, order="v-rgb", filter=filter)
        assert (above.pixels == font.draw_lcd("g", 20, order="v-bgr", filter=filter).pixels[:, :, ::-1]).all()
        assert drawn.pixels.shape != above.pixels.shape or (drawn.pixels != above.pixels).any()
    drawn = font.draw_lcd("g", 20)
    for channel, offset in [(0, third), (1, 0), (2, -third)]:
        moved = font.draw("g", 20, offset=(offset, 0))
        left, top = moved.left - drawn.left, drawn.top - moved.top
        found = drawn.pixels[top : top + moved.height, left : left + moved.width, channel]
        assert (found == moved.pixels).all() and found.sum() == drawn.pixels[:, :, channel].sum()
    raises(ValueError, lambda: font.draw_lcd("g", 20, order="grb"), text="grb")
    raises(ValueError, lambda: font.draw_lcd("g", 20, filter="heavy"), text="heavy")


@test
def metrics_are_in_pixels():
    font = nfr.Font(FONT)
    liberation = nfr.Font(NEURAL)
    for ppem in (9, 16, 33.5):
        assert abs(liberation.advance("a", ppem) - 1139 / 2048 * ppem) < 1e-4
    assert liberation.advance("a", 16) != liberation.hinted_advance("a", 16) == 9.0
    assert liberation.hinted_advance("a", 33.5) == 19.0, "a size between is hinted as the nearest whole one"
    assert liberation.hinted_advance("a", 70) == liberation.advance("a", 70)
    assert 0 < font.hinted_side_bearing("a", 16) < 2
    line = font.line_metrics(20)
    assert line == font.line_metrics(20) != font.line_metrics(21)
    assert line.ascent > 15 and line.descent < 0 and line.underline_position < 0 < line.underline_thickness


@test
def a_line_is_its_glyphs_side_by_side():
    font = nfr.Font(FONT)
    text = "ñamOX g½ __joe"
    for options in ({}, {"hinted_advances": False}, {"hinting": False}):
        drawn = font.draw_text(text, 17, **options)
        hinting = options.get("hinting", True)
        hinted = options.get("hinted_advances", hinting)
        canvas, pen = numpy.zeros((40, 200), dtype=numpy.int64), 0.0
        for character in text:
            glyph = font.draw(character, 17, offset=(pen % 1, 0), hinting=hinting)
            row, column = 25 - glyph.top, 10 + int(pen // 1) + glyph.left
            place = canvas[row : row + glyph.height, column : column + glyph.width]
            place[:] = 255 - ((255 - place) * (255 - glyph.pixels.astype(int)) + 127) // 255
            pen += (font.hinted_advance if hinted else font.advance)(character, 17)
        rows, columns = numpy.nonzero(canvas)
        assert (drawn.left, drawn.top) == (columns.min() - 10, 25 - rows.min()), options
        ink = canvas[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
        left, top = columns.min() - 10 - drawn.left, 25 - rows.min() - drawn.top
        assert numpy.array_equal(drawn.pixels[top : top + len(ink), -left : ink.shape[1] - left], ink), options
        assert drawn.pixels.sum() == ink.sum()
        assert abs(font.text_advance(text, 17, hinted_advances=hinted) - pen) < 1e-3
    assert font.draw_text("", 12).pixels.shape == (0, 0) and font.text_advance("", 12) == 0
    assert same(font.draw_text("b", 12), font.draw(0, 12)), "glyph 0 stands for what is missing"
    assert same(font.draw_text("a\ufe0fo", 12), font.draw_text("ao", 12)), "a selector is not drawn"


@test
def what_is_wrong_with_a_file_is_told():
    raises(FileNotFoundError, lambda: nfr.Font("no/such/font"), text="no/such/font")
    raises(IsADirectoryError, lambda: nfr.Font(ROOT))
    for wrong in (3, None, ["x"], io.StringIO("x")):
        raises(TypeError, lambda: nfr.Font(wrong))
    raises(nfr.FontError, lambda: nfr.Font(b""), "not_a_font", {})
    raises(nfr.FontError, lambda: nfr.Font(b"x" * 1000), "not_a_font")
    raises(nfr.FontError, lambda: nfr.Font(UNCONVERTED), "not_converted", text="'Nfrt'")
    raises(nfr.FontError, lambda: nfr.Font(FONT, 2), "no_such_font", {"index": 2, "count": 1})
    raises(ValueError, lambda: nfr.Font(FONT, -1), text="-1")
    version = with_bytes(b"Nfrt", 0, b"\0\x09")
    raises(nfr.FontError, lambda: nfr.Font(version), "unknown_version", {"major": 9})
    renumbered = with_bytes(b"maxp", 4, b"\0\x09")
    raises(nfr.FontError, lambda: nfr.Font(renumbered), "renumbered", {"models": 51, "font": 9})
    raises(nfr.FontError, lambda: nfr.Font(with_bytes(b"head", 18, b"\0\x01")), "units_per_em", {"units_per_em": 1})
    glyph = nfr.Font(FONT).glyph_for_char("a")
    stale = nfr.Font(with_bytes(b"hmtx", 4 * glyph, b"\x01\x23"))
    raises(nfr.GlyphError, lambda: stale.draw("a", 12), "stale_model", {"glyph": glyph})
    assert stale.draw("o", 12).pixels.any(), "one stale glyph spoils the others"


@test
def damaged_files_raise_and_never_crash():
    for length in range(0, len(BYTES), len(BYTES) // 50):
        kind = getattr(raises_any(lambda: draw_some(BYTES[:length])), "code", None)
        assert kind, length
    start, length = table(BYTES, b"Nfrt")
    chance, refused = random.Random(1), 0
    for _ in range(300):
        data = bytearray(BYTES)
        for _ in range(chance.randrange(1, 4)):
            data[start + chance.randrange(length)] = chance.randrange(256)
        refused += raises_any(lambda: draw_some(bytes(data))) is not None
    assert refused > 30, refused


def raises_any(work):
    """The error of the library's that work raises, if any. Any other exception goes through."""
    try:
        work()
    except nfr.Error as error:
        return error


def draw_some(data):
    font = nfr.Font(data)
    for glyph in range(font.glyph_count):
        font.draw(glyph, 11)
        font.hinted_advance(glyph, 11)


@test
def what_is_wrong_with_an_argument_is_told():
    font = nfr.Font(FONT)
    for ppem in (0, -1, float("nan"), float("inf"), 1e9, 1e300, 2048.01):
        for work in (font.draw, font.draw_text, font.advance, font.hinted_advance, font.hinted_side_bearing):
            error = raises(nfr.ArgumentError, lambda: work("a", ppem), "invalid_size", text="ppem is outside")
            assert isinstance(error, ValueError) and isinstance(error, nfr.Error) and "ppem" in error.values
        raises(nfr.ArgumentError, lambda: font.line_metrics(ppem), "invalid_size")
    for offset in ((0, 1e9), (float("nan"), 0), (0, float("-inf"))):
        raises(nfr.ArgumentError, lambda: font.draw("a", 12, offset=offset), "invalid_offset")
    for offset in ((1,), (1, 2, 3)):
        raises(ValueError, lambda: font.draw("a", 12, offset=offset))
    for offset in (0.25, "ab", (None, 1)):
        raises(TypeError, lambda: font.draw("a", 12, offset=offset))
    for glyph in (51, -1, 10**30):
        raises(nfr.GlyphError, lambda: font.draw(glyph, 12), "no_such_glyph", {"glyph": glyph}, text=str(glyph))
        raises(nfr.GlyphError, lambda: font.advance(glyph, 12), "no_such_glyph")
    raises(nfr.GlyphError, lambda: font.draw("b", 12), "no_such_character", {"character": "b"}, text="U+0062")
    for glyph in (1.0, None, b"a", ["a"]):
        raises(TypeError, lambda: font.draw(glyph, 12))
    for glyph in ("", "ab", "a\ufe00\ufe00"):
        raises(ValueError, lambda: font.draw(glyph, 12), text="one character")
    raises(TypeError, lambda: font.draw("a", "12"))
    raises(TypeError, lambda: font.draw("a", None))
    raises(ValueError, lambda: font.draw_text("a\nb", 12), text="index 1")
    raises(ValueError, lambda: nfr.Font(FONT, missing_model="draw"), text="'outline'")
    raises(TypeError, lambda: nfr.Font(FONT, limits=8))
    raises(ValueError, lambda: nfr.Limits(work=-1), text="work")
    error = raises(nfr.GlyphError, lambda: font.draw(99, 12))
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.code, again.values) == (type(error), str(error), error.code, error.values)


@test
def limits_and_missing_models_are_as_asked_for():
    limits = nfr.Limits(bitmap_side=30)
    assert (limits.decoded_bytes, limits.work) == (8 << 20, 1 << 28) and limits == nfr.Limits(bitmap_side=30)
    font = nfr.Font(FONT, limits=limits)
    assert font.draw("a", 20).pixels.any()
    raises(nfr.LimitError, lambda: font.draw("M", 60), "bitmap_too_large")
    error = raises(nfr.LimitError, lambda: font.draw_text("a" * 200, 20), "line_too_large")
    assert error.values["limit"] == 900
    slow = nfr.Font(FONT, limits=nfr.Limits(work=10))
    raises(nfr.LimitError, lambda: slow.draw("a", 20), "too_much_work")
    small = nfr.Font(FONT, limits=nfr.Limits(decoded_bytes=100))
    raises(nfr.LimitError, lambda: small.draw("a", 20), "decoded_too_large")
    lacking = NEURAL
    glyph = nfr.Font(lacking).glyph_for_char("b")
    raises(nfr.MissingModelError, lambda: nfr.Font(lacking).draw(glyph, 20), "missing_model", {"glyph": glyph})
    assert nfr.Font(lacking, missing_model="blank").draw(glyph, 20).pixels.size == 0
    outline = nfr.Font(lacking, missing_model="outline").draw(glyph, 20)
    assert same(outline, nfr.Font(lacking).draw(glyph, 20, hinting=False)) and outline.pixels.any()
    assert not nfr.Font(lacking).has_model(glyph) and nfr.Font(lacking).has_model("a")


@test
def the_table_is_told_about():
    font = nfr.Font(FONT)
    info = font.info()
    assert (info["version"], info["target"], info["first_ppem"], info["last_ppem"]) == ("2.0", "smooth", 8, 64)
    assert info["glyphs_with_models"] == len(font.modelled_glyphs()) == 51 == font.glyph_count
    assert info["outlines_match"] and info["file_bytes"] == len(BYTES) and info["table_bytes"] == table(BYTES, b"Nfrt")[1]
    assert font.target == "smooth" and font.ppem_range == (8, 64) and font.units_per_em == 2048
    if info["certificate"]:
        assert len(info["certificate"]["glyphs"]) == 51 and "skrifa" in info["certificate"]["teacher"]
    networks = nfr.Font(ROOT / "spec/vectors/network.ttf").info()
    assert networks["networks"] == 2 and networks["network_bits"] == [8] and networks["version"] == "2.1"


@test
def threads_share_a_font():
    font = nfr.Font(FONT)
    glyphs = font.modelled_glyphs()

    def sums(seed):
        order = random.Random(seed).sample(glyphs, len(glyphs))
        return {glyph: [font.draw(glyph, ppem).pixels.tobytes() for ppem in (9, 16, 40)] for glyph in order}

    with ThreadPoolExecutor(8) as pool:
        first, *others = pool.map(sums, range(24))
    assert all(other == first for other in others)


@test
def other_threads_run_while_a_line_is_drawn():
    font = nfr.Font(FONT)
    font.draw("m", 64)
    started, times = threading.Event(), []

    def draw():
        started.set()
        begin = time.perf_counter()
        font.draw_text("m" * 15_000, 64)
        times.append((begin, time.perf_counter()))

    thread = threading.Thread(target=draw)
    thread.start()
    started.wait()
    ticks = []
    while thread.is_alive():
        time.sleep(0.001)
        ticks.append(time.perf_counter())
    thread.join()
    (begin, end), = times
    inside = sum(begin < tick < end for tick in ticks)
    assert inside >= 5, f"{inside} ticks of another thread in {end - begin:.3f} s"


@test
def numpy_is_loaded_with_the_first_bitmap():
    code = (
        "import sys, nfr; font = nfr.Font(sys.argv[1]); assert font.advance('a', 9) > 3;"
        "assert 'numpy' not in sys.modules; font.draw('a', 9); assert 'numpy' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code, FONT], check=True)


if __name__ == "__main__":
    for test in TESTS:
        test()
    print(f"{len(TESTS)} tests of drawing passed, {'with' if 'fontTools' in sys.modules else 'without'} fontTools")
