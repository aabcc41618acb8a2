"""COPP (``copp-py``): the fastest jerk-limited motion along a fixed path, by a sequence of conic programs.

The path is parameterised by the time of the given motion, so that a = (ds/dt)^2 = 1 is that motion. It is
feasible: the jerk constraints are linearised there first, and then at each better profile in turn. The
derivative of the path is zero at both ends, so that any a there starts from rest; a = 1 is kept. The result
is discretised: the grid is doubled once, and the change is stated.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.references.reference import Outcome, Rung, RungKind, Takes

Profile = tuple[Array, Array, Array, Array]

_GRIDS = (24, 48)  # intervals per piece
_SETTLED = 1e-5  # relative change of the time at which linearising again ends
_TURNS = 12
_FLOOR = 1e-9  # of a, where the motion inside nearly stops


def copp_on(problem: Problem, path: Trajectory) -> Outcome:
    """Time the path of a motion as fast as all derivative limits allow.

    Parameters
    ----------
    problem : Problem
        With a jerk limit on some joint.
    path : Trajectory
        A motion through the waypoints that keeps the limits.

    Returns
    -------
    Outcome
        Not applicable without ``copp-py`` or without a jerk limit; its note states the grid error.
    """
    problem.require_plain("COPP")
    try:
        import copp_py
    except ImportError:
        return Outcome.not_applicable("copp-py is not installed: pip install 'timebound[copp]'")
    if not problem.limits.has_jerk:
        return Outcome.not_applicable("no jerk limit: TOPP-RA is the optimum on this path")
    if not problem.moving_joints:
        return Outcome.ok(0.0, note="nothing moves")
    found: list[float] = []
    profile: Profile | None = None
    for grid in _GRIDS:
        try:
            seconds, profile = profile_on(problem, path, grid, profile, problem.moving_joints)
        except copp_py.CoppError as error:
            return Outcome.failed(f"COPP at {grid} intervals per piece: {error}")
        found.append(seconds)
    change = abs(found[-1] / found[-2] - 1.0)
    return Outcome.ok(
        found[-1], note=f"{_GRIDS[-1]} grid intervals per piece; grid error {change:.1e}; jerk limited"
    )


def profile_on(
    problem: Problem,
    path: Trajectory,
    grid: int,
    before: Profile | None,
    moving: Sequence[int],
) -> tuple[float, Profile]:
    """Solve on one grid.

    Parameters
    ----------
    problem : Problem
        Its limits count.
    path : Trajectory
        A motion that keeps them.
    grid : int
        Intervals per piece of it.
    before : Profile, optional
        The profile of a coarser grid.
    moving : sequence of int
        Joints that move along the path.

    Returns
    -------
    seconds : float [s]
    profile : Profile
        Four arrays (n_grid,): places s on the path by the time of the motion given [s],
        a = (ds/dt)^2, b = d^2 s/dt^2, and the times at which the places are passed [s].
    """
    from copp_py.interpolation import s_to_t_topp3
    from copp_py.robot import Robot
    from copp_py.solver import topp3_socp

    conic: Any = topp3_socp  # its stub hides what it exports
    s = np.append(
        np.concatenate(
            [
                start + duration * np.arange(grid) / grid
                for start, duration in zip(path.breaks[:-1], path.durations, strict=True)
            ]
        ),
        path.seconds,
    )
    moving, n = list(moving), len(s)
    robot = Robot(len(moving), capacity=n)
    robot.append_s(s)
    q, dq, ddq, dddq = (np.ascontiguousarray(path.at(s, order)[:, moving]) for order in range(4))
    robot.set_q(q, dq, ddq, 0, dddq=dddq)
    velocity, acceleration, jerk = problem.limits.derivatives[:, moving]
    for add, limit in (
        (robot.add_velocity_limits, velocity),
        (robot.add_acceleration_limits, acceleration),
        (robot.add_jerk_limits, jerk),
    ):
        if np.isfinite(limit).any():
            most = np.where(np.isfinite(limit), limit, 1e12 * np.nanmin(limit[np.isfinite(limit)]))
            add(most, -most, start_idx_s=0, length=n)
    a = np.ones(n)
    b: Array | None = None
    if before is not None:
        a, b = np.interp(s, before[0], before[1]), np.interp(s, before[0], before[2])
    last = np.inf
    for _ in range(_TURNS):
        task = conic.Problem(
            robot.constraints, a, a_boundary=(1.0, 1.0), b_boundary=(0.0, 0.0),
            num_stationary_max=0, b_linearization=b,
        )  # fmt: skip
        answer = conic.solve(task)
        seconds, passed = s_to_t_topp3(s, answer)
        a, b = np.maximum(answer.a, _FLOOR), np.asarray(answer.b)
        if abs(seconds / last - 1.0) < _SETTLED:
            break
        last = seconds
    assert b is not None
    return float(seconds), (s, a, b, np.asarray(passed))


COPP_FAMILY_PATH = Rung(
    key="copp_family_path",
    kind=RungKind.REFERENCE,
    name="COPP, path of the optimum",
    meaning="jerk-limited optimum on the family optimum's path",
    find=copp_on,
    takes=Takes.PATH,
    after=("family",),
    needs=("family",),
)
