"""Points of a motion as CSV: a row per point, a column ``position_NAME`` per joint.

    time,position_elbow,position_wrist,velocity_elbow,velocity_wrist,acceleration_elbow,acceleration_wrist

in [s, rad, rad/s, rad/s^2]. The columns may stand in any order; those of velocities, or of accelerations,
may all be missing. Joints without names are counted from 1.
"""

from __future__ import annotations

import contextlib
import re

import numpy as np

from formulations.motion.files.checked import QUANTITIES, named, numbered, stacked
from formulations.motion.files.decimals import decimals_of, time_decimals, write_records
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.files.records import csv_records, require_small
from formulations.motion.trajectory import MOST_SAMPLES
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.robot.text.files import decode, known_names, shown
from formulations.robot.waypoints.csv_table import check_complete, numbers_of, parse_table

TIMES = ("time", "t", "time_from_start")


def write_csv(points: MotionPoints) -> bytes:
    """Write points as CSV.

    Parameters
    ----------
    points : MotionPoints
        The points, checked.

    Returns
    -------
    bytes
        The file.
    """
    columns, quantities = stacked(points)
    names = points.names or numbered(points.positions.shape[1])
    header = ["time", *(_quoted(f"{quantity}_{name}") for quantity in quantities for name in names)]
    decimals = np.append(time_decimals(points.times), decimals_of(columns))
    literals = [b"", *[b","] * columns.shape[1], b"\n"]
    rows = write_records(np.column_stack([points.times, columns]), decimals, literals)
    return ",".join(header).encode() + b"\n" + rows


def _quoted(name: str) -> str:
    """A name in quotes, if it has marks that a reader of CSV could take for a separator."""
    return name if re.fullmatch(r"[\w./-]+", name) else '"' + name.replace('"', '""') + '"'


def read_csv(data: bytes, file: str, *, records: bool = True) -> MotionPoints:
    """Read points from CSV.

    Parameters
    ----------
    data : bytes
        A file.
    file : str
        Its name, for messages.
    records : bool
        Whether rows that are written alike may be read at once.

    Returns
    -------
    MotionPoints
        Not checked yet.

    Raises
    ------
    InputError
        There are more than 5,000,000 lines, or one that cannot be read; names line and column.
    """
    if (rows := data.count(b"\n")) > MOST_SAMPLES:
        raise InputError(f"{file}: {rows} lines; at most {MOST_SAMPLES} points of a motion are read")
    found, values = csv_records(data) if records else None, None
    if found is not None:
        with contextlib.suppress(InputError):  # its line is that of the document, not that of the file
            header, table = _table(found.document, file)
            values = found.columns(table[0]) if len(table) == 1 else None
        if values is not None:
            return _points(header, values, file)
    require_small(data, file, found)
    return _points(*_table(data, file), file)


def _table(data: bytes, file: str) -> tuple[tuple[str, ...], Array]:
    table = parse_table(decode(data, file), file)
    if table.header is None:
        raise InputError(
            f"{file}: the first row must name the columns: time, position_NAME of each joint, and "
            "velocity_NAME and acceleration_NAME if they are known"
        )
    return table.header, numbers_of(table, table.header)


def _points(header: tuple[str, ...], table: Array, file: str) -> MotionPoints:
    time: int | None = None
    columns: dict[str, dict[str, int]] = {quantity: {} for quantity in QUANTITIES}
    for index, column in enumerate(header):
        quantity, _, name = column.partition("_")
        if column.lower() in TIMES:
            if time is not None:
                raise InputError(
                    f"{file}: columns {shown(header[time])} and {shown(column)} are both times"
                )
            time = index
        elif quantity in columns and name:
            if name in columns[quantity]:
                raise InputError(f"{file}: column {shown(column)} is given twice")
            columns[quantity][name] = index
        else:
            joints = tuple(columns["position"]) or ("NAME",)
            known = [f"{quantity}_{joint}" for quantity in QUANTITIES for joint in joints]
            raise InputError(
                f"{file}: unknown column {shown(column)}; {known_names(column, ['time', *known])}"
            )
    if time is None:
        raise InputError(f"{file}: column 'time' is missing")
    names = tuple(columns["position"])
    if not names:
        raise InputError(f"{file}: there is no column position_NAME")
    values = []
    for quantity in QUANTITIES:
        given = columns[quantity]
        for name in given:
            if name not in names:
                raise InputError(
                    f"{file}: column {quantity}_{name}: there is no column position_{name}"
                )
        if given:
            check_complete(file, f"{quantity} column", list(given), names)
        values.append(table[:, [given[name] for name in names]] if given else None)
    position, velocity, acceleration = values
    assert position is not None
    return MotionPoints(table[:, time], position, velocity, acceleration, named(names))
