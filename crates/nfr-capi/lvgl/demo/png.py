"""Writes a PPM as PNG, each pixel as 2x2: png.py IN.ppm OUT.png. PNG, third edition, sections 5 and 11."""

import struct
import sys
import zlib

SCALE = 2


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


with open(sys.argv[1], "rb") as file:
    _, sizes, _, pixels = file.read().split(b"\n", 3)
width, height = map(int, sizes.split())
rows = []
for y in range(height):
    row = pixels[3 * y * width : 3 * (y + 1) * width]
    # Each row begins with its filter: none.
    rows += [b"\0" + b"".join(row[x : x + 3] * SCALE for x in range(0, 3 * width, 3))] * SCALE
with open(sys.argv[2], "wb") as file:
    header = struct.pack(">IIBBBBB", SCALE * width, SCALE * height, 8, 2, 0, 0, 0)
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header))
    file.write(chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))
