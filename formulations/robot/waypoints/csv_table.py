"""Waypoints from CSV: a row per waypoint, a column per joint, with or without a header of joint names.

The separator is a comma, a semicolon, a tab or spaces, whichever the first row has. Behind a semicolon a
number may have a decimal comma. Lines that begin with ``#`` are comments.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.robot.text.entry import LARGEST_NUMBER
from formulations.robot.text.files import known_names, number_of, shown

MOST_WAYPOINTS = 100_000
MOST_COLUMNS = 1000
_MOST_LINES = 2 * MOST_WAYPOINTS  # with comments and empty lines
_LONGEST_LINE = 100_000  # characters

PREFIX = "position_"
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d+,\d+\s*", re.ASCII)


@dataclass(frozen=True)
class CsvTable:
    """The cells of a CSV file.

    Attributes
    ----------
    file : str
        Its name, for messages.
    header : tuple of str or None
        Names of the columns; None where the first row holds numbers.
    rows : list of (int, list of str)
        Line number and cells of each further row.
    """

    file: str
    header: tuple[str, ...] | None
    rows: list[tuple[int, list[str]]]


def parse_table(text: str, file: str) -> CsvTable:
    """Read CSV text.

    Parameters
    ----------
    text : str
        Rows of cells.
    file : str
        Its name, for messages.

    Returns
    -------
    CsvTable
        Cells without spaces around them; a decimal comma is turned into a point.

    Raises
    ------
    InputError
        The text is not CSV, has no row of numbers, or too many.
    """
    rows: list[tuple[int, list[str]]] = []
    for line, cells in _cells(text, file):
        if len(rows) > MOST_WAYPOINTS:
            raise InputError(f"{file}: more than {MOST_WAYPOINTS} rows; take fewer points of the path")
        rows.append((line, cells))
    if not rows:
        raise InputError(f"{file}: has no rows")
    header = tuple(rows[0][1]) if any(map(_is_name, rows[0][1])) else None
    body = rows[1:] if header else rows
    if not body:
        raise InputError(f"{file}: has a header and no rows below it")
    return CsvTable(file, header, body)


def _is_name(cell: str) -> bool:
    """Whether a cell of the first row names a column, rather than being a number or meant as one."""
    return number_of(cell) is None and cell.lower().lstrip("+-") not in ("nan", "inf", "infinity")


def _cells(text: str, file: str) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of each row that is neither empty nor a comment."""
    lines = text.splitlines()
    if len(lines) > _MOST_LINES:
        raise InputError(f"{file}: {len(lines)} lines; at most {_MOST_LINES} are read")
    first = next((line for line in lines if line.strip() and not line.lstrip().startswith("#")), "")
    bare = re.sub('"[^"]*"', "", first[:_LONGEST_LINE])  # a quoted name may hold any of the marks
    separator = next((mark for mark in (";", "\t", ",") if mark in bare), None)
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if len(line) > _LONGEST_LINE:
            raise InputError(
                f"{file}: line {number}: {len(line)} characters; at most {_LONGEST_LINE} are read"
            )
        if separator is None:
            cells = line.split()
        else:
            try:
                cells = next(csv.reader([line], delimiter=separator, strict=True), [])
            except csv.Error as error:
                raise InputError(f"{file}: line {number}: not valid CSV: {error}") from None
        cells = [cell.strip() for cell in cells]
        if separator == ";":
            cells = [c.replace(",", ".") if _DECIMAL_COMMA.fullmatch(c) else c for c in cells]
        if len(cells) > MOST_COLUMNS:
            raise InputError(
                f"{file}: line {number}: {len(cells)} columns; at most {MOST_COLUMNS} are read"
            )
        if any(cells):
            yield number, cells


def numbers_of(table: CsvTable, columns: Sequence[str]) -> Array:
    """The numbers of all rows.

    Parameters
    ----------
    table : CsvTable
        Cells of a file.
    columns : sequence of str
        What each column holds, as messages name it.

    Returns
    -------
    Array, shape (n_rows, n_columns)
        As the file has them.

    Raises
    ------
    InputError
        A row has another number of cells, or a cell is not a finite number; the message names line and column.
    """
    values = np.empty((len(table.rows), len(columns)))
    for index, (line, cells) in enumerate(table.rows):
        if len(cells) != len(columns):
            raise InputError(
                f"{table.file}: line {line}: {len(cells)} values for {len(columns)} columns "
                f"({', '.join(columns)})"
            )
        for k, cell in enumerate(cells):
            number = number_of(cell)
            if number is None or not abs(number) <= LARGEST_NUMBER:
                reason = "is not a finite number" if number is None else f"is beyond {LARGEST_NUMBER:g}"
                raise InputError(f"{table.file}: line {line}: {columns[k]}: {shown(cell)} {reason}")
            values[index, k] = number
    return values


def joint_columns(table: CsvTable, names: Sequence[str], others: Sequence[str] = ()) -> Array:
    """The numbers of a table with a column per joint, in the order of the joints.

    Parameters
    ----------
    table : CsvTable
        Cells of a file; a header names the columns as the joints, or ``position_`` and the joint.
    names : sequence of str
        The joints.
    others : sequence of str, optional
        Further joints of the robot, which may not have a column.

    Returns
    -------
    Array, shape (n_rows, n_joints)
        As the file has them.

    Raises
    ------
    InputError
        A column is missing, unknown or given twice; the message names it and the nearest joint.
    """
    if table.header is None:
        width = len(table.rows[0][1])
        if width != len(names):
            raise InputError(
                f"{table.file}: line {table.rows[0][0]}: {width} columns without names for {len(names)} joints "
                f"({', '.join(names)})"
            )
        return numbers_of(table, names)
    columns = [_joint_of(column, names) for column in table.header]
    for column, name in zip(table.header, columns, strict=True):
        if name not in names:
            if name in others:
                raise InputError(
                    f"{table.file}: column {shown(column)}: joint {shown(name)} is not among those that are "
                    f"moved ({', '.join(names)}); leave the column out"
                )
            raise InputError(
                f"{table.file}: column {shown(column)} is no joint; {known_names(name, names)}"
            )
    check_complete(table.file, "column", columns, names)
    return numbers_of(table, columns)[:, [columns.index(name) for name in names]]


def check_complete(file: str, what: str, given: Sequence[str], names: Sequence[str]) -> None:
    """Refuse a joint that is given twice or not at all.

    Parameters
    ----------
    file : str
        Name of the file.
    what : str
        What names a joint there: ``column``.
    given : sequence of str
        The joints that it names.
    names : sequence of str
        The joints that it must name.

    Raises
    ------
    InputError
        Names the joints.
    """
    twice = next((name for index, name in enumerate(given) if name in given[:index]), None)
    if twice is not None:
        raise InputError(f"{file}: {what}: joint {shown(twice)} is given twice")
    missing = [name for name in names if name not in given]
    if missing:
        plural = "joint" if len(missing) == 1 else "joints"
        raise InputError(f"{file}: {what}: no {what} for {plural} {', '.join(map(shown, missing))}")


def _joint_of(column: str, names: Sequence[str]) -> str:
    if column not in names and column.startswith(PREFIX):
        return column.removeprefix(PREFIX)
    return column
