"""``python -m compare.solve FILE``: the spelling that the command has always had."""

from __future__ import annotations

from compare.commands import shared
from compare.commands.solve import main

if __name__ == "__main__":
    shared.run(main)
