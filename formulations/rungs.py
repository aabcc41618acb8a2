"""Every bound of one problem, in order, with what each proves."""

from __future__ import annotations

import importlib.metadata
import platform
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal

import numpy as np

from formulations.families import FAMILIES
from formulations.motion.trajectory import Trajectory, check
from formulations.optima.family.optimum import (
    FamilyOptimum,
    each_joint_alone,
    family_optimum,
    longest_segment,
)
from formulations.optima.free_form import FreeForm, free_form
from formulations.problem.arrays import Array
from formulations.problem.errors import NoFeasibleMotion, UnsupportedProblem
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.bound import FreeFormBound, free_form_bound
from formulations.proofs.family import FamilyBound, family_bound
from formulations.references import REFERENCES, Outcome, copp_on, toppra_on

Kind = Literal["lower", "upper", "reference"]

MEANINGS: dict[str, tuple[Kind, str]] = {
    "displacement": ("lower", "no motion is faster: displacement at top speed"),
    "ruckig_end_to_end": ("lower", "no motion is faster: Ruckig, inner waypoints ignored"),
    "free_form_lower": ("lower", "no motion is faster: the best such bound"),
    "free_form": ("upper", "fastest verified motion through the waypoints"),
    "ruckig_stop_and_go": ("upper", "Ruckig with a full stop at each waypoint"),
    "family_lower": ("lower", "no durations in the family are faster, certified"),
    "family": ("upper", "exact NLP optimum of the family"),
    "family_longest_segment": ("upper", "each joint alone, longest time per segment, stretched"),
    "toppra_family_path": ("reference", "TOPP-RA on the family optimum's path, no jerk limit"),
    "toppra_cubic": ("reference", "TOPP-RA on the clamped cubic, no jerk limit"),
    "copp_family_path": ("reference", "jerk-limited optimum on the family optimum's path"),
}

_GAP, _TIME_LIMIT = 1e-7, 20.0  # of the certified bound of the family; s


@dataclass(frozen=True)
class Rung:
    """One line of the ladder; seconds is None unless status is ok. runtime in s of this machine."""

    key: str
    kind: Kind
    status: str
    seconds: float | None
    certified: bool
    runtime: float
    note: str


@dataclass(frozen=True)
class Ladder:
    """The rungs of one problem by key, and the motions behind those that have one."""

    problem: Problem
    rungs: dict[str, Rung]
    durations: dict[str, Array]
    trajectories: dict[str, Trajectory] = field(repr=False)
    optimum: FamilyOptimum | None = field(repr=False)
    alone: tuple[FamilyOptimum | None, ...] = field(repr=False)
    bound: FamilyBound | None = field(default=None, repr=False)
    free_form: FreeForm | None = field(default=None, repr=False)
    free_form_bound: FreeFormBound | None = field(default=None, repr=False)

    def seconds(self, key: str) -> float | None:
        """The number of a rung [s], None where there is none."""
        return self.rungs[key].seconds

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and text, ready for ``json.dumps``."""
        return {
            "problem": self.problem.name,
            "ladder": {
                rung.key: {
                    "seconds": rung.seconds,
                    "kind": rung.kind,
                    "status": rung.status,
                    "certified": rung.certified,
                    "runtime": rung.runtime,
                    "note": rung.note,
                }
                for rung in self.rungs.values()
            },
            "durations": {key: value.tolist() for key, value in self.durations.items()},
            "versions": versions(),
        }


def ladder(
    problem: Problem,
    *,
    seed: int = 0,
    certify: bool = True,
    certificate: bool = False,
    gap: float = 1e-3,
    progress: Callable[[str], None] | None = None,
) -> Ladder:
    """Climb every rung; a method that cannot be used or fails is a status with its reason.

    certify: prove ``family_lower``. certificate: keep the proofs in ``bound.certificate``
    and ``free_form_bound.certificate``. gap:
    relative gap aimed at between ``free_form`` and ``free_form_lower``.
    """
    climb = _Climb(problem, seed, certificate, gap, progress or (lambda key: None))
    return climb.run(certify)


class _Climb:
    def __init__(
        self,
        problem: Problem,
        seed: int,
        certificate: bool,
        gap: float,
        progress: Callable[[str], None],
    ) -> None:
        self.problem, self.seed, self.certificate, self.gap = problem, seed, certificate, gap
        self.progress = progress
        self.rungs: dict[str, Rung] = {}
        self.durations: dict[str, Array] = {}
        self.trajectories: dict[str, Trajectory] = {}
        self.optimum: FamilyOptimum | None = None
        self.alone: tuple[FamilyOptimum | None, ...] = ()
        self.bound: FamilyBound | None = None
        self.free_form: FreeForm | None = None
        self.free_form_bound: FreeFormBound | None = None

    def run(self, certify: bool) -> Ladder:
        for key in ("displacement", "ruckig_end_to_end", "ruckig_stop_and_go"):
            self._add(key, partial(REFERENCES[key], self.problem))
        self._add("family", self._family)
        self._add("free_form", self._free_form)
        self._add("free_form_lower", self._free_form_lower)
        left_out = Outcome.not_applicable("not asked for")
        self._add("family_lower", self._family_lower if certify else lambda: left_out)
        self._add("family_longest_segment", self._longest_segment)
        self._add("toppra_family_path", self._toppra_family_path)
        self._add("toppra_cubic", lambda: REFERENCES["toppra_cubic"](self.problem))
        self._add("copp_family_path", self._copp_family_path)
        return Ladder(
            self.problem,
            {key: self.rungs[key] for key in MEANINGS},
            self.durations,
            self.trajectories,
            self.optimum,
            self.alone,
            self.bound,
            self.free_form,
            self.free_form_bound,
        )

    def _add(self, key: str, method: Callable[[], Outcome]) -> None:
        self.progress(key)
        started = time.perf_counter()
        try:
            outcome = method()
        except UnsupportedProblem as refusal:
            outcome = Outcome.not_applicable(str(refusal))
        except NoFeasibleMotion as failure:
            outcome = Outcome.failed(str(failure))
        runtime = time.perf_counter() - started
        kind = MEANINGS[key][0]
        certified = outcome.status == "ok" and (kind == "lower" or outcome.trajectory is not None)
        self.rungs[key] = Rung(
            key, kind, outcome.status, outcome.seconds, certified, runtime, outcome.note
        )
        if outcome.durations is not None:
            self.durations[key] = outcome.durations
        if outcome.trajectory is not None:
            self.trajectories[key] = outcome.trajectory

    def _free_form_lower(self) -> Outcome:
        if not self.problem.moving_joints:
            return Outcome.ok(0.0, note="nothing moves")
        found = free_form_bound(
            self.problem,
            gap=self.gap,
            upper=self.rungs["free_form"].seconds,
            time_limit=_TIME_LIMIT,
            record=self.certificate,
        )
        self.free_form_bound = found
        note = f"by {found.method}"
        if found.gap is not None:
            note += f", gap {found.gap:.2g}"
        if found.status != "proved":
            note += f"; {found.ending}"
        # the references' own numbers hold as well, should they be the better ones
        simple = {key: self.rungs[key].seconds or 0.0 for key in ("displacement", "ruckig_end_to_end")}
        best = max(simple, key=lambda key: simple[key])
        if simple[best] > found.seconds:
            return Outcome.ok(simple[best], note=f"that of {best}")
        return Outcome.ok(found.seconds, note=note)

    def _free_form(self) -> Outcome:
        if not self.problem.moving_joints:
            return Outcome.ok(0.0, note="nothing moves")
        found = free_form(self.problem, tolerance=self.gap)
        self.free_form = found
        note = "; ".join([found.method, *found.notes])
        if found.status != "ok":
            note += f"; {found.status}"
        # splines and stops are motions too: whatever is faster is the fastest known
        others = {key: self.rungs[key].seconds for key in ("family", "ruckig_stop_and_go")}
        for key, seconds in others.items():
            if seconds is not None and seconds < found.seconds and key in self.trajectories:
                return Outcome.ok(
                    seconds,
                    durations=np.diff(self.trajectories[key].passage_times),
                    trajectory=self.trajectories[key],
                    note=f"that of {key}; the program's takes {found.seconds:.9g} s",
                )
        return Outcome.ok(
            found.seconds, durations=found.durations, trajectory=found.trajectory, note=note
        )

    def _family(self) -> Outcome:
        optimum = family_optimum(self.problem, seed=self.seed)
        verdict = optimum.verdict
        if not verdict.feasible:
            return Outcome.failed(f"did not pass the check: {verdict.faults[0]}")
        self.optimum = optimum
        return Outcome.ok(
            verdict.seconds,
            durations=optimum.durations,
            trajectory=optimum.trajectory,
            note=f"{optimum.family}; {optimum.agreeing_starts} of {len(optimum.starts)} starts agree",
        )

    def _family_lower(self) -> Outcome:
        if self.optimum is None:
            return Outcome.not_applicable("there is no family optimum to start from")
        bound = family_bound(
            self.problem,
            gap=_GAP,
            time_limit=_TIME_LIMIT,
            optimum=self.optimum,
            record=self.certificate,
        )
        self.bound = bound
        whole = self.rungs["free_form_lower"].seconds or 0.0
        status = bound.status.removeprefix("not applicable: ")
        if bound.status.startswith("not applicable") and not whole > bound.seconds:
            return Outcome.not_applicable(status)
        note = f"{bound.boxes} boxes, gap {bound.gap:.2g}" if bound.boxes else status
        if bound.boxes and status != "proved":
            note += f", {status}"
        if bound.upper < self.optimum.seconds * (1.0 - _GAP):
            note += f"; the proof found a faster motion, {bound.upper:.9g} s"
        if whole > bound.seconds:  # its splines are motions
            gap = self.optimum.seconds / whole - 1.0
            return Outcome.ok(whole, note=f"that of all motions, gap {gap:.2g}; {note}")
        return Outcome.ok(bound.seconds, note=note)

    def _longest_segment(self) -> Outcome:
        if self.optimum is None:
            return Outcome.not_applicable("there is no family optimum")
        self.alone = each_joint_alone(self.problem, seed=self.seed)
        moving = [optimum.durations for optimum in self.alone if optimum is not None]
        if not moving:
            return Outcome.ok(self.optimum.seconds, note="nothing moves")
        rule = longest_segment(self.problem, moving)
        trajectory = FAMILIES[self.problem.family].trajectory(self.problem, rule.durations)
        verdict = check(self.problem, trajectory)
        claim = f"claims {rule.claimed.sum():.6g} s"
        if not verdict.feasible:
            return Outcome.failed(f"{claim}; no stretch mends it: {verdict.faults[0]}")
        broken = "keeps the limits" if rule.stretch <= 1.0 else f"needs a stretch of {rule.stretch:.6g}"
        return Outcome.ok(
            verdict.seconds,
            durations=rule.durations,
            trajectory=trajectory,
            note=f"{claim}, {broken}",
        )

    def _copp_family_path(self) -> Outcome:
        if self.optimum is None:
            return Outcome.not_applicable("there is no family optimum")
        return copp_on(self.problem, self.optimum.trajectory)

    def _toppra_family_path(self) -> Outcome:
        if self.optimum is None:
            return Outcome.not_applicable("there is no family optimum")
        return toppra_on(self.problem, self.optimum.trajectory)


def versions() -> dict[str, str]:
    """Versions of Python, timebound and the libraries that make the numbers."""
    packages = ("timebound", "numpy", "scipy", "numba", "casadi", "toppra", "ruckig", "copp-py")
    found = {"python": platform.python_version()}
    for package in packages:
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            found[package] = "not installed"
    return found
