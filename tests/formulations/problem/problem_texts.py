"""A good problem file, and how the tests spoil it."""

from __future__ import annotations

import pytest

from formulations import InputError, parse

GOOD = """
name = "two joints"
unit = "rad"
waypoints = [[0.0, 1.0], [0.5, 1.5], [1.0, 1.0], [2.0, 0.0]]

[limits]
velocity = [1.0, 2.0]
acceleration = 3.0
jerk = [4, 5]
position = [[-1.0, 3.0], [-2.0, 2.0]]
"""


def message(text: str) -> str:
    """The one line with which a text is refused."""
    with pytest.raises(InputError) as caught:
        parse(text, where="FILE")
    line = str(caught.value)
    assert len(line.splitlines()) == 1, line
    assert line.startswith("FILE: ")
    return line


def swapped(old: str, new: str) -> str:
    """The good file with one piece of text replaced."""
    assert GOOD.count(old) == 1
    return GOOD.replace(old, new)
