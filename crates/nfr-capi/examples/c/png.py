"""Writes a grey PGM as PNG: png.py IN.pgm OUT.png. PNG, third edition, sections 5 and 11."""

import struct
import sys
import zlib


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


with open(sys.argv[1], "rb") as file:
    _, sizes, _, pixels = file.read().split(b"\n", 3)
width, height = map(int, sizes.split())
# Each row begins with its filter: none.
rows = b"".join(b"\0" + pixels[y * width : (y + 1) * width] for y in range(height))
with open(sys.argv[2], "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)))
    file.write(chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
