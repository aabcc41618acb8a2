"""SCIP as a general global solver: motions of constant jerk on even steps, with limits at the nodes.

Scaled by powers of the segment's duration T, the steps are linear: w = T v, b = T^2 a and c = T^3 j obey the
rules of a chain of integrators with constant coefficients. What is left of the nonconvexity are the powers
of T in the limits, and the products at the waypoints, where v and a of two segments meet.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.rivals.rival import RivalAnswer
from formulations import REFERENCES, Trajectory
from formulations.problem.problem import Problem
from formulations.proofs.displacement import displacement_durations

_STEPS = 6  # per segment
_TOLERANCE = 1e-6  # SCIP's own, of a constraint
_GAP = 1e-4  # between its bound and its motion, where it ends
_SHARE = 0.8  # of the time


def scip(problem: Problem, seconds: float) -> RivalAnswer:
    """Minimise the sum of the segment times by spatial branch and bound.

    Parameters
    ----------
    problem : Problem
        With an acceleration limit.
    seconds : float
        SCIP gets four fifths of them [s].

    Returns
    -------
    RivalAnswer
        With SCIP's own lower bound of this program, which is none of all motions.
    """
    import pyscipopt

    if not problem.limits.has_acceleration:
        return RivalAnswer(None, note="needs an acceleration limit")
    stopping = REFERENCES["ruckig_stop_and_go"](problem).durations
    assert stopping is not None
    model = pyscipopt.Model()
    model.hideOutput()
    model.setParam("limits/time", _SHARE * seconds)
    model.setParam("limits/gap", _GAP)
    model.setParam("numerics/feastol", _TOLERANCE)
    program = _Program(model, problem, displacement_durations(problem), 2.0 * stopping)
    model.setObjective(pyscipopt.quicksum(program.times))
    model.optimize()
    note = (
        f"{_STEPS} steps per segment, {model.getNVars()} variables, {model.getNNodes()} nodes, tolerance "
        f"{_TOLERANCE:g}, {model.getStatus()}"
    )
    bound = model.getDualbound()
    bound = float(bound) if abs(bound) < model.infinity() else None
    if not model.getNSols():
        return RivalAnswer(None, bound=bound, note=note)
    return RivalAnswer(program.motion(), float(model.getObjVal()), bound, note)


class _Program:
    """Variables and constraints of one problem, per segment k, joint j and node i."""

    def __init__(self, model: object, problem: Problem, least: np.ndarray, most: np.ndarray) -> None:
        self._model, self._problem = model, problem
        add, limits, free = model.addVar, problem.limits, {"lb": None, "ub": None}  # type: ignore[attr-defined]
        count, dof = problem.n_segments, problem.dof
        smooth = limits.has_jerk
        moves = (problem.displacements != 0.0).any(axis=1)
        self.times = [
            add(lb=max(float(a), 1e-4), ub=max(float(b), 1e-3)) if m else add(lb=1e-4, ub=1e-3)
            for a, b, m in zip(least, most, moves, strict=True)
        ]
        inner = range(1, count)
        v = {
            (k, j): add(lb=-limits.velocity[j], ub=limits.velocity[j])
            for k in inner
            for j in range(dof)
        }
        a = {
            (k, j): add(lb=-limits.acceleration[j], ub=limits.acceleration[j])
            for k in (inner if smooth else ())
            for j in range(dof)
        }
        low, high = problem.position_bounds.T
        h = 1.0 / _STEPS
        self._steps: dict[tuple[int, int], list[tuple[Any, Any, Any, Any]]] = {}
        require = model.addCons  # type: ignore[attr-defined]
        for k, T in enumerate(self.times):
            square = add(lb=float(least[k]) ** 2)
            require(square == T * T)
            cube = add(lb=float(least[k]) ** 3) if smooth else None
            if cube is not None:
                require(cube == square * T)
            for j in range(dof):
                x, w = float(problem.waypoints[k, j]), v.get((k, j))
                w = 0.0 if w is None else T * w
                b = a.get((k, j))
                b = 0.0 if b is None else square * b
                chain = []
                for _ in range(_STEPS):
                    bent = add(**free)  # c = T^3 j, or b where there is no jerk limit
                    if smooth:
                        c = bent
                        require(c <= limits.jerk[j] * cube)
                        require(c >= -limits.jerk[j] * cube)
                    else:
                        b, c = bent, 0.0
                        require(b <= limits.acceleration[j] * square)
                        require(b >= -limits.acceleration[j] * square)
                    chain.append((x, w, b, c))
                    ends = [add(**free) for _ in range(3 if smooth else 2)]
                    require(ends[0] == x + h * w + h * h / 2.0 * b + h**3 / 6.0 * c)
                    require(ends[1] == w + h * b + h * h / 2.0 * c)
                    x, w = ends[:2]
                    require(w <= limits.velocity[j] * T)
                    require(w >= -limits.velocity[j] * T)
                    if np.isfinite(low[j]):
                        require(x >= low[j])
                    if np.isfinite(high[j]):
                        require(x <= high[j])
                    if smooth:
                        require(ends[2] == b + h * c)
                        b = ends[2]
                        require(b <= limits.acceleration[j] * square)
                        require(b >= -limits.acceleration[j] * square)
                require(x == float(problem.waypoints[k + 1, j]))
                after = v.get((k + 1, j))
                require(w == 0.0 if after is None else w == T * after)
                if smooth:
                    after = a.get((k + 1, j))
                    require(b == 0.0 if after is None else b == square * after)
                self._steps[k, j] = chain

    def motion(self) -> Trajectory:
        """The best motion found, as exact pieces."""
        value = self._model.getVal  # type: ignore[attr-defined]
        durations, pieces = [], []
        for k, T in enumerate(self.times):
            total = value(T)
            for i in range(_STEPS):
                rows = []
                for j in range(self._problem.dof):
                    x, w, b, c = (e if isinstance(e, float) else value(e) for e in self._steps[k, j][i])
                    rows.append([x, w / total, b / total**2 / 2.0, c / total**3 / 6.0])
                durations.append(total / _STEPS)
                pieces.append(rows)
        return Trajectory(np.array(durations), np.array(pieces))
