"""What ``timebound papers`` stored of every item, rounded to six digits: tests/data/items.json.gz.

After ``timebound papers --out DIR``, ``python tests/compare/papers/stored_items.py DIR`` writes it anew.
"""

from __future__ import annotations

import gzip
import json
import sys
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[2] / "data" / "items.json.gz"


def stored(paper: str, key: str) -> dict[str, Any]:
    """The data of one item; a fresh copy with each call."""
    found: dict[str, Any] = json.loads(gzip.decompress(FILE.read_bytes()))[f"{paper}/{key}"]
    return found


def rounded(value: Any) -> Any:
    """The same value with six digits per number."""
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, list):
        return [rounded(one) for one in value]
    if isinstance(value, dict):
        return {name: rounded(one) for name, one in value.items()}
    return value


if __name__ == "__main__":
    folder = Path(sys.argv[1]) / "papers"
    items = {
        f"{path.parent.name}/{path.stem}": rounded(json.loads(path.read_text("utf-8"))["data"])
        for path in sorted(folder.glob("*/*.json"))
    }
    text = json.dumps(items, separators=(",", ":"))
    FILE.write_bytes(gzip.compress(text.encode(), 9, mtime=0))
