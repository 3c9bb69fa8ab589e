"""The table `Nfrt`, version 2 (spec/nfrt.md), by glyph names: it follows its font through subsetting and other orders of glyphs.

Models are kept as they are, as bytes. Only the messages of composed glyphs are decoded (`composed`), because they refer to other glyphs.
"""

import logging
import struct

from fontTools.misc.textTools import bytesjoin, safeEval
from fontTools.ttLib import TTLibError
from fontTools.ttLib.tables import DefaultTable

from .coder import Damaged
from .composed import Blank, ComposedOutline

log = logging.getLogger(__name__)

HEADER = 52
BLOCK = 64
NETWORKS, OUTLINE_MODELS, CERTIFICATE, DROPOUT = 2, 4, 8, 16


class Reader:
    """Reads big-endian numbers one after the other."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def bytes(self, count):
        end = self.at + count
        if end > len(self.data):
            raise TTLibError("the table Nfrt ends early")
        self.at, taken = end, self.data[self.at : end]
        return taken

    def array(self, code, count):
        return list(struct.unpack(f">{count}{code}", self.bytes(count * struct.calcsize(code))))

    def one(self, code):
        return self.array(code, 1)[0]


def packed(code, numbers):
    return struct.pack(f">{len(numbers)}{code}", *numbers)


class table_N__f_r_t(DefaultTable.DefaultTable):
    dependencies = ["head", "hmtx", "maxp", "glyf"]

    def decompile(self, data, ttFont):
        reader, name = Reader(data), ttFont.getGlyphName
        self.header = bytearray(reader.bytes(HEADER))
        major, _, _, flags = struct.unpack(">HHBB", self.header[:6])
        if major != 2:
            raise TTLibError(f"the table Nfrt has version {major}; this module reads version 2")
        first, last, count = struct.unpack(">HHH", self.header[6:12])
        self.sizes = last - first + 1
        (payload_length,) = struct.unpack(">I", self.header[28:32])
        composed_count, _, part_count, offsets_length = struct.unpack(">HHII", self.header[40:52])
        self._read_fields(reader, name, count, payload_length)
        self._read_composed_fields(reader, name, composed_count, part_count, offsets_length)
        self.networks = {}
        if flags & NETWORKS:
            ids = reader.array("H", reader.one("H"))
            ends = [0] + reader.array("I", len(ids))
            payload = reader.bytes(ends[-1])
            self.networks = {name(gid): payload[a:b] for gid, a, b in zip(ids, ends, ends[1:])}
        self.outlines, self.shared, self.lists = {}, ([], []), []
        names = [*self.fields, *self.composed_fields, *self.networks]
        if flags & OUTLINE_MODELS:
            names += self._read_outlines(reader, ttFont)
        self.certificate, self.errors, self.dropout, self.dropout_exceptions = b"", {}, b"", []
        if flags & CERTIFICATE:
            self.certificate = reader.bytes(1)
            for _ in ("teacher", "converter", "options"):
                length = reader.one("B")
                self.certificate += bytes([length]) + reader.bytes(length)
            self.errors = {name: reader.bytes(3) for name in sorted(names, key=ttFont.getGlyphID)}
        if flags & DROPOUT:
            count = reader.one("H")
            self.dropout = packed("H", [count]) + reader.bytes(3 * count)
            for _ in range(reader.one("H")):
                self.dropout_exceptions.append((name(reader.one("H")), reader.bytes(5)))
        self.rest = data[reader.at :]

    def _names(self, font):
        """The glyphs that the table has, in the font's order."""
        kinds = self.fields, self.composed_fields, self.networks, self.outlines
        return sorted({name for models in kinds for name in models}, key=font.getGlyphID)

    def _read_fields(self, reader, name, count, payload_length):
        gids, lengths = reader.array("H", count), reader.array("H", count)
        reader.array("I", -(-count // BLOCK))
        payload = Reader(reader.bytes(payload_length))
        self.fields = {name(gid): payload.bytes(length) for gid, length in zip(gids, lengths)}

    def _read_composed_fields(self, reader, name, count, part_count, offsets_length):
        gids, ends = reader.array("H", count), [0] + reader.array("I", count)
        numbers, models = reader.array("H", 5 * part_count), list(self.fields)
        parts = [numbers[5 * k : 5 * k + 5] for k in range(part_count)]
        self.composed_fields = {
            name(gid): [[models[part[0]], *part[1:]] for part in parts[a:b]]
            for gid, a, b in zip(gids, ends, ends[1:])
        }
        self.grid_offsets = reader.bytes(offsets_length)

    def _read_outlines(self, reader, font):
        """Reads the outline models. Returns the names of all glyphs that have one, those that are left out among them."""
        range_count, x, y, lists = reader.array("H", 4)
        payload_length = reader.one("I")
        ranges = reader.array("H", 3 * range_count)
        levels = reader.array("h", x), reader.array("h", y)
        gids = [gid for k in range(range_count) for gid in range(ranges[3 * k], ranges[3 * k + 1] + 1)]
        total = len(gids) + x + y + lists
        blocks = reader.array("I", -(-total // BLOCK))
        payload, messages = reader.bytes(payload_length), []
        for k, begin in enumerate(blocks):
            block = Reader(payload[begin & 0x7FFFFFFF :])
            lengths = block.array("H" if begin >> 31 else "B", min(BLOCK, total - k * BLOCK))
            messages += [block.bytes(length) for length in lengths]
        names = [font.getGlyphName(gid) for gid in gids]
        self.outlines = {}
        for name, message in zip(names, messages):
            try:
                self.outlines[name] = ComposedOutline.decode(message, name, font, self.sizes) or message
            except KeyError:
                pass  # The glyph has left glyf already.
            except Damaged as damage:
                log.warning("Nfrt: %s; its model is left out", damage)
        rest = messages[len(gids) :]
        self.shared = list(zip(levels[0], rest[:x])), list(zip(levels[1], rest[x : x + y]))
        self.lists = rest[x + y :]
        return names

    def compile(self, ttFont):
        gid = ttFont.getGlyphID
        fields = sorted(self.fields, key=gid)
        composed = sorted(self.composed_fields, key=gid)
        parts = [part for name in composed for part in self.composed_fields[name]]
        lengths = [len(self.fields[name]) for name in fields]
        payload = bytesjoin(self.fields[name] for name in fields)
        flags = self.header[5] & ~(NETWORKS | OUTLINE_MODELS | CERTIFICATE | DROPOUT)
        flags |= NETWORKS if self.networks else 0
        flags |= OUTLINE_MODELS if self.outlines else 0
        flags |= CERTIFICATE if self.certificate else 0
        flags |= DROPOUT if self.dropout else 0
        header = bytearray(self.header)
        struct.pack_into(">HHBB", header, 0, 2, 1 if self.networks else 0, self.header[4], flags)
        struct.pack_into(">H", header, 10, len(fields))
        struct.pack_into(">I", header, 28, len(payload))
        struct.pack_into(">H", header, 38, len(ttFont.getGlyphOrder()))
        list_count = struct.unpack(">H", self.header[42:44])[0]
        struct.pack_into(">HHII", header, 40, len(composed), list_count, len(parts), len(self.grid_offsets))
        out = [header, packed("H", [gid(name) for name in fields]), packed("H", lengths)]
        out.append(packed("I", [sum(lengths[:at]) for at in range(0, len(fields), BLOCK)]))
        ends = [sum(len(self.composed_fields[name]) for name in composed[: k + 1]) for k in range(len(composed))]
        out += [payload, packed("H", [gid(name) for name in composed]), packed("I", ends)]
        index = {name: at for at, name in enumerate(fields)}
        out.append(packed("H", [number for part in parts for number in [index[part[0]], *part[1:]]]))
        out.append(self.grid_offsets)
        if self.networks:
            names, end, ends = sorted(self.networks, key=gid), 0, []
            for name in names:
                end += len(self.networks[name])
                ends.append(end)
            out += [packed("H", [len(names)]), packed("H", [gid(name) for name in names]), packed("I", ends)]
            out += [self.networks[name] for name in names]
        if self.outlines:
            out += self._packed_outlines(ttFont)
        if self.certificate:
            out.append(self.certificate)
            out += [self.errors[name] for name in self._names(ttFont)]
        if self.dropout:
            out += [self.dropout, packed("H", [len(self.dropout_exceptions)])]
            out += [packed("H", [gid(name)]) + mode for name, mode in self.dropout_exceptions]
        return bytesjoin(out) + self.rest

    def _packed_outlines(self, font):
        names = sorted(self.outlines, key=font.getGlyphID)
        ranges = []
        for at, gid in enumerate(map(font.getGlyphID, names)):
            if ranges and ranges[-1][1] + 1 == gid:
                ranges[-1][1] = gid
            else:
                ranges.append([gid, gid, at])
        coded = [model if isinstance(model := self.outlines[name], bytes) else model.encode(name, font) for name in names]
        messages = coded + [message for axis in self.shared for _, message in axis] + self.lists
        blocks, payload = [], bytearray()
        for at in range(0, len(messages), BLOCK):
            block = messages[at : at + BLOCK]
            is_wide = max(map(len, block)) > 255
            blocks.append(len(payload) | (1 << 31 if is_wide else 0))
            payload += packed("H" if is_wide else "B", [len(message) for message in block])
            payload += bytesjoin(block)
        counts = [len(ranges), len(self.shared[0]), len(self.shared[1]), len(self.lists)]
        levels = [level for axis in self.shared for level, _ in axis]
        return [
            packed("H", counts),
            packed("I", [len(payload)]),
            packed("H", [number for three in ranges for number in three]),
            packed("h", levels),
            packed("I", blocks),
            bytes(payload),
        ]

    def subset_glyphs(self, s):
        """Keeps the models of the subset's glyphs. A composed glyph goes if one of its parts does. What glyphs share stays whole."""

        def kept(models, parts=lambda model: ()):
            return {
                name: model
                for name, model in models.items()
                if name in s.glyphs and all(part in s.glyphs for part in parts(model))
            }

        self.fields, self.networks = kept(self.fields), kept(self.networks)
        self.composed_fields = kept(self.composed_fields, lambda parts: [part[0] for part in parts])
        composed = ComposedOutline
        self.outlines = kept(self.outlines, lambda m: [part for part, _ in m.parts] if isinstance(m, composed) else ())
        if ".notdef" in s.glyphs and not s.options.notdef_outline:
            # The subsetter takes its outline away.
            for models in self.fields, self.networks, self.composed_fields:
                models.pop(".notdef", None)
            if self.outlines:
                self.outlines[".notdef"], self.errors[".notdef"] = Blank(), bytes(3)
        self.dropout_exceptions = [entry for entry in self.dropout_exceptions if entry[0] in s.glyphs]
        return bool(self.fields or self.networks or self.outlines)

    def toXML(self, writer, ttFont):
        def dump(tag, data, **attributes):
            writer.begintag(tag, **attributes)
            writer.newline()
            writer.dumphex(data)
            writer.endtag(tag)
            writer.newline()

        dump("header", self.header)
        for name, data in self.fields.items():
            dump("field", data, glyph=name)
        for name, parts in self.composed_fields.items():
            writer.begintag("composedField", glyph=name)
            writer.newline()
            for part, x, y, list_x, list_y in parts:
                writer.simpletag("part", glyph=part, x=x, y=y, listX=list_x, listY=list_y)
                writer.newline()
            writer.endtag("composedField")
            writer.newline()
        dump("gridOffsets", self.grid_offsets)
        for name, data in self.networks.items():
            dump("network", data, glyph=name)
        for name, model in self.outlines.items():
            if isinstance(model, ComposedOutline):
                self._composed_to_xml(writer, name, model)
            else:
                data = model if isinstance(model, bytes) else model.encode(name, ttFont)
                dump("outline", data, glyph=name)
        for axis, tracks in zip("xy", self.shared):
            for level, data in tracks:
                dump("sharedTrack", data, axis=axis, level=level)
        for data in self.lists:
            dump("list", data)
        if self.certificate:
            dump("certificate", self.certificate)
        for name in self._names(ttFont) if self.certificate else ():
            writer.simpletag("errors", glyph=name, codes=self.errors[name].hex())
            writer.newline()
        if self.dropout:
            dump("dropout", self.dropout)
        for name, mode in self.dropout_exceptions:
            writer.simpletag("dropoutException", glyph=name, mode=mode.hex())
            writer.newline()
        dump("rest", self.rest)

    def _composed_to_xml(self, writer, name, model):
        numbers = model.advances if isinstance(model.advances, list) else [model.advances]
        kind = "own" if isinstance(model.advances, list) else "kind"
        writer.begintag(
            "composedOutline",
            [
                ("glyph", name),
                *([] if model.outline is None else [("outline", model.outline)]),
                (kind, " ".join(map(str, numbers))),
            ],
        )
        writer.newline()
        for (part, (x, y)), (list_x, list_y) in zip(model.parts, model.lists):
            writer.simpletag("part", glyph=part, x=x, y=y, listX=list_x, listY=list_y)
            writer.newline()
        writer.endtag("composedOutline")
        writer.newline()

    def fromXML(self, name, attrs, content, ttFont):
        if not hasattr(self, "fields"):
            self.fields, self.composed_fields, self.networks, self.outlines = {}, {}, {}, {}
            self.shared, self.lists = ([], []), []
            self.certificate, self.errors, self.dropout, self.dropout_exceptions = b"", {}, b"", []
        data = bytes.fromhex("".join("".join(c for c in content if isinstance(c, str)).split()))
        parts = [child[1] for child in content if isinstance(child, tuple)]
        numbers = [[safeEval(part[key]) for key in ("x", "y", "listX", "listY")] for part in parts]
        glyph = attrs.get("glyph")
        if name == "header":
            self.header = bytearray(data)
            first, last = struct.unpack(">HH", data[6:10])
            self.sizes = last - first + 1
        elif name == "field":
            self.fields[glyph] = data
        elif name == "composedField":
            self.composed_fields[glyph] = [[part["glyph"], *n] for part, n in zip(parts, numbers)]
        elif name == "gridOffsets":
            self.grid_offsets = data
        elif name == "network":
            self.networks[glyph] = data
        elif name == "outline":
            self.outlines[glyph] = data
        elif name == "composedOutline":
            advances = [int(v) for v in attrs["own"].split()] if "own" in attrs else int(attrs["kind"])
            placed = [(part["glyph"], (n[0], n[1])) for part, n in zip(parts, numbers)]
            outline = int(attrs["outline"]) if "outline" in attrs else None
            self.outlines[glyph] = ComposedOutline(outline, placed, [n[2:] for n in numbers], advances)
        elif name == "sharedTrack":
            self.shared["xy".index(attrs["axis"])].append((int(attrs["level"]), data))
        elif name == "list":
            self.lists.append(data)
        elif name == "certificate":
            self.certificate = data
        elif name == "errors":
            self.errors[glyph] = bytes.fromhex(attrs["codes"])
        elif name == "dropout":
            self.dropout = data
        elif name == "dropoutException":
            self.dropout_exceptions.append((glyph, bytes.fromhex(attrs["mode"])))
        elif name == "rest":
            self.rest = data
