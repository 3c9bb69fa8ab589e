"""pyftsubset for converted fonts: `python -m nfr.subset FONT.nfr.ttf --text=... --output-file=OUT.ttf`."""

import sys

from fontTools import subset

import nfr  # noqa: F401  registers the table


def main(args=None):
    return subset.main(args)


if __name__ == "__main__":
    sys.exit(main())
