"""What each demand on a motion costs, in seconds: the task is solved again without it, motion and bound.

The motion gives the estimate, motion and bound of both tasks the interval that is proved. What widens the
choice of motions, such as a zone, is asked the other way round: what it saves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from formulations.costs.left_out import TaskWithout, left_out
from formulations.deadlines import NEVER, Deadline
from formulations.dynamics import torque_peaks
from formulations.optima.free_form import FreeForm, SearchStatus, free_form, proved_motion
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError, NoFeasibleMotion, NotFoundInTime
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.bound import FreeFormBound
from formulations.proofs.status import BoundStatus

_GAP, _PROOF = 1e-4, 20.0  # of each motion and its bound; s for one bound
_LOCAL = 1e-3  # gap of motions under limits on tool or motors, whose search takes long
_MANY = ("all zones", "the limits", "the torque limits")  # subjects that are plural
# a task with the slower motions has motions that are not among those of the other one
_NOT_NESTED = ("segment limits", "cycle")
_TORQUES = ("torque", "joint torque")  # the bound knows none, so that it is the same without them
_IDLE = 0.99  # of its limit: a torque that stays below it does not hold a motion up
_NOTHING = 1e-5  # s
_LONGER = (
    2.0  # times the search of the motion itself: so much a demand has before others have their share
)
_CUT_SHORT = (SearchStatus.TIME_LIMIT, SearchStatus.INTERRUPTED)


@dataclass(frozen=True)
class DemandCost:
    """What one demand costs, or saves.

    Attributes
    ----------
    demand : str
        Its kind: "zones" (all of them), "zone", "window", "passage", "least time", "greatest time",
        "wait", "stop", "segment limits", "start state", "end state", "cycle", "total", "asymmetric limit",
        "tool speed", "segment tool speed", "tool ball", "torque" (of all joints) or "joint torque".
    what : str
        The demand in words; waypoints and segments count from 1.
    place : int or None
        Waypoint, segment or joint that it is about, from 0.
    saves : bool
        Whether it lets motions be faster, so that the seconds are saved; else they are lost.
    seconds : float or None [s]
        Difference of the two motions that were found; None where it is not known.
    least, greatest : float [s]
        What is proved: the difference of the two least times of verified motions lies between these.
    unknown : str
        Why the cost is not known; empty where it is.
    """

    demand: str
    what: str
    place: int | None
    saves: bool
    seconds: float | None
    least: float
    greatest: float
    unknown: str = ""

    @property
    def line(self) -> str:
        """The cost in one sentence."""
        if self.seconds is None:
            return f"{self.what}: not known, {self.unknown}"
        verb = ("save" if self.saves else "cost") + ("" if self.what.startswith(_MANY) else "s")
        most = _digits(self.greatest, up=True)
        found = "nothing" if abs(self.seconds) < _NOTHING else f"{self.seconds:.4g} s"
        at_least = self.least > 0.0 and self.greatest >= _NOTHING
        proved = f"at least {_digits(self.least)} s" if at_least else f"at most {most} s"
        return f"{self.what} {verb} {found} (proved: {proved})"

    def to_json(self) -> dict[str, Any]:
        """The same as plain data; the place counts from 1."""
        place = None if self.place is None else self.place + 1
        greatest = self.greatest if np.isfinite(self.greatest) else None
        return {**vars(self), "place": place, "greatest": greatest}


class SolvedTask(NamedTuple):
    """The best motion of a task [s], and what no verified motion of it beats [s]."""

    motion: float
    bound: float

    def over(self, other: SolvedTask) -> tuple[float, float, float]:
        """Compare with another task.

        Parameters
        ----------
        other : SolvedTask

        Returns
        -------
        tuple of float [s]
            How much longer this task takes: by the two motions, at least and at most, proved.
        """
        return self.motion - other.motion, self.bound - other.motion, self.motion - other.bound


def demand_costs(
    problem: Problem,
    conditions: Conditions | None = None,
    *,
    found: FreeForm | None = None,
    proof: FreeFormBound | None = None,
    deadline: Deadline = NEVER,
    progress: Callable[[str], None] | None = None,
) -> tuple[DemandCost, ...]:
    """Solve a task without each of its demands in turn, and say what each costs.

    Parameters
    ----------
    problem : Problem
    conditions : Conditions, optional
        In place of the problem's own.
    found : FreeForm, optional
        The motion under all demands; searched for if left out.
    proof : FreeFormBound, optional
        What is proved of it. It is proved again where that bound went no further than it was asked to.
    deadline : Deadline
        Each demand has half of the time that is left, or twice as long as the motion itself took; the last
        one all that is left.
    progress : callable, optional
        Called with each demand in words before it is left out.

    Returns
    -------
    tuple of DemandCost
        One per demand, largest first; those that are not known, with the reason, last. Where the total time
        is given, the total alone: under it no other demand changes the time.

    Raises
    ------
    NoFeasibleMotion
        No motion was found that keeps all demands.

    Notes
    -----
    With motions of times u and lower bounds b, the least times differ by at least b - u' and at most
    u - b', where a prime marks the task without the demand. Where all motions of one task are motions of the
    other too, the faster of both motions and the greater of both bounds serve both. The bounds are those of
    motions that pass the check, whose tolerances can save a part in 1e8 (``FreeFormBound.least_verified``).
    They know nothing of torques, so that the least cost of a torque limit that is proved is 0.

    Examples
    --------
    A joint turns back at 1 rad, where it stands still in any case, and waits there for half a second:

    >>> from formulations import Conditions, Limits, Problem
    >>> problem = Problem.of([[0.0], [1.0], [0.0]], Limits.of(velocity=10.0, acceleration=4.0, dof=1))
    >>> for cost in demand_costs(problem, Conditions(waits={1: 0.5})):
    ...     print(f"{cost.what} costs {cost.seconds:.4f} s")
    the wait at waypoint 2 costs 0.5000 s
    """
    asked = problem.conditions if conditions is None else conditions
    problem = replace(problem, conditions=asked)
    demands = list(left_out(problem))
    if not demands:
        return ()
    if deadline.over:
        return _all_unknown(demands, _ended(deadline))
    say = progress or (lambda what: None)
    found = found or _fastest(problem, deadline.within(deadline.left / 2.0))
    whole = solved(
        problem,
        deadline.within(deadline.left / 2.0),
        found,
        bound=None if proof is None or _could_be_closer(proof) else _with_times(problem, proof),
    )
    if whole is None:
        return _all_unknown(demands, f"{_ended(deadline)} before the motion itself was found")
    idle, least = _idle_motors(problem, found), _LONGER * found.runtime
    costs = []
    for one in demands:
        part = deadline if one is demands[-1] else deadline.within(max(deadline.left / 2.0, least))
        if deadline.over:
            costs.append(_unknown(one, _ended(deadline)))
            continue
        say(one.what)
        try:
            other = solved(
                replace(one.problem, conditions=one.conditions),
                part,
                found if one.demand == "joint torque" and one.place in idle else None,
                bound=whole.bound if one.demand in _TORQUES else None,
            )
        except NotFoundInTime:
            other = None
        except (
            InputError,
            NoFeasibleMotion,
        ) as reason:  # without it the task is none, or has no motion
            costs.append(_unknown(one, f"nothing can be compared: {reason}"))
            continue
        costs.append(
            _unknown(one, _ended(deadline, "its share of the time"))
            if other is None
            else _compared(one, whole, other)
        )
    return tuple(sorted(costs, key=lambda cost: np.inf if cost.seconds is None else -cost.seconds))


def _compared(one: TaskWithout, whole: SolvedTask, other: SolvedTask) -> DemandCost:
    """What a demand costs, from the task with it and without it."""
    faster, slower = (whole, other) if one.saves else (other, whole)
    nested = one.demand not in _NOT_NESTED
    if nested:
        faster = faster._replace(motion=min(faster.motion, slower.motion))
        slower = slower._replace(bound=max(slower.bound, faster.bound))
    seconds, least, most = slower.over(faster)
    least = max(least, 0.0) if nested else least
    return DemandCost(one.demand, one.what, one.place, one.saves, seconds, least, most)


def _unknown(one: TaskWithout, why: str) -> DemandCost:
    return DemandCost(one.demand, one.what, one.place, one.saves, None, 0.0, np.inf, why)


def _all_unknown(demands: Iterable[TaskWithout], why: str) -> tuple[DemandCost, ...]:
    return tuple(_unknown(one, why) for one in demands)


def _ended(deadline: Deadline, part: str = "the time") -> str:
    if deadline.interrupted:
        return "it was interrupted"
    return f"{'the time' if deadline.over else part} was over"


def solved(
    problem: Problem,
    deadline: Deadline = NEVER,
    found: FreeForm | None = None,
    *,
    bound: float | None = None,
) -> SolvedTask | None:
    """Find the fastest motion of a task and its bound.

    Parameters
    ----------
    problem : Problem
        With its conditions.
    deadline : Deadline
    found : FreeForm, optional
        Its motion, where it is known.
    bound : float, optional [s]
        Its bound, where it is known.

    Returns
    -------
    SolvedTask or None
        None where the time ended the search.
    """
    motion = found or _fastest(problem, deadline)
    if motion.status in _CUT_SHORT:
        return None
    if bound is not None:
        return SolvedTask(motion.seconds, bound)
    motion, proof = proved_motion(
        motion,
        gap=_GAP,
        time_limit=deadline.within(_PROOF).left,
        stop=deadline.stop,
    )
    return SolvedTask(motion.seconds, _with_times(problem, proof))


def _with_times(problem: Problem, proof: FreeFormBound) -> float:
    """What no verified motion beats [s]: what is proved, and the total time where it is given."""
    fixed = problem.conditions.times(problem).get(problem.n_segments)
    return max(proof.least_verified, fixed or 0.0)


def _could_be_closer(proof: FreeFormBound) -> bool:
    """Whether a proof ended at a gap that was asked for, above the one of costs."""
    return proof.status is BoundStatus.PROVED and (proof.gap or 0.0) > _GAP


def _fastest(problem: Problem, deadline: Deadline) -> FreeForm:
    asked = problem.conditions
    tolerance = _LOCAL if asked.ties_joints else _GAP
    return free_form(problem, tolerance=tolerance, time_limit=deadline.left, stop=deadline.stop)


def _idle_motors(problem: Problem, found: FreeForm | None) -> set[int]:
    """Joints whose torques stay below their limits: the motion that was found is as good without these."""
    torque = problem.conditions.torque
    if torque is None or found is None or found.trajectory is None:
        return set()
    peaks = torque_peaks(problem, found.trajectory, torque)
    return {peak.joint for peak in peaks if peak.factor < _IDLE}


def _digits(seconds: float, *, up: bool = False) -> str:
    """Four digits, rounded to the side on which what is said stays proved."""
    if not (np.isfinite(seconds) and seconds > 0.0):
        return f"{seconds:.4g}"
    unit = 10.0 ** (np.floor(np.log10(seconds)) - 3.0)
    return f"{(np.ceil if up else np.floor)(seconds / unit) * unit:.4g}"
