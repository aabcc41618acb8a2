"""Find the points of a file that are all written alike, and read them at once.

A long motion is the same few words per point with other numbers. Such a file is split into its numbers, a
row per point, and a short document: the file with its first point alone, in which each number is replaced
by a mark that tells its column. The ordinary reader of the format reads the short document, checks it, and
says by the marks what each column is. So there is one reader per format, whatever the size of the file.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass

import numpy as np

from formulations.motion.files.decimals import read_records
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError

_MARK = 900_000_000  # marks are whole numbers from here on
_HEAD = 1_000_000  # bytes in which the points must begin
_SHORT = 250_000  # bytes of the short document at most
_NUMBER = re.compile(
    rb"""(?<![\w.+"'-])-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?(?![\w.+-])""", re.ASCII
)
_FIRST_OF_JSON = re.compile(rb'"points"\s*:\s*\[\s*(?=\{)')
_FIRST_OF_YAML = re.compile(rb"""(?:^|[\s{,])points["']?:[ \t]*\r?\n([ \t]*)(?=- )""")

LARGEST_IRREGULAR = 10_000_000  # bytes of a file whose points are not written alike


@dataclass(frozen=True)
class Records:
    """The numbers of all points, and a document that says what they are.

    Attributes
    ----------
    document : bytes
        The file with one point, its numbers replaced by marks.
    values : Array, shape (n_points, n_columns)
        The numbers.
    """

    document: bytes
    values: Array

    def columns(self, marks: Array) -> Array | None:
        """The numbers in place of marks.

        Parameters
        ----------
        marks : Array, shape (n,)
            What the ordinary reader found in the one point of the document.

        Returns
        -------
        Array, shape (n_points, n), or None
            None where one of them is no mark.
        """
        at = marks - _MARK
        if not ((at >= 0) & (at < self.values.shape[1]) & (at == np.rint(at))).all():
            return None
        return self.values[:, at.astype(np.intp)]


def require_small(data: bytes, file: str, found: Records | None = None) -> None:
    """Refuse a large file whose points are not written alike: each value of it would be an object.

    Parameters
    ----------
    data : bytes
        The file.
    file : str
        Its name, for messages.
    found : Records, optional
        Its first points, if some are written alike.

    Raises
    ------
    InputError
        It has more than 10,000,000 bytes.
    """
    if len(data) > LARGEST_IRREGULAR:
        alike = "" if found is None else f"; the first {len(found.values)} are alike"
        raise InputError(
            f"{file}: {len(data)} bytes; points that do not all state the same, written alike, are read "
            f"from at most {LARGEST_IRREGULAR} bytes{alike}"
        )


def json_records(data: bytes) -> Records | None:
    """Split a JointTrajectory in JSON.

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    Records or None
        None where its points are not written alike.
    """
    found = _FIRST_OF_JSON.search(data, 0, _HEAD)
    if found is None:
        return None
    start = found.end()
    try:
        _, length = json.JSONDecoder().raw_decode(data[start : start + _SHORT].decode("latin-1"))
    except (ValueError, RecursionError):
        return None
    end = start + length
    behind = re.compile(rb"\s*,\s*(?=\{)").match(data, end)
    return None if behind is None else _split(data, start, end, behind.group())


def yaml_records(data: bytes) -> Records | None:
    """Split a JointTrajectory in YAML with a block per point.

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    Records or None
        None where its points are not written alike.
    """
    found = _FIRST_OF_YAML.search(data, 0, _HEAD)
    if found is None:
        return None
    separator = (b"\r\n" if data[found.start() : found.end()].count(b"\r") else b"\n") + found.group(1)
    end = data.find(separator + b"- ", found.end(), found.end() + _SHORT)
    return None if end < 0 else _split(data, found.end(), end, separator)


def csv_records(data: bytes) -> Records | None:
    """Split a CSV file behind its first line.

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    Records or None
        None where its rows are not written alike.
    """
    head = data.find(b"\n", 0, _HEAD) + 1
    end = data.find(b"\n", head, head + _SHORT)
    if not head or end <= head:
        return None
    separator = b"\r\n" if data[end - 1 : end] == b"\r" else b"\n"
    return _split(data, head, end + 1 - len(separator), separator)


def _split(data: bytes, start: int, end: int, separator: bytes) -> Records | None:
    """Split a file whose first point lies between two places."""
    record = data[start:end]
    if b"\0" in record:
        return None
    template = re.sub(rb"(?<![ \t])[ \t]+\0", b"\0", _NUMBER.sub(b"\0", record))
    slots = template.count(b"\0")
    if not slots:
        return None
    first = template.partition(b"\0")[0].rstrip(b" \t")
    count = data.count(separator + first, end) + 1
    if count * slots > len(data):  # a number takes a byte at least
        return None
    values, stop = read_records(data, start, template, separator, count)
    if len(values) < 2 or start + len(record) + len(data) - stop > _SHORT:
        return None
    numbers = iter(range(_MARK, _MARK + slots))
    marked = _NUMBER.sub(lambda _: b"%d" % next(numbers), record)
    return Records(data[:start] + marked + data[stop:], values)
