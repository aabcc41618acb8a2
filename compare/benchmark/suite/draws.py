"""Whole numbers drawn from a name: the same on every machine, whatever the version of any library."""

from __future__ import annotations

import hashlib


class Draws:
    """A stream of random whole numbers.

    Parameters
    ----------
    name : str
        Streams of different names are independent.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._count = 0

    def between(self, low: int, high: int) -> int:
        """Draw a number uniformly.

        Parameters
        ----------
        low, high : int
            Least and greatest number.

        Returns
        -------
        int
        """
        word = hashlib.sha256(f"{self._name}/{self._count}".encode()).digest()[:8]
        self._count += 1
        return low + (int.from_bytes(word, "big") * (high - low + 1) >> 64)
