"""4-3-...-3-4: bounds of the parts of a motion, from short parts to long ones (Verfaillie et al. 1996).

A whole of many segments has too many boxes: every good box of its first half meets every good box of its
second half. A part costs little, and its bound holds whatever the rest does. The bounds of parts that
lie side by side add up, so each one narrows the search for the longer ones and for the whole.

References
----------
G. Verfaillie, M. Lemaitre, T. Schiex: Russian Doll Search for Solving Constraint Optimization Problems,
AAAI 1996.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.domain import data_of
from formulations.proofs.four_three_four.bound import search_of
from formulations.proofs.part import PartBound
from formulations.proofs.proof import Proof

LEAST_SEGMENTS = 8  # fewer are faster without
_LONGEST = 5  # segments of a part
_BOXES = 500  # of one attempt
_SLICE = 20  # boxes between looks at the clock
_ATTEMPTS = 4  # at one part: bisection between what is known and what the best motion takes
_BETTER = 1e-3  # relative; less is not worth an attempt


def parts_of(
    problem: Problem,
    durations: Array,
    horizon: float,
    *,
    record: bool,
    over: Callable[[], bool],
    progress: Callable[[int], None],
) -> tuple[PartBound, ...]:
    """Prove lower bounds of parts of every motion of at most ``horizon`` seconds.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    durations : Array, shape (n_segments,) [s]
        Of the best motion known: no part can be bounded by more than it takes there.
    horizon : float [s]
        Their total, or more.
    record : bool
        Whether the events are kept for a certificate.
    over : callable
        Asked again and again whether to end now.
    progress : callable
        Is called with the boxes of each attempt.

    Returns
    -------
    tuple of PartBound
        From short parts to long ones; none of a problem of few segments.
    """
    n = problem.n_segments
    if n < LEAST_SEGMENTS:
        return ()
    source = data_of(problem)
    shortest = source.shortest(horizon)
    found: list[PartBound] = []
    for length in range(1, _LONGEST + 1):
        for start in range(n - length + 1):
            part = (start, start + length)
            known = least_time(shortest, part, found)
            low, high = known, float(durations[start : start + length].sum())
            best: Proof | None = None
            for _ in range(_ATTEMPTS):
                middle = 0.5 * (low + high)
                if over():
                    return tuple(found)
                if middle < known * (1.0 + _BETTER):
                    break
                proof = Proof(
                    search_of(source, part, middle, horizon, found, narrow=1e-3), middle, record=record
                )
                while proof.depth > 0 and not proof.stuck and proof.boxes < _BOXES and not over():
                    proof.run(_SLICE)
                progress(proof.boxes)
                if proof.proved:
                    low, best = middle, proof
                else:
                    high = middle
            if best is not None:
                log = best.log() if record else None
                found.append(PartBound(*part, best.L, horizon, best.search.parts, log))
    return tuple(found)


def least_time(shortest: Array, part: tuple[int, int], known: Sequence[PartBound]) -> float:
    """Add up the best bounds of parts side by side, in floating point.

    Parameters
    ----------
    shortest : Array, shape (n_segments,) [s]
        Lower bounds of the durations.
    part : (int, int)
        First segment, and the one after the last.
    known : sequence of PartBound
        Bounds of parts.

    Returns
    -------
    float [s]
        Lower bound of the part's time, not rounded.
    """
    start, end = part
    total = np.zeros(end + 1)
    for k in range(start, end):
        total[k + 1] = total[k] + shortest[k]
        for p in known:
            if p.end == k + 1 and p.start >= start:
                total[k + 1] = max(total[k + 1], total[p.start] + p.seconds)
    return float(total[end])
