"""``python -m compare.papers [KEY ...]``: the command ``papers``."""

from __future__ import annotations

import sys

from compare.__main__ import main

if __name__ == "__main__":
    sys.exit(main(["papers", *sys.argv[1:]]))
