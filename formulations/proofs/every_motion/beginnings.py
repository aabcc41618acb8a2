"""Where the search for a bound begins: bounds in closed form, and the first boxes of a horizon."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.proofs.displacement import displacement_bound
from formulations.proofs.every_motion.closed_forms import (
    bound_at_top_speed,
    least_durations,
    stop_and_go_durations,
    typical_durations,
)
from formulations.proofs.every_motion.relaxation.boxes import Boxes, clipped
from formulations.proofs.every_motion.relaxation.cuts import Cuts, Kind
from formulations.proofs.every_motion.relaxation.propagation import propagate
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, UP, RelaxedProblem
from formulations.proofs.rest_to_rest import end_to_end_bound

_TANGENTS = 4  # for each duration to begin with
_LOOSER = 1e-2  # durations to begin with are looser, so that rows and not boxes carry the bound
_GUESS = 2.0  # times from rest to rest: how long a motion under conditions may be, to begin with
_SHORTEST = 1e-3  # of a greatest duration, where the first tangent is posed
_TINY = 1e-9  # s, the least unit of a duration


def first_bounds(demands: Demands) -> tuple[dict[str, float], Array, float]:
    """Compute the bounds in closed form.

    Parameters
    ----------
    demands : Demands

    Returns
    -------
    bounds : dict of str to float [s]
        By each method.
    typical : Array, shape (n_segments,) [s]
        Durations from rest to rest, about.
    slowest : float [s]
        Time of stop and go; under conditions a guess of what a motion may take.
    """
    problem = demands.problem
    if demands.plain:
        bounds = {
            "displacement": displacement_bound(problem),
            "ruckig_end_to_end": end_to_end_bound(problem),
            "segment": float(least_durations(problem).sum()) * (1.0 - 1e-15 * problem.n_segments),
        }
        typical = stop_and_go_durations(problem)
        return bounds, typical, float(typical.sum())
    relaxed = RelaxedProblem.under(demands, np.inf)
    bound = bound_at_top_speed(relaxed)[0]
    typical = np.ones(problem.n_segments)
    typical[relaxed.segments] = np.maximum(typical_durations(relaxed), _TINY)
    whole = float(typical[relaxed.segments].sum()) + relaxed.waits
    return {"displacement": bound}, typical, _GUESS * max(whole, bound)


def first_boxes(demands: Demands, relaxed: RelaxedProblem, boxes: Boxes | None) -> Boxes:
    """Make the first boxes for a horizon: from those of a longer one, if there are any.

    Parameters
    ----------
    demands : Demands
    relaxed : RelaxedProblem
    boxes : Boxes or None

    Returns
    -------
    Boxes
    """
    if boxes is None:
        least = relaxed.at_top_speed
        if demands.plain:
            least = np.maximum(least_durations(demands.problem)[relaxed.segments], least)
        least = np.maximum(least * (1.0 - _LOOSER), relaxed.least)[: relaxed.n_segments]
        boxes = Boxes.around(relaxed, least, relaxed.most[: relaxed.n_segments])
    durations = boxes.durations.copy()
    # no duration is longer than what the least durations of the others leave
    segments = durations[: relaxed.n_segments]
    others = segments[:, 0].sum() - segments[:, 0]
    segments[:, 1] = np.minimum(segments[:, 1], relaxed.horizon * (1.0 + 1e-12) - others)
    empty = bool((durations[:, 0] > durations[:, 1]).any())
    return propagate(relaxed, clipped(relaxed, replace(boxes, durations=durations, empty=empty)))


def derived_boxes(relaxed: RelaxedProblem) -> Boxes:
    """Make the boxes that a checker derives by itself.

    They follow from displacement over top speed, from what the others leave, and from the limits.

    Parameters
    ----------
    relaxed : RelaxedProblem

    Returns
    -------
    Boxes
    """
    least = np.maximum(DOWN * relaxed.at_top_speed, relaxed.least)[: relaxed.n_segments]
    most = np.minimum(relaxed.most[: relaxed.n_segments], relaxed.horizon * UP - (least.sum() - least))
    return Boxes.around(relaxed, least, most)


def tangents(durations: Array) -> Cuts:
    """Pose tangents of 1 / T at durations that are even in the logarithm of T.

    Parameters
    ----------
    durations : Array, shape (K, 2) [s]
        Boxes.

    Returns
    -------
    Cuts
    """
    low, high = durations.T
    at = np.geomspace(np.where(low > 0.0, low, _SHORTEST * high), high, _TANGENTS)
    return Cuts.of(Kind.TANGENT, np.tile(np.arange(len(durations)), _TANGENTS), at.ravel())
