"""Rows and traces as SQLite holds them, and back: strict in both directions, exact to the last bit."""

from __future__ import annotations

import math
import sys
import zlib
from collections.abc import Callable, Iterable, Sequence
from enum import StrEnum
from functools import cache
from typing import Any

import numpy as np

from compare.benchmark.grade import Trace
from compare.benchmark.records.cells import one_line
from compare.benchmark.records.database.schema import KINDS

_LARGEST = 100_000_000  # bytes of the traces of one run
_INTEGERS, _FLOATS = np.dtype("<i4"), np.dtype("<f8")


def encoded(value: Any) -> Any:
    """Return a value of a row as SQLite holds it.

    Parameters
    ----------
    value : str, int, float, bool, tuple of float or None

    Returns
    -------
    str, int, float, bytes or None

    Raises
    ------
    ValueError
        If a number is not finite.
    """
    if isinstance(value, str):
        return one_line(value)
    for number in value if isinstance(value, tuple) else (value,):
        if isinstance(number, float) and not math.isfinite(number):
            raise ValueError(f"{number!r} is not a finite number")
    if isinstance(value, tuple):
        return np.array(value, dtype=_FLOATS).tobytes()
    if isinstance(value, bool):
        return int(value)
    return float(value) if isinstance(value, float) else value


@cache
def decoder(name: str) -> Callable[[Any], Any]:
    """Return the function that reads a stored value of a column.

    Parameters
    ----------
    name : str
        The column.

    Returns
    -------
    callable
        It raises ValueError for what does not fit.
    """
    kind = KINDS[name]
    if isinstance(kind, type) and issubclass(kind, StrEnum):
        return kind
    by_type: dict[Any, Callable[[Any], Any]] = {
        str: sys.intern,  # of equal texts there are many
        bool: _truth,
        bool | None: lambda value: None if value is None else _truth(value),
        tuple[float, ...]: lambda value: tuple(np.frombuffer(value, dtype=_FLOATS).tolist()),
    }
    return by_type.get(kind, lambda value: value)


def _truth(value: Any) -> bool:
    if value not in (0, 1):
        raise ValueError(f"{value!r} is neither 0 nor 1")
    return bool(value)


def packed(traces: Sequence[Trace]) -> bytes:
    """Return the traces of one run as compressed numbers.

    Parameters
    ----------
    traces : sequence of Trace

    Returns
    -------
    bytes
        Compressed: the number of traces; joint and length of each; all evaluations; all fitnesses.
    """
    head = [len(traces), *(n for t in traces for n in (t.joint, len(t.evaluations)))]
    evaluations = [n for trace in traces for n in trace.evaluations]
    best = [b for trace in traces for b in trace.best]
    whole = np.array(head + evaluations, dtype=_INTEGERS).tobytes()
    return zlib.compress(whole + np.array(best, dtype=_FLOATS).tobytes(), 6)


def unpacked(data: bytes) -> list[Trace]:
    """Return the traces of one run.

    Parameters
    ----------
    data : bytes
        As ``packed`` gives them.

    Returns
    -------
    list of Trace

    Raises
    ------
    ValueError
        If they do not fit.
    """
    stream = zlib.decompressobj()
    try:
        plain = stream.decompress(data, _LARGEST)
    except zlib.error as error:
        raise ValueError(str(error)) from None
    if stream.unconsumed_tail or not stream.eof:
        raise ValueError(f"a trace that is cut short, or larger than {_LARGEST} bytes")
    count = int(np.frombuffer(plain, _INTEGERS, 1)[0])
    shapes = np.frombuffer(plain, _INTEGERS, 2 * count, 4).reshape(count, 2)
    total, start = int(shapes[:, 1].sum()), 4 * (1 + 2 * count)
    evaluations = np.frombuffer(plain, _INTEGERS, total, start)
    best = np.frombuffer(plain, _FLOATS, total, start + 4 * total)
    ends = shapes[:, 1].cumsum()
    return [
        Trace(int(joint), evaluations[end - n : end].tolist(), best[end - n : end].tolist())
        for (joint, n), end in zip(shapes, ends, strict=True)
    ]


def decoded(names: Iterable[str], values: Iterable[Any]) -> dict[str, Any]:
    """Return stored values by their columns.

    Parameters
    ----------
    names : iterable of str
        Columns.
    values : iterable
        As SQLite holds them.

    Returns
    -------
    dict of str to value

    Raises
    ------
    ValueError
        If a value does not fit; the message names the column.
    """
    found = {}
    for name, value in zip(names, values, strict=True):
        try:
            found[name] = decoder(name)(value)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None
    return found
