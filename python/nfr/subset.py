"""pyftsubset for converted fonts: `python -m nfr.subset FONT.nfr.ttf --text=... --output-file=OUT.ttf`."""

import sys

import nfr  # noqa: F401  registers the table


def main(args=None):
    try:
        from fontTools import subset
    except ModuleNotFoundError as missing:
        if missing.name != "fontTools":
            raise
        sys.exit("fontTools is not installed: pip install fonttools")
    return subset.main(args)


if __name__ == "__main__":
    sys.exit(main())
