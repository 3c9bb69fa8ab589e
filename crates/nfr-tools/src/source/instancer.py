"""Reads a variable font from stdin and writes its static instance to stdout. The arguments are a value for each axis: wght=600."""

import io
import sys

try:
    from fontTools.ttLib import TTFont
    from fontTools.varLib import instancer
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(3)

data = sys.stdin.buffer.read()
place = {tag.ljust(4): float(value) for tag, value in (argument.split("=") for argument in sys.argv[1:])}


def instance(renamed):
    # With the time of the original, the same font comes out the same.
    font = TTFont(io.BytesIO(data), recalcTimestamp=False)
    return instancer.instantiateVariableFont(font, place, inplace=True, updateFontNames=renamed)


try:
    # The name of the instance, where STAT has the names of its parts.
    font = instance(renamed=True)
except ValueError:
    font = instance(renamed=False)
font.save(sys.stdout.buffer)
