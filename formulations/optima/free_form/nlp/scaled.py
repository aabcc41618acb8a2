"""The numbers of one problem in the units of its program: bounds of variables and rows, parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from formulations.optima.free_form.nlp.assembly import RAMP, least_times
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.problem.arrays import Array, Truths


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


class Offset(NamedTuple):
    """A waypoint whose position is free within a box, for one joint.

    Attributes
    ----------
    order : int
        Of the joint.
    member : int
        Number of the joint in the group of its order.
    waypoint : int
    """

    order: int
    member: int
    waypoint: int


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
    def segment_times(self) -> tuple[Array, Array]:
        """Bounds on the segment times, (S,) each."""
        least = np.maximum(least_times(self.task), self.task.durations[:, 0])
        return least / self.second, self.task.durations[:, 1] / self.second

    def at_nodes(self, order: int, derivative: int) -> tuple[Array, Array]:
        """Bounds on velocity (0) or acceleration (1) at the nodes of a group.

        The velocity is 0 at stops and at waypoints on a position limit, the acceleration at stops; both
        are fixed at the ends of the motion, where they are not free.

        Parameters
        ----------
        order, derivative : int

        Returns
        -------
        low, high : Array, shape ((S arcs + 1) n,)
        """
        task, joints, arcs = self.task, self.groups[order], self.arcs_of(order)
        unit = self.unit(order, derivative)
        bounds = task.intervals[derivative][:, joints] / unit[:, None]
        lower, upper = -_at_nodes(-bounds[..., 0], arcs), _at_nodes(bounds[..., 1], arcs)
        given = (task.ends, task.end_accelerations)[derivative][:, joints] / unit
        fixed = {0: given[0], task.n_segments * arcs: given[1]}
        fixed |= {k * arcs: np.zeros(len(joints)) for k in task.stops}
        if derivative == 0:
            still = self._on_limit(joints)
            lower[::arcs][still] = upper[::arcs][still] = 0.0
        for node, value in fixed.items():
            lower[node] = np.where(np.isnan(value), lower[node], value)
            upper[node] = np.where(np.isnan(value), upper[node], value)
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
        bounds = self.task.intervals[0][:, joints] / self.v_unit[joints][:, None]
        whole = np.repeat(bounds, self.arcs_of(order), axis=0)
        return whole[..., 0].ravel(), whole[..., 1].ravel()

    def top(self, order: int, side: int = 1) -> Array:
        """Limit of the highest derivative, upwards (1) or downwards (0).

        Parameters
        ----------
        order, side : int

        Returns
        -------
        Array, shape (S n,)
            Moduli.
        """
        joints = self.groups[order]
        if order == 3:
            limits = self.task.limits[2][:, joints]
        else:
            limits = np.abs(self.task.intervals[1][:, joints, side])
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

    def window(self, waypoint: int) -> tuple[float, float]:
        """Least and greatest sum of the segment times before a waypoint.

        Parameters
        ----------
        waypoint : int

        Returns
        -------
        low, high : float
        """
        low, high = self.task.windows[waypoint]
        return low / self.second, high / self.second

    def _of(self, where: Offset) -> int:
        """The joint of an offset."""
        return self.task.group(where.order)[where.member]

    def offsets(self, zones: Sequence[Offset]) -> tuple[Array, Array]:
        """Bounds on how far the positions at waypoints are from the waypoints.

        Parameters
        ----------
        zones : sequence of Offset

        Returns
        -------
        low, high : Array, shape (n_zones,)
        """
        joints, at = [self._of(zone) for zone in zones], [zone.waypoint for zone in zones]
        sides = self.task.boxes[at, joints] - self.task.waypoints[at, joints][:, None]
        sides = sides / (self.v_unit[joints] * self.second)[:, None]
        return sides[:, 0], sides[:, 1]

    def crossed(self, crossings: Sequence[Offset]) -> tuple[Array, Array, Array]:
        """What joints with a velocity limit only cross on segments, and how fast they may.

        Parameters
        ----------
        crossings : sequence of Offset
            Each stands for the segment after its waypoint.

        Returns
        -------
        displacement, least, greatest : Array, shape (n,)
            Displacement between the waypoints, and bounds on the velocity.
        """
        joints, at = [self._of(one) for one in crossings], [one.waypoint for one in crossings]
        speeds = self.task.intervals[0][at, joints] * (1.0 - 3.0 * RAMP)
        unit = self.v_unit[joints]
        way = self.task.displacements[at, joints] / (unit * self.second)
        return way, speeds[:, 0] / unit, speeds[:, 1] / unit

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
        ends, start = task.boxes[k : k + 2, j], task.waypoints[k, j]
        lowest = min(task.position_bounds[k, j, 0] + task.margin, ends.min())
        highest = max(task.position_bounds[k, j, 1] - task.margin, ends.max())
        unit = self.v_unit[j] * self.second
        return float((lowest - start) / unit), float((highest - start) / unit)

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
        if waypoint in self.task.stops:
            return True
        given = [self.task.ends[:, joint]]
        if self.task.order[joint] == 3:
            given.append(self.task.end_accelerations[:, joint])
        at = {0: 0, self.task.n_segments: 1}.get(waypoint)
        return at is not None and all(values[at] == 0.0 for values in given)

    def _on_limit(self, joints: list[int]) -> Truths:
        """Waypoints that lie on a position limit, where the velocity must be 0, (S + 1, n)."""
        bounds, x = self.task.position_bounds[:, joints], self.task.waypoints[:, joints]
        near = np.zeros(x.shape, dtype=bool)
        for side in (slice(None, -1), slice(1, None)):
            near[side] |= (np.abs(bounds - x[side, :, None]) <= self.task.margin).any(axis=2)
        if not self.task.demands.cyclic:
            near[[0, -1]] = False  # at an end, the joint may come from the limit or go to it
        return near & ~self.task.zones[:, joints]


def _at_nodes(limits: Array, arcs: int) -> Array:
    """Limits (S, n) at the nodes (S arcs + 1, n); at a waypoint the lower of both segments."""
    found = np.repeat(limits, arcs, axis=0)
    return np.asarray(np.minimum(np.vstack([found[:1], found]), np.vstack([found, found[-1:]])))
