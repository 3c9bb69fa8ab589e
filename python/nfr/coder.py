"""The arithmetic coder of the table and its adaptive probabilities: sections 2.1 to 2.5 of spec/nfrt.md, as far as composed
glyphs of outlines need them (nothing there is mixed)."""

from importlib import resources

# Squashed values of the logistic function (2.2).
_CURVE = [
    1, 2, 3, 6, 10, 16, 27, 45, 73, 120, 194, 310, 488, 747, 1101, 1546, 2047, 2549, 2994, 3348, 3607, 3785, 3901, 3975,
    4022, 4050, 4068, 4079, 4085, 4089, 4092, 4093, 4094,
]

# The elements of outline models: the contexts of each set, and bins (7.3).
_ELEMENTS = {
    "message": ([1], 4),
    "track": ([24, 24, 24], 1),
    "unusual": ([6], 1),
    "subtrack": ([2], 6),
    "source": ([6], 4),
    "shared": ([4], 12),
    "hit": ([16, 44, 24], 1),
    "miss pixels": ([21], 6),
    "miss fraction": ([28], 8),
    "advance": ([27], 5),
    "corrected size": ([4], 1),
    "corrected": ([8], 1),
    "correction": ([4], 8),
    "part list": ([4], 12),
    "part": ([4], 12),
    "grid offset of an outline": ([9], 8),
    "advances": ([1], 4),
    "section": ([4], 12),
}

_SUFFIX_LENGTHS = 7
_HALF = 2048


def _squash(x):
    if x > 2047:
        return 4095
    if x < -2047:
        return 0
    at, share = (x >> 7) + 16, x & 127
    return (_CURVE[at] * (128 - share) + _CURVE[at + 1] * share + 64) >> 7


def _read_priors():
    text = "".join(resources.files("nfr").joinpath("outline-priors.txt").read_text().split())
    first, slots = {}, 0
    for name, (contexts, bins) in _ELEMENTS.items():
        first[name] = slots
        slots += sum(contexts) * bins + (3 * _SUFFIX_LENGTHS if bins > 1 else 0)
    values = [16 * _squash(64 * (ord(digit) - 48 - 32) + 32) + 8 for digit in text[:slots]]
    return first, values


_FIRST, _SLOTS = _read_priors()


class Damaged(ValueError):
    """A message that does not follow the format."""


class Encoder:
    """Writes bins."""

    def __init__(self):
        self.low, self.high, self.out = 0, 0xFFFFFFFF, bytearray()

    def bit(self, probability, bit):
        split = self.low + (self.high - self.low) * probability // 4096
        if bit:
            self.high = split
        else:
            self.low = split + 1
        while (self.low ^ self.high) >> 24 == 0:
            self.out.append(self.low >> 24)
            self.low = self.low << 8 & 0xFFFFFFFF
            self.high = self.high << 8 & 0xFFFFFFFF | 255
        return bit

    def finish(self):
        if self.low:
            self.out.append((self.low + 0xFFFFFF) >> 24)
        return bytes(self.out)


class Decoder:
    """Reads bins."""

    def __init__(self, data):
        self.low, self.high, self.data, self.at = 0, 0xFFFFFFFF, data, 4
        self.window = int.from_bytes((data + bytes(4))[:4], "big")

    def bit(self, probability, _=None):
        split = self.low + (self.high - self.low) * probability // 4096
        bit = self.window <= split
        if bit:
            self.high = split
        else:
            self.low = split + 1
        while (self.low ^ self.high) >> 24 == 0:
            self.low = self.low << 8 & 0xFFFFFFFF
            self.high = self.high << 8 & 0xFFFFFFFF | 255
            more = self.data[self.at] if self.at < len(self.data) else 0
            self.window = (self.window << 8 & 0xFFFFFFFF) | more
            self.at += 1
        return int(bit)

    def finish(self):
        if self.at - 4 + (self.low > 0) != len(self.data):
            raise Damaged("a message ends early, or has bytes left over")


class Model:
    """Codes numbers with a coder: a reader is given None for each number and returns it, a writer the number."""

    def __init__(self, coder):
        self.coder, self.slots = coder, list(_SLOTS)

    def _bin(self, slot, bit):
        value = self.slots[slot]
        bit = self.coder.bit(min(max(value >> 4, 1), 4095), bit)
        self.slots[slot] = value + ((65535 - value) >> 4) if bit else value - (value >> 4)
        return bit

    def _slot(self, element, context, bin):
        _, bins = _ELEMENTS[element]
        return _FIRST[element] + context * bins + min(bin, bins - 1)

    def flag(self, element, context, value=None):
        return self._bin(self._slot(element, context, 0), value)

    def bits(self, element, context, width, value=None):
        known = 1
        for at in reversed(range(width)):
            slot = _FIRST[element] + (context << width) + known
            known = known << 1 | self._bin(slot, None if value is None else value >> at & 1)
        return known - (1 << width)

    def raw(self, value=None):
        known = 0
        for at in reversed(range(16)):
            known = known << 1 | self.coder.bit(_HALF, None if value is None else value >> at & 1)
        return known

    def positive(self, element, context, value=None):
        length, below = None if value is None else value.bit_length() - 1, 0
        while below < 31 and self._bin(
            self._slot(element, context, 2 + below), None if length is None else int(below < length)
        ):
            below += 1
        contexts, bins = _ELEMENTS[element]
        suffix, known = _FIRST[element] + sum(contexts) * bins, 1
        for at in reversed(range(below)):
            bit, depth = None if value is None else value >> at & 1, below - 1 - at
            if depth <= 1 and below <= _SUFFIX_LENGTHS:
                slot = suffix + 3 * (below - 1) + (0 if depth == 0 else 1 + (known & 1))
                known = known << 1 | self._bin(slot, bit)
            else:
                known = known << 1 | self.coder.bit(_HALF, bit)
        return known

    def signed(self, element, context, value=None):
        if not self._bin(self._slot(element, context, 0), None if value is None else int(value != 0)):
            return 0
        negative = self._bin(self._slot(element, context, 1), None if value is None else int(value < 0))
        size = self.positive(element, context, None if value is None else abs(value))
        return -size if negative else size
