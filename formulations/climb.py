"""The ladder of one problem: every rung of ``RUNGS`` climbed, each with its status and its runtime."""

from __future__ import annotations

import importlib.metadata
import platform
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from formulations.deadlines import NEVER, Deadline
from formulations.lateness import explained
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import check
from formulations.optima.family.optimum import FamilyOptimum
from formulations.optima.free_form import FreeForm
from formulations.problem.arrays import Array
from formulations.problem.errors import NoFeasibleMotion, UnsupportedProblem
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.bound import FreeFormBound
from formulations.proofs.family import FamilyBound
from formulations.references.reference import Outcome, OutcomeStatus, Rung, RungKind, Takes


@dataclass(frozen=True)
class RungResult:
    """What was found for one rung.

    Attributes
    ----------
    key : str
    kind : RungKind
    status : OutcomeStatus
    seconds : float or None
        The number [s]; None unless the status is ok.
    certified : bool
        Whether the number is a proved lower bound or the time of a verified motion.
    runtime : float
        Time that the method took on this machine [s].
    note : str
        One line: how the number came about, or why there is none.
    """

    key: str
    kind: RungKind
    status: OutcomeStatus
    seconds: float | None
    certified: bool
    runtime: float
    note: str


@dataclass(frozen=True)
class Ladder:
    """The rungs of one problem by key, and what stands behind them.

    Attributes
    ----------
    problem : Problem
    rungs : dict of str to RungResult
        Those asked for, in the order of ``RUNGS``.
    durations : dict of str to Array, shape (n_segments,)
        Durations of the rungs that have them [s].
    trajectories : dict of str to Trajectory
        Motions of the rungs that have one.
    optimum : FamilyOptimum or None
    alone : tuple of FamilyOptimum or None
        The optimum of each joint alone.
    bound : FamilyBound or None
    free_form : FreeForm or None
    free_form_bound : FreeFormBound or None
    """

    problem: Problem
    rungs: dict[str, RungResult]
    durations: dict[str, Array]
    trajectories: dict[str, Trajectory] = field(repr=False)
    optimum: FamilyOptimum | None = field(repr=False)
    alone: tuple[FamilyOptimum | None, ...] = field(repr=False)
    bound: FamilyBound | None = field(default=None, repr=False)
    free_form: FreeForm | None = field(default=None, repr=False)
    free_form_bound: FreeFormBound | None = field(default=None, repr=False)

    def seconds(self, key: str) -> float | None:
        """Return the number of a rung.

        Parameters
        ----------
        key : str
            A key of ``RUNGS``.

        Returns
        -------
        float or None
            Seconds; None if the rung has no number.
        """
        return self.rungs[key].seconds

    def to_json(self) -> dict[str, Any]:
        """Return the ladder as plain numbers and text, ready for ``json.dumps``.

        Returns
        -------
        dict
            Keys ``problem``, ``ladder``, ``durations`` and ``versions``.
        """
        return {
            "problem": self.problem.name,
            "ladder": {
                rung.key: {
                    "seconds": rung.seconds,
                    "kind": rung.kind.value,
                    "status": rung.status.value,
                    "certified": rung.certified,
                    "runtime": rung.runtime,
                    "note": rung.note,
                }
                for rung in self.rungs.values()
            },
            "durations": {key: value.tolist() for key, value in self.durations.items()},
            "versions": versions(),
        }


@dataclass
class Climb:
    """A ladder in the making: options, and all that has been found so far.

    Attributes
    ----------
    problem : Problem
    seed : int
        Seed of the NLP's starts.
    certify : bool
        Whether ``family_lower`` is to be proved.
    certificate : bool
        Whether proofs are to be recorded.
    gap : float
        Relative gap aimed at between ``free_form`` and ``free_form_lower``.
    deadline : Deadline
        Rungs that have not begun when it is over are not climbed, and say so.
    starts : int or None
        Number of starts of the family's NLP; by default one, where a short proof shows that it suffices.
    results, durations, trajectories, optimum, alone, bound, free_form, free_form_bound
        As in ``Ladder``.
    finished : callable
        Called with every result as soon as it is there.
    """

    problem: Problem
    seed: int = 0
    certify: bool = True
    certificate: bool = False
    gap: float = 1e-3
    deadline: Deadline = NEVER
    starts: int | None = None
    results: dict[str, RungResult] = field(default_factory=dict)
    durations: dict[str, Array] = field(default_factory=dict)
    trajectories: dict[str, Trajectory] = field(default_factory=dict)
    optimum: FamilyOptimum | None = None
    alone: tuple[FamilyOptimum | None, ...] = ()
    bound: FamilyBound | None = None
    free_form: FreeForm | None = None
    free_form_bound: FreeFormBound | None = None
    finished: Callable[[RungResult], None] = lambda result: None

    @property
    def search(self) -> dict[str, Any]:
        """Options of every search for an optimum of the family."""
        return {"starts": self.starts, "seed": self.seed, "stop": self.deadline.stop}

    def proof(self, seconds: float) -> dict[str, Any]:
        """List options of a proof.

        Parameters
        ----------
        seconds : float [s]
            Its time limit.

        Returns
        -------
        dict
        """
        left = self.deadline.within(seconds).left
        return {"time_limit": left, "stop": self.deadline.stop, "record": self.certificate}

    def seconds(self, key: str) -> float | None:
        """Return the number of a rung climbed before.

        Parameters
        ----------
        key : str
            A key that the rung in hand names in ``after``.

        Returns
        -------
        float or None
            Seconds; None if the rung has no number, or was not asked for.
        """
        return self.results[key].seconds if key in self.results else None

    def run(
        self,
        rungs: Mapping[str, Rung],
        progress: Callable[[str], None],
        finished: Callable[[RungResult], None] = lambda result: None,
    ) -> Ladder:
        """Climb all rungs, each after those that it looks at.

        Parameters
        ----------
        rungs : mapping of str to Rung
            Entries by key, in the order of the answer.
        progress : callable
            Called with the key of each rung before it is climbed.
        finished : callable
            Called with the result of each rung as soon as it is there.

        Returns
        -------
        Ladder
        """
        self.finished = finished
        for rung in rungs.values():
            self._climb(rung, rungs, progress)
        return Ladder(
            self.problem,
            {key: self.results[key] for key in rungs},
            self.durations,
            self.trajectories,
            self.optimum,
            self.alone,
            self.bound,
            self.free_form,
            self.free_form_bound,
        )

    def _climb(
        self,
        rung: Rung,
        rungs: Mapping[str, Rung],
        progress: Callable[[str], None],
    ) -> None:
        if rung.key in self.results:
            return
        for key in rung.after:
            if key in rungs:
                self._climb(rungs[key], rungs, progress)
        progress(rung.key)
        started = time.perf_counter()
        outcome = self._found(rung)
        self.record(rung, outcome, time.perf_counter() - started)

    def record(self, rung: Rung, outcome: Outcome, runtime: float) -> None:
        """Judge what was found for a rung and keep it, in place of what was found before.

        Parameters
        ----------
        rung : Rung
        outcome : Outcome
        runtime : float [s]
        """
        outcome = self._judged(rung, outcome)
        shown = rung.kind is RungKind.LOWER or outcome.trajectory is not None
        certified = rung.certified and outcome.status is OutcomeStatus.OK and shown
        self.results[rung.key] = RungResult(
            rung.key, rung.kind, outcome.status, outcome.seconds, certified, runtime, outcome.note
        )
        self.finished(self.results[rung.key])
        if outcome.durations is not None:
            self.durations[rung.key] = outcome.durations
        if outcome.trajectory is not None:
            self.trajectories[rung.key] = outcome.trajectory

    def _found(self, rung: Rung) -> Outcome:
        """Call the function of a rung; a refusal or a failure is a status with its reason."""
        if self.deadline.over:
            ended = "it was interrupted" if self.deadline.interrupted else "the time limit was over"
            return Outcome.failed(f"{ended} before it began")
        try:
            if not rung.knows_conditions:
                self.problem.require_plain(f"unsupported: {rung.key}")
            if rung.takes is Takes.PROBLEM:
                return rung.find(self.problem)
            if rung.takes is Takes.CLIMB:
                with explained(self.problem, deadline=self.deadline):
                    return rung.find(self)
            if self.optimum is None:
                return Outcome.not_applicable("there is no family optimum")
            return rung.find(self.problem, self.optimum.trajectory)
        except UnsupportedProblem as refusal:
            return Outcome.not_applicable(str(refusal))
        except NoFeasibleMotion as failure:
            return Outcome.failed(str(failure))

    def _judged(self, rung: Rung, outcome: Outcome) -> Outcome:
        """Check the motion of an upper bound, whoever made it."""
        if rung.kind is not RungKind.UPPER or outcome.trajectory is None:
            return outcome
        verdict = check(self.problem, outcome.trajectory, conditions=self.problem.conditions)
        if verdict.feasible:
            return outcome
        return Outcome.failed(f"did not pass the check: {verdict.faults[0]}")


def versions() -> dict[str, str]:
    """Return the versions of Python, timebound and the libraries that make the numbers.

    Returns
    -------
    dict of str to str
        "not installed" where a library is missing.
    """
    packages = ("timebound", "numpy", "scipy", "numba", "casadi", "toppra", "ruckig", "copp-py")
    found = {"python": platform.python_version()}
    for package in packages:
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            found[package] = "not installed"
    return found
