"""``python -m compare.audit [PAPER]``: the command ``audit``."""

from __future__ import annotations

import sys

from compare.__main__ import main

if __name__ == "__main__":
    sys.exit(main(["audit", *sys.argv[1:]]))
