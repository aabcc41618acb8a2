"""How far motions under limits on tool or motors are from their bounds: rows, summary and text.

The problems are drawn by ``tool_gaps`` and ``torque_gaps``.
"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from compare.screen import table
from formulations import NoFeasibleMotion, Problem, check, free_form, free_form_bound

QUANTILES = (0.1, 0.5, 0.9, 1.0)
_NEAR = 1e-3  # a gap that says the limit costs nothing that the bound does not know
_PROOF = 5.0  # s for a bound, beyond its first linear program


@dataclass(frozen=True)
class LimitAnswer:
    """One problem: times [s] of the motion, None where none was found, and of the bound.

    limit: of the tool's speed [m/s], or the share of its torques that the arm may use. slowed: the fastest
    motion without the limit, slowed down as a whole until it keeps it [s]. runtime, proof: of the search and
    of the bound [s].
    """

    seed: int
    segments: int
    limit: float
    seconds: float | None
    slowed: float
    bound: float
    method: str
    status: str
    runtime: float
    proof: float

    @property
    def gap(self) -> float:
        """Seconds over the bound, minus 1; infinite without a motion."""
        return np.inf if self.seconds is None or self.bound == 0.0 else self.seconds / self.bound - 1.0

    @property
    def slowed_gap(self) -> float:
        """The same of the motion that is slowed down as a whole."""
        return self.slowed / self.bound - 1.0 if self.bound else np.inf


def answer(
    problem: Problem, seed: int, limit: float, tolerance: float, time_limit: float | None
) -> LimitAnswer:
    """Find the fastest motion under a limit on tool or motors, and bound it.

    Parameters
    ----------
    problem : Problem
    seed : int
        Of the problem.
    limit : float
        For the row.
    tolerance : float
        Relative, of the search and of the bound.
    time_limit : float or None [s]
        For the search.

    Returns
    -------
    LimitAnswer
    """
    started = time.perf_counter()
    seconds, slowed, method, status = None, np.inf, "", ""
    try:
        found = free_form(problem, tolerance=tolerance, time_limit=time_limit)
    except NoFeasibleMotion as reason:
        status = str(reason)
    else:
        assert found.trajectory is not None
        seconds = found.seconds if check(problem, found.trajectory).feasible else None
        slowed = next(s.seconds for s in found.stages if s.name.endswith("slowed down"))
        method, status = found.method, str(found.status)
    runtime = time.perf_counter() - started
    bound = free_form_bound(problem, gap=tolerance, upper=seconds, time_limit=_PROOF)
    return LimitAnswer(
        seed,
        problem.n_segments,
        limit,
        seconds,
        slowed,
        bound.seconds,
        method,
        status,
        runtime,
        bound.runtime,
    )


@dataclass(frozen=True)
class LimitSummary:
    """What matters of all problems.

    near: gap of at most 1e-3. below: motions faster than their bound. gap, slowed: quantiles of the gaps of
    the motions that were found, and of those slowed down as a whole. runtime, proof: quantiles too [s].
    """

    problems: int
    found: int
    near: int
    below: int
    gap: tuple[float, ...]
    slowed: tuple[float, ...]
    runtime: tuple[float, ...]
    proof: tuple[float, ...]


def summarise(answers: list[LimitAnswer]) -> dict[str, Any]:
    """Sum all problems up.

    Parameters
    ----------
    answers : list of LimitAnswer

    Returns
    -------
    dict
        A ``LimitSummary``.
    """
    found = [a for a in answers if a.seconds is not None]
    summary = LimitSummary(
        len(answers),
        len(found),
        sum(a.gap <= _NEAR for a in found),
        sum(a.gap < -1e-9 for a in found),
        _quantiles([a.gap for a in found]),
        _quantiles([a.slowed_gap for a in found if np.isfinite(a.slowed)]),
        _quantiles([a.runtime for a in answers]),
        _quantiles([a.proof for a in answers]),
    )
    return asdict(summary)


def _quantiles(values: list[float]) -> tuple[float, ...]:
    return tuple(np.quantile(values, QUANTILES).tolist()) if values else ()


def as_text(answers: list[LimitAnswer], summary: dict[str, Any]) -> str:
    """Show the quantiles, and the problems without a motion.

    Parameters
    ----------
    answers : list of LimitAnswer
    summary : dict
        Of ``summarise``.

    Returns
    -------
    str
    """
    s = LimitSummary(**summary)
    rows = [
        [name, *(form.format(value) for value in values)]
        for name, values, form in (
            ("gap", s.gap, "{:.2%}"),
            ("gap of the motion slowed down as a whole", s.slowed, "{:.0%}"),
            ("search [s]", s.runtime, "{:.1f}"),
            ("bound [s]", s.proof, "{:.1f}"),
        )
        if values
    ]
    text = table(["quantiles", *(f"{q:.0%}" for q in QUANTILES)], rows, right=(1, 2, 3, 4))
    text += (
        f"\n{s.problems} problems, {s.found} motions found, {s.near} with a gap of at most {_NEAR:g}, "
        f"{s.below} below their bounds"
    )
    none = [f"seed {a.seed}: {a.status}" for a in answers if a.seconds is None]
    return "\n".join([text, *none])
