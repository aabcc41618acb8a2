"""``python -m compare.solve FILE``: every bound of one problem."""

from __future__ import annotations

import sys

from compare.__main__ import main

if __name__ == "__main__":
    sys.exit(main(["solve", *sys.argv[1:]]))
