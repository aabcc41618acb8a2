"""The nonlinear program under limits on the tool, on steps that all joints share.

Each segment has N steps with durations h of their own. At the nodes between them stand positions q,
velocities v and, for joints with a jerk limit, accelerations a; in between the jerk is constant:

    minimise    sum h + w sum |v+ - v|^2, with w going to 0 in the search
    subject to, on each step,
        v+ - v = h (a + a+) / 2,    q+ - q = h v + h^2 (2 a + a+) / 6                    (1)
        |a+ - a| <= J h                                                                  (2)
        v, a at nodes and v + h a / 2 within their limits                                (3)
        q + h v / 3, q+ - h v+ / 3 within the position limits                            (4)
        floor <= h N / (time of the segment)                                             (5)
    and at each node and at ``INNER`` between them
        |J(q) v|^2 <= s^2,                                                               (6)
    at each waypoint with a ball |p(q) - p(w)|^2 <= r^2,                                 (7)
    and the windows, times and cycles of ``Demands``, which are linear.

Joints without a jerk limit have constant accelerations: v+ - v within A h, q+ - q = h (v + v+) / 2. The joints
share their steps, since (6) ties them together at each time. The limit s of each row is a parameter, which the
search lowers where the speed is larger between the samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi
import numpy as np

from formulations.deadlines import Deadline
from formulations.deadlines.ipopt import StoppableIpopt
from formulations.optima.free_form.tool.stepped import Stepped
from formulations.optima.free_form.tool.symbols import point_function, square_speed
from formulations.problem.arrays import Array, Truths
from formulations.problem.demands import Demands

INNER = (1.0 / 3.0, 2.0 / 3.0)  # of a step
_FLOOR = 0.2  # least step, as a share of the mean one of its segment
_INSIDE = 1e-9  # share by which limits are drawn in, as the solver keeps them up to this
_OPTIONS: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "error_on_fail": False,
    "show_eval_warnings": False,
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.honor_original_bounds": "yes",
}


@dataclass(frozen=True)
class _Rows:
    """Rows of one kind with their bounds."""

    symbols: Any
    low: Array
    high: Array


class ToolProgram:
    """The program of one problem on N steps per segment.

    Attributes
    ----------
    demands : Demands
    steps : int
        N.
    second : float [s]
        The unit of time.
    """

    def __init__(self, demands: Demands, steps: int, second: float) -> None:
        """Pose the program.

        Parameters
        ----------
        demands : Demands
        steps : int
        second : float [s]
        """
        self.demands, self.steps, self.second = demands, steps, second
        self.S, self.n = demands.tool_speed.size, demands.problem.dof
        self.third: Truths = np.asarray(np.isfinite(demands.jerk).all(axis=0))
        M = self.S * steps
        self.h = casadi.SX.sym("h", M)
        self.q, self.v, self.a = (casadi.SX.sym(name, self.n, M + 1) for name in "qva")
        self.speeds = casadi.SX.sym("speed", M)  # squares of the limits on the steps
        self.x = casadi.vertcat(self.h, *(casadi.vec(part) for part in (self.q, self.v, self.a)))
        self.segment = np.repeat(np.arange(self.S), steps)
        self.rows: list[_Rows] = []
        self._dynamics()
        self._limits()
        self._times()
        self._tool()
        self.low, self.high = self._bounds()
        total = demands.conditions.total
        cost = casadi.sum1(self.h) if total is None else self._roughness()
        self.weight = casadi.SX.sym("weight")
        cost += self.weight * casadi.sumsqr(self.v[:, 1:] - self.v[:, :-1])
        nlp = {
            "x": self.x,
            "p": casadi.vertcat(self.speeds, self.weight),
            "f": cost,
            "g": casadi.vertcat(*(rows.symbols for rows in self.rows)),
        }
        self._nlp = nlp
        self.row_low, self.row_high = (
            np.concatenate([getattr(rows, side) for rows in self.rows]) for side in ("low", "high")
        )
        self._solvers: dict[float, StoppableIpopt] = {}

    def _row(self, symbols: Any, low: Array | float, high: Array | float) -> None:
        column = casadi.vec(symbols)
        count = column.numel()
        sides = [np.broadcast_to(np.asarray(side, float), count).copy() for side in (low, high)]
        kept = np.flatnonzero(np.isfinite(sides[0]) | np.isfinite(sides[1]))
        if len(kept):
            self.rows.append(_Rows(column[kept.tolist()], sides[0][kept], sides[1][kept]))

    def _per_step(self, values: Array) -> Array:
        """Values (S, n) of segments as a column over joints and steps, as CasADi orders it."""
        return np.asarray(values[self.segment].ravel())

    def _dynamics(self) -> None:
        """Rows (1) and (2)."""
        n, d = self.n, self.demands
        h = casadi.repmat(self.h.T, n, 1)
        q0, q1, v0, v1, a0, a1 = (
            part[:, side]
            for part in (self.q, self.v, self.a)
            for side in (slice(None, -1), slice(1, None))
        )
        third = casadi.repmat(casadi.DM(self.third.astype(float)), 1, len(self.segment))
        self._row(
            q1 - q0 - h * casadi.if_else(third, v0 + h * (2.0 * a0 + a1) / 6.0, (v0 + v1) / 2.0),
            0.0,
            0.0,
        )
        jerk = self._per_step(np.where(np.isfinite(d.jerk), d.jerk, np.inf)) * self.second**3
        hs = casadi.vec(h)
        bent = np.tile(self.third, len(self.segment))
        change_a, change_v = casadi.vec(a1 - a0), casadi.vec(v1 - v0)
        for index, symbols, limits in (
            (np.flatnonzero(bent), change_a, np.stack([-jerk, jerk])),
            (np.flatnonzero(~bent), change_v, self._both(d.acceleration, 2)),
        ):
            if not len(index):
                continue
            rows = index.tolist()
            low, high = limits[:, index] * (1.0 - _INSIDE)
            for bound, sign in ((low, -1.0), (high, 1.0)):
                mine = np.flatnonzero(np.isfinite(bound)).tolist()
                at = [rows[i] for i in mine]
                self._row(sign * (hs[at] * bound[mine] - symbols[at]), 0.0, np.inf)
        rows = np.flatnonzero(bent).tolist()
        if rows:
            gained = casadi.vec(v1 - v0 - h * (a0 + a1) / 2.0)
            self._row(gained[rows], 0.0, 0.0)

    def _both(self, intervals: Array, order: int) -> Array:
        """Lower and upper limits (2, joints x steps) of intervals (S, n, 2), in units of the program."""
        return np.stack([self._per_step(intervals[:, :, side]) * self.second**order for side in (0, 1)])

    def _limits(self) -> None:
        """Rows (3) and (4); what concerns nodes alone is a bound of variables."""
        d = self.demands
        h = casadi.repmat(self.h.T, self.n, 1)
        v0, v1 = self.v[:, :-1], self.v[:, 1:]
        bent = np.flatnonzero(np.tile(self.third, len(self.segment)))
        middle = casadi.vec(v0 + h * self.a[:, :-1] / 2.0)
        low, high = self._both(d.velocity, 1)[:, bent] * (1.0 - _INSIDE)
        self._row(middle[bent.tolist()], low, high)
        slack = 0.5 * d.problem.position_slack
        low, high = self._both(d.position, 0) + np.array([[-slack], [slack]])
        near = self._nearby()[self.segment].ravel()
        low, high = np.where(near, low, -np.inf), np.where(near, high, np.inf)
        self._row(self.q[:, :-1] + h * v0 / 3.0, low, high)
        self._row(self.q[:, 1:] - h * v1 / 3.0, low, high)

    def _nearby(self) -> Truths:
        """Where a position limit is so near that a motion may touch it, (S, n)."""
        d = self.demands
        ends = d.waypoints[np.arange(self.S)[:, None] + np.arange(2)]
        low, high = ends[..., 0].min(axis=1), ends[..., 1].max(axis=1)
        room = np.minimum(low - d.position[..., 0], d.position[..., 1] - high)
        return np.asarray(room < np.maximum(high - low, 0.5))

    def _times(self) -> None:
        """Rows (5), durations of segments, windows of waypoints, and a cycle's ends."""
        d, N = self.demands, self.steps
        times = [casadi.sum1(self.h[k * N : (k + 1) * N]) for k in range(self.S)]
        mean = casadi.vertcat(*[times[k] / N for k in self.segment])
        self._row(self.h - _FLOOR * mean, 0.0, np.inf)
        passed: Any = 0.0
        for k, time in enumerate(times):
            self._row(time, *(d.durations[k] / self.second))
            passed = passed + time
            waited = float(d.waits[: k + 1].sum())
            self._row(passed, *((d.passages[k + 1] - waited) / self.second))
        if d.cyclic:
            for part in (self.q, self.v, self.a):
                self._row(part[:, 0] - part[:, -1], 0.0, 0.0)

    def _tool(self) -> None:
        """Rows (6) and (7)."""
        d, chain = self.demands, self.demands.problem.tool
        assert chain is not None
        speed, point = square_speed(chain), point_function(chain)
        limited = np.flatnonzero(np.isfinite(d.tool_speed[self.segment])).tolist()
        squares = []
        for i in limited:
            shares = (0.0, *INNER, 1.0)
            squares += [speed(*self._inside(i, u)) - self.speeds[i] for u in shares]
        if squares:
            self._row(casadi.vertcat(*squares), -np.inf, 0.0)
        for k in np.flatnonzero(np.isfinite(d.tool_radius)).tolist():
            off = point(self.q[:, k * self.steps]) - point(casadi.DM(d.problem.waypoints[k]))
            radius = float(d.tool_radius[k]) * (1.0 - 1e-7)
            self._row(casadi.sumsqr(off) / radius**2, -np.inf, 1.0)

    def _inside(self, i: int, u: float) -> tuple[Any, Any]:
        """Positions and velocities at the share u of step i."""
        h, q, v, v1 = self.h[i], self.q[:, i], self.v[:, i], self.v[:, i + 1]
        if u in (0.0, 1.0):
            return self.q[:, i + int(u)], self.v[:, i + int(u)]
        third = casadi.DM(self.third.astype(float))
        a = third * self.a[:, i] * h + (1.0 - third) * (v1 - v)  # gained in a whole step
        rate = third * (self.a[:, i + 1] - self.a[:, i]) * h
        return q + h * u * (v + u * (a / 2.0 + u * rate / 6.0)), v + u * (a + u * rate / 2.0)

    def _roughness(self) -> Any:
        """The integral of the squares of jerk over limit, of order 2 acceleration over limit."""
        found: Any = 0.0
        jerk = self.demands.jerk.max(axis=0) * self.second**3
        acceleration = np.abs(self.demands.acceleration).max(axis=(0, 2)) * self.second**2
        for j in range(self.n):
            part, unit = (self.a, jerk[j]) if self.third[j] else (self.v, acceleration[j])
            change = (part[j, 1:] - part[j, :-1]).T / unit
            found += casadi.sum1(change**2 / self.h)
        return found

    def _bounds(self) -> tuple[Array, Array]:
        """Bounds of the variables; those of nodes are the tighter ones of the two segments that meet."""
        d, N, tau = self.demands, self.steps, self.second
        sides = []
        for side, tighter in ((0, np.maximum), (1, np.minimum)):

            def at_nodes(values: Array, power: int, tighter: Any = tighter, side: int = side) -> Array:
                mine = values[self.segment, :, side] * tau**power
                return np.asarray(tighter(np.vstack([mine[:1], mine]), np.vstack([mine, mine[-1:]])))

            q = at_nodes(d.position, 0)
            q[::N] = d.waypoints[:, :, side]
            v = at_nodes(d.velocity, 1) * (1.0 - _INSIDE)
            a = at_nodes(d.acceleration, 2) * (1.0 - _INSIDE)
            v[[0, -1]] = d.end_velocity[..., side] * tau
            a[[0, -1]] = d.end_acceleration[..., side] * tau**2
            v[::N][d.stops] = 0.0
            a[::N][d.stops] = 0.0
            a[:, ~self.third] = 0.0
            h = np.full(len(self.segment), (1e-9, np.inf)[side])
            sides.append(np.concatenate([h, q.ravel(), v.ravel(), a.ravel()]))
        return sides[0], sides[1]

    def solve(
        self,
        start: Stepped,
        limits: Array,
        deadline: Deadline,
        *,
        near: float = 1e-3,
        weight: float = 0.0,
    ) -> tuple[Stepped, bool, str]:
        """Solve from a motion.

        Parameters
        ----------
        start : Stepped
            On the same steps.
        limits : Array, shape (S N,)
            Limits of the tool's speed on the steps [m/s].
        deadline : Deadline
        near : float
            Barrier parameter to start with.
        weight : float
            Of the squares of the changes of velocity on steps, in the objective: they keep the motion from
            swinging between samples.

        Returns
        -------
        motion : Stepped
        converged : bool
        status : str
            How the solver says it ended.
        """
        tau = self.second
        powers = (start.h / tau, start.q, start.v * tau, start.a * tau**2)
        point = np.clip(np.concatenate([part.ravel() for part in powers]), self.low, self.high)
        if near not in self._solvers:
            options = {
                "ipopt.tol": 1e-8,
                "ipopt.max_iter": 200,
                "ipopt.mu_strategy": "monotone",
                "ipopt.mu_init": near,
            }
            blocks = [rows.symbols for rows in self.rows]
            self._solvers[near] = StoppableIpopt("tool", self._nlp, _OPTIONS | options, blocks)
        squares = np.where(np.isfinite(limits), limits * tau, 1.0) ** 2
        try:
            solved = self._solvers[near].solve(
                deadline,
                x0=point,
                p=np.append(squares, weight),
                lbx=self.low,
                ubx=self.high,
                lbg=self.row_low,
                ubg=self.row_high,
            )
        except RuntimeError as error:  # CasADi refuses the numbers
            return start, False, str(error).strip().splitlines()[-1]
        if solved is None:
            return start, False, "stopped at the deadline"
        found, stats = solved
        x = np.asarray(found["x"]).ravel()
        status = str(stats["return_status"]).replace("_", " ").lower()
        if not np.isfinite(x).all():
            return start, False, status
        M = len(self.segment)
        h, nodes = np.maximum(x[:M], 1e-9) * tau, x[M:].reshape(3, M + 1, self.n)
        motion = Stepped(self.third, h, nodes[0], nodes[1] / tau, nodes[2] / tau**2)
        return motion, bool(stats["success"]), status
