"""The greatest torque of every joint over a whole motion, between samples too, by branch and bound.

A torque is evaluated at both ends of a span of time. In between it lies within h^2/8 max |tau''| of the
straight line through the two values, where ``growth`` bounds the second derivative. Spans in which this bound
is above the greatest torque found by more than ``RESOLUTION`` of the limit are halved. So the motion reaches
the torque that is reported, and nowhere exceeds it by more than ``RESOLUTION`` of the limit.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np

from formulations.dynamics.growth import ORDERS, growth
from formulations.dynamics.model import ArmDynamics, dynamics_of
from formulations.motion.peaks import Peak
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array, Indices
from formulations.problem.problem import Problem
from formulations.problem.torque import TorqueLimits

RESOLUTION = 1e-6  # of the limit: torques are judged to this accuracy
_MOST_SPANS = 3_000_000  # more are not opened; the bound of what is left is the answer
_BLOCK = 20_000  # spans that are looked at together


@dataclass(frozen=True)
class TorqueExtremes:
    """What the torques of a motion reach.

    Attributes
    ----------
    greatest : Array, shape (dof,)
        Modulus of each torque [N m]. The motion reaches it, and nowhere exceeds it by more than
        ``RESOLUTION`` of the limit.
    reached : Array, shape (dof,)
        The same with its sign, as it was evaluated [N m].
    times : Array, shape (dof,)
        When that was [s].
    stretch : Array, shape (dof,)
        Least factor on all durations with which every torque that was evaluated keeps its limit; infinite
        where the weight of the arm alone is over the limit.
    """

    greatest: Array
    reached: Array
    times: Array
    stretch: Array


def torque_peaks(problem: Problem, trajectory: Trajectory, torque: TorqueLimits) -> list[Peak]:
    """Find the greatest torque of every joint, as the check reports it.

    Parameters
    ----------
    problem : Problem
        Names the joints.
    trajectory : Trajectory
        The motion.
    torque : TorqueLimits

    Returns
    -------
    list of Peak
        One for each joint, with the quantity "torque"; dry friction is part of the value.
    """
    dynamics = dynamics_of(torque)
    found = torque_extremes(dynamics, trajectory)
    passages = trajectory.passage_times
    segments = np.clip(np.searchsorted(passages, found.times) - 1, 0, max(len(passages) - 2, 0))
    values = found.greatest + dynamics.friction
    return [
        Peak(
            "torque",
            joint,
            int(segments[joint]),
            float(found.times[joint]),
            float(np.copysign(values[joint], found.reached[joint])),
            float(limit),
            float(values[joint] / limit),
            float(found.stretch[joint]),
            problem.names[joint] if problem.names else "",
            problem.units[joint],
            problem.display_unit,
        )
        for joint, limit in enumerate(dynamics.limits)
    ]


def torque_extremes(dynamics: ArmDynamics, trajectory: Trajectory) -> TorqueExtremes:
    """Bound the torques of a motion between samples too.

    Parameters
    ----------
    dynamics : ArmDynamics
    trajectory : Trajectory
        The motion of the same joints.

    Returns
    -------
    TorqueExtremes
    """
    search = _Search(dynamics, trajectory)
    search.run()
    # the second is the greater one only where too many spans were left
    greatest = np.maximum(np.abs(search.reached), search.upper - RESOLUTION * dynamics.available)
    return TorqueExtremes(greatest, search.reached, search.times, search.stretch)


class _Search:
    """Spans of time that may hold the greatest torque of a joint."""

    def __init__(self, dynamics: ArmDynamics, trajectory: Trajectory) -> None:
        self.dynamics = dynamics
        # every derivative of each piece as a polynomial of local time, (n_pieces, dof, degree + 1 - order)
        self.derivatives = [trajectory.coefficients]
        while len(self.derivatives) < max(ORDERS, trajectory.coefficients.shape[-1]):
            last = self.derivatives[-1]
            self.derivatives.append(last[..., 1:] * np.arange(1, last.shape[-1]))
        self.starts, self.durations = trajectory.breaks[:-1], trajectory.durations
        self.reached, self.times, self.stretch, self.upper = np.zeros((4, dynamics.dof))
        self.opened = 0

    def run(self) -> None:
        """Halve spans until none can hold a torque that is greater than those found."""
        pieces = np.arange(len(self.durations))
        spans = np.stack([np.zeros(len(pieces)), self.durations], axis=1)
        torques = np.stack([self._torques(pieces, spans[:, end]) for end in (0, 1)], axis=1)
        while len(pieces):
            blocks = np.split(np.arange(len(pieces)), range(_BLOCK, len(pieces), _BLOCK))
            bounds = np.concatenate([self._bounds(pieces[i], spans[i], torques[i]) for i in blocks])
            allowed = np.abs(self.reached) + RESOLUTION * self.dynamics.available
            halve = np.asarray((bounds > allowed).any(axis=1))
            self.opened += 2 * int(halve.sum())
            if self.opened > _MOST_SPANS:
                halve = np.zeros_like(halve)
            self.upper = np.maximum(self.upper, bounds[~halve].max(axis=0, initial=0.0))
            pieces, spans, torques = self._halved(pieces[halve], spans[halve], torques[halve])

    def _bounds(self, pieces: Indices, spans: Array, torques: Array) -> Array:
        """Upper bounds on the moduli of the torques on spans, (n, dof)."""
        length = spans[:, 1] - spans[:, 0]
        bend = growth(self.dynamics, self._reach(pieces, spans))
        return np.asarray(np.abs(torques).max(axis=1) + length[:, None] ** 2 / 8.0 * bend)

    def _halved(self, pieces: Indices, spans: Array, torques: Array) -> tuple[Indices, Array, Array]:
        middles = spans.mean(axis=1)
        between = self._torques(pieces, middles)
        halves = [
            np.stack([spans[:, 0], middles], axis=1),
            np.stack([middles, spans[:, 1]], axis=1),
        ]
        ends = [
            np.stack([torques[:, 0], between], axis=1),
            np.stack([between, torques[:, 1]], axis=1),
        ]
        return np.concatenate([pieces, pieces]), np.concatenate(halves), np.concatenate(ends)

    def _torques(self, pieces: Indices, local: Array) -> Array:
        """Torques at local times of pieces, (n, dof); the greatest are remembered."""
        if not len(pieces):
            return np.zeros((0, self.dynamics.dof))
        q, v, a = (_values(self.derivatives[order][pieces], local) for order in range(3))
        found = self.dynamics.torques(q, v, a)
        size = np.abs(found)
        for joint, row in enumerate(size.argmax(axis=0)):
            if size[row, joint] > abs(self.reached[joint]):
                self.reached[joint] = found[row, joint]
                self.times[joint] = self.starts[pieces[row]] + local[row]
        held = self.dynamics.holding(q)
        damped = self.dynamics.damping * v
        needed = stretch_of(held, damped, found - held - damped, self.dynamics.available)
        self.stretch = np.maximum(self.stretch, needed.max(axis=0))
        return found

    def _reach(self, pieces: Indices, spans: Array) -> Array:
        """Greatest moduli of position to fourth derivative on spans, (5, n, dof), by Taylor's formula."""
        middles, half = spans.mean(axis=1), (spans[:, 1] - spans[:, 0])[:, None] / 2.0
        at = [np.abs(_values(derivative[pieces], middles)) for derivative in self.derivatives]
        found = np.zeros((ORDERS, *at[0].shape))
        for order in range(ORDERS):
            for k in range(order, len(at)):
                found[order] += at[k] * half ** (k - order) / factorial(k - order)
        return found


def _values(polynomials: Array, points: Array) -> Array:
    """Values of polynomials (n, dof, k) at a point each (n,): (n, dof)."""
    found = np.zeros(polynomials.shape[:2])
    for k in range(polynomials.shape[-1] - 1, -1, -1):
        found = found * points[:, None] + polynomials[..., k]
    return found


def stretch_of(held: Array, damped: Array, driven: Array, available: Array) -> Array:
    """Find the least factor on all durations that keeps the limits at samples.

    Slowed down by s, a torque is held + damped / s + driven / s^2.

    Parameters
    ----------
    held, damped, driven : Array, shape (..., dof)
        Torques of the weight, of the damping, and of all that changes with the square of the speed [N m].
    available : Array, shape (dof,)
        Limits less friction [N m].

    Returns
    -------
    Array, shape (..., dof)
        0 where no speed is too much; infinite where the weight alone is.
    """
    least = np.full(np.shape(held), np.inf)  # the least speed 1 / s at which a limit is met
    for limit in (available, -available):
        excess = held - limit
        # a limit may be infinite
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            root = np.sqrt(np.maximum(damped**2 - 4.0 * driven * excess, 0.0))
            real = damped**2 >= 4.0 * driven * excess
            h = -0.5 * (damped + np.copysign(root, damped))
            for speed in (h / driven, excess / h):
                least = np.where(real & (speed > 0.0) & (speed < least), speed, least)
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(np.abs(held) >= available, np.inf, 1.0 / least))
