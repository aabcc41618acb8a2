"""What a rung of the ladder is, and what its method returns: one number, or the reason why there is none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array


class RungKind(StrEnum):
    """What the number of a rung says about the fastest motion."""

    LOWER = "lower"  # no motion (of the family) is faster
    UPPER = "upper"  # a verified motion takes this long
    REFERENCE = "reference"  # neither: a timing to compare with


class OutcomeStatus(StrEnum):
    """How the method of a rung ended."""

    OK = "ok"
    NOT_APPLICABLE = "not-applicable"  # the problem gives the method no meaning
    FAILED = "failed"  # the method was run and gave no valid result


class Takes(StrEnum):
    """What the function of a rung is called with."""

    PROBLEM = "problem"
    PATH = "problem and path"  # the family optimum's trajectory
    CLIMB = "climb"  # all that the rungs before it have found


@dataclass(frozen=True)
class Outcome:
    """Answer of one method: a number, or a status with its reason.

    Attributes
    ----------
    status : OutcomeStatus
    seconds : float, optional
        The timing [s]; None unless the status is ok.
    durations : Array, shape (n_segments,), optional
        The same per segment [s].
    trajectory : Trajectory, optional
        The motion that takes this long.
    note : str
        One line: how the number came about, or the reason why there is none.

    Examples
    --------
    >>> Outcome.ok(1.5, note="by hand").seconds
    1.5
    >>> Outcome.not_applicable("no jerk limit").status.value
    'not-applicable'
    """

    status: OutcomeStatus
    seconds: float | None = None
    durations: Array | None = None
    trajectory: Trajectory | None = None
    note: str = ""

    @staticmethod
    def ok(
        seconds: float,
        *,
        durations: Array | None = None,
        trajectory: Trajectory | None = None,
        note: str = "",
    ) -> Outcome:
        """Report a result.

        Parameters
        ----------
        seconds : float
            The timing [s].
        durations : Array, shape (n_segments,), optional
            The same per segment [s].
        trajectory : Trajectory, optional
            The motion that takes this long; an upper bound without one is not called certified.
        note : str
            One line on how the number came about.

        Returns
        -------
        Outcome
        """
        return Outcome(OutcomeStatus.OK, seconds, durations, trajectory, note)

    @staticmethod
    def not_applicable(reason: str) -> Outcome:
        """Report that the problem gives this method no meaning.

        Parameters
        ----------
        reason : str
            One line.

        Returns
        -------
        Outcome
        """
        return Outcome(OutcomeStatus.NOT_APPLICABLE, note=reason)

    @staticmethod
    def failed(reason: str) -> Outcome:
        """Report that the method was run and gave no valid result.

        Parameters
        ----------
        reason : str
            One line.

        Returns
        -------
        Outcome
        """
        return Outcome(OutcomeStatus.FAILED, note=reason)


@dataclass(frozen=True)
class Rung:
    """One entry of ``RUNGS``: what a number of the ladder means, and the function that finds it.

    Attributes
    ----------
    key : str
        Name in the JSON of the ladder.
    kind : RungKind
    name : str
        Name in pictures.
    meaning : str
        What the number says, in one line.
    find : Callable
        Returns an ``Outcome``; ``takes`` says what it is called with.
    takes : Takes
    certified : bool
        Whether the number is a theorem: a lower bound that is proved and rounded down, or an upper bound
        whose motion passes the check. The ladder runs that check itself.
    after : tuple of str
        Keys of the rungs whose results ``find`` looks at, where they are asked for.
    needs : tuple of str
        Those among them that it cannot do without: they are climbed with it.
    knows_conditions : bool
        Whether the number holds under the conditions of a problem; a rung that knows none says so.
    """

    key: str
    kind: RungKind
    name: str
    meaning: str
    find: Callable[..., Outcome]
    takes: Takes = Takes.PROBLEM
    certified: bool = False
    after: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    knows_conditions: bool = False
