"""What a controller makes of the points of a file: pieces between them, by what each point states.

The trajectory controller of ros2_control (joint_trajectory_controller) joins two points

- that state positions by a straight line,
- that state velocities too by a cubic,
- that state accelerations too by a quintic,

each the Hermite interpolant of what both points state. A motion from a file is judged as that controller
would run it.
"""

from __future__ import annotations

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError

INTERPOLATIONS = ("auto", "linear", "cubic", "quintic")
_NEEDS = {"linear": 1, "cubic": 2, "quintic": 3}  # of positions, velocities, accelerations


def joined(
    times: Array,
    positions: Array,
    velocities: Array | None = None,
    accelerations: Array | None = None,
    *,
    interpolation: str = "auto",
    passages: Array | None = None,
) -> Trajectory:
    """Join points as a controller does.

    Parameters
    ----------
    times : Array, shape (n_points,) [s]
        Increasing; the first one is the start of the motion, whatever its value.
    positions, velocities, accelerations : Array, shape (n_points, dof) [rad, rad/s, rad/s^2]
        What the points state; velocities and accelerations may be missing.
    interpolation : {"auto", "linear", "cubic", "quintic"}
        Degree of the pieces; ``auto`` is the highest that the points allow, as the controller does it.
    passages : Array, shape (n_waypoints,) [s], optional
        Times at which waypoints are passed; every point if left out.

    Returns
    -------
    Trajectory
        One piece between two points.

    Raises
    ------
    InputError
        The interpolation is not known, or needs what the points do not state.
    """
    given = [x for x in (positions, velocities, accelerations) if x is not None]
    if velocities is None and accelerations is not None:
        raise InputError("interpolation: the points state accelerations without velocities")
    if interpolation not in INTERPOLATIONS:
        raise InputError(f"interpolation: {interpolation!r} is not one of {', '.join(INTERPOLATIONS)}")
    degree = (
        ("linear", "cubic", "quintic")[len(given) - 1] if interpolation == "auto" else interpolation
    )
    if _NEEDS[degree] > len(given):
        missing = ("velocities", "accelerations")[len(given) - 1]
        raise InputError(f"interpolation: {degree} needs {missing}, and the points state none")
    lengths = np.diff(times)
    h = lengths[:, None]
    step = np.diff(positions, axis=0)
    columns = [positions[:-1]]  # coefficients on the normalised time s = t / h
    if degree == "linear":
        columns += [step]
    else:
        assert velocities is not None
        v0, v1 = velocities[:-1] * h, velocities[1:] * h
        if degree == "cubic":
            columns += [v0, 3.0 * step - 2.0 * v0 - v1, -2.0 * step + v0 + v1]
        else:
            assert accelerations is not None
            a0, a1 = accelerations[:-1] * h**2, accelerations[1:] * h**2
            # what the quintic still has to reach beyond the parabola of its first point
            rest, slope, bend = step - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0
            columns += [
                v0,
                0.5 * a0,
                10.0 * rest - 4.0 * slope + 0.5 * bend,
                -15.0 * rest + 7.0 * slope - bend,
                6.0 * rest - 3.0 * slope + 0.5 * bend,
            ]
    # a row per power in memory, which is how the judge goes through them
    rows = np.stack([column / h**power for power, column in enumerate(columns)])
    coefficients = np.moveaxis(rows, 0, -1)
    shifted = None if passages is None else passages - times[0]
    return Trajectory(lengths, coefficients, shifted)
