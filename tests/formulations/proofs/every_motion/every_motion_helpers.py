"""What the tests of the bound of every motion share: problems, motions, and their place in the rows."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import ruckig
from conftest import powers_of_ten

from formulations import FAMILIES, REFERENCES, FreeFormBound, Limits, Problem, Trajectory, check, load
from formulations.problem.arrays import Array
from formulations.proofs.every_motion.closed_forms import least_durations, stop_and_go_durations
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import (
    ALL_PRODUCTS,
    CRUISES,
    FADES,
    HULLS,
    PEAKS,
    SPEED_PRODUCTS,
    SQUARE_PRODUCTS,
    STOPS,
    TANGENTS,
    ZONES,
    Cuts,
    Kind,
)
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.references.ruckig_ import pieces_of

ROUNDING = 1e-12  # in the motions themselves, in units of the rows' variables
SIZE = powers_of_ten(-1.0, 1.0)


def jerk_limited(name: str, factor: float) -> Problem:
    """A case with jerk limits of ``factor`` times its acceleration limits."""
    problem = load(name)
    limits = problem.limits
    return replace(problem, limits=replace(limits, jerk=factor * limits.acceleration))


def unbounded(problem: Problem) -> Problem:
    """The same without position limits."""
    position = np.full((problem.dof, 2), (-np.inf, np.inf))
    return replace(problem, limits=replace(problem.limits, position=position))


def problem_of(waypoints: Any, *limits: Any, **position: Any) -> Problem:
    points = np.asarray(waypoints, dtype=np.float64)
    return Problem.of(points, Limits.of(*limits, **position, dof=points.shape[1]))


def holds(problem: Problem, bound: FreeFormBound) -> None:
    """What must hold of every bound: its order, and that its own motion is one."""
    assert bound.seconds == max(bound.bounds.values())
    assert 0.0 <= bound.seconds <= stop_and_go_durations(problem).sum() * (1.0 + 1e-9)
    assert bound.seconds == bound.bounds[bound.method]
    if bound.motion is not None:
        verdict = check(problem, bound.motion)
        assert verdict.feasible, verdict.faults
        assert bound.least_verified <= verdict.seconds
        assert bound.upper is not None
        assert bound.upper <= verdict.seconds


def exact(problem: Problem, motion: Trajectory) -> Trajectory:
    """Stretched until it keeps the limits without a tolerance."""
    return motion.stretched(max(check(problem, motion).stretch, 1.0) * (1.0 + 1e-12))


def stopping(problem: Problem) -> Trajectory:
    motion = REFERENCES["ruckig_stop_and_go"](problem).trajectory
    assert motion is not None
    return motion


def splined(problem: Problem, family: str, rng: np.random.Generator) -> Trajectory:
    """A family's spline for random durations, as fast as the limits allow."""
    durations = 10.0 ** rng.uniform(-0.5, 0.5, problem.n_segments)
    stretch = FAMILIES[family].stretch(problem, durations[None])[0]
    return FAMILIES[family].trajectory(problem, durations * stretch)


def through_states(problem: Problem, rng: np.random.Generator) -> Trajectory:
    """Ruckig from waypoint to waypoint through random states: passes at speed, accelerating."""
    limits = problem.limits
    speeds = 0.4 * rng.uniform(-1.0, 1.0, problem.waypoints.shape) * limits.velocity
    steeps = 0.4 * rng.uniform(-1.0, 1.0, problem.waypoints.shape) * limits.acceleration
    steeps *= np.sqrt(np.minimum(1.0, limits.jerk * limits.velocity / limits.acceleration**2))
    speeds[[0, -1]] = steeps[[0, -1]] = 0.0
    parts, lengths = [], [0.0]
    for k in range(problem.n_segments):
        start = problem.waypoints[k]
        motion = ruckig.Trajectory(problem.dof)
        task = ruckig.InputParameter(problem.dof)
        task.current_position, task.target_position = start.tolist(), problem.waypoints[k + 1].tolist()
        task.current_velocity, task.target_velocity = speeds[k].tolist(), speeds[k + 1].tolist()
        task.current_acceleration = steeps[k].tolist()
        task.target_acceleration = steeps[k + 1].tolist()
        task.max_velocity, task.max_acceleration = (
            limits.velocity.tolist(),
            limits.acceleration.tolist(),
        )
        task.max_jerk = limits.jerk.tolist()
        ruckig.Ruckig(problem.dof).calculate(task, motion)
        parts.append(integrated(motion, start, speeds[k], steeps[k]))
        lengths.append(parts[-1][0].sum())
    durations, coefficients = (np.concatenate(both) for both in zip(*parts, strict=True))
    return Trajectory(durations, coefficients, np.cumsum(lengths))


def integrated(motion: ruckig.Trajectory, x: Array, v: Array, a: Array) -> tuple[Array, Array]:
    """``pieces_of`` with the state it starts from."""
    durations, coefficients = pieces_of(motion, x)
    t = np.concatenate([[0.0], np.cumsum(durations)[:-1]])[:, None]
    coefficients[..., 0] += v * t + a * t**2 / 2.0
    coefficients[..., 1] += v + a * t
    coefficients[..., 2] += a / 2.0
    return durations, coefficients


def point_of(frame: Frame, problem: Problem, motion: Trajectory) -> Array:
    """A motion in the variables of the relaxation, from its own polynomials."""
    task = frame.relaxed
    times = motion.passage_times[np.append(task.segments, task.segments[-1] + 1)]
    T = np.diff(times) / frame.typical
    v = motion.at(times, 1)[:, task.joints] / task.velocity
    a = motion.at(times, 2)[:, task.joints] / task.acceleration
    v[[0, -1]] = a[[0, -1]] = 0.0  # rest but for rounding
    a[:, ~task.has_jerk] = 0.0
    x = np.zeros(frame.size)
    x[frame.T], x[frame.inverse], x[frame.square] = T, 1.0 / T, T**2
    x[frame.v], x[frame.a] = v, a
    x[frame.W[:, :, 0]], x[frame.W[:, :, 1]] = T[:, None] * a[:-1], T[:, None] * a[1:]
    return x


def frame_for(problem: Problem, horizon: float) -> Frame:
    relaxed = RelaxedProblem.of(problem, horizon)
    low = least_durations(problem)[relaxed.segments]
    return Frame(relaxed, Boxes.around(relaxed, low, horizon - (low.sum() - low)), 2.0 * low)


def random_cuts(frame: Frame, rng: np.random.Generator, m: int = 80) -> Cuts:
    """Rows of every kind, posed anywhere."""
    found = []
    for kind in Kind:
        k, j = rng.integers(frame.L, size=m), rng.integers(frame.n, size=m)
        limited = frame.relaxed.has_jerk[j][:, None]
        low, high = frame.boxes.durations[k].T
        at = np.sort(rng.random((m, 6)) ** rng.choice([0.2, 1.0, 5.0], (m, 1)), axis=1)
        # without a jerk limit: no pieces of jerk
        late = at[:, 3] if kind in CRUISES else at[:, 1]
        plain = np.stack([0.0 * k, at[:, 1], at[:, 1], late, late, 0.0 * k + 1.0], axis=1)
        if kind in (*TANGENTS, *HULLS):
            at = (low + rng.random(m) ** 3 * (high - low))[:, None]
        elif kind in ALL_PRODUCTS:
            at = rng.integers(4, size=(m, 1)).astype(np.float64)
        elif kind in (Kind.PEAK_AT_START, Kind.PEAK_AT_END):
            at = (rng.normal(size=m) * frame.relaxed.acceleration[j] / frame.typical[k])[:, None]
        elif kind in FADES:
            at = (rng.normal(size=m) * frame.relaxed.acceleration[j])[:, None]
        elif kind == Kind.SPEED:
            at = np.where(limited, at[:, :2], [0.0, 1.0])
        elif kind in STOPS:
            at = np.where(limited, at, plain)[:, :2]
        else:
            at = np.where(limited, at, plain)
        cuts = Cuts.of(kind, k, at, j, rng.choice([-1.0, 1.0], m))
        if kind in (*PEAKS, *FADES, Kind.CHANGE):
            cuts = cuts[limited[:, 0]]
        if kind in STOPS:
            cuts = cuts[np.isfinite(frame.relaxed.room).all(axis=(0, 1, 3))[j]]
        if kind in ZONES:
            cuts = cuts[frame.p[cuts.segment, cuts.joint, kind.end] >= 0]
        if kind in (*SPEED_PRODUCTS, *SQUARE_PRODUCTS) or kind.times_T:
            cuts = cuts[frame.short[cuts.segment]]
        # a joint with a velocity limit only has the row at top speed alone
        alone = frame.relaxed.by_speed_alone[cuts.joint] & ~np.isin(kind, (*TANGENTS, *HULLS, *ZONES))
        cuts = cuts[~alone]
        found.append(cuts)
    return Cuts.joined(found)


def limited_by(motion: Trajectory, problem: Problem) -> Problem:
    """The problem with position limits that the motion just keeps."""
    extremes = motion.extremes(0)
    bounds = np.stack([extremes.low.min(axis=0), extremes.high.max(axis=0)], axis=1)
    return replace(problem, limits=replace(problem.limits, position=bounds))


LIMITS: dict[str, tuple[Any, ...]] = {
    "jerk": ([1.0, 2.0, 1.5], [3.0, 2.0, 9.0], [20.0, 4.0, 500.0]),
    "no jerk": ([1.0, 2.0, 1.5], [3.0, 2.0, 9.0]),
    "jerk of one": ([1.0, 2.0, 1.5], [3.0, 2.0, 9.0], [np.inf, 4.0, np.inf]),
    "low jerk": ([3.0, 2.0, 5.0], [30.0, 20.0, 90.0], [2.0, 1.0, 5.0]),
}


def spread(exponents: tuple[float, float], n: int, dof: int, seed: int) -> Array:
    rng = np.random.default_rng(seed)
    steps = 10.0 ** rng.uniform(*exponents, (n, dof)) * rng.choice([-1.0, 1.0], (n, dof))
    return np.cumsum(np.vstack([np.zeros(dof), steps]), axis=0)
