"""The bound proved once more, so that a checker can follow the proof."""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.deadlines import Deadline
from formulations.proofs.every_motion.beginnings import derived_boxes
from formulations.proofs.every_motion.closed_forms import bound_at_top_speed
from formulations.proofs.every_motion.horizons import BEYOND, HorizonSearch
from formulations.proofs.every_motion.parts import PartedProof
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem

_NEAR = 1e-2  # of the bound: how far above it the horizon of its certificate is at most


def proved_again(search: HorizonSearch, deadline: Deadline) -> tuple[float, float, list[list[Any]]]:
    """Prove a bound near the best one of a search again.

    Parameters
    ----------
    search : HorizonSearch
        It is told of the bound, which may be better than its own.
    deadline : Deadline

    Returns
    -------
    bound : float [s]
    horizon : float [s]
        Of the proof.
    events : list
        As ``events`` describes them; none where the displacement bound is the proof.
    """
    least = search.bounds["displacement"] * (1.0 - 1e-12)
    near = search.seconds * (1.0 if search.long else 1.0 + _NEAR)
    horizon = min(search.known * (1.0 + BEYOND), near)
    relaxed = search.relaxed(horizon)
    if not len(relaxed.joints) or not search.seconds > least * (1.0 + 1e-9):
        return least, least, _without_rows(search)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        target = search.seconds * (1.0 - 1e-8)
        proof = PartedProof(relaxed, horizon, target, search.typical, deadline, for_checker=True)
        events = proof.prove(derived_boxes(relaxed), search.cuts)
    bound = proof.bound
    if not bound > least:
        return least, least, _without_rows(search)
    search.improve(bound)  # a near horizon may prove more
    return bound, horizon, events


def _without_rows(search: HorizonSearch) -> list[list[Any]]:
    """Events that prove displacement at top speed: of a plain problem the checker does so by itself."""
    if search.plain:
        return []
    search.without = frozenset()  # that bound counts all waypoints
    relaxed = RelaxedProblem.under(search.demands, np.inf)
    latest = bound_at_top_speed(relaxed)[1]
    rows = [["b", int(relaxed.waypoints[latest]), (1.0).hex()]] if latest else []
    return [["P"], ["F", rows]]
