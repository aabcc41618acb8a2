"""Many decimal numbers at once, between arrays and bytes, without a Python object per number.

Written are decimals without an exponent, which CSV, JSON and YAML 1.1 and 1.2 read alike. Each column has
at most as many decimals as its largest value has in double precision: 17 digits, counted from the first
digit of that value, so nothing is lost beyond the 17th digit of the largest. Times that are whole
nanoseconds have nine decimals and lose nothing.

Read are records that differ in their numbers only. A number of up to 18 digits is rounded correctly by one
division with its remainder; the few others are left to Python.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.problem.arrays import Array, Indices

_DIGITS = 17
_MOST_DECIMALS = 22  # powers of ten up to here are exact in double precision
_POWERS = 10.0 ** np.arange(_MOST_DECIMALS + 1)


def decimals_of(columns: Array) -> Indices:
    """Find how many decimals each column needs.

    Parameters
    ----------
    columns : Array, shape (n_rows, n_columns)
        Finite numbers.

    Returns
    -------
    Indices, shape (n_columns,)
        From 0 to 22.
    """
    largest = np.abs(columns).max(axis=0, initial=0.0)
    exponents = np.floor(np.log10(np.where(largest > 0.0, largest, 1.0)))
    return np.asarray(np.clip(_DIGITS - 1 - exponents, 0, _MOST_DECIMALS), dtype=np.intp)


def time_decimals(times: Array) -> int:
    """Find how many decimals times need: nine if all are whole nanoseconds.

    Parameters
    ----------
    times : Array, shape (n_points,) [s]
        Finite numbers.

    Returns
    -------
    int
        From 0 to 22.
    """
    whole = np.abs(times).max() < 9e6 and np.array_equal(np.rint(times * 1e9) / 1e9, times)
    return 9 if whole else int(decimals_of(times[:, None])[0])


def write_records(columns: Array, decimals: Indices, literals: list[bytes]) -> bytes:
    """Write one record per row: a literal, a number, a literal, a number, ..., a literal.

    Parameters
    ----------
    columns : Array, shape (n_rows, n_columns)
        Numbers; times 10 to the decimals, they are below 9e18.
    decimals : Indices, shape (n_columns,)
        Most decimals of each column; zeros at the end are left out, all but the first.
    literals : list of bytes, length n_columns + 1
        What stands around the numbers.

    Returns
    -------
    bytes
        All records, one behind the other.
    """
    ends = np.cumsum([len(literal) for literal in literals])
    longest = int(ends[-1]) + columns.shape[1] * (_MOST_DECIMALS + 22)
    rows = max(1, 16_000_000 // longest)
    text = np.frombuffer(b"".join(literals), dtype=np.uint8)
    buffer = np.empty(longest * min(rows, max(len(columns), 1)), dtype=np.uint8)
    parts = []
    for start in range(0, len(columns), rows):
        block = np.ascontiguousarray(columns[start : start + rows])
        length = _write(block, decimals, _POWERS, text, ends, buffer)
        parts.append(buffer[:length].tobytes())
    return b"".join(parts)


@compiled
def _write(columns: Any, decimals: Any, powers: Any, text: Any, ends: Any, out: Any) -> int:
    at = 0
    zero, ten = np.uint64(0), np.uint64(10)  # division of unsigned numbers is faster
    digits = np.empty(24, dtype=np.uint8)
    for row in range(columns.shape[0]):
        for k in range(ends[0]):
            out[at] = text[k]
            at += 1
        for column in range(columns.shape[1]):
            value = columns[row, column]
            places = decimals[column]
            size = abs(value)
            whole = np.uint64(np.rint(size * powers[places]))
            kept = places
            for shorter in (places - 2, places - 1):  # if they say the same number
                if shorter > 0:
                    scaled = np.rint(size * powers[shorter])
                    if scaled < 9007199254740992.0 and scaled / powers[shorter] == size:
                        whole, kept = np.uint64(scaled), shorter
                        break
            if value < 0.0 and whole > zero:
                out[at] = 45  # -
                at += 1
            while kept > 1:
                rest = whole // ten
                if rest * ten != whole:
                    break
                whole = rest
                kept -= 1
            count = 0
            while whole > zero or count <= kept:
                rest = whole // ten
                digits[count] = np.uint8(whole - rest * ten) + np.uint8(48)
                whole = rest
                count += 1
            for k in range(count - 1, -1, -1):
                out[at] = digits[k]
                at += 1
                if k == kept and kept > 0:
                    out[at] = 46  # .
                    at += 1
            for k in range(ends[column], ends[column + 1]):
                out[at] = text[k]
                at += 1
    return at


def read_records(
    data: bytes, start: int, template: bytes, separator: bytes, count: int
) -> tuple[Array, int]:
    """Read records that are all written like a template.

    Parameters
    ----------
    data : bytes
        A whole file.
    start : int
        Where the first record begins.
    template : bytes
        A record, with a null byte for each number. Spaces before a number do not matter.
    separator : bytes
        What stands between two records.
    count : int
        Most records.

    Returns
    -------
    values : Array, shape (n_records, n_numbers)
        The numbers, rounded correctly.
    end : int
        Where the last record that fits ends.
    """
    values = np.empty((count, template.count(b"\0")))
    hard = np.empty((min(values.size, 4_000_000), 3), dtype=np.int64)
    arrays = (np.frombuffer(part, dtype=np.uint8) for part in (data, template, separator))
    rows, end, n_hard = _read(*arrays, start, _POWERS, values, hard)
    flat = values.reshape(-1)
    for place, begin, stop in hard[:n_hard].tolist():
        flat[place] = float(data[begin:stop])
    return values[:rows], int(end)


@compiled
def _read(
    data: Any, template: Any, separator: Any, start: int, powers: Any, values: Any, hard: Any
) -> tuple[int, int, int]:
    at, good, rows, n_hard = start, start, 0, 0
    size = len(data)
    while rows < len(values):
        slot, fits, n_before = 0, True, n_hard
        for mark in template:
            if mark != 0:
                if at >= size or data[at] != mark:
                    fits = False
                    break
                at += 1
                continue
            while at < size and (data[at] == 32 or data[at] == 9):
                at += 1
            at, value, kind = _number(data, at, powers)
            if kind == 0 or (kind == 2 and n_hard == len(hard)):
                fits = False
                break
            values[rows, slot] = value
            if kind == 2:
                hard[n_hard, 0] = rows * values.shape[1] + slot
                hard[n_hard, 1] = at - np.int64(value)
                hard[n_hard, 2] = at
                n_hard += 1
            slot += 1
        if not fits:
            n_hard = n_before
            break
        rows, good = rows + 1, at
        for mark in separator:
            if at >= size or data[at] != mark:
                return rows, good, n_hard
            at += 1
    return rows, good, n_hard


@compiled
def _number(data: Any, at: int, powers: Any) -> tuple[int, float, int]:
    """A number of JSON: where it ends, its value, and 1; 0 if it is none; 2 and its length if it is hard."""
    size, begin = len(data), at
    negative = at < size and data[at] == 45
    if negative:
        at += 1
    whole, digits, places = np.int64(0), 0, 0
    first = at
    while at < size and 48 <= data[at] <= 57:
        if digits < 18:
            whole = whole * 10 + np.int64(data[at] - 48)
        if whole > 0:
            digits += 1
        at += 1
    if at == first or (data[first] == 48 and at > first + 1):
        return at, 0.0, 0
    if at < size and data[at] == 46:
        at += 1
        first = at
        while at < size and 48 <= data[at] <= 57:
            if digits < 18:
                whole = whole * 10 + np.int64(data[at] - 48)
                places += 1
            if whole > 0:
                digits += 1
            at += 1
        if at == first:
            return at, 0.0, 0
    if at < size and (data[at] == 101 or data[at] == 69):  # e, E
        at += 1
        minus = at < size and data[at] == 45
        if at < size and (data[at] == 45 or data[at] == 43):
            at += 1
        first, exponent = at, 0
        while at < size and 48 <= data[at] <= 57:
            if exponent < 10_000:
                exponent = 10 * exponent + int(data[at]) - 48
            at += 1
        if at == first:
            return at, 0.0, 0
        places += exponent if minus else -exponent
    if at - begin > 400:
        return at, 0.0, 0
    if whole > 0 and (digits > 18 or places < 0 or places > 22):
        return at, float(at - begin), 2
    value = 0.0 if whole == 0 else _quotient(whole, powers[places])
    return at, -value if negative else value, 1


@compiled
def _quotient(whole: int, power: float) -> float:
    """A whole number of up to 18 digits over a power of ten, rounded once.

    The remainder of a first quotient is exact by Dekker's product (1971), and corrects it.
    """
    high = float(whole)
    low = float(whole - np.int64(high))
    q = high / power
    split = 134217729.0  # 2^27 + 1
    a = split * q
    a1 = a - (a - q)
    a2 = q - a1
    b = split * power
    b1 = b - (b - power)
    b2 = power - b1
    product = q * power
    error = ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2
    return q + ((high - product) - error + low) / power
