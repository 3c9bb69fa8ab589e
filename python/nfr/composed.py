"""Composed glyphs of outline models (spec/nfrt.md, 7.6)."""

from .coder import Damaged, Decoder, Encoder, Model

MAX_PARTS = MAX_DEPTH = 16
# The kind of their messages, and the context of "unusual" for parts that are not those of glyf.
COMPOSED, LISTED = 1, 2


def plain_parts(glyf, name, offset=(0, 0), depth=0):
    """The simple glyphs that a composite glyph consists of, with their offsets; None if they have to be listed."""
    glyph = glyf[name]
    if not glyph.isComposite():
        return [(name, offset)] if glyph.numberOfContours > 0 else []
    if depth > MAX_DEPTH:
        return None
    parts = []
    for component in glyph.components:
        if hasattr(component, "firstPt") or hasattr(component, "transform"):
            return None
        at = (offset[0] + component.x, offset[1] + component.y)
        found = plain_parts(glyf, component.glyphName, at, depth + 1)
        if found is None or any(not -32768 <= v <= 32767 for v in at):
            return None
        parts += found
    return parts if len(parts) <= MAX_PARTS else None


def folded_hash(numbers):
    """FNV-1a over numbers of 16 bits, folded to 16 bits."""
    value = 0x811C9DC5
    for number in numbers:
        value = (value ^ number) * 0x01000193 & 0xFFFFFFFF
    return (value ^ value >> 16) & 0xFFFF


def advance_width(font, name):
    return font["hmtx"][name][0] & 0xFFFF


def parts_hash(parts, name, font):
    placed = [(font.getGlyphID(part), x & 0xFFFF, y & 0xFFFF) for part, (x, y) in parts]
    return folded_hash([number for part in placed for number in part] + [advance_width(font, name)])


def sign(value):
    return (value >= 0) + (value >= 1)


class Blank:
    """The outline model of a glyph without an outline, which hinting does not touch."""

    parts = ()

    def encode(self, name, font):
        model = Model(coder := Encoder())
        model.bits("message", 0, 2, 0)
        model.raw(folded_hash([advance_width(font, name)]))
        for context in (1, 0, 2, 3, 4):
            model.flag("unusual", context, 0)
        return coder.finish()


class ComposedOutline:
    """A glyph that is composed of outline models: parts, the lists of grid offsets of each (along x and y), advance widths.

    `outline` is the hash of its own outline where the parts are listed, else None: they are those of glyf.
    """

    def __init__(self, outline, parts, lists, advances):
        self.outline, self.parts, self.lists, self.advances = outline, parts, lists, advances

    @classmethod
    def decode(cls, message, name, font, sizes):
        coder = Decoder(message)
        model = Model(coder)
        if model.bits("message", 0, 2) != COMPOSED:
            return None
        outline = None
        if model.flag("unusual", LISTED):
            count, parts = model.signed("part", 0), []
            if not 0 <= count <= MAX_PARTS:
                raise Damaged(f"glyph {name} has {count} parts")
            outline = model.raw()
            for _ in range(count):
                gid = model.raw()
                parts.append((font.getGlyphName(gid), (model.signed("part", 1), model.signed("part", 2))))
        else:
            parts = plain_parts(font["glyf"], name) if font["glyf"][name].isComposite() else None
            if parts is None or model.raw() != parts_hash(parts, name, font):
                raise Damaged(f"the parts or the advance width of glyph {name} are not those that its model was made of")
        lists = [[model.positive("part list", axis) for axis in (0, 1)] for _ in parts]
        advances = model.bits("advances", 0, 2)
        if advances >= 2:
            numbers = []
            for _ in range(sizes):
                v, u = (numbers[-1:] or [0])[0], (numbers[-2:-1] or [0])[0]
                step = model.signed("advance", 9 + 3 * sign(v) + sign(u))
                numbers.append((v + step + 128) % 256 - 128)
            advances = numbers
        coder.finish()
        return cls(outline, parts, lists, advances)

    def encode(self, name, font):
        coder = Encoder()
        model = Model(coder)
        model.bits("message", 0, 2, COMPOSED)
        model.flag("unusual", LISTED, int(self.outline is not None))
        if self.outline is not None:
            model.signed("part", 0, len(self.parts))
            model.raw(self.outline)
            for part, (x, y) in self.parts:
                model.raw(font.getGlyphID(part))
                model.signed("part", 1, x)
                model.signed("part", 2, y)
        else:
            model.raw(parts_hash(self.parts, name, font))
        for lists in self.lists:
            for axis, number in enumerate(lists):
                model.positive("part list", axis, number)
        numbers = self.advances if isinstance(self.advances, list) else None
        model.bits("advances", 0, 2, self.advances if numbers is None else 2)
        v = u = 0
        for number in numbers or []:
            model.signed("advance", 9 + 3 * sign(v) + sign(u), number - v)
            v, u = number, v
        return coder.finish()
