"""Which code is running: a digest of the source of the three packages."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

_PACKAGES = ("formulations", "metaheuristics", "compare")


@cache
def source_digest() -> str:
    """Return a digest of the source of the three packages: results of other code are not mixed in.

    Returns
    -------
    str
        64 hexadecimal digits.
    """
    root = Path(__file__).parents[1]
    files = [path for name in _PACKAGES for path in sorted((root / name).rglob("*.py"))]
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()
