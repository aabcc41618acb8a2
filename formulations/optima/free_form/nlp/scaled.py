"""The numbers of one problem in the units of its program: bounds of variables and rows, parameters."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from formulations.optima.free_form.nlp.assembly import least_times
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.problem.arrays import Array, Truths

POSITION_MARGIN = 1e-9  # rad per (1 + |waypoints|) that solutions stay inside the position limits


class Place(NamedTuple):
    """Where rows (6) are posed: one joint on one segment.

    Attributes
    ----------
    order : int
        Of the joint.
    member : int
        Number of the joint in the group of its order.
    segment : int
    first, last : int
        How many coefficients at either end are left out since they lie at the waypoint itself.
    """

    order: int
    member: int
    segment: int
    first: int
    last: int


class ScaledProblem:
    """A problem on a mesh, in units in which all variables are of order 1.

    Attributes
    ----------
    second : float [s]
        The unit of time.
    v_unit, a_unit : Array, shape (dof,) [rad/s], [rad/s^2]
        The units of velocity and acceleration: what the motion can reach.
    groups : dict of int to list of int
        Moving joints by order, 2 and 3.
    arcs : tuple of int
        Arcs per segment, of order 2 and of order 3.
    """

    def __init__(self, task: ConditionedProblem, arcs: tuple[int, int], second: float) -> None:
        """Choose the units.

        Parameters
        ----------
        task : ConditionedProblem
        arcs : tuple of int
        second : float [s]
        """
        self.task, self.arcs, self.second = task, arcs, second
        self.groups = {order: task.group(order) for order in (2, 3) if task.group(order)}
        self._margin = POSITION_MARGIN * (1.0 + float(np.abs(task.waypoints).max()))
        velocity, acceleration, jerk = task.limits.max(axis=1)
        span = second * task.n_segments
        with np.errstate(invalid="ignore"):  # of joints with a velocity limit only
            self.a_unit = np.minimum(acceleration, jerk * span)
            self.v_unit = np.minimum(velocity, self.a_unit * span)

    def arcs_of(self, order: int) -> int:
        """Number of arcs per segment of a group.

        Parameters
        ----------
        order : int

        Returns
        -------
        int
        """
        return self.arcs[order - 2]

    def unit(self, order: int, derivative: int) -> Array:
        """Units of velocity (0) or acceleration (1) of a group's joints.

        Parameters
        ----------
        order, derivative : int

        Returns
        -------
        Array, shape (n,) [rad/s] or [rad/s^2]
        """
        return np.asarray((self.v_unit, self.a_unit)[derivative][self.groups[order]])

    @property
    def least_times(self) -> Array:
        """Lower bounds on the segment times, (S,)."""
        return least_times(self.task) / self.second

    def at_nodes(self, order: int, derivative: int) -> tuple[Array, Array]:
        """Bounds on velocity (0) or acceleration (1) at the nodes of a group.

        The velocity is 0 at stops and at waypoints on a position limit, the acceleration at stops; both
        are fixed at the ends of the motion.

        Parameters
        ----------
        order, derivative : int

        Returns
        -------
        low, high : Array, shape ((S arcs + 1) n,)
        """
        task, joints, arcs = self.task, self.groups[order], self.arcs_of(order)
        unit = self.unit(order, derivative)
        bound = _at_nodes(task.limits[derivative][:, joints], arcs) / unit
        lower, upper = -bound, bound.copy()
        fixed = {0: task.ends[0, joints] / unit, task.n_segments * arcs: task.ends[1, joints] / unit}
        fixed |= {k * arcs: np.zeros(len(joints)) for k in task.stops}
        if derivative == 0:
            still = self._on_limit(joints)[1:-1]
            lower[arcs:-1:arcs][still] = upper[arcs:-1:arcs][still] = 0.0
        for node, value in fixed.items():
            lower[node] = upper[node] = value if derivative == 0 else 0.0
        return lower.ravel(), upper.ravel()

    def velocity_on_arcs(self, order: int) -> tuple[Array, Array]:
        """Bounds on the middle Bernstein coefficient of the velocity of each arc.

        Parameters
        ----------
        order : int

        Returns
        -------
        low, high : Array, shape (S arcs n,)
        """
        joints = self.groups[order]
        bound = self.task.limits[0][:, joints] / self.v_unit[joints]
        high = np.repeat(bound, self.arcs_of(order), axis=0).ravel()
        return -high, high

    def top(self, order: int) -> Array:
        """Limit of the highest derivative.

        Parameters
        ----------
        order : int

        Returns
        -------
        Array, shape (S n,)
        """
        limits = self.task.limits[order - 1][:, self.groups[order]]
        return np.asarray(limits * self.second / self.unit(order, order - 2)).ravel()

    def displacement(self, order: int) -> Array:
        """Displacement of each segment.

        Parameters
        ----------
        order : int

        Returns
        -------
        Array, shape (S n,)
        """
        joints = self.groups[order]
        return np.asarray(
            self.task.displacements[:, joints] / (self.v_unit[joints] * self.second)
        ).ravel()

    def gain(self, order: int) -> Array:
        """Velocity that a unit of acceleration adds in a unit of time.

        Parameters
        ----------
        order : int

        Returns
        -------
        Array, shape (n,)
        """
        joints = self.groups[order]
        return np.asarray(self.a_unit[joints] * self.second / self.v_unit[joints])

    def fixed_time(self, waypoint: int) -> float:
        """Time at which a waypoint is passed.

        Parameters
        ----------
        waypoint : int

        Returns
        -------
        float
        """
        return self.task.times[waypoint] / self.second

    def room(self, place: Place) -> tuple[float, float]:
        """Position limits on a segment, relative to its first waypoint and drawn in by a margin.

        A waypoint on the limit leaves no room for the margin.

        Parameters
        ----------
        place : Place

        Returns
        -------
        low, high : float
        """
        task, k, j = self.task, place.segment, self.groups[place.order][place.member]
        ends = task.waypoints[k : k + 2, j]
        lowest = min(task.position_bounds[k, j, 0] + self._margin, ends.min())
        highest = max(task.position_bounds[k, j, 1] - self._margin, ends.max())
        unit = self.v_unit[j] * self.second
        return float((lowest - ends[0]) / unit), float((highest - ends[0]) / unit)

    def place(self, joint: int, segment: int) -> Place:
        """Where rows (6) of a joint on a segment are posed.

        The first coefficient of a segment is the waypoint itself where the velocity is 0 there, and of
        a cubic also the second one where the acceleration is 0 as well.

        Parameters
        ----------
        joint, segment : int

        Returns
        -------
        Place
        """
        order = int(self.task.order[joint])
        first, last = (
            order - 1 if self._rests(joint, w) else int(self._on_limit([joint])[w, 0])
            for w in (segment, segment + 1)
        )
        return Place(order, self.groups[order].index(joint), segment, first, last)

    def _rests(self, joint: int, waypoint: int) -> bool:
        given = {0: self.task.ends[0, joint], self.task.n_segments: self.task.ends[1, joint]}
        return waypoint in self.task.stops or given.get(waypoint, 1.0) == 0.0

    def _on_limit(self, joints: list[int]) -> Truths:
        """Waypoints that lie on a position limit, where the velocity must be 0, (S + 1, n)."""
        bounds, x = self.task.position_bounds[:, joints], self.task.waypoints[:, joints]
        near = np.zeros(x.shape, dtype=bool)
        for side in (slice(None, -1), slice(1, None)):
            near[side] |= (np.abs(bounds - x[side, :, None]) <= self._margin).any(axis=2)
        return near


def _at_nodes(limits: Array, arcs: int) -> Array:
    """Limits (S, n) at the nodes (S arcs + 1, n); at a waypoint the lower of both segments."""
    found = np.repeat(limits, arcs, axis=0)
    return np.asarray(np.minimum(np.vstack([found[:1], found]), np.vstack([found, found[-1:]])))
