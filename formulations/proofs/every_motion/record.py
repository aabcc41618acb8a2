"""The relaxation's bound once more, written down for a checker that builds every row itself.

All motions of at most H seconds, in boxes that a checker can derive: durations from displacement over
top speed, accelerations within their limits. Then boxes narrower one by one, each by the multipliers of
some rows, and last the bound by those of others. Multipliers are given for the rows in SI units:

    ["h", y]                                          (5)      ["s", segment, y]                  (6)
    ["t", segment, t, y]                              (7)      ["c", segment, t, y]               (8)
    ["w", joint, segment, end, corner, y]             (9)      ["v", joint, segment, end, sign, c, y]  (10)
    ["d", joint, segment, sign, s1 .. s6, y]          (1)      ["k", ...] the same without top speed
    ["a", joint, segment, sign, s1, s2, y]            (2)      ["r", joint, segment, end, sign, s1, s2, y]  (3)

Events: ["N", "T", segment, side, rows] or ["N", "a", waypoint, joint, side, rows] narrows a box from
below (side 0) or above (1), from the next ["R"] on; ["F", rows] ends with the bound, ["E", rows] with
nothing left. Segments and joints are those of the problem, counted from 0; those in which nothing moves
are passed over, and a waypoint goes by the segment that it begins.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.relaxation.cuts import (
    CRUISE,
    DISTANCE,
    HULL,
    PEAK_AT_END,
    PEAK_AT_START,
    PRODUCT_AT_END,
    PRODUCT_AT_START,
    SPEED,
    STOP_AT_END,
    STOP_AT_START,
    TANGENT,
    Cuts,
)
from formulations.proofs.every_motion.relaxation.program import Program, Solution
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.task import DOWN, UP, Task
from formulations.proofs.every_motion.relaxation.tightening import Boxes, tightened

_ROUNDS, _TOLERANCE = 100, 1e-9  # of cuts
_STEPS = 30  # of narrower boxes
_LEAST = 1e-13  # multipliers below this share of the largest say nothing
_MARGIN = 1e-10  # relative, for the checker's own rounding of boxes and rows


def recorded(
    problem: Problem, horizon: float, target: float, cuts: Cuts, typical: Array, deadline: float
) -> tuple[float, list[list[Any]]]:
    """A bound [s], as near ``target`` as it gets, and its events. horizon: H [s].

    cuts: to begin with; typical: (n_segments,) [s], durations to scale by. The bound is 0 where there
    is none.
    """
    task = Task.of(problem, horizon)
    boxes = _root(task)
    units = typical[task.segments]
    narrowing: list[list[Any]] = []
    best: tuple[float, list[list[Any]]] = (0.0, [])
    for _ in range(_STEPS):
        frame = Frame(task, boxes.durations, boxes.accelerations, units)
        program = Program(frame, cuts)
        solution = program.solve(frame.cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
        if solution.empty:
            return horizon, [*narrowing, ["E", rows_of(program, solution.multipliers)]]
        bound = min(solution.bound, horizon) * (1.0 - _MARGIN)
        if bound > best[0]:
            best = bound, [*narrowing, ["F", rows_of(program, solution.multipliers)]]
        if best[0] >= target or time.perf_counter() > deadline:
            break

        def note(column: int, side: int, found: Solution, program: Program = program) -> None:
            head, unit = _narrowed(program.frame, column)
            rows = rows_of(program, found.multipliers * unit)
            narrowing.append(["E", rows] if found.empty else [*head, side, rows])

        boxes = tightened(program, solution, deadline, note)
        if boxes.empty:
            return (horizon, narrowing) if narrowing[-1][0] == "E" else best
        narrowing.append(["R"])
        cuts = program.cuts
    return best


def _root(task: Task) -> Boxes:
    """Displacement over top speed; what the others leave; accelerations within their limits."""
    least = DOWN * (np.abs(task.displacements) / task.velocity).max(axis=1)
    least = np.maximum(least, task.least)
    most = task.horizon * UP - (least.sum() - least)
    widest = np.broadcast_to(
        task.acceleration[:, None] * (-1.0, 1.0), (len(least) + 1, len(task.joints), 2)
    )
    return Boxes(np.stack([least, most], axis=1), widest.copy(), bool((least > most).any()))


def _narrowed(frame: Frame, column: int) -> tuple[list[Any], float]:
    """The head of the event that narrows a variable, and the variable's unit."""
    task = frame.task
    if column < frame.K:
        return ["N", "T", int(task.segments[column])], float(frame.typical[column])
    waypoint, joint = np.argwhere(frame.a == column)[0].tolist()
    at = task.segments[waypoint] if waypoint < frame.K else task.segments[-1] + 1
    return ["N", "a", int(at), int(task.joints[joint])], float(task.acceleration[joint])


def rows_of(program: Program, multipliers: Array) -> list[list[Any]]:
    """Rows with their multipliers for SI units."""
    frame, cuts = program.frame, program.cuts
    task, unit = frame.task, frame.typical
    y = np.where(multipliers > _LEAST * np.abs(multipliers).max(initial=0.0), multipliers, 0.0)
    y = y * program.rows.scale  # of the rows before they were scaled
    rows: list[list[Any]] = []

    if y[0]:
        rows.append(["h", _hex(y[0] / task.horizon)])
    for k in np.flatnonzero(y[1 : frame.K + 1]).tolist():
        value = y[k + 1] * unit[k]
        rows.append(["s", int(task.segments[k]), _hex(value)])
    for i in np.flatnonzero(y[program.n_fixed :]).tolist():
        row, kind, k, j = (
            i + program.n_fixed,
            int(cuts.kind[i]),
            int(cuts.segment[i]),
            int(cuts.joint[i]),
        )
        segment, joint, sign = int(task.segments[k]), int(task.joints[j]), int(cuts.sign[i])
        at = [_hex(x) for x in cuts.at[i]]
        V, A = float(task.velocity[j]), float(task.acceleration[j])
        if kind in (TANGENT, HULL):
            t = float(np.clip(cuts.at[i, 0] / unit[k], frame.low[k], frame.high[k]) * unit[k])
            if kind == TANGENT:
                value = y[row] * unit[k]
                rows.append(["t", segment, _hex(t), _hex(value)])
            else:
                value = y[row] / unit[k] ** 2
                rows.append(["c", segment, _hex(t), _hex(value)])
        elif kind in (PRODUCT_AT_START, PRODUCT_AT_END):
            value = y[row] / (unit[k] * A)
            end, corner = int(kind == PRODUCT_AT_END), int(cuts.at[i, 0])
            rows.append(["w", joint, segment, end, corner, _hex(value)])
        elif kind in (PEAK_AT_START, PEAK_AT_END):
            rows.append(["v", joint, segment, int(kind == PEAK_AT_END), sign, at[0], _hex(y[row] / V)])
        elif kind in (STOP_AT_START, STOP_AT_END):
            end = int(kind == STOP_AT_END)
            rows.append(["r", joint, segment, end, sign, *at[:2], _hex(y[row] / V)])
        elif kind == SPEED:
            rows.append(["a", joint, segment, sign, *at[:2], _hex(y[row] / V)])
        else:
            assert kind in (DISTANCE, CRUISE)
            rows.append(["d" if kind == CRUISE else "k", joint, segment, sign, *at, _hex(y[row] / V)])
    return rows


def _hex(x: float) -> str:
    return float(x).hex()
