"""What holds the time up: derivatives of the total time by every limit and displacement.

They are read off the multipliers of the program at its solution. Slowing a motion down by 1 + e is the
same as lowering velocity limits by e, acceleration limits by 2 e and jerk limits by 3 e, so for the
fastest motion, with s_i = -dT / d log(limit_i) of order o_i, Euler's identity holds:

    sum_i o_i s_i = T

and o_i s_i is the share of the time that a limit holds. Position limits have no share: slowing down
does not change the path.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.optima.free_form.nlp.program import Program, Solution
from formulations.problem.arrays import Array


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of the total time at the optimum, per segment and joint of the problem.

    limits: (3, n_segments, dof) [s], dT / d log(limit) of velocity, acceleration and jerk: 10 % more of
    a limit changes the time by 0.1 of it, to first order.
    positions: (n_segments, dof, 2) [s/rad], dT / d bound of the lower and upper position limit.
    displacements: (n_segments, dof) [s/rad], dT / d displacement of one segment alone.
    """

    limits: Array
    positions: Array
    displacements: Array

    @property
    def held(self) -> Array:
        """Seconds of the total time that each limit holds, (3, n_segments, dof): they add up to it."""
        return np.asarray(-self.limits * np.array([1.0, 2.0, 3.0])[:, None, None])


def sensitivity(program: Program, solution: Solution) -> Sensitivity:
    """From the multipliers of a solved program that minimises the time."""
    task, second = program.task, program.second
    S, n_segments, dof = task.n_segments, task.problem.n_segments, task.problem.dof
    limits = np.zeros((3, S, dof))
    positions, displacements = np.zeros((S, dof, 2)), np.zeros((S, dof))

    # bounds on segment times, by joints with a velocity limit alone
    ramped, at = task.group(1), S
    if ramped:
        shares = np.abs(task.displacements[:, ramped]) / task.limits[0][:, ramped]
        slowest = np.array(ramped)[shares.argmax(axis=1)]
        mine = (np.arange(S), slowest)
        pull = np.maximum(-solution.bound_multipliers[:S], 0.0)
        limits[(0, *mine)] -= pull * program.low[:S] * second
        with np.errstate(divide="ignore", invalid="ignore"):
            rate = pull * program.low[:S] * second / task.displacements[mine]
        displacements[mine] += np.where(task.displacements[mine] != 0.0, rate, 0.0)

    # bounds on velocity and acceleration at the nodes
    for order, joints in program.groups.items():
        arcs = program.arcs[order - 2]
        if program.free:
            at += len(joints) * S * arcs
        for derivative in range(order - 1):
            size = len(joints) * (S * arcs + 1)
            part = slice(at, at + size)
            ends = program.high[part] == program.low[part]  # states that are given
            pull = np.where(ends, 0.0, np.abs(solution.bound_multipliers[part])) * program.high[part]
            limits[derivative][:, joints] -= (
                _by_segment(pull.reshape(-1, len(joints)), S, arcs) * second
            )
            at += size

    # rows
    at = 0
    guarded = iter(program.shape.guarded)
    for kind, order, n in program.symbols.kinds:
        found = solution.row_multipliers[at : at + n]
        high = program.row_high[at : at + n]
        at += n
        joints = program.groups.get(order, [])
        if kind == "velocity":
            pull = (np.abs(found) * high).reshape(S, -1, len(joints)).sum(axis=1)
            limits[0][:, joints] -= pull * second
        elif kind == "top":
            # d row / d log(limit) = limit h, with h as the solution has it
            reach = _reach(program, solution, order).reshape(-1, len(joints))
            pull = (np.abs(found.reshape(-1, len(joints))) * reach).reshape(S, -1, len(joints))
            limits[order - 1][:, joints] -= pull.sum(axis=1) * second
        elif kind == "displacement":
            displacements[:, joints] -= found.reshape(S, -1) / program.v_unit[joints]
        elif kind == "position":
            _, i, k, *_ = next(guarded)
            unit = program.v_unit[joints[i]]
            positions[k, joints[i]] -= np.array([found[found < 0].sum(), found[found > 0].sum()]) / unit

    def spread(values: Array, axis: int) -> Array:
        """To the problem's own segments; those that take no time hold nothing."""
        shape = list(values.shape)
        shape[axis] = n_segments
        whole = np.zeros(shape)
        whole[(slice(None),) * axis + (task.segments,)] = values
        return whole

    return Sensitivity(spread(limits, 1), spread(positions, 0), spread(displacements, 0))


def _by_segment(pull: Array, segments: int, arcs: int) -> Array:
    """Pulls at the nodes (S arcs + 1, n) summed per segment (S, n); waypoints shared by both sides."""
    inner = pull[:-1].reshape(segments, arcs, -1)
    found = inner[:, 1:].sum(axis=1) + 0.5 * inner[:, 0]
    found[:-1] += 0.5 * inner[1:, 0]
    found[0] += 0.5 * pull[0]
    found[-1] += pull[-1]
    return np.asarray(found)


def _reach(program: Program, solution: Solution, order: int) -> Array:
    """Limit times arc duration in the program's units, flat as its rows."""
    task, joints, arcs = program.task, program.groups[order], program.arcs[order - 2]
    S, n = task.n_segments, len(joints)
    unit = (program.a_unit if order == 3 else program.v_unit)[joints]
    top = task.limits[order - 1][:, joints] * program.second / unit
    if not program.free:
        h = np.repeat(solution.x[:S, None] / arcs, n, axis=1)[:, None]
        return np.asarray(np.repeat(top[:, None] * h, arcs, axis=1).ravel())
    before = S if order == 2 or 2 not in program.groups else S + _size(program, 2)
    h = solution.x[before : before + n * S * arcs].reshape(S, arcs, n)
    return np.asarray((top[:, None] * h).ravel())


def _size(program: Program, order: int) -> int:
    """Number of variables of a group."""
    n, steps = len(program.groups[order]), program.task.n_segments * program.arcs[order - 2]
    return n * (steps * program.free + (steps + 1) * (order - 1))
