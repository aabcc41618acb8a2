"""Narrower boxes for the motions that take at most the horizon, and with them a tighter relaxation.

Each bound of a duration, or of an acceleration or a position at a waypoint, is itself the optimum of the
relaxation for another cost, and it is certified in the same way (optimality-based bound tightening). What
the rows (6), (8), (9) and (11) lose is proportional to the product of two boxes' widths. So every box that
has become narrower is used at once, in the rows of the next program.

References
----------
Gleixner, Berthold, Mueller & Weltge 2017, "Three enhancements for optimization-based bound tightening",
Journal of Global Optimization 67, pp. 731-757.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from formulations.deadlines import Deadline
from formulations.problem.arrays import Array, Truths
from formulations.proofs.every_motion.relaxation.boxes import Boxes, joined_ends
from formulations.proofs.every_motion.relaxation.cuts import (
    PRODUCTS,
    SPEED_PRODUCTS,
    SQUARE_PRODUCTS,
    ZONES,
    Cuts,
    Kind,
)
from formulations.proofs.every_motion.relaxation.in_band import least_time, long_chain
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPSolution
from formulations.proofs.every_motion.relaxation.propagation import propagate
from formulations.proofs.every_motion.relaxation.relaxed_problem import UP
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.windows import HALF, Window, solve_in_windows

FEW, MANY = 3, 15  # rounds of cuts for one bound: to begin with, and where few gain nothing
_TOLERANCE = 1e-6
_RENEWED = 2  # of cuts for the total time, whenever boxes were narrowed in windows
_AT_WAYPOINTS = ("accelerations", "offsets", "velocities")


class Record(Protocol):
    """What writes a proof down while boxes are narrowed."""

    def narrowed(self, program: LinearProgram, column: int, side: int, found: LPSolution) -> None:
        """Note the program that narrows the box of a column from one side, or proves it empty."""

    def renewed(self) -> None:
        """Note that the rows are from now on those of the narrowed boxes, after ``propagate``."""


def tighten(
    program: LinearProgram,
    solution: LPSolution,
    deadline: Deadline,
    record: Record | None = None,
    rounds: int = FEW,
) -> tuple[Boxes, Cuts]:
    """Narrow the boxes of a program without losing a motion, as far as the time goes.

    All durations are narrowed, and those accelerations and positions whose products (9) and (11) have a
    multiplier.

    Parameters
    ----------
    program : LinearProgram
    solution : LPSolution
        Of the total time.
    deadline : Deadline
    record : Record, optional
    rounds : int
        Of cuts for one bound.

    Returns
    -------
    boxes : Boxes
    cuts : Cuts
        Of the last program.
    """
    if long_chain(program.frame):
        return _tighten_in_windows(program, solution, deadline, record, rounds)
    wanted = [("durations", k, 0) for k in _durations_of(program, solution)]
    for name, kinds in (
        ("accelerations", (*PRODUCTS, *SQUARE_PRODUCTS)),
        ("offsets", ZONES),
        ("velocities", SPEED_PRODUCTS),
    ):
        wanted += [(name, k, j) for k, j in _with_multiplier(program, solution, kinds)]
    for name, k, j in wanted:
        frame, boxes = program.frame, program.frame.boxes
        narrowed = {key: getattr(boxes, key).copy() for key in ("durations", *_AT_WAYPOINTS)}
        interval = _interval(narrowed, name, k, j)
        column, unit = _column(frame, name, k, j)
        for side, sign in ((0, 1.0), (1, -1.0)):
            if deadline.over:
                return boxes, program.cuts
            cost = np.zeros(frame.size)
            cost[column] = sign
            found = program.solve(cost, rounds=rounds, tolerance=_TOLERANCE, deadline=deadline)
            if record is not None:
                record.narrowed(program, column, side, found)
            if found.empty:
                return Boxes(**narrowed, empty=True), program.cuts
            _narrow(interval, side, found.bound * unit)
        boxes = _with_what_follows(frame, narrowed, record)
        if boxes.empty:
            return boxes, program.cuts
        program = program.renewed(boxes)
    return program.frame.boxes, program.cuts


def _durations_of(program: LinearProgram, solution: LPSolution) -> list[int]:
    """All segments, and those legs over several whose rows have a multiplier."""
    y = solution.multipliers[program.n_fixed :]
    used = program.cuts.segment[y > 1e-9 * np.abs(y).max(initial=0.0)]
    return [*range(program.frame.K), *np.unique(used[used >= program.frame.K]).tolist()]


def _tighten_in_windows(
    program: LinearProgram,
    solution: LPSolution,
    deadline: Deadline,
    record: Record | None,
    rounds: int,
) -> tuple[Boxes, Cuts]:
    """Narrow the boxes in the middle of windows that do not overlap, then those of the next ones."""
    used = np.zeros(0, dtype=bool)
    for first in range(2 * HALF + 1):
        frame, boxes = program.frame, program.frame.boxes
        used = _either(used, solution.multipliers > 0.0)
        accelerations = set(_with_multiplier(program, solution, PRODUCTS)) if rounds > FEW else set()
        middles = range(first, frame.K, 2 * HALF + 1)
        windows = {k: Window(program, solution.multipliers, k) for k in middles}
        narrowed = {key: getattr(boxes, key).copy() for key in ("durations", *_AT_WAYPOINTS)}
        for name, j in (("durations", 0), *(("accelerations", j) for j in range(frame.n))):
            here = [k for k in middles if name == "durations" or (k, j) in accelerations]
            places = [_column(frame, name, k, j) for k in here]
            for side, sign in ((0, 1.0), (1, -1.0)):
                costs = [sign * (np.arange(frame.size) == column) for column, _ in places]
                mine = [windows[k] for k in here]
                answers = solve_in_windows(program, mine, costs, solution.x, rounds, deadline)
                for k, (column, unit), found in zip(here, places, answers, strict=True):
                    if found is None:
                        continue
                    used = _either(used, found.multipliers > 0.0)
                    if record is not None:
                        record.narrowed(program, column, side, found)
                    _narrow(_interval(narrowed, name, k, j), side, found.bound * unit)
        boxes = _with_what_follows(frame, narrowed, record)
        if boxes.empty:
            return boxes, program.cuts
        used = _either(used, np.zeros(len(program.rows), dtype=bool))
        program = program.renewed(boxes, used[program.n_fixed :])
        used = np.concatenate(
            [used[: program.n_fixed], used[program.n_fixed :][used[program.n_fixed :]]]
        )
        if deadline.over:
            break
        solution = least_time(
            program,
            rounds=_RENEWED,
            tolerance=_TOLERANCE,
            deadline=deadline,
            ceiling=frame.relaxed.horizon,
        )
    return program.frame.boxes, program.cuts


def _either(one: Truths, other: Truths) -> Truths:
    """Either of two, the shorter of which goes on with False."""
    found = np.zeros(max(len(one), len(other)), dtype=bool)
    found[: len(one)] = one
    found[: len(other)] |= other
    return found


def _interval(arrays: dict[str, Array], name: str, k: int, j: int) -> Array:
    """The interval of a duration, or of joint j at waypoint k."""
    return np.asarray(arrays[name][k] if name == "durations" else arrays[name][k, j])


def _with_what_follows(frame: Frame, narrowed: dict[str, Array], record: Record | None) -> Boxes:
    """Boxes of narrowed intervals, and what else they narrow; the rows are those of these from now on."""
    for key in _AT_WAYPOINTS:
        narrowed[key] = joined_ends(frame.relaxed, narrowed[key])
    empty = any(bool((each[..., 0] > each[..., 1]).any()) for each in narrowed.values())
    boxes = propagate(frame.relaxed, Boxes(**narrowed, empty=empty))
    if record is not None:
        record.renewed()
    return boxes


def _narrow(interval: Array, side: int, bound: float) -> None:
    """Narrow an interval from below (0), or from above (1) by the bound of what is turned round."""
    bound = bound if side == 0 else -bound
    bound -= (1.0 - 2.0 * side) * (UP - 1.0) * abs(bound)
    interval[side] = max(interval[0], bound) if side == 0 else min(interval[1], bound)


def _column(frame: Frame, name: str, k: int, j: int) -> tuple[int, float]:
    """The column of a variable and its unit."""
    if name == "durations":
        return int(frame.T[k]), float(frame.typical[k])
    if name == "accelerations":
        return int(frame.a[k, j]), float(frame.relaxed.acceleration[j])
    if name == "velocities":
        return int(frame.v[k, j]), float(frame.relaxed.velocity[j])
    return int(frame.e[k, j]), float(frame.relaxed.zones[k, j])


def _with_multiplier(
    program: LinearProgram, solution: LPSolution, kinds: tuple[Kind, ...]
) -> list[tuple[int, int]]:
    """Waypoints and joints whose rows of these kinds have a multiplier."""
    last = program.frame.K
    cuts, y = program.cuts, solution.multipliers[program.n_fixed :]
    found = set()
    for kind in kinds:
        carries = (cuts.kind == kind) & (y > 1e-9 * np.abs(y).max(initial=0.0))
        waypoints = program.frame.relaxed.legs[cuts.segment[carries], kind.end]
        if program.frame.relaxed.cyclic:
            waypoints = waypoints % last
        found |= set(zip(waypoints.tolist(), cuts.joint[carries].tolist(), strict=True))
    return sorted(found)
