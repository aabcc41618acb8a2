"""TOML text -> a table, or one line; in a time that is bounded by its length."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from formulations.problem.errors import InputError

LARGEST = 1_000_000  # bytes; a problem file or a paper is a few kilobytes
_MOST_PARTS = 32
# tomllib takes a time that grows with the square of the parts of a key, and with their number for each key
_MANY_PARTS = re.compile(
    r"""(?<![\w"'-])(?:(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*)""" + f"{{{_MOST_PARTS}}}"
)


def parse_toml(text: str, where: str) -> dict[str, Any]:
    """Read TOML text.

    Parameters
    ----------
    text : str
        The text; a byte-order mark is passed over.
    where : str
        Name of the file, for messages.

    Returns
    -------
    dict
        As ``tomllib`` reads it.

    Raises
    ------
    InputError
        The text is no TOML, is longer than 1,000,000 characters, or has a key of more than 32 parts.
    """
    if len(text) > LARGEST:
        raise InputError(f"{where}: {len(text)} characters; at most {LARGEST} are read")
    found = _MANY_PARTS.search(text)
    if found is not None:
        line = text.count("\n", 0, found.start()) + 1
        raise InputError(f"{where}: line {line}: {_MOST_PARTS} names joined by points or more")
    try:
        return tomllib.loads(text.removeprefix("\ufeff"))
    except (ValueError, RecursionError) as error:  # ValueError: also whole numbers beyond 4300 digits
        raise InputError(f"{where}: not valid TOML: {error}") from None
