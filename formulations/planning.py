"""``plan``: the fastest motion through the waypoints of a problem, with its distance from the proved bound."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from formulations.deadlines import Deadline
from formulations.deadlines.deadline import Stop
from formulations.lateness import explained
from formulations.motion.picture import motion_picture
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict
from formulations.optima.at_rate.export import Export, check_export, export_motion
from formulations.optima.free_form import FreeForm, free_form, proved_motion
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.bound import FreeFormBound

_PROOF, _EACH = 20.0, 0.1  # s for the bound, where the time limit leaves more; at least per segment
_KEPT = 0.25  # of a time limit that the motion leaves to the bound, which needs no more than it is given above

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class PlannedMotion:
    """The fastest motion found, verified, and what no motion can beat.

    Attributes
    ----------
    problem : Problem
    found : FreeForm
        The motion and how it was found.
    proof : FreeFormBound or None
        The lower bound of the motions that keep the same conditions, their total time aside; None if it
        was not asked for.
    """

    problem: Problem
    found: FreeForm
    proof: FreeFormBound | None

    @property
    def seconds(self) -> float:
        """Time of the motion [s]."""
        return self.found.seconds

    @property
    def bound(self) -> float | None:
        """Certified lower bound: no motion takes less [s]. None without a proof."""
        return None if self.proof is None else self.proof.seconds

    @property
    def gap(self) -> float | None:
        """How far the motion is from the bound, relative: seconds / bound - 1. None without a proof."""
        if self.bound is None:
            return None
        return max(self.seconds / self.bound - 1.0, 0.0) if self.bound > 0.0 else 0.0

    @property
    def trajectory(self) -> Trajectory:
        """The motion as polynomials; raises InputError where no joint moves."""
        if self.found.trajectory is None:
            raise InputError(f"{self.problem.name}: no joint moves, so there is no motion")
        return self.found.trajectory

    @property
    def verdict(self) -> Verdict | None:
        """What the independent check found; None where no joint moves."""
        return self.found.verdict

    def to_csv(self, path: str | Path, *, rate: float | None = None) -> Export:
        """Write the motion for a controller; the file is read back and judged before it gets its name.

        Parameters
        ----------
        path : str or Path
            Ends in .csv.
        rate : float, optional
            Points per second [1/s]. Left out: points where the jerk switches.

        Returns
        -------
        Export
            What was written, and what the points cost.

        Raises
        ------
        InputError
            For another suffix, a rate that cannot be, or a file that cannot be written.
        NoFeasibleMotion
            The points are too coarse; the message says at which rate they keep the limits.
        """
        if Path(path).suffix.lower() != ".csv":
            raise InputError(f"path: {path} does not end in .csv; export_motion writes other formats")
        check_export(path, self.problem, rate, self.found.conditions)
        return export_motion(
            path, self.problem, self.trajectory, rate, conditions=self.found.conditions
        )

    def plot(self) -> Figure:
        """Draw position to jerk of each joint, with limits and units.

        Returns
        -------
        Figure
            Of matplotlib; ``figure.savefig(path)`` writes it, ``plt.show()`` shows it.
        """
        return motion_picture(self.problem, self.trajectory, repr(self))

    def __repr__(self) -> str:
        words = f"{self.problem.name}: {self.seconds:.9g} s"
        if self.bound is not None:
            words += f", no motion takes less than {self.bound:.9g} s (gap {self.gap:.2g})"
        return f"{words}, verified"


def plan(
    problem: Problem,
    *,
    conditions: Conditions | None = None,
    gap: float = 1e-3,
    bound: bool = True,
    time_limit: float | None = None,
    stop: Stop | None = None,
    progress: Callable[[str], None] | None = None,
) -> PlannedMotion:
    """Find the fastest motion through the waypoints, and prove how much faster one could be.

    Where the bound leaves a larger gap than asked for, the search begins again from what the bound says of the
    waypoints (``proved_motion``).

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    conditions : Conditions, optional
        Zones, times, stops, waits, states at the ends, limits of single segments; those of the problem if
        left out. The bound is that of the motions that keep them; with a total time it says how fast they
        could be. With torque limits it is the bound of all motions that keep the others, so
        that the gap holds what torques cost.
    gap : float, default 1e-3
        Relative gap to be reached.
    bound : bool, default True
        Whether to prove the lower bound too, for which it takes 20 s at the most, or 0.1 s per segment.
    time_limit : float, optional [s]
        End after this time, with the best motion that was verified and the best bound that was proved. A
        quarter of it, at most what the bound takes, is kept for the bound.
    stop : callable, optional
        Asked again and again whether to end now, in the same way.
    progress : callable, optional
        Called with one line for each stage.

    Returns
    -------
    PlannedMotion

    Raises
    ------
    InputError
        For conditions that do not fit the problem.
    NoFeasibleMotion
        No motion was found that keeps what was asked for; where a latest time is proved to be out of reach,
        the message says so with both times. NotFoundInTime, which is one, where the time ended
        before a motion was verified.

    Examples
    --------
    >>> import formulations as f
    >>> motion = f.plan(f.Problem([[0], [90]], {"velocity": 90, "acceleration": 90}, unit="deg"))
    >>> print(motion)
    problem: 2 s, no motion takes less than 2 s (gap 0), verified
    """
    if not isinstance(problem, Problem):
        raise InputError(f"problem: expected a Problem (load reads one), got {problem!r:.50}")
    if not (np.isfinite(gap) and gap > 0.0):
        raise InputError(f"gap: {gap:g} is not positive")
    say = progress or (lambda line: None)
    asked = problem.conditions if conditions is None else conditions
    deadline = Deadline(time_limit, stop)
    for_proof = max(_PROOF, _EACH * problem.n_segments)
    kept = min(for_proof, _KEPT * (time_limit or 0.0)) if bound else 0.0
    with explained(problem, asked, deadline=deadline):
        found = free_form(
            problem,
            conditions=asked,
            tolerance=gap,
            time_limit=None if time_limit is None else time_limit - kept,
            stop=stop,
            progress=lambda what, seconds: say(f"{what}: {seconds:.6g} s"),
        )
    proof = None
    if bound:
        say("how fast any motion could be")
        found, proof = proved_motion(
            found,
            gap=gap,
            time_limit=deadline.within(for_proof).left,
            stop=stop,
        )
    return PlannedMotion(problem, found, proof)
