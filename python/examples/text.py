"""A picture of a text at several sizes, hinted and not: python text.py FONT OUT.png [TEXT]."""

import struct
import sys
import zlib

import nfr
import numpy

SIZES = (9, 10, 11, 12, 13, 14, 16, 18, 21, 24)
TEXT = "Sphinx of black quartz, judge my vow. 0123456789"
MARGIN, GAP = 12, 24


def paste(page, bitmap, x, baseline):
    """Draws coverage in black on a page of paper's brightness, 0-255."""
    top, left = baseline - bitmap.top, x + bitmap.left
    place = page[top : top + bitmap.height, left : left + bitmap.width]
    place[:] = place.astype(numpy.uint16) * (255 - bitmap.pixels.astype(numpy.uint16)) // 255


def write_png(path, page):
    """Writes a page as a grey PNG."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width = page.shape
    rows = b"".join(b"\0" + row.tobytes() for row in page)
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def main(path, out, text=TEXT):
    font = nfr.Font(path)
    lines, baseline = [], MARGIN
    for ppem in SIZES:
        metrics = font.line_metrics(ppem)
        baseline += round(metrics.ascent)
        lines.append((baseline, font.draw_text(text, ppem), font.draw_text(text, ppem, hinting=False)))
        baseline += round(metrics.line_gap - metrics.descent) + 4
    column = MARGIN + max(hinted.left + hinted.width for _, hinted, _ in lines) + GAP
    width = column + max(plain.left + plain.width for _, _, plain in lines) + MARGIN
    page = numpy.full((baseline + MARGIN, width), 255, dtype=numpy.uint8)
    for baseline, hinted, plain in lines:
        paste(page, hinted, MARGIN, baseline)
        paste(page, plain, column, baseline)
    write_png(out, page)


if __name__ == "__main__":
    if not 3 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
