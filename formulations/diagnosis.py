"""What holds the time up: which joint's which limit, on which segment, and what more of it would save.

The multipliers of the free-form program say by how much each limit delays the motion; as slowing down
by 1 + e is the same as lowering velocity limits by e, acceleration limits by 2 e and jerk limits by
3 e, they share out the whole time (``free_form.sensitivity``). What more of a limit saves is not taken
from them: the motion is planned again under the raised limit, and checked.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from formulations.motion.verdict import QUANTITIES
from formulations.optima.free_form import FreeForm, free_form
from formulations.problem.arrays import Array
from formulations.problem.problem import Limits, Problem

_LEAST = 1e-3  # of the time: holds shorter than this are not worth a line


@dataclass(frozen=True)
class Hold:
    """A limit holds a segment for ``seconds`` of the total time. Joint and segment count from 0."""

    joint: int
    quantity: str
    segment: int
    seconds: float


@dataclass(frozen=True)
class Saving:
    """Planned again with ``more`` of one limit, the motion takes ``seconds`` [s] less."""

    joint: int
    quantity: str
    more: float
    seconds: float


@dataclass(frozen=True)
class Diagnosis:
    """What holds up a motion of ``seconds`` [s]: holds and savings, largest first.

    unexplained: what is not shared out [s], as the motion is only nearly a local optimum.
    """

    seconds: float
    holds: tuple[Hold, ...]
    savings: tuple[Saving, ...]
    unexplained: float

    def lines(self) -> list[str]:
        """One sentence per hold; the savings of its limit behind the first one."""
        saved = {(s.joint, s.quantity): s for s in self.savings}
        text = []
        for hold in self.holds:
            line = (
                f"joint {hold.joint + 1}'s {hold.quantity} holds segment {hold.segment + 1} for "
                f"{hold.seconds:.3g} of {self.seconds:.4g} s"
            )
            saving = saved.pop((hold.joint, hold.quantity), None)
            if saving is not None:
                line += f"; {100.0 * saving.more:.3g} % more of it would save {saving.seconds:.3g} s"
            text.append(line)
        return text


def diagnose(problem: Problem, found: FreeForm, *, more: float = 0.1, top: int = 4) -> Diagnosis:
    """Share out the time of a free-form motion, and plan again with ``more`` of the ``top`` limits."""
    held = _held(problem, found)
    holds = [
        Hold(int(j), QUANTITIES[o + 1], int(k), float(held[o, k, j]))
        for o, k, j in np.argwhere(held > _LEAST * max(found.seconds, 1e-300))
    ]
    holds.sort(key=lambda hold: -hold.seconds)
    per_limit = held.sum(axis=1)
    worst = np.argsort(-per_limit, axis=None, kind="stable")[:top]
    savings = []
    for o, j in zip(*np.unravel_index(worst, per_limit.shape), strict=True):
        if per_limit[o, j] > _LEAST * found.seconds:
            faster = free_form(_raised(problem, int(o), int(j), 1.0 + more))
            savings.append(Saving(int(j), QUANTITIES[int(o) + 1], more, found.seconds - faster.seconds))
    savings.sort(key=lambda saving: -saving.seconds)
    return Diagnosis(found.seconds, tuple(holds), tuple(savings), found.seconds - float(held.sum()))


def _held(problem: Problem, found: FreeForm) -> Array:
    """Seconds held by each limit, (3, n_segments, dof)."""
    if found.sensitivity is not None:
        return found.sensitivity.held
    held = np.zeros((3, problem.n_segments, problem.dof))
    if not problem.limits.has_acceleration and not problem.limits.has_jerk:
        # with velocity limits alone the slowest joint holds all of a segment
        share = np.abs(problem.displacements) / problem.limits.velocity
        rows = np.arange(problem.n_segments)
        held[0, rows, share.argmax(axis=1)] = share.max(axis=1)
    return held


def _raised(problem: Problem, order: int, joint: int, factor: float) -> Problem:
    derivatives = problem.limits.derivatives.copy()
    derivatives[order, joint] *= factor
    velocity, acceleration, jerk = derivatives
    limits = Limits.of(velocity, acceleration, jerk, problem.limits.position, dof=problem.dof)
    return replace(problem, limits=limits)
