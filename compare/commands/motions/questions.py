"""Questions to a person at a terminal, each asked again until the answer can be used."""

from __future__ import annotations

import sys
from collections.abc import Callable
from math import isfinite
from typing import TypeVar

T = TypeVar("T")


def at_a_terminal() -> bool:
    """Whether there is a person to ask."""
    return sys.stdin.isatty() and sys.stderr.isatty()


def ask(question: str, read: Callable[[str], T]) -> T:
    """Ask until the answer can be read. The question goes to standard error.

    Parameters
    ----------
    question : str
        What to ask.
    read : callable
        Makes the answer a value; raises ValueError with the reason where it cannot.

    Returns
    -------
    object
        What ``read`` returned.

    Raises
    ------
    InputError
        The input ended.
    """
    from formulations import InputError

    while True:
        print(f"{question}: ", end="", file=sys.stderr, flush=True)
        line = sys.stdin.readline()
        if not line:
            raise InputError(f"{question}: no answer was given")
        try:
            return read(line.strip())
        except ValueError as error:
            print(f"  {error}", file=sys.stderr)


def words(text: str) -> tuple[str, ...]:
    """Read names that are separated by commas or spaces.

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    tuple of str

    Raises
    ------
    ValueError
        There is none.
    """
    found = tuple(text.replace(",", " ").split())
    if not found:
        raise ValueError("at least one is needed")
    return found


def numbers(text: str) -> list[float]:
    """Read finite numbers that are separated by commas or spaces.

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    list of float

    Raises
    ------
    ValueError
        One of them is no number.
    """
    found = []
    for word in words(text):
        try:
            value = float(word)
        except ValueError:
            raise ValueError(f"{word!r} is not a number") from None
        if not isfinite(value):
            raise ValueError(f"{word} is not finite")
        found.append(value)
    return found


def limits(text: str, count: int) -> list[float]:
    """Read one positive number for all joints, or one per joint.

    Parameters
    ----------
    text : str
        What was typed.
    count : int
        Number of joints.

    Returns
    -------
    list of float
        As many as joints.

    Raises
    ------
    ValueError
        There are others.
    """
    found = numbers(text)
    for value in found:
        if not value > 0.0:
            raise ValueError(f"{value:g} is not positive")
    if len(found) == 1:
        return found * count
    if len(found) != count:
        raise ValueError(f"{len(found)} numbers where 1 or {count} are expected")
    return found
