"""Draws everything in spec/vectors through the wheel: python vectors.py FOLDER. Pixels that differ from the vectors: none are allowed.

Needs a C compiler, for the hashes: Python would take half a minute for them.
"""

import ctypes
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import nfr
import numpy

FNV1A = """
#include <stddef.h>
#include <stdint.h>
uint64_t fnv1a(uint64_t hash, const uint8_t *bytes, size_t count) {
    while (count--) hash = (hash ^ *bytes++) * 0x100000001b3;
    return hash;
}
"""
BASIS = 0xCBF29CE484222325
# Sizes of a sweep, below the last size of the models.
STEPS = [step / 4 for step in range(64, -1, -1)]


def hasher(directory):
    library = str(Path(directory) / "fnv1a.so")
    command = ["cc", "-O2", "-shared", "-fPIC", "-x", "c", "-", "-o", library]
    subprocess.run(command, check=True, input=FNV1A, text=True)
    function = ctypes.CDLL(library).fnv1a
    function.restype = ctypes.c_uint64
    function.argtypes = [ctypes.c_uint64, ctypes.c_char_p, ctypes.c_size_t]
    return lambda state, pixels: function(state, pixels.tobytes(), pixels.size)


def drawn(font, columns):
    """The bitmap of the columns glyph, ppem, offset-x, offset-y, and the other columns as they are for it."""
    glyph, ppem, *offset = int(columns[0]), *map(float, columns[1:4])
    bitmap = font.draw(glyph, ppem, offset=offset)
    assert bitmap.pixels.shape == (bitmap.height, bitmap.width) and bitmap.pixels.dtype == numpy.uint8
    return bitmap, [*columns[:4], *map(str, (bitmap.left, bitmap.top, bitmap.width, bitmap.height))]


def lines(path):
    return [line for line in path.read_text().splitlines() if line and not line.startswith("#")]


def check(folder, fnv1a):
    fonts = {path.stem: nfr.Font(path) for path in sorted(folder.glob("*.ttf"))}

    def vector(name, line):
        bitmap, columns = drawn(fonts[name], line.split())
        return " ".join([*columns, f"{fnv1a(BASIS, bitmap.pixels):016x}"])

    def sweep(line):
        name, glyph, _ = line.split()
        state = BASIS
        for step in STEPS:
            state = fnv1a(state, fonts[name].draw(int(glyph), fonts[name].ppem_range[1] - step).pixels)
        return f"{name} {glyph} {state:016x}"

    def picture(block):
        name, *columns = block.splitlines()[0].split()
        bitmap, columns = drawn(fonts[name], columns)
        rows = [" ".join(f"{pixel:02x}" for pixel in row) for row in bitmap.pixels.tolist()]
        return "\n".join([" ".join([name, *columns]), *rows])

    jobs = [(vector, name, line) for name in fonts for line in lines(folder / f"{name}.txt")]
    jobs += [(sweep, line) for line in lines(folder / "sweeps.txt")]
    jobs += [(picture, block) for block in (folder / "bitmaps.txt").read_text().strip().split("\n\n")[1:]]
    # Two threads share the fonts.
    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(lambda job: job[0](*job[1:]), jobs))
    wrong = [(job[-1], line) for job, line in zip(jobs, found) if line != job[-1]]
    for written, other in wrong[:5]:
        print(f"written {written}\ndrawn   {other}", file=sys.stderr)
    assert not wrong, f"{len(wrong)} of {len(jobs)} bitmaps and sweeps differ"
    print(f"{len(jobs)} bitmaps and sweeps of {len(fonts)} fonts, all the same")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as directory:
        check(Path(sys.argv[1]), hasher(directory))
