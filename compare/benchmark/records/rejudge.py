"""Judge stored rows again, from their durations: a row that its own durations contradict is a fault.

Anybody can change a file, and so can a plug-in. The report therefore takes no number of a row on trust.
It builds the spline of the row's durations, takes its exact extremes by the arithmetic of
`formulations.Trajectory` and not by the swarms' kernels, and compares what follows with what the row
states: time, limits, bound and gap. All rows of a case are judged at once; 5,000 rows take about 1 s.

A row that states a consistent set of numbers for a motion that keeps its limits cannot be told from a
graded one. That no plug-in can write such a row is the task of isolation, not of this file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from compare.benchmark.below_bound import broken_bound
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.provenance import problem_digest
from compare.benchmark.records.rows import Row, RowStatus, RunKey, durations_of, relative_gap
from compare.benchmark.summaries import bound_of
from formulations import FAMILIES, InputError, Problem, Trajectory, check
from formulations.motion.verdict import TOLERANCE
from formulations.problem.arrays import Array, Truths

_ROUNDING = 1e-12  # relative; the sum of the durations on another machine
_SAME = 1e-8  # relative; stretch of the claimed motion, from the verified one


def judged_again(
    rows: Sequence[Row], problems: Mapping[str, Problem], ladders: Mapping[str, LadderRecord]
) -> list[Row]:
    """Judge stored rows again.

    Parameters
    ----------
    rows : sequence of Row
        Rows as they are stored.
    problems : mapping of str to Problem
        The problem of each case.
    ladders : mapping of str to LadderRecord
        The stored bounds of each case.

    Returns
    -------
    list of Row
        The same rows in the same order. Where a row does not hold, it has the status ``contradicted``,
        the reason as its note, and none of its numbers.
    """
    reasons: dict[int, str] = {}
    seen: set[RunKey] = set()
    for index, row in enumerate(rows):
        if row.case not in problems or row.case not in ladders:
            reasons[index] = f"the comparison has no case {row.case}"
        elif row.key in seen:
            reasons[index] = "there is an earlier row of the same run"
        seen.add(row.key)
    for case, problem in problems.items():
        mine = [i for i, row in enumerate(rows) if row.case == case and i not in reasons]
        if mine:
            judge = _Judge(problem, ladders[case], [rows[i] for i in mine])
            reasons |= {mine[k]: reason for k, reason in judge.contradictions()}
    return [contradicted(row, reasons[i]) if i in reasons else row for i, row in enumerate(rows)]


def contradicted(row: Row, reason: str) -> Row:
    """Return a row without its numbers, as a fault.

    Parameters
    ----------
    row : Row
    reason : str
        Why it does not hold.
    """
    return replace(
        row,
        status=RowStatus.contradicted,
        note=reason,
        claimed=None,
        keeps_limits=None,
        stretch=None,
        seconds=None,
        gap=None,
        claimed_gap=None,
        durations=(),
        worst="",
    )


@dataclass(frozen=True)
class _Judge:
    """The rows of one case beside what follows from their durations."""

    problem: Problem
    ladder: LadderRecord
    rows: list[Row]

    def contradictions(self) -> Iterator[tuple[int, str]]:
        """Index and reason of each row that does not hold."""
        for k in range(len(self.rows)):
            for find in self._laws:
                reason = find(k)
                if reason is not None:
                    yield k, reason
                    break

    @cached_property
    def _laws(self) -> tuple[Callable[[int], str | None], ...]:
        """What must hold of a row, the first law first; each says what is wrong, or None."""
        return (
            self._task, self._durations, self._status, self._time, self._limits, self._proved,
            self._gaps, self._claim,
        )  # fmt: skip

    def _task(self, k: int) -> str | None:
        row = self.rows[k]
        if row.problem != self._digest or row.family != self.problem.family:
            return f"it was made for another problem than {row.case}"
        return None

    def _durations(self, k: int) -> str | None:
        row, n = self.rows[k], self.problem.n_segments
        if row.durations and not self._good[k]:
            return f"its durations {row.durations} are not {n} positive times"
        if row.seconds is not None and not row.durations:
            return f"it states {row.seconds:.6g} s and no durations"
        return None

    def _status(self, k: int) -> str | None:
        row = self.rows[k]
        if row.status is RowStatus.contradicted:
            return "it was stored as contradicted"
        if row.status is RowStatus.ok and row.seconds is None:
            return "its status is ok, but it has no verified motion"
        if row.seconds is None and row.durations and self._legal(k):
            return f"its durations keep the limits, but its status is {row.status}"
        return None

    def _time(self, k: int) -> str | None:
        row, total = self.rows[k], float(self._total[k])
        if row.seconds is not None and not np.isclose(row.seconds, total, rtol=_ROUNDING, atol=0.0):
            return f"it states {row.seconds:.9g} s, its durations add up to {total:.9g} s"
        return None

    def _limits(self, k: int) -> str | None:
        if self.rows[k].seconds is None or self._legal(k):
            return None
        return f"its motion does not hold: {self._verdict_faults(k)[0]}"

    def _proved(self, k: int) -> str | None:
        seconds = self.rows[k].seconds
        broken = broken_bound(seconds, self.ladder)
        if broken is None:
            return None
        key, least = broken
        return f"{seconds:.9g} s is less than {least:.9g} s, the certified bound ({key})"

    def _gaps(self, k: int) -> str | None:
        row = self.rows[k]
        bound, proof = self._bound
        if row.bound != bound or row.proof is not proof:
            return f"its gap is measured against {row.bound} s ({row.proof}), not {bound} s ({proof})"
        for name, gap, seconds in (
            ("gap", row.gap, row.seconds),
            ("claimed gap", row.claimed_gap, row.claimed),
        ):
            if gap != relative_gap(seconds, bound):
                return f"it states the {name} {gap}, which is {relative_gap(seconds, bound)}"
        return None

    def _claim(self, k: int) -> str | None:
        """The claimed motion is the verified one, slowed down by its stretch if that is above 1."""
        row = self.rows[k]
        if not row.durations:
            stated = (row.claimed, row.keeps_limits, row.stretch)
            return None if stated == (None, None, None) else f"it claims {row.claimed} s of no motion"
        if row.claimed is None or row.stretch is None or row.keeps_limits is None or row.claimed <= 0:
            return "it has durations but no claim"
        total = float(self._total[k])
        slower = max(row.stretch, 1.0) if row.coding == "published" else 1.0
        if not np.isclose(row.claimed * slower, total, rtol=_SAME, atol=0.0):
            return f"it claims {row.claimed:.9g} s, of which its durations make {total / slower:.9g} s"
        # durations times f: the least feasible stretch is divided by f
        stretch = float(self._stretch[k]) * total / row.claimed
        if not np.isclose(row.stretch, stretch, rtol=_SAME, atol=_SAME):
            return f"it states the stretch {row.stretch:.9g}, which is {stretch:.9g}"
        most = 1.0 + TOLERANCE  # within rounding of it either verdict can be right
        keeps = stretch <= most and bool(self._inside[k])
        if row.keeps_limits is not keeps and abs(stretch - most) > 0.5 * TOLERANCE:
            return f"its claim {'keeps' if keeps else 'breaks'} the limits, against what it states"
        return None

    # --- what follows from the durations; arrays have one entry per row -----------------------------

    @cached_property
    def _digest(self) -> str:
        return problem_digest(self.problem)

    @cached_property
    def _bound(self) -> tuple[float | None, str]:
        return bound_of(self.ladder)

    @cached_property
    def _good(self) -> Truths:
        """Whether a row has one positive time for each segment."""
        n = self.problem.n_segments
        return np.array(
            [len(r.durations) == n and all(0.0 < t < np.inf for t in r.durations) for r in self.rows]
        )

    @cached_property
    def _population(self) -> tuple[Array, Array, Array]:
        """Total time, stretch, and excess over the position limits; NaN where there is no motion."""
        total, stretch, excess = np.full((3, len(self.rows)), np.nan)
        mine = np.flatnonzero(self._good)
        if len(mine):
            durations = np.stack([durations_of(self.rows[k]) for k in mine])
            total[mine], stretch[mine], excess[mine] = exact_extent(self.problem, durations)
        return total, stretch, excess

    @property
    def _total(self) -> Array:
        return self._population[0]

    @property
    def _stretch(self) -> Array:
        return self._population[1]

    @cached_property
    def _inside(self) -> Truths:
        return np.asarray(self._population[2] <= 0.0)

    def _legal(self, k: int) -> bool:
        """Whether the check accepts the motion. It is asked itself where the population is at odds."""
        within = self._inside[k] and self._stretch[k] <= 1.0 + 0.5 * TOLERANCE
        if within and self.rows[k].seconds is not None:
            return True
        return not self._verdict_faults(k)

    def _verdict_faults(self, k: int) -> tuple[str, ...]:
        family = FAMILIES[self.problem.family]
        try:
            with np.errstate(all="ignore"):
                trajectory = family.trajectory(self.problem, durations_of(self.rows[k]))
                return check(self.problem, trajectory).faults
        except InputError as error:  # times so short or long that no number holds the motion
            return (str(error),)


def exact_extent(problem: Problem, durations: Array) -> tuple[Array, Array, Array]:
    """Total time, stretch and excess over the position limits of a population of splines.

    The extremes are those of `formulations.Trajectory`, which shares no code with the swarms' kernels.

    Parameters
    ----------
    problem : Problem
    durations : Array, shape (n, n_segments) [s]

    Returns
    -------
    total : Array, shape (n,) [s]
    stretch : Array, shape (n,)
        Least factor on all durations that keeps the velocity, acceleration and jerk limits; NaN where
        no number holds the motion.
    excess : Array, shape (n,) [rad]
        How far the position limits are left beyond the slack; at most 0 if they are kept.
    """
    with np.errstate(all="ignore"):
        return _exact_extent(problem, durations)


def _exact_extent(problem: Problem, durations: Array) -> tuple[Array, Array, Array]:
    lengths, normalised = FAMILIES[problem.family].pieces(problem, durations)
    n, n_pieces, _, width = normalised.shape
    total = np.cumsum(lengths, axis=1)[:, -1]
    stretch, excess = np.zeros(n), np.full(n, -np.inf)
    limits, bounds = problem.limits.derivatives, problem.position_bounds
    for piece in range(n_pieces):
        # the same piece of every candidate, one after the other: extremes do not ask when it begins
        t = lengths[:, piece]
        coefficients = normalised[:, piece] / t[:, None, None] ** np.arange(width)
        held = np.isfinite(coefficients).all(axis=(1, 2)) & (t > 0.0)
        stretch[~held] = np.nan
        row = Trajectory(np.where(held, t, 1.0), np.where(held[:, None, None], coefficients, 0.0))
        for order in (1, 2, 3):
            if np.isfinite(limits[order - 1]).any():
                extremes = row.extremes(order)
                ratio = np.maximum(-extremes.low, extremes.high) / limits[order - 1]
                np.maximum(stretch, ratio.max(axis=1) ** (1.0 / order), out=stretch)
        if np.isfinite(bounds).any():
            extremes = row.extremes(0)
            over = np.maximum(bounds[:, 0] - extremes.low, extremes.high - bounds[:, 1])
            np.maximum(excess, over.max(axis=1) - problem.position_slack, out=excess)
    return total, stretch, excess
