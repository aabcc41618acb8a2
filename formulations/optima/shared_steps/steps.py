"""Motions on steps that all joints share: jerks are constant on each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.optima.free_form.nlp.arcs import Arcs
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands


@dataclass(frozen=True)
class Steps:
    """States at the ends of steps, M on each of S segments.

    Attributes
    ----------
    durations : Array, shape (S, M)
        [s].
    states : Array, shape (3, S M + 1, dof)
        Position, velocity and acceleration [rad/s^k].
    """

    durations: Array
    states: Array

    def stretched(self, factor: float) -> Steps:
        """The same path, every time multiplied by a factor.

        Parameters
        ----------
        factor : float

        Returns
        -------
        Steps
        """
        powers = factor ** np.arange(3.0)[:, None, None]
        return Steps(self.durations * factor, self.states / powers)

    def assembled(self, demands: Demands) -> Trajectory:
        """Make a trajectory that passes the waypoints exactly, and stands still where it has to wait.

        Jerks are changed within the tolerance of the solver.

        Parameters
        ----------
        demands : Demands

        Returns
        -------
        Trajectory
        """
        S, M = self.durations.shape
        dof = self.states.shape[2]
        points = np.clip(self.states[0, ::M], *np.moveaxis(demands.waypoints, -1, 0))
        coefficients = np.zeros((S, M, dof, 4))
        for joint in range(dof):
            ends = self.states[1:, ::M, joint].T
            slopes = np.diff(self.states[2, :, joint]).reshape(S, M) / self.durations
            given = Arcs(3, self.durations, slopes, ends)
            arcs = given.projected(np.diff(points[:, joint]))
            v, a = (one[:, :-1] for one in arcs.nodes)
            h, j = arcs.durations, arcs.tops
            moved = np.cumsum(h * (v + h * (a / 2.0 + h * j / 6.0)), axis=1)
            x = points[:-1, joint, None] + np.concatenate([np.zeros((S, 1)), moved[:, :-1]], axis=1)
            coefficients[:, :, joint] = np.stack([x, v, a / 2.0, j / 6.0], axis=-1)
        return _with_waits(demands, self.durations, coefficients, points)


def _with_waits(demands: Demands, durations: Array, coefficients: Array, points: Array) -> Trajectory:
    """Put the waits between the steps (S, M) of the segments; passages are arrivals."""
    times, pieces, passages, clock = [], [], [0.0], 0.0
    for k, (h, rows) in enumerate(zip(durations, coefficients, strict=True)):
        wait = demands.waits[k]
        if wait > 0.0:
            still = np.zeros((1, *rows.shape[1:]))
            still[0, :, 0] = points[k]
            times.append(np.array([wait]))
            pieces.append(still)
        times.append(h)
        pieces.append(rows)
        clock += wait + float(h.sum())
        passages.append(clock)
    total = np.concatenate(times)
    passages[-1] = float(np.cumsum(total)[-1])
    return Trajectory(total, np.concatenate(pieces), np.array(passages))


def sampled(trajectory: Trajectory, demands: Demands, steps: int) -> Steps:
    """Sample a motion on even steps, as a start for the program.

    Parameters
    ----------
    trajectory : Trajectory
        Waits of the demands are skipped.
    demands : Demands
    steps : int
        Per segment, M.

    Returns
    -------
    Steps
    """
    arrivals = trajectory.passage_times
    leaving = arrivals + demands.waits
    seconds = np.maximum(arrivals[1:] - leaving[:-1], 1e-9 * trajectory.seconds)
    shares = np.arange(steps) / steps
    times = np.append((leaving[:-1, None] + seconds[:, None] * shares).ravel(), trajectory.seconds)
    states = np.stack([trajectory.at(np.minimum(times, trajectory.seconds), k) for k in range(3)])
    return Steps(np.repeat(seconds[:, None] / steps, steps, axis=1), states)
