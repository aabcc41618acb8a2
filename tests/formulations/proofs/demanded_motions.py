"""Random motions, and demands that they keep because they are read off from what the motions do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Array = np.ndarray
ENDS = ("rest", "given", "free", "arrive moving", "steady", "cyclic")
_FACTORIALS = np.array([[1.0, 1.0, 0.5, 1.0 / 6.0], [0.0, 1.0, 1.0, 0.5], [0.0, 0.0, 1.0, 1.0]])


@dataclass
class PiecewiseMotion:
    """Pieces of constant jerk, or of constant acceleration that jumps between them.

    knots: (m + 1,) [s]; states: (m, dof, 4), position, velocity, acceleration and jerk where a piece begins.
    """

    knots: Array
    states: Array

    def at(self, piece: int, t: float) -> Array:
        """Position, velocity and acceleration (dof, 3) at a time of a piece, counted from its start."""
        x, v, a, j = self.states[piece].T
        return np.stack(
            [x + v * t + a * t**2 / 2 + j * t**3 / 6, v + a * t + j * t**2 / 2, a + j * t], axis=1
        )

    def range(self, first: int, last: int, order: int) -> Array:
        """Least and greatest value (dof, 2) of a derivative over the pieces first .. last - 1."""
        values = []
        for piece in range(first, last):
            h = self.knots[piece + 1] - self.knots[piece]
            for joint, state in enumerate(self.states[piece]):
                c = np.array([state[k] / [1, 1, 2, 6][k] for k in range(4)])
                p = np.polynomial.Polynomial(c).deriv(order) if order else np.polynomial.Polynomial(c)
                roots = p.deriv().roots()
                real = roots[np.isreal(roots)].real
                t = np.concatenate([[0.0, h], real[(real > 0.0) & (real < h)]])
                values.append((joint, p(t).min(), p(t).max()))
        dof = self.states.shape[1]
        return np.array(
            [
                [min(lo for j, lo, _ in values if j == i), max(hi for j, _, hi in values if j == i)]
                for i in range(dof)
            ]
        )


@dataclass
class Scenario:
    """A motion and the demands that it keeps.

    demands: the arrays of a certificate. arrivals, leavings: (n + 1,) [s]. states: (n + 1, dof, 3) at the
    arrivals.
    """

    demands: dict[str, Any]
    arrivals: Array
    leavings: Array
    states: Array


def scenario(
    rng: np.random.Generator, ends: str, *, n: int = 4, dof: int = 2, times: str = "some"
) -> Scenario:
    """Make a random motion with the given ends, and demands that hold it; times: some, none or all."""
    jerky = rng.random(dof) < 0.8
    waits = np.where(rng.random(n + 1) < 0.2, rng.uniform(0.1, 0.6, n + 1), 0.0)
    waits[[0, -1]] = 0.0
    # two waypoints at one time, where the motion does not wait
    at_once = (rng.random(n) < 0.15) & (waits[:-1] == 0.0)
    at_once[-1] &= ends != "cyclic"  # rounding puts the last waypoint elsewhere
    pieces = np.where(at_once, 0, rng.integers(1, 4, n))
    pieces[0] = max(pieces[0], 9 - pieces[1:].sum())
    lengths: list[float] = []
    still: list[bool] = []
    arrive, leave = [0], [0]
    for k in range(n):
        size = 10.0 ** rng.uniform(-1.0, 0.3)
        lengths += [size * x for x in rng.uniform(0.2, 1.0, pieces[k])]
        still += [False] * pieces[k]
        arrive.append(len(lengths))
        if waits[k + 1]:
            lengths.append(waits[k + 1])
            still.append(True)
        leave.append(len(lengths))
    h = np.array(lengths)
    stops = (waits > 0.0) | ((rng.random(n + 1) < 0.1) & (np.arange(n + 1) % n > 0))
    states = np.zeros((len(h), dof, 4))
    for j in range(dof):
        states[:, j] = _joint(rng, h, still, [arrive[i] for i in np.flatnonzero(stops)], ends, jerky[j])
    motion = PiecewiseMotion(np.concatenate([[0.0], np.cumsum(h)]), states)
    there = [motion.at(i, 0.0) if i < len(h) else motion.at(len(h) - 1, h[-1]) for i in arrive]
    demands = _demands(rng, motion, arrive, leave, np.array(there), jerky, ends)
    demands |= {"waits": waits, "stops": [bool(x) for x in stops]}
    if ends == "rest":
        demands["stops"][0] = demands["stops"][-1] = True
    if times == "none":
        demands["durations"][:], demands["passages"][1:] = (0.0, np.inf), (0.0, np.inf)
    if times == "all":
        T = (motion.knots[arrive][1:] - motion.knots[leave][:-1])[:, None]
        demands["durations"] = np.where(T > 0.0, T * (1.0 + np.array([-1e-9, 1e-9])), [0.0, np.inf])
    return Scenario(demands, motion.knots[arrive], motion.knots[leave], np.array(there))


def _joint(
    rng: np.random.Generator, h: Array, still: list[bool], stops: list[int], ends: str, jerky: bool
) -> Array:
    """States (m, 4) of one joint: a random motion made to keep what is linear in it."""
    m, order = len(h), 3 if jerky else 2
    state = np.zeros((m + 1, 3, order + m))  # a linear function of the start and of what is constant
    state[0, :order, :order] = np.eye(order)
    conditions = []
    for i in range(m):
        x, v, a = state[i].copy()
        top = np.zeros(order + m)
        top[order + i] = 1.0
        jerk = top if jerky else 0.0 * top
        a = a if jerky else top
        if not jerky:
            state[i, 2] = top
        state[i + 1] = [
            x + v * h[i] + a * h[i] ** 2 / 2 + jerk * h[i] ** 3 / 6,
            v + a * h[i] + jerk * h[i] ** 2 / 2,
            a + jerk * h[i],
        ]
        if still[i]:
            conditions += [v, state[i, 2], top]
    levels = (1, 2) if jerky else (1,)
    for i in stops:
        conditions += [state[i, level] for level in levels]
    if ends == "rest":
        conditions += [state[i, level] for i in (0, m) for level in levels]
    elif ends == "arrive moving":
        conditions += [state[0, level] for level in levels]
    elif ends == "steady" and jerky:
        conditions += [state[0, 2], state[m, 2]]
    elif ends == "cyclic":
        conditions += [state[m, level] - state[0, level] for level in (0, *levels)]
    scale = np.concatenate([[1.0, 1.0, 3.0][:order], np.full(m, 10.0 if jerky else 3.0)])
    y = rng.normal(size=order + m) * scale
    if rng.random() < 0.3:
        y[order:] = np.sign(y[order:]) * scale[order:]  # at its limit all the time
    if conditions:
        C = np.array(conditions)
        y -= np.linalg.pinv(C, rcond=1e-10) @ (C @ y)
    found = np.zeros((m, 4))
    found[:, :3] = (state[:-1] @ y)[:, :3]
    if jerky:
        found[:, 3] = y[order:]
    else:
        found[:, 2] = y[order:]
    return found


def _demands(
    rng: np.random.Generator,
    motion: PiecewiseMotion,
    arrive: list[int],
    leave: list[int],
    there: Array,
    jerky: Array,
    ends: str,
) -> dict[str, Any]:
    """Limits from the extremes of each segment, zones and times around what the motion does."""
    n, dof = len(arrive) - 1, there.shape[1]
    spans = [(leave[k], max(arrive[k + 1], leave[k] + 1)) for k in range(n)]
    spans = [(min(a, len(motion.states) - 1), min(b, len(motion.states))) for a, b in spans]
    velocity, acceleration, position = (
        np.stack([motion.range(a, b, order) for a, b in spans]) for order in (1, 2, 0)
    )
    jerk = np.stack([np.abs(motion.states[a:b, :, 3]).max(axis=0) for a, b in spans])
    inside = np.array([-1e-2, 1e-2])
    uniform = rng.random() < 0.4

    low_high = []
    for values in (velocity, acceleration):
        if uniform:
            values = np.broadcast_to(
                np.stack([values[..., 0].min(axis=0), values[..., 1].max(axis=0)], axis=-1),
                values.shape,
            )
        values = np.stack(
            [np.minimum(values[..., 0], inside[0]), np.maximum(values[..., 1], inside[1])], axis=-1
        )
        low_high.append(values * rng.choice([1.0, 1.0, 1.3], values.shape))
    velocity, acceleration = low_high
    acceleration[:, jerky & (rng.random(dof) < 0.3)] = (-np.inf, np.inf)
    jerk = np.maximum(jerk.max(axis=0) if uniform else jerk, 1e-2) * rng.choice([1.0, 1.3], (n, dof))
    jerk[:, ~jerky] = np.inf
    zones = rng.random((n + 1, dof, 2)) * rng.choice([0.0, 0.03, 0.4], (n + 1, 1, 1))
    waypoints = there[..., :1] + zones * (-1.0, 1.0)
    if ends == "cyclic":
        waypoints[-1] = waypoints[0]
        there[-1] = there[0]
    position = np.where(rng.random((n, dof, 2)) < 0.5, position, [-np.inf, np.inf])
    whole = np.stack([velocity[[0, -1]], acceleration[[0, -1]]])  # (2 orders, 2 ends, dof, 2)
    given = {"rest": (1, 1), "given": (1, 1), "free": (0, 0), "arrive moving": (1, 0), "cyclic": (0, 0)}
    for end in (0, 1):
        state = there[-end][:, 1:]
        for order in (0, 1):
            if given.get(ends, (0, 0))[end] or (ends == "steady" and order == 1):
                value = state[:, order] if order == 0 else np.where(jerky, state[:, order], 0.0)
                if ends in ("rest", "steady") or (ends == "arrive moving" and end == 0):
                    value = np.where(np.abs(value) < 1e-9, 0.0, value)
                whole[order, end] = np.clip(value, *whole[order, end].T)[:, None]  # rounding aside
    durations = np.tile([0.0, np.inf], (n, 1))
    passages = np.tile([0.0, np.inf], (n + 1, 1))
    times = motion.knots[arrive]
    T = times[1:] - motion.knots[leave][:-1]
    for k in range(n):
        if T[k] > 0.0 and rng.random() < 0.3:
            durations[k] = T[k] * rng.choice([0.0, 0.9, 1.0]), T[k] * rng.choice([1.0, 1.1, np.inf])
        if rng.random() < 0.3:
            passages[k + 1] = times[k + 1] * np.array([rng.choice([0.9, 1.0]), rng.choice([1.0, 1.2])])
    passages[0] = 0.0
    return {
        "waypoints": waypoints,
        "velocity": velocity,
        "acceleration": acceleration,
        "jerk": jerk,
        "position": position,
        "end_velocity": whole[0],
        "end_acceleration": whole[1],
        "durations": durations,
        "passages": passages,
        "cyclic": ends == "cyclic",
    }
