"""The nonlinear program of the fastest motion within torque limits and limits on the tool.

    minimise    sum h
    subject to, on each step of duration h that all joints share, with jerk (a+ - a) / h,
        v+ = v + h (a + a+) / 2                                                     (1)
        q+ = q + h v + h^2 (2 a + a+) / 6                                           (2)
        |a+ - a| <= J h                                                             (3)
        v, a at nodes and v + h a / 2 within the limits                             (4)

and, where torques and the tool point p are limited,

        |M(q) a + C(q, v) v + g(q) + D v| <= (1 - margin) limit   at nodes, and in the middle    (5)
        |J(q) v|^2 <= speed^2   at nodes, and at ``TOOL`` between them                    (6)
        |p(q) - p(w)|^2 <= r^2   at waypoints w with a ball                              (7)

(4) bounds the Bernstein coefficients of the velocity. Elsewhere torques may exceed (5), and speeds (6):
``search`` looks there, raises the margins and lowers the speeds. Positions within limits are posed on Bernstein
coefficients too. Joints without a jerk limit have no (3); their accelerations are continuous here, which costs
little time on fine steps. All demands that are linear (zones, windows, times, states at the ends, cycles) are
bounds or linear rows.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import casadi
import numpy as np

from formulations.deadlines import NEVER, Deadline
from formulations.deadlines.ipopt import StoppableIpopt
from formulations.dynamics import ArmDynamics
from formulations.dynamics.symbolic import symbolic_torques
from formulations.optima.shared_steps.steps import Steps
from formulations.optima.shared_steps.tool_symbols import point_function, square_speed
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands

_OPTIONS: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.tol": 1e-8,
    "ipopt.max_iter": 300,
    "ipopt.mu_strategy": "adaptive",
    "error_on_fail": False,
    "show_eval_warnings": False,
}
_SHORTEST = 1e-4  # of the mean step: the least duration of a step
_UNEVEN = 2.0  # how much longer or shorter than the mean of its segment a step may be
TOOL = (1.0 / 3.0, 2.0 / 3.0)  # of a step
_RAISED = 0.9
_INSIDE = 1e-9  # share by which limits are lowered: the tolerance of the solver


class StepProgram:
    """The program of one problem on M steps per segment.

    Attributes
    ----------
    margins : Array, shape (dof, S M + 1)
        Shares of the torque limits that are left unused at the nodes and next to them.
    speeds : Array, shape (S M,)
        Limits of the tool's speed on the steps [m/s].
    """

    def __init__(
        self,
        demands: Demands,
        dynamics: ArmDynamics | None,
        start: Steps,
        *,
        smoothest: bool = False,
    ) -> None:
        """Pose the program.

        Parameters
        ----------
        demands : Demands
        dynamics : ArmDynamics or None
            None without torque limits.
        start : Steps
            Its number of steps is taken, and its times are the units.
        smoothest : bool
            Whether the smoothest motion is asked for, as where the total time is given.
        """
        self.demands, self.dynamics, self.start = demands, dynamics, start
        low, high = demands.passages[-1]
        self.smoothest = smoothest or bool(np.isfinite(high) and low == high)
        self.S, self.M = start.durations.shape
        self.dof = start.states.shape[2]
        self.second = float(start.durations.sum()) / self.S
        self.units = self._units()
        self.margins = np.zeros((self.dof, self.S * self.M + 1))
        self.speeds = np.repeat(demands.tool_speed, self.M)
        self._rows: list[tuple[Any, Array, Array]] = []
        self._pose()

    def _units(self) -> Array:
        """Units of position, velocity and acceleration, (3, dof)."""
        velocity = np.abs(self.demands.velocity).max(axis=(0, 2))
        steepest = np.abs(self.demands.acceleration).max(axis=(0, 2))
        reached = np.abs(self.start.states[2]).max(axis=0)
        a = np.where(np.isfinite(steepest), steepest, np.maximum(reached, velocity / self.second))
        return np.stack([velocity * self.second, velocity, a])

    def _row(self, expression: Any, low: Any, high: Any) -> None:
        column = casadi.densify(casadi.vec(expression))
        n = column.numel()
        sides = [np.broadcast_to(np.ravel(side, order="F"), n).astype(float) for side in (low, high)]
        self._rows.append((column, sides[0], sides[1]))

    def _pose(self) -> None:
        S, M, dof, asked = self.S, self.M, self.dof, self.demands
        N, (unit, rate, gain) = S * M, self.units
        h = casadi.MX.sym("h", 1, N)
        q, v, a = (casadi.MX.sym(name, dof, N + 1) for name in "qva")
        self._symbols = casadi.veccat(h, q, v, a)
        rows = np.repeat(np.arange(S), M)
        H = casadi.repmat(h, dof, 1)
        v0, v1, a0, a1 = v[:, :-1], v[:, 1:], a[:, :-1], a[:, 1:]
        speed_up = casadi.repmat(casadi.DM(gain * self.second / rate), 1, N)  # what h a adds to v
        self._row(v1 - v0 - H * speed_up * (a0 + a1) / 2.0, 0.0, 0.0)  # (1)
        steps = H * v0 + H**2 * speed_up * (2.0 * a0 + a1) / 6.0
        self._row(q[:, 1:] - q[:, :-1] - steps, 0.0, 0.0)  # (2)
        jerk = asked.jerk[rows].T * (self.second / gain)[:, None] * (1.0 - _INSIDE)
        limited = np.flatnonzero(np.isfinite(jerk).all(axis=1)).tolist()
        if limited:
            most = casadi.DM(jerk[limited]) * H[limited, :]
            change = (a1 - a0)[limited, :]
            self._row(most - change, 0.0, np.inf)  # (3)
            self._row(most + change, 0.0, np.inf)
        velocity = asked.velocity[rows].transpose(2, 1, 0) / rate[None, :, None] * (1.0 - _INSIDE)
        self._row(v0 + H * speed_up * a0 / 2.0, *velocity)  # (4)
        bounded = asked.problem.limits.has_position or np.isfinite(asked.position).any()
        if bounded:
            room = asked.position[rows].transpose(2, 1, 0) / unit[None, :, None]
            self._row(q[:, :-1] + H * v0 / 3.0, *room)
            self._row(q[:, 1:] - H * v1 / 3.0, *room)
        scales = [casadi.repmat(casadi.DM(one), 1, N + 1) for one in (unit, rate, gain)]

        def inside(u: float, n: int) -> tuple[Any, ...]:
            """States at the share u of each step, in SI; at all n nodes for u = 0."""
            if not u:
                states = [q, v, a]
            else:
                gain, change = H * speed_up, a1 - a0
                states = [
                    q[:, :-1] + H * u * (v0 + u * gain * (a0 / 2.0 + u * change / 6.0)),
                    v0 + u * gain * (a0 + u * change / 2.0),
                    a0 + u * change,
                ]
            return tuple(x * scale[:, :n] for x, scale in zip(states, scales, strict=True))

        self._motors(q * scales[0], inside)
        self._tool(q * scales[0], inside)
        if asked.cyclic:
            for one in (q, v, a):
                self._row(one[:, 0] - one[:, N], 0.0, 0.0)
        self._times(h)
        even = casadi.reshape(h, M, S)
        self._uneven = self._n_rows  # these rows are opened once even steps are solved
        self._row(even[1:, :] - even[:-1, :], 0.0, 0.0)
        cost = casadi.sum2(h)
        if self.smoothest:
            cost = casadi.sum1(casadi.vec((a1 - a0) ** 2 / H))
        rows_of_all = casadi.vertcat(*(column for column, _, _ in self._rows))
        self._nlp = {"x": self._symbols, "p": casadi.MX(0, 1), "f": cost, "g": rows_of_all}
        self._low, self._high = self._bounds()

    @property
    def _n_rows(self) -> int:
        return sum(column.numel() for column, _, _ in self._rows)

    def _motors(self, q: Any, inside: Callable[[float, int], tuple[Any, ...]]) -> None:
        """Rows (5), whose bounds follow ``margins``; q: positions at the nodes (dof, N + 1) [rad]."""
        self._torques, N, asked = self._n_rows, self.S * self.M, self.demands
        if self.dynamics is None:
            return
        torques = symbolic_torques(self.dynamics)
        for u, n in ((0.0, N + 1), (0.5, N)):
            self._row(torques.map(n)(*inside(u, n)), -1.0, 1.0)
        stops = np.flatnonzero(asked.stops & np.ptp(asked.waypoints, axis=2).any(axis=1))
        if len(stops):  # where the arm stands still in a zone it holds its weight
            still = casadi.DM.zeros(self.dof, len(stops))
            self._row(torques.map(len(stops))(q[:, (stops * self.M).tolist()], still, still), -1.0, 1.0)

    def _tool(self, q: Any, inside: Callable[[float, int], tuple[Any, ...]]) -> None:
        """Rows (6), whose bounds follow ``speeds``, and (7); q: positions at the nodes (dof, N + 1) [rad]."""
        asked, chain = self.demands, self.demands.problem.tool
        self._speeds = self._n_rows
        if np.isfinite(self.speeds).any():
            assert chain is not None
            speed = square_speed(chain)
            for u in (0.0, *TOOL):
                limits = _at(u, self.speeds)
                there = np.flatnonzero(np.isfinite(limits))
                q_u, v_u, _ = (x[:, there.tolist()] for x in inside(u, len(limits)))
                squares = speed.map(len(there))(q_u, v_u)
                self._row(squares / casadi.DM(limits[there] ** 2).T, -np.inf, 1.0)
        for k in np.flatnonzero(np.isfinite(asked.tool_radius)).tolist():
            assert chain is not None
            point = point_function(chain)
            off = point(q[:, k * self.M]) - point(casadi.DM(asked.problem.waypoints[k]))
            radius = float(asked.tool_radius[k]) * (1.0 - 1e-7)
            self._row(casadi.sumsqr(off) / radius**2, -np.inf, 1.0)

    def _allowed(self) -> Array:
        """Upper bounds of rows (6): squares of what is left of the limits."""
        asked, shares = np.repeat(self.demands.tool_speed, self.M), (0.0, *TOOL)
        now, most = (np.concatenate([_at(u, one) for u in shares]) for one in (self.speeds, asked))
        limited = np.isfinite(most)
        return np.asarray((now[limited] / most[limited]) ** 2)

    def _times(self, h: Any) -> None:
        """Rows on the times of segments and of arrivals."""
        asked, M = self.demands, self.M
        passed = np.concatenate([[0.0], np.cumsum(asked.waits[:-1])])  # waits before each arrival
        for k in range(self.S):
            low, high = asked.durations[k] / self.second
            if low > 0.0 or np.isfinite(high):
                self._row(casadi.sum2(h[k * M : (k + 1) * M]), low, high)
            low, high = (asked.passages[k + 1] - passed[k + 1]) / self.second
            if low > 0.0 or np.isfinite(high):
                self._row(casadi.sum2(h[: (k + 1) * M]), low, high)

    def _bounds(self) -> tuple[Array, Array]:
        """Bounds of the variables: steps, then positions, velocities and accelerations at nodes."""
        S, M, asked = self.S, self.M, self.demands
        shortest = _SHORTEST * self.start.durations.mean() / self.second
        found = []
        for side, worst in ((0, np.maximum), (1, np.minimum)):
            before, after = (
                np.r_[0, np.repeat(np.arange(S), M)],
                np.r_[np.repeat(np.arange(S), M), S - 1],
            )
            states = np.stack(
                [
                    worst(given[before, :, side], given[after, :, side])
                    for given in (asked.position, asked.velocity, asked.acceleration)
                ]
            )
            states[1:] *= 1.0 - _INSIDE
            states[0, ::M] = asked.waypoints[..., side]
            stiff = np.isfinite(asked.jerk).all(axis=0)
            if not asked.cyclic:
                states[1, [0, -1]] = asked.end_velocity[..., side]
                states[2][[0, -1]] = np.where(
                    stiff, asked.end_acceleration[..., side], states[2][[0, -1]]
                )
            for k in np.flatnonzero(asked.stops):
                states[1, k * M] = 0.0
                states[2, k * M] = np.where(stiff, 0.0, states[2, k * M])
            steps = np.full(S * M, (shortest, np.inf)[side])
            found.append(np.concatenate([steps, (states / self.units[:, None]).ravel()]))
        return found[0], found[1]

    def lower(self, factors: Array) -> None:
        """Lower the tool's speed where it is too fast between the samples of (6).

        What was lowered too far is raised again, by a tenth at most.

        Parameters
        ----------
        factors : Array, shape (S M,)
            Speed over limit on the steps.
        """
        asked = np.repeat(self.demands.tool_speed, self.M)
        self.speeds = np.minimum(asked, self.speeds / np.maximum(factors, _RAISED))

    def solve(
        self, start: Steps, *, even: bool, fixed: bool = False, deadline: Deadline = NEVER
    ) -> tuple[Steps, bool, str]:
        """Solve the program with the margins at hand.

        Parameters
        ----------
        start : Steps
            Of this program's shape.
        even : bool
            Whether all steps of a segment last equally long.
        fixed : bool
            Whether all steps last as long as those of the start.
        deadline : Deadline
            How long IPOPT may take.

        Returns
        -------
        found : Steps
        converged : bool
        status : str
            How IPOPT says it ended, in lower case.
        """
        x = np.concatenate(
            [start.durations.ravel() / self.second, (start.states / self.units[:, None]).ravel()]
        )
        low, high = (np.concatenate([row[side] for row in self._rows]) for side in (1, 2))
        between = np.maximum(self.margins[:, 1:], self.margins[:, :-1])
        room = 1.0 - np.concatenate([self.margins, between], axis=1).ravel(order="F")
        if self.dynamics is not None:
            torques = slice(self._torques, self._torques + len(room))
            low[torques], high[torques] = -room, room
        allowed = self._allowed()
        high[self._speeds : self._speeds + len(allowed)] = allowed
        x_low, x_high = self._low.copy(), self._high.copy()
        if not even:
            n = self.S * (self.M - 1)
            low[self._uneven : self._uneven + n] = -np.inf
            high[self._uneven : self._uneven + n] = np.inf
            given = start.durations / self.second
            mean = np.broadcast_to(given.mean(axis=1, keepdims=True), given.shape)
            low_h, high_h = (given, given) if fixed else (mean / _UNEVEN, mean * _UNEVEN)
            x_low[: given.size] = (
                low_h.ravel() if fixed else np.maximum(low_h.ravel(), x_low[: given.size])
            )
            x_high[: given.size] = high_h.ravel()
        answer = self._solver.solve(
            deadline,
            x0=np.clip(x, x_low, x_high),
            lbx=x_low,
            ubx=x_high,
            lbg=low,
            ubg=high,
        )
        if answer is None:
            return start, False, "stopped at the deadline"
        found, stats = answer
        point = np.asarray(found["x"]).ravel()
        status = str(stats["return_status"]).replace("_", " ").lower()
        return self._steps(point), bool(stats["success"]), status

    @cached_property
    def _solver(self) -> StoppableIpopt:
        return StoppableIpopt("steps", self._nlp, _OPTIONS)

    def _steps(self, x: Array) -> Steps:
        n = self.S * self.M
        states = x[n:].reshape(3, n + 1, self.dof) * self.units[:, None]
        return Steps(np.maximum(x[:n], 1e-12).reshape(self.S, self.M) * self.second, states)


def _at(share: float, speeds: Array) -> Array:
    """Limits (S M,) of steps at a share of them; at all nodes, (S M + 1,), for 0."""
    if share:
        return speeds
    edge = [np.inf]
    return np.asarray(np.minimum(np.concatenate([edge, speeds]), np.concatenate([speeds, edge])))
