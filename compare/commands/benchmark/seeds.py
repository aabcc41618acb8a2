"""The option ``--seeds`` of a comparison: how many, or which."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from cyclopts import Parameter, Token

from compare.commands.options import positive


def listed_seeds(text: str) -> tuple[int, ...]:
    """Read a choice of seeds.

    Parameters
    ----------
    text : str
        A number of seeds from 0, a range ``10-19``, or several of them, ``3,5,8`` or ``0-4,9``.

    Returns
    -------
    tuple of int
        Each once, in ascending order.

    Raises
    ------
    ValueError
        It is none of them.
    """
    if text.strip().lstrip("-").isdecimal():
        positive(int, int(text))
        return tuple(range(int(text)))
    found: set[int] = set()
    for part in filter(None, (part.strip() for part in text.split(","))):
        first, dash, last = (word.strip() for word in part.partition("-"))
        if not first.isdecimal() or not (last.isdecimal() if dash else not last):
            raise ValueError(f"{part!r} is no seed and no range of seeds such as 10-19")
        if dash and int(last) < int(first):
            raise ValueError(f"{part!r} holds no seed: {last} is less than {first}")
        found.update(range(int(first), int(last or first) + 1))
    if not found:
        raise ValueError(f"{text!r} holds no seed")
    return tuple(sorted(found))


def _read_seeds(kind: Any, tokens: Sequence[Token]) -> tuple[int, ...]:
    return listed_seeds(tokens[0].value)


SeedList = Annotated[
    tuple[int, ...] | None,
    Parameter(name="--seeds", converter=_read_seeds, n_tokens=1, metavar="N|A-B|A,B"),
]
