"""SCIP as a general global solver: motions of constant jerk on even steps, with limits all along each step.

Scaled by powers of the segment's duration T, the steps are linear: w = T v, b = T^2 a and c = T^3 j obey the
rules of a chain of integrators with constant coefficients. What is left of the nonconvexity are the powers
of T in the limits, and the products at the waypoints, where v and a of two segments meet.

Positions and velocities are limited at the Bezier points of a step, between which they lie. With limits at the
nodes alone velocities are up to 1.5 times their limits between them, with limits at the middles too up to 1.05
times (random problems of two arms); the motions are as slow as with Bezier points to within 0.2 %.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from compare.rivals.rival import RivalAnswer
from formulations import REFERENCES, Trajectory
from formulations.problem.problem import Problem
from formulations.proofs.displacement import displacement_durations

_STEPS = 8  # per segment
_TOLERANCE = 1e-6  # SCIP's own, of a constraint
_GAP = 1e-4  # between its bound and its motion, where it ends
_SHARE = 0.8  # of the time


def scip(problem: Problem, seconds: float) -> RivalAnswer:
    """Minimise the sum of the segment times by spatial branch and bound.

    Parameters
    ----------
    problem : Problem
    seconds : float
        SCIP gets four fifths of them [s].

    Returns
    -------
    RivalAnswer
        With SCIP's own lower bound of this program, which is none of all motions.
    """
    import pyscipopt

    least = displacement_durations(problem)
    stopping = REFERENCES["ruckig_stop_and_go"](problem).durations
    most = _STEPS * least if stopping is None else 2.0 * stopping  # none: no acceleration limit
    model = pyscipopt.Model()
    model.hideOutput()
    model.setParam("limits/time", _SHARE * seconds)
    model.setParam("limits/gap", _GAP)
    model.setParam("numerics/feastol", _TOLERANCE)
    program = _Program(model, problem, least, most)
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

    def __init__(self, model: Any, problem: Problem, least: np.ndarray, most: np.ndarray) -> None:
        self._model, self._problem = model, problem
        add, limits = model.addVar, problem.limits
        count, dof, smooth = problem.n_segments, problem.dof, problem.limits.has_jerk
        moves = (problem.displacements != 0.0).any(axis=1)
        self.times = [
            add(lb=max(float(a), 1e-4), ub=max(float(b), 1e-3)) if m else add(lb=1e-4, ub=1e-3)
            for a, b, m in zip(least, most, moves, strict=True)
        ]
        v, a = {}, {}
        for k, j in itertools.product(range(1, count), range(dof)):
            v[k, j] = self._within(limits.velocity[j])
            if smooth:
                a[k, j] = self._within(limits.acceleration[j])
        low, high = problem.position_bounds.T
        h = 1.0 / _STEPS
        self._steps: dict[tuple[int, int], list[tuple[Any, Any, Any, Any]]] = {}
        require, keep = model.addCons, self._keep
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
                    bent = add(lb=None)  # c = T^3 j, or b where there is no jerk limit
                    if smooth:
                        c = bent
                        keep(c, limits.jerk[j], cube)
                    else:
                        b, c = bent, 0.0
                        keep(b, limits.acceleration[j], square)
                    chain.append((x, w, b, c))
                    ends = [add(lb=None) for _ in range(3 if smooth else 2)]
                    require(ends[0] == x + h * w + h * h / 2.0 * b + h**3 / 6.0 * c)
                    require(ends[1] == w + h * b + h * h / 2.0 * c)
                    places, speeds = [ends[0]], [ends[1]]  # Bezier points of the step, but its first
                    if smooth:
                        places += [x + h / 3.0 * w, x + 2.0 * h / 3.0 * w + h * h / 6.0 * b]
                        speeds.append(w + h / 2.0 * b)
                    else:
                        places.append(x + h / 2.0 * w)
                    for place in places:
                        if np.isfinite(low[j]) and not isinstance(place, float):
                            require(place >= low[j])
                        if np.isfinite(high[j]) and not isinstance(place, float):
                            require(place <= high[j])
                    for speed in speeds:
                        if not isinstance(speed, float):
                            keep(speed, limits.velocity[j], T)
                    x, w = ends[:2]
                    if smooth:
                        require(ends[2] == b + h * c)
                        b = ends[2]
                        keep(b, limits.acceleration[j], square)
                require(x == float(problem.waypoints[k + 1, j]))
                after = v.get((k + 1, j))
                require(w == 0.0 if after is None else w == T * after)
                if smooth:
                    after = a.get((k + 1, j))
                    require(b == 0.0 if after is None else b == square * after)
                self._steps[k, j] = chain

    def _within(self, limit: float) -> Any:
        """A variable within a limit."""
        ends = (-limit, limit) if np.isfinite(limit) else (None, None)
        return self._model.addVar(lb=ends[0], ub=ends[1])

    def _keep(self, value: Any, limit: float, power: Any) -> None:
        """Keep a limit, both scaled by the same power of the duration."""
        if np.isfinite(limit):
            self._model.addCons(value <= limit * power)
            self._model.addCons(value >= -limit * power)

    def motion(self) -> Trajectory:
        """The best motion found, as exact pieces."""
        value = self._model.getVal
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
