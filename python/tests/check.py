"""Checks the module with a converted font: python check.py NEURAL ORIGINAL NFR.

The table comes back from decompiling and from XML as it was. A subset draws the same bitmaps, that of pyftsubset with the
module, that of `nfr subset`, and after WOFF2 there and back; without the module it is refused.
"""

import io
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from fontTools import subset as plain
from fontTools.ttLib import TTFont

TEXT = "aéR"


def check_round_trip(path):
    font = TTFont(path)
    raw, table = font.reader["Nfrt"], font["Nfrt"]
    assert table.compile(font) == raw, f"the table of {path} is not the one that was read"
    xml = io.BytesIO()
    font.saveXML(xml, tables=["GlyphOrder", "Nfrt"])
    again = TTFont(path)
    del again["Nfrt"]
    xml.seek(0)
    again.importXML(xml)
    assert again["Nfrt"].compile(again) == raw, f"the table of {path} is another one after XML"


def drawn(nfr, path):
    command = [nfr, "render", path, "--text", TEXT, "--ppem", "9,12,40", "--json"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    glyphs, font = map(json.loads, lines), TTFont(path)
    ids = {font.getGlyphID(font.getBestCmap()[ord(character)]): character for character in TEXT}
    found = {}
    for glyph in glyphs:
        bare = {key: value for key, value in glyph.items() if key not in ("gid", "name")}
        found.setdefault(ids[glyph["gid"]], []).append(bare)
    return found


def main(neural, original, nfr):
    import nfr as module  # noqa: F401  registers the table
    from nfr.subset import main as subset

    vectors = Path(__file__).parents[2] / "spec" / "vectors"
    for path in [neural, *map(str, sorted(vectors.glob("outline*.ttf")))]:
        check_round_trip(path)
    with tempfile.TemporaryDirectory() as directory:
        def name(file):
            return str(Path(directory) / file)

        subset([neural, f"--text={TEXT}", f"--output-file={name('blank.ttf')}"])
        subset([neural, f"--text={TEXT}", "--notdef-outline", f"--output-file={name('neural.ttf')}"])
        same = ["--hinting", "--notdef-outline", f"--output-file={name('original.ttf')}"]
        plain.main([original, f"--text={TEXT}", *same])
        compact = [nfr, "subset", neural, name("compact.ttf"), "--text", TEXT, "--python", sys.executable]
        subprocess.run(compact, check=True)
        for file in "blank.ttf", "neural.ttf", "compact.ttf":
            assert drawn(nfr, name(file)) == drawn(nfr, neural), f"{file} draws something else"
        lengths = [len(TTFont(name(file)).reader["Nfrt"]) for file in ("compact.ttf", "neural.ttf")]
        assert lengths[0] <= lengths[1], "what no glyph needs was not left out"
        assert len(TTFont(name("neural.ttf")).getGlyphOrder()) < len(TTFont(neural).getGlyphOrder())
        from fontTools.ttLib import woff2

        woff2.compress(name("neural.ttf"), name("neural.woff2"))
        woff2.decompress(name("neural.woff2"), name("back.ttf"))
        for file in "neural.ttf", "back.ttf", "compact.ttf":
            verify = [nfr, "verify", name("original.ttf"), name(file)]
            verified = subprocess.run(verify, check=True, capture_output=True, text=True).stdout
            assert "certificate   holds: the errors of 6 glyphs" in verified, verified
        # Without the module the table keeps its old glyph numbers, and nfr refuses the font.
        passed = [sys.executable, "-m", "fontTools.subset", neural, f"--text={TEXT}", "--passthrough-tables"]
        subprocess.run([*passed, f"--output-file={name('passed.ttf')}"], check=True, stderr=subprocess.DEVNULL)
        refused = subprocess.run([nfr, "info", name("passed.ttf")], capture_output=True, text=True)
        assert refused.returncode == 1 and "renumbered" in refused.stderr, refused
    print("pyftsubset, ttx and WOFF2 keep the models")


if __name__ == "__main__":
    main(*sys.argv[1:4])
