"""Other programs on the same tasks: each is one file with one function, and one entry of ``RIVALS``.

A function takes a problem and the seconds that it may take, and returns a ``RivalAnswer``. It runs in a process
of its own, because some of these programs crash or do not come back (``isolated.py``). Its motion is judged by
the independent check (``rows.py``). Loading this list loads none of the programs.
"""

from compare.rivals.rival import Rival, RivalAnswer

_ALL = (
    Rival(
        "drake_spline", "Drake, B-spline", "compare.rivals.drake_spline:drake_spline", "drake",
        ("pydrake.planning",),
        "the total time of one cubic B-spline (KinematicTrajectoryOptimization, SNOPT)",
        "free passage times: the shares of the time at which waypoints are passed are given to it",
    ),
    Rival(
        "drake_gcs", "Drake, GCS", "compare.rivals.drake_gcs:drake_gcs", "drake", ("pydrake.planning",),
        "the sum of the times of one Bezier curve of degree 5 per segment (GcsTrajectoryOptimization)",
        "limits between control points exactly: the hull of the control points is held to them",
    ),
    Rival(
        "drake_toppra", "Drake, TOPP-RA", "compare.rivals.drake_toppra:drake_toppra", "drake",
        ("pydrake.multibody.optimization", "pydrake.multibody.plant", "pydrake.trajectories"),
        "the speed along a given path, the cubic spline through the waypoints (Toppra)",
        "a jerk limit, or a better path",
    ),
    Rival(
        "toppra", "toppra", "compare.rivals.toppra_spline:toppra_spline", "toppra", ("toppra",),
        "the speed along a given path, the same cubic spline",
        "a jerk limit, or a better path",
    ),
    Rival(
        "pyroboplan_cubic", "pyroboplan, cubics", "compare.rivals.pyroboplan_cubic:pyroboplan_cubic",
        "pyroboplan", ("pyroboplan.trajectory.trajectory_optimization",),
        "the segment times of one cubic per segment, with limits at 11 samples of each",
        "zero acceleration at both ends, limits between the samples",
    ),
    Rival(
        "pyroboplan_trapezoids", "pyroboplan, trapezoids",
        "compare.rivals.pyroboplan_trapezoids:pyroboplan_trapezoids", "pyroboplan",
        ("pyroboplan.trajectory.trapezoidal_velocity",),
        "straight lines from stop to stop with trapezoidal speed, in closed form",
        "a jerk limit, or passing a waypoint without a stop",
    ),
    Rival(
        "justblend_stops", "justblend, stops", "compare.rivals.justblend_:justblend_stops", "justblend",
        ("justblend",),
        "straight lines from stop to stop, in closed form",
        "position limits, or passing a waypoint without a stop",
    ),
    Rival(
        "justblend_blends", "justblend, blends", "compare.rivals.justblend_:justblend_blends", "justblend",
        ("justblend",),
        "straight lines with blended corners, in closed form; here the fastest of five widths within the zones",
        "position limits, or passing a waypoint exactly without a stop", zones=True,
    ),
    Rival(
        "scip", "SCIP", "compare.rivals.scip:scip", "pyscipopt", ("pyscipopt",),
        "the sum of the segment times over motions of constant jerk on eight even steps per segment, globally",
        "a proof that can be checked, or of all motions; limits exactly: it has a tolerance",
    ),
    Rival(
        "ruckig", "Ruckig, stop and go", "compare.rivals.ruckig_:ruckig_stops", "ruckig", ("ruckig",),
        "each segment from rest to rest, exactly",
        "passing a waypoint without a stop (see ruckig_waypoints)",
    ),
    Rival(
        "ruckig_waypoints", "Ruckig, waypoints", "", "ruckig", (),
        "a motion through intermediate waypoints", "a proof",
        "its community version sends such waypoints to a cloud service, and no task leaves this machine",
    ),
    Rival(
        "jacobi", "jacobi-motion", "", "jacobi-motion", (),
        "a motion through waypoints", "unknown: it is closed",
        "its licence (of version 1.1.17: proprietary, a copyright notice alone) grants no right to run it",
    ),
)  # fmt: skip

RIVALS: dict[str, Rival] = {rival.key: rival for rival in _ALL}

__all__ = ["RIVALS", "Rival", "RivalAnswer"]
