"""Limits that follow from the others, and from the time that a motion has.

A motion from rest to rest, with an acceleration of 0 at both ends, that takes at most H seconds keeps

    |v| <= min(A H / 2, J H^2 / 16),     |a| <= min(sqrt(2 J V), J H / 4).

A speed v that is gained must be lost again: either takes at least v / A, and at least 2 sqrt(v / J) where the
acceleration starts and ends at 0. An acceleration a takes a / J to rise and a / J to fall. Meanwhile the
velocity changes by a^2 / J, which is at most 2 V; a change of the opposite sign takes at least 2 a / J more.

Where only the accelerations at both ends are 0, or the motion is a cycle, |a| <= sqrt(2 J V) is left. Else
some time L / 2 lies on one side of a, where L is the least time of the whole motion or less. The velocity
changes by at least a L / 2 - J L^2 / 8 there, so

    |a| <= 4 V / L + J L / 4,     L <= 4 sqrt(V / J), where this is least.

V, A and J are the greatest in either direction on any segment.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array, Indices
from formulations.problem.demands import Demands

_UP = 1.0 + 2.0**-50  # covers the rounding of two operations


def implied_limits(
    demands: Demands, joints: Indices, horizon: float, least: float
) -> tuple[Array, Array]:
    """Compute the greatest velocity and acceleration that follow.

    Parameters
    ----------
    demands : Demands
    joints : Indices, shape (n,)
        The joints asked for.
    horizon : float [s]
        No motion that is considered takes longer.
    least : float [s]
        Every motion takes as long, rounded down.

    Returns
    -------
    velocity, acceleration : Array, shape (n,)
        Rounded up; infinite where nothing follows.
    """
    V, A = (
        np.abs(interval[:, joints]).max(axis=(0, 2))
        for interval in (demands.velocity, demands.acceleration)
    )
    J = demands.jerk[:, joints].max(axis=0)
    still, fading = at_rest(demands), no_acceleration(demands)
    if still and fading:
        speed = np.minimum(A * horizon / 2.0, J * horizon**2 / 16.0)
        steepest = np.minimum(np.sqrt(2.0 * J * V), J * horizon / 4.0)
        return _UP * speed, _UP * steepest
    nothing = np.full(len(joints), np.inf)
    if fading or demands.cyclic:
        return nothing, _UP * np.sqrt(2.0 * J * V)
    with np.errstate(divide="ignore", invalid="ignore"):
        whole = np.minimum(least, 4.0 * np.sqrt(V / J)) / _UP
        found = _UP**2 * (4.0 * V / whole + J * whole / 4.0)
    return nothing, np.where(np.isfinite(J) & (whole > 0.0), found, np.inf)


def at_rest(demands: Demands) -> bool:
    """Whether the velocity is 0 at both ends.

    Parameters
    ----------
    demands : Demands

    Returns
    -------
    bool
    """
    return not (demands.cyclic or demands.end_velocity.any())


def no_acceleration(demands: Demands) -> bool:
    """Whether the acceleration of joints with a jerk limit is 0 at both ends.

    Parameters
    ----------
    demands : Demands

    Returns
    -------
    bool
    """
    return not (demands.cyclic or demands.end_acceleration.any())
