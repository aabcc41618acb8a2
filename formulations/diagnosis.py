"""Diagnosis: which limit of which joint holds the motion up on which segment, and what raising it saves.

The multipliers of the free-form program say how much each limit delays the motion, and these shares add
up to the whole time (``optima.free_form.sensitivity``). What a raised limit saves is not estimated from
them: the motion is planned again under the raised limit, and checked.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from formulations.costs.demand_costs import DemandCost
from formulations.deadlines import NEVER, Deadline
from formulations.motion.verdict import QUANTITIES
from formulations.optima.free_form import FreeForm, SearchStatus, free_form
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.joint_words import joint_label
from formulations.problem.problem import Limits, Problem

_LEAST = 1e-3  # of the time: shorter holds are not shown


@dataclass(frozen=True)
class Hold:
    """The share of one limit on one segment in the total time.

    Attributes
    ----------
    joint : int
        From 0.
    quantity : str
        "velocity", "acceleration" or "jerk".
    segment : int
        From 0.
    seconds : float [s]
    """

    joint: int
    quantity: str
    segment: int
    seconds: float


@dataclass(frozen=True)
class Saving:
    """What the motion saves when it is planned again with one limit raised.

    Attributes
    ----------
    joint : int
        From 0.
    quantity : str
        "velocity", "acceleration" or "jerk".
    more : float
        By how much the limit is raised, relative.
    seconds : float [s]
        By how much the motion is faster.
    """

    joint: int
    quantity: str
    more: float
    seconds: float


@dataclass(frozen=True)
class Diagnosis:
    """What holds a motion up.

    Attributes
    ----------
    seconds : float [s]
        Total time of the motion.
    holds : tuple of Hold
        Largest first, those shorter than 1e-3 of the time left out.
    savings : tuple of Saving
        Largest first.
    unexplained : float [s]
        Time minus all shares; small but not 0, since the motion is a local optimum only nearly.
    names : tuple of str
        Names of the joints; empty where they have none.
    costs : tuple of DemandCost
        What each demand costs, by ``demand_costs``; empty where it was not asked for.
    """

    seconds: float
    holds: tuple[Hold, ...]
    savings: tuple[Saving, ...]
    unexplained: float
    names: tuple[str, ...] = ()
    costs: tuple[DemandCost, ...] = ()

    def lines(self) -> list[str]:
        """Write one sentence per hold; the first of each limit also says what raising it saves."""
        saved = {(s.joint, s.quantity): s for s in self.savings}
        text = []
        for hold in self.holds:
            line = (
                f"{joint_label(self.names, hold.joint)}'s {hold.quantity} holds segment {hold.segment + 1} for "
                f"{hold.seconds:.3g} of {self.seconds:.4g} s"
            )
            saving = saved.pop((hold.joint, hold.quantity), None)
            if saving is not None:
                line += f"; {100.0 * saving.more:.3g} % more of it would save {saving.seconds:.3g} s"
            text.append(line)
        return text

    def to_json(self) -> dict[str, object]:
        """The same as plain data. Joints and segments count from 1, as in ``lines``."""
        return {
            "seconds": self.seconds,
            "holds": [self._row(hold) for hold in self.holds],
            "savings": [self._row(saving) for saving in self.savings],
            "unexplained": self.unexplained,
            "demands": [cost.to_json() for cost in self.costs],
        }

    def _row(self, entry: Hold | Saving) -> dict[str, object]:
        row: dict[str, object] = dict(vars(entry))
        row["joint"] = entry.joint + 1
        row["name"] = self.names[entry.joint] if self.names else None
        if isinstance(entry, Hold):
            row["segment"] = entry.segment + 1
        return row


def diagnose(
    problem: Problem,
    found: FreeForm,
    *,
    more: float = 0.1,
    top: int = 4,
    deadline: Deadline = NEVER,
) -> Diagnosis:
    """Share out the time of a free-form motion among the limits, and plan again with raised ones.

    Parameters
    ----------
    problem : Problem
    found : FreeForm
        The motion of this problem. What is saved is that under the same conditions; with times asked for,
        the shares do not add up to the whole time.
    more : float, default 0.1
        By how much a limit is raised, relative.
    top : int, default 4
        Number of limits to raise, one at a time, those with the largest shares first.
    deadline : Deadline
        What a raised limit saves is left out where the time is over before it is known.

    Returns
    -------
    Diagnosis

    Raises
    ------
    InputError
        If a raised limit is not a valid limit.

    See Also
    --------
    free_form : the motion, whose ``sensitivity`` has the shares.

    Notes
    -----
    A motion slowed down by 1 + e keeps velocity limits that are lower by e, acceleration limits by 2 e and
    jerk limits by 3 e, to first order. So the derivatives of the time by the logarithms of the limits,
    times 1, 2 and 3, add up to the time (Euler's identity for homogeneous functions).

    Examples
    --------
    >>> from formulations import Limits, Problem, free_form
    >>> from formulations.diagnosis import diagnose
    >>> problem = Problem.of([[0.0], [1.0]], Limits.of(velocity=100.0, acceleration=4.0, dof=1))
    >>> for line in diagnose(problem, free_form(problem, tolerance=1e-6), more=0.21).lines():
    ...     print(line)
    joint 1's acceleration holds segment 1 for 1 of 1 s; 21 % more of it would save 0.0909 s
    """
    held = _held(problem, found)
    holds = largest_holds(held, found.seconds)
    per_limit = held.sum(axis=1)
    worst = np.argsort(-per_limit, axis=None, kind="stable")[:top]
    savings = []
    for o, j in zip(*np.unravel_index(worst, per_limit.shape), strict=True):
        if per_limit[o, j] > _LEAST * found.seconds and not deadline.over:
            raised, asked = _raised(problem, found.conditions, int(o), int(j), 1.0 + more)
            faster = free_form(raised, conditions=asked, time_limit=deadline.left, stop=deadline.stop)
            if faster.status in (SearchStatus.TIME_LIMIT, SearchStatus.INTERRUPTED):
                break
            savings.append(Saving(int(j), QUANTITIES[int(o) + 1], more, found.seconds - faster.seconds))
    savings.sort(key=lambda saving: -saving.seconds)
    left = found.seconds - float(held.sum())
    return Diagnosis(found.seconds, tuple(holds), tuple(savings), left, problem.names)


def largest_holds(held: Array, seconds: float) -> list[Hold]:
    """List the shares of the limits in a time.

    Parameters
    ----------
    held : Array, shape (3, n_segments, dof) [s]
        Time that each velocity, acceleration and jerk limit holds each segment.
    seconds : float [s]
        The whole time.

    Returns
    -------
    list of Hold
        Largest first, those shorter than 1e-3 of the time left out.
    """
    holds = [
        Hold(int(j), QUANTITIES[o + 1], int(k), float(held[o, k, j]))
        for o, k, j in np.argwhere(held > _LEAST * max(seconds, 1e-300))
    ]
    return sorted(holds, key=lambda hold: -hold.seconds)


def _held(problem: Problem, found: FreeForm) -> Array:
    """Seconds that each limit holds, (3, n_segments, dof)."""
    if found.sensitivity is not None:
        return found.sensitivity.held
    held = np.zeros((3, problem.n_segments, problem.dof))
    if not problem.limits.has_acceleration and not problem.limits.has_jerk:
        # with velocity limits only, the slowest joint holds a whole segment
        share = np.abs(problem.displacements) / problem.limits.velocity
        rows = np.arange(problem.n_segments)
        held[0, rows, share.argmax(axis=1)] = share.max(axis=1)
    return held


def _raised(
    problem: Problem, asked: Conditions, order: int, joint: int, factor: float
) -> tuple[Problem, Conditions]:
    """The problem and its conditions with one limit raised, also where segments have limits of their own."""
    quantity = QUANTITIES[order + 1]
    segments = {
        k: _raised_limits(own, quantity, joint, factor) for k, own in asked.segment_limits.items()
    }
    asked = replace(asked, segment_limits=segments)
    limits = _raised_limits(problem.limits, quantity, joint, factor)
    return replace(problem, limits=limits, conditions=asked), asked


def _raised_limits(limits: Limits, quantity: str, joint: int, factor: float) -> Limits:
    changed = {}
    for name in (quantity, f"{quantity}_interval"):
        values = getattr(limits, name, None)
        if values is not None:
            changed[name] = values.copy()
            changed[name][joint] *= factor
    return replace(limits, **changed)
