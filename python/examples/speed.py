"""Glyphs a second through Python, of printable ASCII at 16 pixels per em, warm: python speed.py NEURAL ORIGINAL.

Each round draws all glyphs with each library in turn, so that all of them meet the same machine; the figure is the best of the rounds.
Pillow and freetype-py are left out where they are not installed.
"""

import ctypes
import sys
import time

import nfr
import numpy

PPEM, ROUNDS = 16, 200
TEXT = [chr(code) for code in range(0x20, 0x7F)]


def with_nfr(path):
    font = nfr.Font(path)
    numbers = [font.glyph_for_char(character) for character in TEXT]
    line = "".join(TEXT)
    yield "nfr, draw(glyph).pixels", lambda: [font.draw(number, PPEM).pixels for number in numbers]
    yield "nfr, draw(character).pixels", lambda: [font.draw(character, PPEM).pixels for character in TEXT]
    yield "nfr, draw_text of all, a glyph", lambda: font.draw_text(line, PPEM).pixels


def with_freetype(path):
    import freetype

    face = freetype.Face(path)
    face.set_pixel_sizes(0, PPEM)
    numbers = [face.get_char_index(character) for character in TEXT]

    def draw(number):
        face.load_glyph(number, freetype.FT_LOAD_RENDER)
        bitmap = face.glyph.bitmap
        rows, pitch = bitmap.rows, bitmap.pitch
        # Faster than bitmap.buffer, which is a list.
        pixels = ctypes.string_at(bitmap._FT_Bitmap.buffer, rows * pitch) if rows else b""
        return numpy.frombuffer(pixels, dtype=numpy.uint8).reshape(rows, pitch)

    yield f"freetype-py, hinted, FreeType {'.'.join(map(str, freetype.version()))}", lambda: list(map(draw, numbers))


def with_pillow(path):
    import PIL
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.truetype(path, PPEM, layout_engine=ImageFont.Layout.BASIC)
    line = "".join(TEXT)
    box = font.getbbox(line)

    def draw_line():
        image = Image.new("L", (box[2], box[3]))
        ImageDraw.Draw(image).text((0, 0), line, fill=255, font=font)
        return numpy.asarray(image)

    yield f"Pillow {PIL.__version__}, hinted, getmask, no array", lambda: [font.getmask(character, mode="L") for character in TEXT]
    yield f"Pillow {PIL.__version__}, a line, a glyph", draw_line


def main(neural, original):
    rivals = list(with_nfr(neural))
    for make in (with_freetype, with_pillow):
        try:
            rivals += make(original)
        except ImportError as missing:
            print(f"without {missing.name}")
    best = dict.fromkeys((name for name, _ in rivals), float("inf"))
    for _ in range(ROUNDS):
        for name, work in rivals:
            work()  # Brings back what the others have pushed out of the processor's caches.
            begin = time.perf_counter()
            work()
            best[name] = min(best[name], time.perf_counter() - begin)
    for name, seconds in best.items():
        print(f"{name:<45}{len(TEXT) / seconds:>12,.0f} glyphs/s{seconds / len(TEXT) * 1e6:>9.2f} µs a glyph")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
