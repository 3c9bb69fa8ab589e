"""The page and the table of a sweep: totals first, then what went wrong, then figures."""

import collections
import csv as csv_module
import io
import platform
import re

TARGETS = ("smooth", "mono")
# Keys of the program's results, and what they compare.
ERRORS = (
    ("neural", "models and skrifa's hinted bitmaps"),
    ("neural_freetype", "models and FreeType's"),
    ("teacher_freetype", "skrifa's hinted bitmaps and FreeType's"),
    ("unhinted", "unhinted outlines and skrifa's hinted bitmaps"),
    ("unhinted_freetype", "unhinted outlines and FreeType's"),
)
QUANTILES = (("median", 0.5), ("90 %", 0.9), ("99 %", 0.99), ("worst", 1.0))
WORST = 12


def write(path, text):
    """Puts the file there as a whole."""
    part = path.with_name(path.name + ".part")
    part.write_text(text)
    part.replace(path)


def quantile(values, share):
    ordered = sorted(values)
    return ordered[round(share * (len(ordered) - 1))] if ordered else 0


def rows(header, body):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in body])


def glyph_text(glyph):
    character = glyph["character"]
    return f"{glyph['gid']}" + (f" (U+{ord(character):04X})" if character else "")


def face_text(face):
    return f"{face.name}{f' #{face.index}' if face.index else ''} ({face.source})"


class Report:
    """Results of all faces, and notes about packages that gave none."""

    def __init__(self, results, notes, seconds, megabytes):
        self.results, self.notes, self.limits = results, notes, (seconds, megabytes)
        read = [(face, result) for face, result in results if "hints" in result]
        self.hinted = [(f, r) for f, r in read if any(r["hints"].values())]
        self.plain = len(read) - len(self.hinted)
        self.unreadable = [(f, r["unreadable"]) for f, r in results if "unreadable" in r]
        self.ended = [(f, r["ended"]) for f, r in results if "ended" in r]
        self.panics = [(f, r["panics"]) for f, r in results if r.get("panics") and "ended" not in r]
        self.broken = [(f, t, r[t]["broken"]) for f, r in self.hinted for t in TARGETS if "broken" in r[t]]
        self.outcomes = [(f, r, t, r[t]["converted"]) for f, r in self.hinted for t in TARGETS if "converted" in r[t]]
        self.converted = len({id(f) for f, *_ in self.outcomes})
        self.worse = [(f, t, worse) for f, _, t, o in self.outcomes for worse in o["worse"]]
        silent = [worse for worse in self.worse if not worse[2]["warned"]]
        self.silent = {judge: [w for w in silent if w[2]["judge"] == judge] for judge in ("skrifa", "FreeType")}
        self.failures = len(self.ended) + len(self.panics) + len(self.broken) + len(silent)

    def of(self, target):
        return [(f, o) for f, _, t, o in self.outcomes if t == target]

    def totals(self):
        refused = lambda target: sum("refused" in r[target] for _, r in self.hinted)
        warned = lambda target: sum(bool(o["warnings"]) for _, o in self.of(target))
        left_out = lambda target: sum(len(o["left_out"]) for _, o in self.of(target))
        glyphs = lambda target: sum(len(r["glyphs"]) - len(o["left_out"]) for _, r, t, o in self.outcomes if t == target)
        both = lambda count: " | ".join(str(count(t)) for t in TARGETS)
        return rows(
            ("", *TARGETS),
            [
                ("faces", f"{len(self.results)} | {len(self.results)}"),
                ("… without hints: no `fpgm`, `prep` or glyph programs", f"{self.plain} | {self.plain}"),
                ("… that cannot be read", f"{len(self.unreadable)} | {len(self.unreadable)}"),
                ("… with hints", f"{len(self.hinted)} | {len(self.hinted)}"),
                ("converted", both(lambda t: len(self.of(t)))),
                ("refused, of those with hints", both(refused)),
                ("converted with a warning", both(warned)),
                ("glyphs converted", both(glyphs)),
                ("glyphs left without a model, with a warning", both(left_out)),
                ("**panics, crashes**, of faces or caught", f"{self.crashes()} | {self.crashes()}"),
                ("**converted fonts that do not open or draw**", both(lambda t: sum(t == target for _, target, _ in self.broken))),
                ("**no result in time**", f"{self.late()} | {self.late()}"),
                ("**glyphs worse than unhinted without a warning**, by skrifa", both(lambda t: self.silent_of("skrifa", t))),
                ("**the same** by FreeType", both(lambda t: self.silent_of("FreeType", t))),
            ],
        )

    def late(self):
        return sum("no result" in how for _, how in self.ended)

    def crashes(self):
        return len(self.ended) - self.late() + len(self.panics)

    def silent_of(self, judge, target):
        return sum(t == target for _, t, _ in self.silent[judge])

    def wrong(self):
        """What should not be there."""
        lines = [f"- {face_text(f)}: {how}" for f, how in self.ended]
        lines += [f"- {face_text(f)}: {count} caught panics" for f, count in self.panics]
        lines += [f"- {face_text(f)}, {target}: {error}" for f, target, error in self.broken]
        for judge, silent in self.silent.items():
            for face, target, w in silent:
                figures = f"mae {w['neural']:.4f}, unhinted {w['unhinted']:.4f}, by {judge}"
                lines.append(f"- {face_text(face)}, {target}: glyph {glyph_text(w)}, {figures}")
        return "\n".join(lines) or "Nothing."

    def errors(self, target):
        outcomes = [o for _, o in self.of(target)]
        row = lambda key, what: [what, *(f"{quantile([o[key] for o in outcomes], share):.5f}" for _, share in QUANTILES)]
        return rows(("mae between", *(name for name, _ in QUANTILES)), [row(*error) for error in ERRORS])

    def times(self):
        conversions = [o["seconds"] for *_, o in self.outcomes]
        faces = [r["seconds"] for _, r in self.hinted]
        memory = [r["megabytes"] for _, r in self.hinted]
        row = lambda what, values, text: [what, *(text.format(quantile(values, share)) for _, share in QUANTILES)]
        return rows(
            ("", *(name for name, _ in QUANTILES)),
            [
                row("a conversion of 16 glyphs, s", conversions, "{:.2f}"),
                row("a face: two conversions, two comparisons, s of processor time", faces, "{:.2f}"),
                row("memory of its process, MB", memory, "{:.0f}"),
            ],
        )

    def worst_faces(self, target, key):
        ordered = sorted(self.of(target), key=lambda pair: -pair[1][key])[:WORST]
        place = "worst_freetype" if key.endswith("freetype") else "worst"
        body = []
        for face, o in ordered:
            worst = o[place]
            at = f"{glyph_text(worst)} at {worst['ppem']} ppem: {worst['mae']:.4f}" if worst else ""
            body.append((face_text(face), f"{o[key]:.5f}", f"{o['teacher_freetype']:.5f}", f"{o['unhinted']:.4f}", at))
        return rows(("face", "mae", "skrifa and FreeType", "unhinted", "worst glyph and size"), body)

    def reasons(self):
        """Refusals and warnings, with their numbers of faces. Numbers and lists in them are left out."""
        counts = collections.defaultdict(lambda: [0, 0])
        for _, result in self.hinted:
            for at, target in enumerate(TARGETS):
                outcome = result[target]
                texts = ["refused: " + outcome["refused"]] if "refused" in outcome else outcome.get("converted", {}).get("warnings", [])
                for text in {self.kind(text) for text in texts}:
                    counts[text][at] += 1
        body = [(text.replace("|", "\\|"), *count) for text, count in sorted(counts.items(), key=lambda item: (-sum(item[1]), item[0]))]
        return rows(("refusal or warning", *TARGETS), body)

    @staticmethod
    def kind(text):
        """A text without its advice, the place in a program, and numbers."""
        text = re.sub(r"\(\w+\[\d+\]@\d+(?::\S+)?: ", "(", text.split(";")[0])
        text = re.sub(r" \([\d, ]+(?:and \d+ more)?\)", "", text)
        return re.sub(r"\d+(?:, \d+)*", "n", text).replace("n glyphs", "n glyph")

    def summary(self):
        return f"{self.totals()}\n\n" + "".join(f"{t}\n{self.errors(t)}\n\n" for t in TARGETS) + f"wrong\n{self.wrong()}\n"

    def page(self):
        seconds, megabytes = self.limits
        notes = "".join(f"\n- `{package}` {problem}" for package, problem in self.notes) or "\n- none"
        unreadable = "".join(f"\n- {face_text(f)}: {why}" for f, why in self.unreadable) or "\n- none"
        warned = [w for w in self.worse if w[2]["warned"]]
        told = rows(
            ("face", "target", "glyph", "judge", "mae", "unhinted"),
            [(face_text(f), t, glyph_text(w), w["judge"], f"{w['neural']:.5f}", f"{w['unhinted']:.5f}") for f, t, w in warned],
        )
        return PAGE.format(
            system=platform.freedesktop_os_release().get("PRETTY_NAME", "Debian"), packages=len({f.source for f, _ in self.results}),
            seconds=seconds, megabytes=megabytes, totals=self.totals(), wrong=self.wrong(), smooth=self.errors("smooth"),
            mono=self.errors("mono"), times=self.times(), worst_smooth=self.worst_faces("smooth", "neural"),
            worst_mono=self.worst_faces("mono", "neural"), freetype=self.worst_faces("smooth", "teacher_freetype"),
            freetype_mono=self.worst_faces("mono", "teacher_freetype"), told=told, reasons=self.reasons(), notes=notes,
            unreadable=unreadable, overlapping=sum(bool(r["overlapping"]) for _, r in self.hinted),
        )

    def csv(self):
        out = io.StringIO()
        writer = csv_module.writer(out, lineterminator="\n")
        figures = ("table_bytes", *(key for key, _ in ERRORS))
        header = ["package", "file", "index", "glyphs_in_font", "fpgm", "prep", "glyph_programs", "chosen"]
        for target in TARGETS:
            header += [f"{target}_{name}" for name in ("outcome", "left_out", "warnings", *figures, "worst_gid", "worst_ppem", "worst_mae")]
        writer.writerow(header)
        for face, result in sorted(self.results, key=lambda pair: (pair[0].source, pair[0].name, pair[0].index)):
            writer.writerow([face.source, face.name, face.index, *self.cells(result, figures)])
        return out.getvalue()

    def cells(self, result, figures):
        if "hints" not in result:
            return ["", "", "", "", "", result.get("ended") or result["unreadable"]]
        cells = [result["glyph_count"], *result["hints"].values(), len(result["glyphs"])]
        for target in TARGETS:
            outcome = result[target]
            if not any(result["hints"].values()):
                cells += ["no hints"] + [""] * (len(figures) + 5)
            elif "converted" not in outcome:
                cells += [(outcome.get("refused") or outcome["broken"]).split(";")[0]] + [""] * (len(figures) + 5)
            else:
                o = outcome["converted"]
                worst = o["worst"] or {"gid": "", "ppem": "", "mae": 0.0}
                numbers = [f"{o[key]:.6f}" if isinstance(o[key], float) else o[key] for key in figures]
                cells += ["converted", len(o["left_out"]), len(o["warnings"]), *numbers, worst["gid"], worst["ppem"], f"{worst['mae']:.5f}"]
        return cells


PAGE = """# The converter on other people's fonts

`tools/sweep/run` makes this page: it downloads {packages} packages of {system}'s main archive ([list](../tools/sweep/packages)), takes every TrueType face of
them once, and converts 16 glyphs of each at 9–24 pixels per em for smooth and for black-and-white rendering, at the default quality. A face has a process of
its own, with {seconds} s of processor time and {megabytes} MB of memory. [sweep.csv](sweep.csv) has a line for each face.

The glyphs are two digits, two signs and letters of the face's scripts in turn, the most frequent first
([the rule](../crates/nfr-convert/examples/sweep/choice.rs)). Of a face without letters, characters at even distances are taken. What the library draws from the
converted font is compared with skrifa's hinted bitmaps, which the models learn, and with those of FreeType, which knows nothing of them: mae is the mean absolute error
of a pixel's coverage, 0 to 1, over the union of two bitmaps' boxes. Bitmaps of both targets are grey. A glyph counts as worse than its unhinted
outline if its error over all sizes is larger by more than an eighth of a level of 255, the converter's own measure.

{totals}

## What went wrong

{wrong}

## Errors

Of a face's 16 glyphs at 16 sizes together; quantiles are those of the converted faces. Smooth:

{smooth}

Hinted for black and white:

{mono}

FreeType is given the fonts without the flags that say that contours overlap (`OVERLAP_SIMPLE`, `OVERLAP_COMPOUND`; {overlapping} of these faces have them): with such a
flag it draws a glyph from 4×4 samples a pixel, in place of exact areas, hinted or not.

## Times

{times}

## Faces with the largest errors

Smooth, models and skrifa's hinted bitmaps:

{worst_smooth}

Hinted for black and white:

{worst_mono}

## Faces on which skrifa and FreeType differ most

[upstream.md](upstream.md) has the rules in which they differ. Smooth; the first mae is theirs, the worst glyph that of the models against FreeType:

{freetype}

Hinted for black and white:

{freetype_mono}

## Glyphs worse than their unhinted outlines, of which the converter warns

{told}

## Refusals and warnings

Numbers are those of faces; in the texts, n stands for any number.

{reasons}

Packages that gave no face:
{notes}

Faces that cannot be read:
{unreadable}
"""
