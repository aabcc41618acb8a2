"""Random problems under each kind of condition."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from formulations import Conditions, Limits, Problem
from formulations.problem.arrays import Array


@dataclass(frozen=True)
class Drawn:
    """A random problem to which a condition is added."""

    rng: np.random.Generator
    waypoints: Array
    velocity: Array
    acceleration: Array
    jerk: Any

    @property
    def dof(self) -> int:
        """Number of joints."""
        return int(self.waypoints.shape[1])

    @property
    def last(self) -> int:
        """Number of the last waypoint."""
        return len(self.waypoints) - 1

    def inner(self) -> int:
        """Draw an inner waypoint."""
        return int(self.rng.integers(1, self.last))

    def limits(self, share: float = 1.0) -> Limits:
        """Return the limits, velocity and acceleration times a share.

        Parameters
        ----------
        share : float

        Returns
        -------
        Limits
        """
        return Limits.of(share * self.velocity, share * self.acceleration, self.jerk, dof=self.dof)

    def problem(self, conditions: Conditions, limits: Limits | None = None) -> Problem:
        """Return the problem under a condition.

        Parameters
        ----------
        conditions : Conditions
        limits : Limits, optional
            In place of those drawn.

        Returns
        -------
        Problem
        """
        return Problem(self.waypoints, limits or self.limits(), conditions=conditions)


def _zones(d: Drawn) -> Problem:
    zones = {k: d.rng.uniform(0.02, 0.3, d.dof) for k in range(1, d.last + 1)}
    return d.problem(Conditions(tolerance=zones))


def _window(d: Drawn) -> Problem:
    early = d.rng.uniform(0.5, 6.0)
    waypoint = int(d.rng.integers(1, d.last + 1))
    return d.problem(Conditions(windows={waypoint: (early, 20.0 + early)}))


def _least_time(d: Drawn) -> Problem:
    segment = int(d.rng.integers(0, d.last))
    return d.problem(Conditions(segment_times={segment: (d.rng.uniform(0.5, 3.0), np.inf)}))


def _wait(d: Drawn) -> Problem:
    return d.problem(Conditions(waits={d.inner(): float(d.rng.uniform(0.1, 1.0))}))


def _cycle(d: Drawn) -> Problem:
    d.waypoints[-1] = d.waypoints[0]
    return d.problem(Conditions(cyclic=True))


def _given_ends(d: Drawn) -> Problem:
    start, end = (d.rng.uniform(-0.5, 0.5, d.dof) * d.velocity for _ in range(2))
    return d.problem(Conditions(start_velocity=start, end_velocity=end))


def _free_end(d: Drawn) -> Problem:
    return d.problem(Conditions(end_velocity="free", end_acceleration="free"))


def _segment_limits(d: Drawn) -> Problem:
    segment, share = int(d.rng.integers(0, d.last)), d.rng.uniform(0.2, 1.0)
    return d.problem(Conditions(segment_limits={segment: d.limits(share)}))


def _two_directions(d: Drawn) -> Problem:
    pairs = [
        np.stack([-limit * d.rng.uniform(0.3, 1.0, d.dof), limit], axis=1)
        for limit in (d.velocity, d.acceleration)
    ]
    limits = Limits.of(pairs[0], pairs[1], d.jerk, dof=d.dof)
    return d.problem(Conditions(), limits)


KINDS: dict[str, Callable[[Drawn], Problem]] = {
    "zones": _zones,
    "window": _window,
    "least time": _least_time,
    "wait": _wait,
    "cycle": _cycle,
    "given ends": _given_ends,
    "free end": _free_end,
    "segment limits": _segment_limits,
    "two directions": _two_directions,
}


def drawn_problem(kind: str, seed: int) -> Problem:
    """Draw a problem under a condition.

    Parameters
    ----------
    kind : str
        A key of ``KINDS``.
    seed : int
        The same seed draws the same problem.

    Returns
    -------
    Problem
    """
    rng = np.random.default_rng(seed)
    waypoints = rng.uniform(-1.5, 1.5, (int(rng.integers(3, 6)), int(rng.integers(1, 4))))
    dof = waypoints.shape[1]
    jerk = rng.uniform(10.0, 60.0, dof) if rng.random() < 0.8 else np.inf
    velocity, acceleration = (
        np.asarray(rng.uniform(1.0, 3.0, dof)),
        np.asarray(rng.uniform(2.0, 8.0, dof)),
    )
    return KINDS[kind](Drawn(rng, waypoints, velocity, acceleration, jerk))
