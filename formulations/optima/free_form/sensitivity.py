"""Sensitivity: derivatives of the total time by every limit and displacement, from the multipliers.

A motion slowed down by 1 + e keeps velocity limits that are lower by e, acceleration limits by 2 e and
jerk limits by 3 e, to first order. So for the fastest motion, with s_i = -dT / d log(limit_i) of a limit
of order o_i, Euler's identity holds:

    sum_i o_i s_i = T

and o_i s_i is the share of the time that a limit holds. Position limits have no share, since slowing
down does not change the path.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.optima.free_form.nlp.blocks import Block
from formulations.optima.free_form.nlp.program import FreeFormNLP, NLPSolution
from formulations.problem.arrays import Array


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of the total time at the optimum, per segment and joint of the problem.

    Attributes
    ----------
    limits : Array, shape (3, n_segments, dof) [s]
        dT / d log(limit) of velocity, acceleration and jerk limits: 10 % more of a limit changes the
        time by 0.1 of the entry, to first order.
    positions : Array, shape (n_segments, dof, 2) [s/rad]
        dT / d bound of the lower and the upper position limit.
    displacements : Array, shape (n_segments, dof) [s/rad]
        dT / d displacement of one segment alone.
    """

    limits: Array
    positions: Array
    displacements: Array

    @property
    def held(self) -> Array:
        """Seconds of the total time that each limit holds, (3, n_segments, dof); their sum is the time."""
        return np.asarray(-self.limits * np.array([1.0, 2.0, 3.0])[:, None, None])


class _Derivatives:
    """The same for the segments that take time, filled in block by block."""

    def __init__(self, program: FreeFormNLP, solution: NLPSolution) -> None:
        self.program, self.solution = program, solution
        self.task, self.numbers = program.task, program.numbers
        S, dof = self.task.n_segments, self.task.problem.dof
        self.limits = np.zeros((3, S, dof))
        self.positions, self.displacements = np.zeros((S, dof, 2)), np.zeros((S, dof))

    def of_times(self, block: Block) -> None:
        """Bounds on segment times, set by joints with a velocity limit only."""
        task, low, S = self.task, self.program.low[block.part], self.task.n_segments
        ramped = task.group(1)
        if not ramped:
            return
        speeds = task.intervals[0][:, ramped]
        ways = task.displacements[:, ramped]
        shares = np.maximum(ways / speeds[..., 1], ways / speeds[..., 0])
        mine = (np.arange(S), np.array(ramped)[shares.argmax(axis=1)])
        pull = np.maximum(-self.solution.bound_multipliers[block.part], 0.0)
        pull = np.where(
            low * self.numbers.second > task.durations[:, 0], pull, 0.0
        )  # else a least time holds
        self.limits[(0, *mine)] -= pull * low * self.numbers.second
        with np.errstate(divide="ignore", invalid="ignore"):
            rate = pull * low * self.numbers.second / task.displacements[mine]
        self.displacements[mine] += np.where(task.displacements[mine] != 0.0, rate, 0.0)

    def of_nodes(self, block: Block, derivative: int) -> None:
        """Bounds on velocity (0) or acceleration (1) at the nodes."""
        joints, arcs = self.numbers.groups[block.order], self.numbers.arcs_of(block.order)
        low, high = self.program.low[block.part], self.program.high[block.part]
        # states that are given have no limit
        found = self.solution.bound_multipliers[block.part]
        pull = np.where(high == low, 0.0, np.where(found > 0.0, found * high, found * low))
        per_segment = _by_segment(pull.reshape(-1, len(joints)), self.task.n_segments, arcs)
        self.limits[derivative][:, joints] -= per_segment * self.numbers.second

    def of_row(self, block: Block) -> None:
        """The rows of one block."""
        S, joints = self.task.n_segments, self.numbers.groups.get(block.order, [])
        found = self.solution.row_multipliers[block.part]
        if block.name == "velocity":
            low, high = self.program.row_low[block.part], self.program.row_high[block.part]
            pull = np.where(found > 0.0, found * high, found * low)
            pull = pull.reshape(S, -1, len(joints)).sum(axis=1)
            self.limits[0][:, joints] -= pull * self.numbers.second
        elif block.name in ("top", "fall"):
            # d row / d log(limit) = limit h, with h of the solution
            side = int(block.name == "top")
            reach = _reach(self.program, self.solution, block.order, side).reshape(-1, len(joints))
            pull = (np.abs(found.reshape(-1, len(joints))) * reach).reshape(S, -1, len(joints))
            self.limits[block.order - 1][:, joints] -= pull.sum(axis=1) * self.numbers.second
        elif block.name == "displacement":
            self.displacements[:, joints] -= found.reshape(S, -1) / self.numbers.v_unit[joints]
        elif block.place is not None:
            j, k = joints[block.place.member], block.place.segment
            both = np.array([found[found < 0].sum(), found[found > 0].sum()])
            self.positions[k, j] -= both / self.numbers.v_unit[j]


def read_sensitivity(program: FreeFormNLP, solution: NLPSolution) -> Sensitivity:
    """Read the derivatives off the multipliers of a solved program that minimises the time.

    Parameters
    ----------
    program : FreeFormNLP
    solution : NLPSolution

    Returns
    -------
    Sensitivity
    """
    found = _Derivatives(program, solution)
    for block in program.equations.variables:
        if block.name == "times":
            found.of_times(block)
        elif block.name in ("velocity", "acceleration"):
            found.of_nodes(block, ("velocity", "acceleration").index(block.name))
    for block in program.equations.rows:
        found.of_row(block)
    task = program.task

    def spread(values: Array, axis: int) -> Array:
        """To the problem's own segments; those that take no time hold nothing."""
        shape = list(values.shape)
        shape[axis] = task.problem.n_segments
        whole = np.zeros(shape)
        whole[(slice(None),) * axis + (task.segments,)] = values
        return whole

    return Sensitivity(
        spread(found.limits, 1), spread(found.positions, 0), spread(found.displacements, 0)
    )


def _by_segment(pull: Array, segments: int, arcs: int) -> Array:
    """Pulls at the nodes (S arcs + 1, n) summed per segment (S, n); half at a waypoint for each side."""
    inner = pull[:-1].reshape(segments, arcs, -1)
    found = inner[:, 1:].sum(axis=1) + 0.5 * inner[:, 0]
    found[:-1] += 0.5 * inner[1:, 0]
    found[0] += 0.5 * pull[0]
    found[-1] += pull[-1]
    return np.asarray(found)


def _reach(program: FreeFormNLP, solution: NLPSolution, order: int, side: int) -> Array:
    """Limit upwards (1) or downwards (0) times arc duration, in the units and the order of the rows."""
    numbers, arcs = program.numbers, program.numbers.arcs_of(order)
    S, n = program.task.n_segments, len(numbers.groups[order])
    top = numbers.top(order, side).reshape(S, n)
    if not program.free:
        times = solution.x[program.equations.variable("times", 0)]
        h = np.repeat(times[:, None] / arcs, n, axis=1)[:, None]
        return np.asarray(np.repeat(top[:, None] * h, arcs, axis=1).ravel())
    h = solution.x[program.equations.variable("arcs", order)].reshape(S, arcs, n)
    return np.asarray((top[:, None] * h).ravel())
