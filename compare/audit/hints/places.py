"""The places of a paper that can disagree with the rest of it, and whether they do.

A place is a waypoint, a time vector, a point, a sum or a group of totals. It is judged as the audit judges
it, for every reading of the printed digits, but without proofs: whether a motion keeps its limits needs none.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compare.audit.findings import Finding
from compare.audit.findings.claims import claims_of
from compare.audit.findings.points import residual
from compare.audit.findings.unplaced import unplaced_findings
from compare.audit.findings.vectors import position_faults
from compare.audit.findings.waypoints import waypoints_beyond
from compare.audit.motion.minima import reached
from compare.audit.motion.printed_motion import ROOTS, PrintedMotion
from compare.audit.motion.ranged import Undecided
from compare.audit.paper import Paper, Point, PrintedTimes
from formulations import FAMILIES, InputError
from formulations.arms import Chain
from formulations.motion.verdict import QUANTITIES, TOLERANCE

Place = tuple[str, str]  # what it is (waypoint, vector, point, sum, totals), and where

_VECTOR = ("displacement", "minimum", "limits", "other limits")
_POINT = ("point", "reach")
FULL = 0.98  # share of its limits that a motion uses which was made under them
_FAR = 1.5  # stretch at the printed digits that rounding does not explain


@dataclass(frozen=True)
class State:
    """How one place stands.

    Attributes
    ----------
    sound : bool
        Whether it agrees with the rest of the paper.
    used : tuple of float
        Share of its limits that is used: of velocity, acceleration and jerk, as a stretch, for a motion; one
        number for totals and waypoints; empty where there are no limits.
    """

    sound: bool
    used: tuple[float, ...] = ()

    @property
    def use(self) -> float:
        """The largest share."""
        return max(self.used, default=0.0)


SOUND, FAULTY = State(True), State(False)


def faulty_places(paper: Paper, findings: Sequence[Finding]) -> dict[Place, list[Finding]]:
    """Group the faults of an audit by place.

    Parameters
    ----------
    paper : Paper
        What the paper prints.
    findings : sequence of Finding
        Of its audit.

    Returns
    -------
    dict
        Faults by place.
    """
    vectors = {row.where for row in paper.rows}
    found: dict[Place, list[Finding]] = {}
    for finding in findings:
        if finding.kind in _VECTOR:
            what = "vector" if finding.where in vectors else "totals"
            if finding.where.startswith("waypoint "):
                what = "waypoint"
        elif finding.kind in _POINT:
            what = "point"
        elif finding.kind == "sum":
            what = "sum"
        else:
            continue
        found.setdefault((what, finding.where), []).append(finding)
    return found


class Places:
    """Judges the places of changed papers; what a change leaves alone is judged once."""

    def __init__(self) -> None:
        self._vectors: dict[tuple[object, ...], State] = {}
        self._points: dict[tuple[object, ...], State] = {}

    def states(self, paper: Paper, *, longest: bool = False) -> dict[Place, State]:
        """Judge the time vectors, points and sums of a paper.

        Parameters
        ----------
        paper : Paper
            With a change, or without.
        longest : bool
            Whether to judge the vectors of the longest times too. Their rule breaks limits of its own, so they
            are no reason for a hint.

        Returns
        -------
        dict
            State by place; of several vectors at one place the worse one.
        """
        found: dict[Place, State] = {}
        if paper.waypoints is not None:
            wrong = {finding.where for finding in waypoints_beyond(paper)}
            farthest = _share_of_range(paper)
            for i in range(paper.n_waypoints):
                where = f"waypoint {i + 1}"
                found["waypoint", where] = FAULTY if where in wrong else State(True, (farthest,))
            for row in (row for row in paper.rows if longest or not row.of):
                state = self._vector(paper, row)
                before = found.get(("vector", row.where), state)
                found["vector", row.where] = state if before.sound else before
        wrong = {finding.where for finding in claims_of(paper)}
        sums = {claim.where for claim in paper.claims} | {row.where for row in paper.rows}
        found |= {("sum", where): FAULTY if where in wrong else SOUND for where in sums}
        if paper.arm is not None and paper.waypoints is not None:
            for point in paper.points:
                state = self._point(paper, paper.arm.chain, point)
                before = found.get(("point", point.where), state)
                found["point", point.where] = state if before.sound else before
        return found

    def totals(self, paper: Paper) -> dict[Place, State]:
        """Judge the totals without a time vector.

        Parameters
        ----------
        paper : Paper
            With a change, or without.

        Returns
        -------
        dict
            State by place. A group is sound if some motion that keeps the limits is as fast.
        """
        found: dict[Place, State] = {}
        if paper.waypoints is None:
            wrong = {finding.where for finding in unplaced_findings(paper)}
            return {
                ("totals", t.table): FAULTY if t.table in wrong else State(True, (1.0,))
                for t in paper.totals
            }
        for total in paper.totals:
            if total.limits is None:
                continue
            best = reached(paper.problem(total.joint, total.limits))
            if total.value.high < best:
                found["totals", total.table] = FAULTY
            found.setdefault(("totals", total.table), State(True, (best / total.value.high,)))
        return found

    def _point(self, paper: Paper, chain: Chain, point: Point) -> State:
        assert paper.waypoints is not None
        parts = (chain.d, chain.a, chain.alpha, chain.offset, chain.sign, chain.base)
        key = (point, *(part.tobytes() for part in (paper.waypoints[point.waypoint], *parts)))
        if key not in self._points:
            off = residual(paper, point)
            self._points[key] = FAULTY if off.moved or off.turned else SOUND
        return self._points[key]

    def _vector(self, paper: Paper, row: PrintedTimes) -> State:
        if row.limits is None:
            return SOUND
        columns = slice(None) if row.joint is None else slice(row.joint, row.joint + 1)
        assert paper.waypoints is not None
        stated = paper.stated[row.limits].of_joint(row.joint)
        key = (
            row.joint,
            tuple(time.text for time in row.times),
            tuple(time.value for time in row.times),
            *(
                part.tobytes()
                for part in (paper.waypoints[:, columns], stated.derivatives, stated.position)
            ),
        )
        if key not in self._vectors:
            try:
                self._vectors[key] = _state(PrintedMotion.of(paper, row))
            except Undecided:
                self._vectors[key] = SOUND  # the audit cannot judge it either
            except InputError:
                self._vectors[key] = FAULTY  # waypoints beyond their limits of position, for example
        return self._vectors[key]


def _state(motion: PrintedMotion) -> State:
    problem = motion.problem
    peaks = FAMILIES[problem.family].peaks(problem, motion.times[None])[0].T
    used = ((peaks / problem.limits.derivatives) ** ROOTS).max(axis=1)
    stretch = float(used.max())
    if stretch > _FAR or (stretch > 1.0 + TOLERANCE and motion.breaks):
        return FAULTY
    if not _inside(motion) and position_faults(motion):
        return FAULTY
    return State(True, tuple(np.minimum(used, 1.0).tolist()))


def _share_of_range(paper: Paper) -> float:
    """Largest joint angle over the largest limit of position; 0 without such limits."""
    assert paper.waypoints is not None
    bounds = [stated.position[np.isfinite(stated.position)] for stated in paper.stated.values()]
    largest = max((float(np.abs(bound).max()) for bound in bounds if bound.size), default=np.inf)
    return float(np.abs(paper.waypoints).max()) / largest if largest else 0.0


def _inside(motion: PrintedMotion) -> bool:
    """Whether the motion keeps the limits of position at the printed digits."""
    low, high = motion.problem.limits.position.T
    if not np.isfinite([low, high]).any():
        return True
    spline = FAMILIES[motion.problem.family].trajectory(motion.problem, motion.times)
    reached = spline.extremes(0)
    return bool((reached.low >= low).all() and (reached.high <= high).all())


def explained(found: Sequence[Finding], after: State) -> bool:
    """Whether a change explains the faults of one place.

    Parameters
    ----------
    found : sequence of Finding
        The faults.
    after : State
        The place after the change.

    Returns
    -------
    bool
        A motion that fits lower limits than the stated ones is explained if it uses these limits fully then.
    """
    for finding in (finding for finding in found if finding.kind == "other limits"):
        lower = [k for k, quantity in enumerate(QUANTITIES[1:]) if quantity in finding.numbers]
        shares = [after.used[k] for k in lower if k < len(after.used)] or [after.use]
        if min(shares) < FULL:
            return False
    return after.sound
