"""Runs the examples in README.md: python readme.py NEURAL."""

import os
import re
import shutil
import sys
import tempfile
from importlib import util
from pathlib import Path

README = Path(__file__).parents[1] / "README.md"


def check(neural):
    examples = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    runnable = [text for text in examples if "fontTools" not in text or util.find_spec("fontTools")]
    with tempfile.TemporaryDirectory() as directory:
        shutil.copy(neural, Path(directory) / "FONT.nfr.ttf")
        os.chdir(directory)
        for text in runnable:
            names = {}
            exec(compile(text, str(README), "exec"), names)
            if "line" in names:
                assert names["page"].max() > 200 and names["x"] == 13 and names["line"].pixels.any()
        os.chdir(README.parent)
    print(f"{len(runnable)} of {len(examples)} examples of README.md run")


if __name__ == "__main__":
    check(Path(sys.argv[1]).resolve())
