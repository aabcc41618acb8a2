"""The relaxation's bound proved once more, written down for a checker that builds every row itself.

The proof is about all motions of at most H seconds, in boxes that the checker can derive: durations from
displacement over top speed, accelerations within their limits. Then single boxes are narrowed, each by
the multipliers of some rows, and the last multipliers prove the bound. Multipliers are for rows in SI
units:

    ["h", y]                                          (5)      ["s", segment, y]                  (6)
    ["t", segment, t, y]                              (7)      ["c", segment, t, y]               (8)
    ["w", joint, segment, end, corner, y]             (9)      ["v", joint, segment, end, sign, c, y]  (10)
    ["d", joint, segment, sign, s1 .. s6, y]          (1)      ["k", ...] the same without top speed
    ["a", joint, segment, sign, s1, s2, y]            (2)      ["r", joint, segment, end, sign, s1, s2, y]  (3)
    ["b", waypoint, y] earliest, ["l", waypoint, y] latest (5)    ["m", joint, segment, end, corner, y] (11)

Where segments may take no time, ["S", ...], ["T", ...], ["C", ...], ["D", ...], ["K", ...] and ["R", ...] are
the rows of the small letters times T, and these are posed besides:

    ["g", joint, segment, end, corner, y], ["x", ...]  products T v and T^2 a, as "w"       (9)
    ["V", joint, waypoint, sign, a, y]  at an acceleration (10)    ["j", joint, segment, sign, y]  (14)
    ["e", segment, sign, y]  the time of a leg over several segments is that of the segments

In place of a segment stands the pair of waypoints at the ends of a leg over several segments.

Events: ["N", "T", segment, side, rows] or ["N", "a", "v" or "x", waypoint, joint, side, rows] narrows a box
(of a duration, an acceleration, a velocity, or a position in a zone, from the middle of the zone) from
below (side 0) or from above (side 1), with effect after the next ["P"], which also narrows the
accelerations by (13), or ["R"], which does not. ["S", segment, value, events, events] splits the box of a
duration; both parts have events of their own, those of the lower part first. ["F", rows] ends with the bound,
["E", rows] with the proof that no motion is left, as does an event that leaves a box empty. Segments and
joints have the numbers of the problem, counted from 0; a segment between two waypoints that are kept has the
number of the first, and waypoints that are not kept do not occur.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import (
    CRUISES,
    FADES,
    HULLS,
    PEAKS,
    PRODUCTS,
    SPEED_PRODUCTS,
    SQUARE_PRODUCTS,
    STOPS,
    TANGENTS,
    ZONES,
    Kind,
)
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPSolution
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame

Event = list[Any]


class EventLog:
    """The events of ``tighten``.

    Attributes
    ----------
    events : list
    """

    def __init__(self) -> None:
        """Begin without events."""
        self.events: list[Event] = []

    def narrowed(self, program: LinearProgram, column: int, side: int, found: LPSolution) -> None:
        """Note what narrows a box, or proves that nothing is left.

        Parameters
        ----------
        program : LinearProgram
        column : int
            Of the variable.
        side : int
            0 from below, 1 from above.
        found : LPSolution
        """
        head, unit = _narrowed(program.frame, column)
        rows = rows_of(program, found.multipliers * unit)
        self.events.append(["E", rows] if found.empty else [*head, side, rows])

    def renewed(self) -> None:
        """Note that the narrowed boxes count from now on."""
        self.events.append(["P"])

    def without_time(self, relaxed: RelaxedProblem, boxes: Boxes) -> None:
        """Name the legs over several segments whose box is empty: a checker knows those named.

        Parameters
        ----------
        relaxed : RelaxedProblem
        boxes : Boxes
        """
        empty = np.flatnonzero(boxes.durations[:, 0] > boxes.durations[:, 1]).tolist()
        self.events += [
            ["N", "T", leg_name(relaxed, k), 0, []] for k in empty if k >= relaxed.n_segments
        ]

    def split(self, relaxed: RelaxedProblem, k: int, at: float, parts: list[list[Event]]) -> None:
        """Note that the box of a duration is split.

        Parameters
        ----------
        relaxed : RelaxedProblem
        k : int
            The leg.
        at : float [s]
        parts : list of list
            The events of the lower part and of the upper part.
        """
        self.events.append(["S", leg_name(relaxed, k), _hex(at), *parts])


def _narrowed(frame: Frame, column: int) -> tuple[Event, float]:
    """The head of the event that narrows a variable, and the variable's unit."""
    relaxed = frame.relaxed
    if column < frame.L:
        return ["N", "T", leg_name(relaxed, column)], float(frame.typical[column])
    for name, columns, units in (
        ("a", frame.a, np.broadcast_to(relaxed.acceleration, frame.a.shape)),
        ("v", frame.v, np.broadcast_to(relaxed.velocity, frame.v.shape)),
        ("x", frame.e, relaxed.zones),
    ):
        if (columns == column).any():
            waypoint, joint = np.argwhere(columns == column)[0].tolist()
            at = int(relaxed.waypoints[waypoint])
            return ["N", name, at, int(relaxed.joints[joint])], float(units[waypoint, joint])
    raise ValueError(f"column {column} is of no variable that is narrowed")


def rows_of(program: LinearProgram, multipliers: Array) -> list[Event]:
    """Write down rows with their multipliers for SI units.

    Parameters
    ----------
    program : LinearProgram
    multipliers : Array, shape (n_rows,)

    Returns
    -------
    list
    """
    frame, cuts = program.frame, program.cuts
    relaxed, unit = frame.relaxed, frame.typical
    y = np.maximum(multipliers, 0.0) * program.rows.scale  # for the rows before they were scaled
    rows: list[Event] = []
    if y[0]:
        rows.append(["h", _hex(y[0] / relaxed.horizon)])
    first = 1
    for name, which, units in (("s", frame.long, unit), ("S", frame.short, unit**-2)):
        for k in np.flatnonzero(which).tolist():
            if y[first]:
                rows.append([name, leg_name(relaxed, k), _hex(y[first] * units[k])])
            first += 1
    for k in range(frame.K, frame.L):
        for sign, value in zip((1, -1), y[first : first + 2].tolist(), strict=True):
            if value:
                rows.append(["e", leg_name(relaxed, k), sign, _hex(value / unit[k])])
        first += 2
    of_sums = y[first : program.n_fixed].tolist()
    for (waypoint, side), value in zip(frame.bounded_sums, of_sums, strict=True):
        if value:
            rows.append(["l" if side else "b", int(relaxed.waypoints[waypoint]), _hex(value)])
    of_cuts = y[program.n_fixed :]
    places = frame.place(cuts) * unit[cuts.segment]
    for i in np.flatnonzero(of_cuts).tolist():
        kind, k, j = Kind(int(cuts.kind[i])), int(cuts.segment[i]), int(cuts.joint[i])
        segment, joint, sign = leg_name(relaxed, k), int(relaxed.joints[j]), int(cuts.sign[i])
        at, value = [_hex(x) for x in cuts.at[i]], float(of_cuts[i])
        times_T = kind.times_T
        reach = value / (float(unit[k]) if times_T else 1.0)
        of_reach = _hex(reach / float(relaxed.velocity[j]))
        by_speed = _hex(value / float(relaxed.velocity[j]))
        if kind in TANGENTS:
            by_unit = value / places[i] ** 2 if times_T else value * unit[k]
            rows.append(["T" if times_T else "t", segment, _hex(places[i]), _hex(by_unit)])
        elif kind in HULLS:
            by_unit = value / unit[k] ** (3 if times_T else 2)
            rows.append(["C" if times_T else "c", segment, _hex(places[i]), _hex(by_unit)])
        elif kind in SPEED_PRODUCTS:
            by_both = _hex(value / (unit[k] * float(relaxed.velocity[j])))
            rows.append(["g", joint, segment, kind.end, int(cuts.at[i, 0]), by_both])
        elif kind in SQUARE_PRODUCTS:
            by_both = _hex(value / (unit[k] ** 2 * float(relaxed.acceleration[j])))
            rows.append(["x", joint, segment, kind.end, int(cuts.at[i, 0]), by_both])
        elif kind in FADES:
            waypoint = int(relaxed.waypoints[relaxed.legs[k, kind.end]])
            along = _hex(sign * cuts.at[i, 0])
            rows.append(["V", joint, waypoint, sign, along, by_speed])
        elif kind in PRODUCTS:
            by_both = _hex(value / (unit[k] * float(relaxed.acceleration[j])))
            rows.append(["w", joint, segment, kind.end, int(cuts.at[i, 0]), by_both])
        elif kind in ZONES:
            zone = float(relaxed.zones[relaxed.legs[k, kind.end], j])
            rows.append(
                ["m", joint, segment, kind.end, int(cuts.at[i, 0]), _hex(value * unit[k] / zone)]
            )
        elif kind in PEAKS:
            rows.append(["v", joint, segment, kind.end, sign, at[0], by_speed])
        elif kind in STOPS:
            name = "R" if times_T else "r"
            rows.append([name, joint, segment, kind.end, sign, *at[:2], of_reach])
        elif kind == Kind.CHANGE:
            rows.append(["j", joint, segment, sign, _hex(value / float(relaxed.acceleration[j]))])
        elif kind == Kind.SPEED:
            rows.append(["a", joint, segment, sign, *at[:2], by_speed])
        else:
            name = "d" if kind in CRUISES else "k"
            rows.append([name.upper() if times_T else name, joint, segment, sign, *at, of_reach])
    return rows


def leg_name(relaxed: RelaxedProblem, k: int) -> int | list[int]:
    """Name a leg: a segment by the number of its first waypoint, else by the waypoints at both ends.

    Parameters
    ----------
    relaxed : RelaxedProblem
    k : int

    Returns
    -------
    int or list of int
    """
    return (
        int(relaxed.segments[k])
        if k < relaxed.n_segments
        else relaxed.waypoints[relaxed.legs[k]].tolist()
    )


def _hex(x: float) -> str:
    return float(x).hex()
