"""The hunt for a motion that attains the bound of the relaxation: durations are tried, stretched a little."""

from __future__ import annotations

import numpy as np

from formulations.deadlines import Deadline
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import check
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.attaining_motion.durations import descend
from formulations.proofs.every_motion.attaining_motion.motion import connect
from formulations.proofs.every_motion.attaining_motion.states import find_states
from formulations.proofs.every_motion.relaxation.cuts import Cuts

_STRETCHES = (2e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # of durations, tried for a motion


class MotionHunt:
    """The fastest motion known of a problem without conditions, and what was tried for it.

    Attributes
    ----------
    upper : float or None [s]
        Time of the fastest motion known.
    motion : Trajectory or None
        That motion, if it was found here.
    attained : float [s]
        Time of the fastest motion found that may leave the position limits.
    given : bool
        Whether a motion was known before.
    """

    def __init__(self, problem: Problem, upper: float | None) -> None:
        """Begin with what is known.

        Parameters
        ----------
        problem : Problem
        upper : float or None [s]
            Time of a verified motion.
        """
        self.problem, self.upper = problem, upper
        self.motion: Trajectory | None = None
        self.attained = np.inf
        self.given = upper is not None
        self._looking = not self.given  # whether durations nearby are worth their time

    def look(
        self, durations: Array, cuts: Cuts, *, bound: float, gap: float, deadline: Deadline
    ) -> None:
        """Try durations, slightly stretched; then durations nearby.

        Parameters
        ----------
        durations : Array, shape (K,) [s]
            Of the segments that move, at the relaxation's optimum.
        cuts : Cuts
            To begin with.
        bound : float [s]
            The bound proved so far.
        gap : float
            Relative gap to it at which the hunt ends.
        deadline : Deadline
        """
        enough = bound * (1.0 + gap)
        for local in (False, True):
            if local:
                if not self._looking:
                    return
                durations, cuts = descend(self.problem, durations, cuts, deadline)
            for stretch in _STRETCHES[: 4 if self._looking and not local else None]:
                if (self.upper is not None and self.upper <= enough) or self.attained <= enough:
                    return
                if self._try(durations * (1.0 + stretch), cuts, deadline):
                    self._looking = False
                    return

    def _try(self, durations: Array, cuts: Cuts, deadline: Deadline) -> bool:
        """Whether a longer stretch is pointless; a motion that passes the check and is fastest is kept."""
        total = float(durations.sum())
        if self.upper is not None and total >= self.upper:
            return True
        states = find_states(self.problem, durations, cuts, deadline)
        if states is None:
            return False
        motion = connect(self.problem, durations, states)
        if motion is None:
            self.attained = min(self.attained, total)
            return False
        verdict = check(self.problem, motion)
        done = verdict.feasible or not verdict.position_kept  # no stretch changes the positions
        if done:
            self.attained = min(self.attained, total)
        if verdict.feasible:
            self.motion, self.upper = motion, verdict.seconds
        return done
