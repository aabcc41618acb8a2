"""The problem that the relaxation is posed for: the waypoints and joints that count, and their limits."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from formulations.problem.arrays import Array, Indices, Truths
from formulations.problem.demands import Demands
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.relaxation.implied_limits import implied_limits
from formulations.proofs.every_motion.relaxation.kept_waypoints import gaps, kept_waypoints
from formulations.proofs.every_motion.relaxation.legs import LegLimits, down, legs_between

UP, DOWN = 1.0 + 2.0**-50, 1.0 - 2.0**-50  # cover the rounding of two operations
_WIDER = (
    1.001  # position slack that is proved, per slack allowed: covers rounding, and checkers ask for it
)


@dataclass(frozen=True)
class RelaxedProblem:
    """A problem without the waypoints and joints that have no row, and with limits for one horizon.

    A joint that never has to move is left out, since it can stand still. A joint with a velocity limit only
    has rows if a waypoint is a zone; else all that it implies is T >= |d| / V, which ``least`` holds.

    Where limits differ between segments or directions, ``velocity``, ``acceleration`` and ``jerk`` are the
    greatest of them. A segment between two waypoints that are kept has the loosest limits of the problem's
    segments there. Directions come as backwards, forwards.

    Attributes
    ----------
    least, most : Array, shape (K,) [s]
        Bounds on each duration: those asked for, and that of the joints with a velocity limit only.
    gaps : Array, shape (K, n, 2) [rad]
        How far a joint has to go at least, backwards and forwards.
    displacements : Array, shape (K, n) [rad]
        Between the middles of the zones, each rounded once.
    zones : Array, shape (K + 1, n) [rad]
        How far a waypoint may be from its middle; 0 where it is fixed.
    room : Array, shape (K, 2, n, 2) [rad]
        Distance from the middle at either end of a segment to the lower and to the upper position limit,
        infinite without one.
    velocity, acceleration, jerk : Array, shape (n,)
        Limits that every motion of at most ``horizon`` seconds keeps; jerk is 0 where unlimited.
    velocities, accelerations : Array, shape (K, n, 2)
        The same on each segment, backwards and forwards, as moduli.
    jerks : Array, shape (K, n)
    v_boxes, a_boxes : Array, shape (K + 1, n, 2)
        Least and greatest velocity and acceleration at the waypoints [rad/s, rad/s^2].
    horizon : float [s]
        The motions considered take at most this long, without the waits at waypoints.
    waits : float [s]
        The sum of those waits, rounded down.
    arrivals : Array, shape (K + 1, 2) [s]
        Bounds on the sum of the durations before a waypoint, rounded outward.
    cyclic : bool
        Whether positions, velocities and accelerations are the same at both ends.
    fades : tuple of bool
        Whether an acceleration has to come from 0 after the start, and to fall to 0 before the end.
    by_speed_alone : Truths, shape (n,)
        Which joints have a velocity limit only; they are here where a waypoint is a zone.
    plain : bool
        Whether the problem has no conditions; each segment takes time then.
    legs : Indices, shape (L, 2)
        The waypoints, of those kept, between which rows are posed: the K segments come first, then legs over
        several segments. All arrays of shape (K, ...) above have L lines.
    segments : Indices, shape (K,)
        The problem's number of the waypoint where each segment starts.
    joints : Indices, shape (n,)
        The problem's number of each joint kept.
    end : int
        The problem's number of the last waypoint kept.
    """

    least: Array
    most: Array
    gaps: Array
    displacements: Array
    zones: Array
    room: Array
    velocity: Array
    acceleration: Array
    jerk: Array
    velocities: Array
    accelerations: Array
    jerks: Array
    v_boxes: Array
    a_boxes: Array
    horizon: float
    waits: float
    arrivals: Array
    cyclic: bool
    fades: tuple[bool, bool]
    by_speed_alone: Truths
    plain: bool
    legs: Indices
    segments: Indices
    joints: Indices
    end: int

    @staticmethod
    def of(problem: Problem, horizon: float, slack: float | None = None) -> RelaxedProblem:
        """Relax a problem for all motions of at most ``horizon`` seconds.

        Parameters
        ----------
        problem : Problem
        horizon : float [s]
            The time H.
        slack : float, optional [rad]
            Distance outside the position limits that still counts as inside; by default a thousandth
            more than the problem's.

        Returns
        -------
        RelaxedProblem
        """
        return RelaxedProblem.under(Demands.of(problem), horizon, slack)

    @staticmethod
    def under(
        demands: Demands,
        horizon: float,
        slack: float | None = None,
        without: frozenset[int] = frozenset(),
    ) -> RelaxedProblem:
        """Relax what a motion has to keep, for all motions of at most ``horizon`` seconds.

        Parameters
        ----------
        demands : Demands
        horizon : float [s]
            The time H, with all waits.
        slack : float, optional [rad]
            As in ``of``.
        without : frozenset of int
            Inner waypoints to leave out.

        Returns
        -------
        RelaxedProblem
        """
        kept, joints = kept_waypoints(demands, without), _joints_in_rows(demands)
        legs = legs_between(demands, kept)
        of_legs = LegLimits(kept[legs])
        box = demands.waypoints[kept][:, joints]
        middles = box.mean(axis=-1)
        apart = np.maximum(box[..., 1] - middles, middles - box[..., 0])
        slack = demands.problem.position_slack * _WIDER if slack is None else slack
        bounds = of_legs.hull(demands.position[:, joints])
        room = [(bounds - middles[legs[:, e], :, None]) * (-1.0, 1.0) for e in (0, 1)]
        waits = float(demands.waits[kept].sum()) * down(len(kept))
        asked = np.maximum(of_legs.least(demands), _by_velocity_alone(demands, kept[legs]))
        speeds = np.abs(of_legs.hull(demands.velocity[:, joints]))
        by_speed = DOWN * (gaps(box, legs) / speeds).max(axis=(1, 2), initial=0.0)
        K = len(kept) - 1
        shortest = float(np.maximum(asked, by_speed)[:K].sum() + waits) * down(len(kept) + 1)
        top, steepest = implied_limits(demands, joints, horizon, shortest)
        velocities = np.minimum(speeds, top[:, None])
        accelerations = np.minimum(
            np.abs(of_legs.hull(demands.acceleration[:, joints])), steepest[:, None]
        )
        alone = ~_limited(demands)[joints]
        accelerations[:, alone] = velocities[:, alone]  # a unit: their rows have no acceleration
        jerks = of_legs.hull(np.stack(2 * [demands.jerk[:, joints]], axis=-1))[..., 1]
        jerks = np.where(np.isfinite(jerks), jerks, 0.0)
        return RelaxedProblem(
            least=asked,
            most=of_legs.most(demands),
            gaps=gaps(box, legs),
            displacements=middles[legs[:, 1]] - middles[legs[:, 0]],
            zones=np.where(box[..., 0] < box[..., 1], UP * apart, 0.0),
            room=np.maximum(np.stack(room, axis=1), 0.0) + slack,
            velocity=velocities.max(axis=(0, 2), initial=0.0),
            acceleration=accelerations.max(axis=(0, 2), initial=0.0),
            jerk=jerks.max(axis=0, initial=0.0),
            velocities=velocities,
            accelerations=accelerations,
            jerks=jerks,
            v_boxes=_at_waypoints(demands, kept, joints, velocities[:K], demands.end_velocity),
            a_boxes=_at_waypoints(
                demands,
                kept,
                joints,
                (accelerations * (jerks > 0.0)[..., None])[:K],
                demands.end_acceleration,
            ),
            horizon=UP * (horizon - waits) if waits else horizon,
            waits=waits,
            arrivals=_arrivals(demands, kept),
            cyclic=demands.cyclic,
            fades=_fades(demands),
            by_speed_alone=~_limited(demands)[joints],
            plain=demands.plain,
            legs=legs,
            segments=kept[:-1],
            joints=joints,
            end=int(kept[-1]) if len(kept) else 0,
        )

    @property
    def has_jerk(self) -> Truths:
        """Which joints have a jerk limit, (n,)."""
        return self.jerk > 0.0

    @property
    def at_top_speed(self) -> Array:
        """Least displacement over top speed of the slowest joint of each segment, (K,) [s]."""
        return np.asarray((self.gaps / self.velocities).max(axis=(1, 2), initial=0.0))

    @property
    def waypoints(self) -> Indices:
        """The problem's number of each waypoint kept, (K + 1,)."""
        return np.append(self.segments, self.end)

    @property
    def n_segments(self) -> int:
        """Number of segments between waypoints that are kept."""
        return len(self.segments)

    def units(self, typical: Array) -> Array:
        """Choose a unit for the duration of each segment: the longest of the problem's segments on it.

        Parameters
        ----------
        typical : Array, shape (n_segments,) [s]
            Of the problem's segments, about.

        Returns
        -------
        Array, shape (K,) [s]
        """
        return np.array([typical[i:k].max() for i, k in pairwise(self.waypoints.tolist())])

    def over_legs(self, values: Array) -> Array:
        """Add up values of the segments for each leg.

        Parameters
        ----------
        values : Array, shape (K,)

        Returns
        -------
        Array, shape (L,)
        """
        sums = [values[i:k].sum() for i, k in self.legs[self.n_segments :].tolist()]
        return np.concatenate([values, sums]) if sums else values


def _limited(demands: Demands) -> Truths:
    """Which joints have an acceleration or a jerk limit, (dof,)."""
    limits = demands.problem.limits
    return np.isfinite(limits.acceleration) | np.isfinite(limits.jerk)


def _joints_in_rows(demands: Demands) -> Indices:
    """Joints with more than a velocity limit that cannot stand still."""
    box = demands.waypoints
    moves = box[..., 0].max(axis=0) > box[..., 1].min(axis=0)
    for states in (demands.end_velocity, demands.end_acceleration):
        moves |= ((states[..., 0] > 0.0) | (states[..., 1] < 0.0)).any(axis=0)
    zones = (box[..., 0] < box[..., 1]).any(axis=0)
    return np.flatnonzero(moves & (_limited(demands) | zones))


def _by_velocity_alone(demands: Demands, legs: Indices) -> Array:
    """Least time of the joints with a velocity limit only, (L,) [s]."""
    others = np.flatnonzero(~_limited(demands))
    speeds = np.abs(LegLimits(legs).hull(demands.velocity[:, others]))
    return DOWN * (gaps(demands.waypoints[:, others], legs) / speeds).max(axis=(1, 2), initial=0.0)


def _at_waypoints(
    demands: Demands, kept: Indices, joints: Indices, moduli: Array, ends: Array
) -> Array:
    """Intervals at the waypoints, (K + 1, n, 2), from moduli backwards and forwards on the segments."""
    both = moduli * (-1.0, 1.0)
    if not len(both):
        return np.zeros((len(kept), len(joints), 2))
    before, after = np.concatenate([both[:1], both]), np.concatenate([both, both[-1:]])
    found = np.stack(
        [np.maximum(before[..., 0], after[..., 0]), np.minimum(before[..., 1], after[..., 1])], axis=-1
    )
    found[demands.stops[kept]] = 0.0
    if not demands.cyclic:
        given = ends[:, joints]
        for i in (0, -1):
            found[i, :, 0] = np.maximum(found[i, :, 0], given[i, :, 0])
            found[i, :, 1] = np.minimum(found[i, :, 1], given[i, :, 1])
    return found


def _arrivals(demands: Demands, kept: Indices) -> Array:
    """Bounds on the sum of the durations before each waypoint, (K + 1, 2) [s]."""
    waited = np.concatenate([[0.0], np.cumsum(demands.waits[kept])[:-1]]) if len(kept) else np.zeros(0)
    found = demands.passages[kept] - waited[:, None]
    with np.errstate(invalid="ignore"):
        rounding = (1.0 - down(len(kept))) * (waited[:, None] + np.abs(found)) * (-1.0, 1.0)
        rounded = np.isfinite(found) & (waited[:, None] > 0.0)
        return np.where(rounded, found + rounding, found)


def _fades(demands: Demands) -> tuple[bool, bool]:
    """Whether the acceleration has to come from 0 after the start, and to fall to 0 before the end."""
    start, end = (demands.cyclic or not states.any() for states in demands.end_acceleration)
    return start, end
