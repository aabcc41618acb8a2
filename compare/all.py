"""``python -m compare.all``: grade every swarm on every case, and write the report."""

from __future__ import annotations

import sys

from compare.__main__ import main

if __name__ == "__main__":
    sys.exit(main(["all", *sys.argv[1:]]))
