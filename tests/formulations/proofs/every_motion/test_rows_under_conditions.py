"""No row of the relaxation under conditions cuts off a motion that keeps them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from demanded_motions import ENDS, Scenario, scenario
from every_motion_helpers import random_cuts

from formulations import Conditions, Limits, Problem
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.proofs.every_motion.closed_forms import bound_at_top_speed
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.columns import Columns
from formulations.proofs.every_motion.relaxation.cuts import PEAKS, Cuts, Kind
from formulations.proofs.every_motion.relaxation.inequalities import Terms
from formulations.proofs.every_motion.relaxation.propagation import propagate
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.separation import separate

ROUNDING = 1e-8


def demands_of(made: Scenario) -> Demands:
    """The arrays of a scenario as ``Demands``; whose conditions they are does not matter."""
    found = {key: np.asarray(value) for key, value in made.demands.items() if key != "cyclic"}
    velocity, acceleration = (
        np.abs(found[key]).max(axis=(0, 2)) for key in ("velocity", "acceleration")
    )
    limits = Limits.of(velocity, acceleration, found["jerk"].max(axis=0), dof=len(velocity))
    problem = Problem(found["waypoints"].mean(axis=-1), limits)
    asked = Conditions(stops=frozenset({1}))  # not a plain problem
    n = len(found["durations"])
    no_tool = {"tool_speed": np.full(n, np.inf), "tool_radius": np.full(n + 1, np.inf)}
    return Demands(problem, asked, **found, **no_tool, cyclic=made.demands["cyclic"])


def point_of(frame: Frame, made: Scenario) -> Array:
    """The motion in the variables of the relaxation."""
    relaxed = frame.relaxed
    at, j, short, long = relaxed.waypoints, relaxed.joints, frame.short, frame.long
    start, end = relaxed.legs.T
    T = np.maximum(made.arrivals[at][end] - made.leavings[at][start], 0.0) / frame.typical
    v = made.states[at][:, j, 1] / relaxed.velocity
    a = np.where(relaxed.has_jerk, made.states[at][:, j, 2], 0.0) / relaxed.acceleration
    x = np.zeros(frame.size)
    x[frame.T], x[frame.square], x[frame.cube[short]] = T, T**2, T[short] ** 3
    x[frame.inverse[long]] = 1.0 / T[long]
    if relaxed.cyclic:
        v[-1], a[-1] = v[0], a[0]
    x[frame.v], x[frame.a] = v, a
    for side, waypoint in enumerate((start, end)):
        x[frame.W[:, :, side]] = T[:, None] * a[waypoint]
        x[frame.g[short, :, side]] = (T[:, None] * v[waypoint])[short]
        x[frame.X[short, :, side]] = (T[:, None] ** 2 * a[waypoint])[short]
    middles = demands_of(made).waypoints[at][:, j].mean(axis=-1)
    there = relaxed.zones > 0.0
    e = np.divide(made.states[at][:, j, 0] - middles, relaxed.zones, where=there, out=0.0 * middles)
    if relaxed.cyclic:
        e[-1] = e[0]
    x[frame.e[there]] = e[there]
    for side in (0, 1):
        k, i = np.nonzero((frame.p[:, :, side] >= 0) & long[:, None])
        x[frame.p[k, i, side]] = e[relaxed.legs[k, side], i] / T[k]
    return x


def framed(made: Scenario, stretch: float) -> Frame | None:
    """A frame for all motions that are slower by a factor at the most; None where there is no relaxation."""
    demands = demands_of(made)
    relaxed = RelaxedProblem.under(demands, made.leavings[-1] * stretch)
    least = np.maximum(relaxed.least, relaxed.at_top_speed)[: relaxed.n_segments]
    if not len(relaxed.joints) or (relaxed.cyclic and len(least) < 2):
        return None
    assert bound_at_top_speed(RelaxedProblem.under(demands, np.inf))[0] <= made.arrivals[-1] * (
        1 + 1e-12
    )
    most = np.minimum(relaxed.most[: relaxed.n_segments], relaxed.horizon - (least.sum() - least))
    boxes = propagate(relaxed, Boxes.around(relaxed, least * (1 - 1e-12), most * (1 + 1e-12)))
    assert not boxes.empty
    return Frame(relaxed, boxes, 1.7 * least + 0.3)


def with_speed_alone(made: Scenario) -> None:
    """Take the acceleration limit of joints without a jerk limit away."""
    without_jerk = np.isinf(made.demands["jerk"]).all(axis=0)
    made.demands["acceleration"][:, without_jerk] = (-np.inf, np.inf)
    made.demands["end_acceleration"][:, without_jerk] = (-np.inf, np.inf)


@pytest.mark.parametrize("ends", ENDS)
def test_no_row_cuts_off_a_motion_that_keeps_the_conditions(ends: str) -> None:
    seen, short, alone = set(), 0, 0
    for seed in range(30):
        rng = np.random.default_rng(seed)
        made = scenario(rng, ends, n=int(rng.integers(2, 6)))
        if seed % 3 == 0:
            with_speed_alone(made)
        for stretch in (1.0 + 1e-9, 1.5):
            frame = framed(made, stretch)
            if frame is None:
                continue
            x = point_of(frame, made)
            short, alone = short + frame.short.sum(), alone + frame.relaxed.by_speed_alone.sum()
            outside = np.maximum(frame.box[:, 0] - x, x - frame.box[:, 1])
            assert outside.max() <= ROUNDING * (1.0 + np.abs(x).max()), seed
            # rows posed anywhere, and those that cut deepest
            for cuts in (random_cuts(frame, rng), separate(frame, x, -math.inf)):
                rows = frame.of(cuts)
                posed = np.flatnonzero(rows.finite)
                rows = rows[posed]
                size = abs(rows.matrix) @ np.abs(x) + np.abs(rows.upper)
                excess = rows.matrix @ x - rows.upper
                assert (excess <= ROUNDING * (1.0 + size)).all(), seed
                seen |= set(cuts.kind[posed].tolist())
            fixed = frame.fixed()
            assert (fixed.matrix @ x - fixed.upper <= ROUNDING * (1.0 + np.abs(fixed.upper))).all(), (
                seed
            )
    assert short > 10
    assert alone > 0
    assert seen >= set(Kind) - set(PEAKS)


def test_peaks_beside_free_ends_would_cut_motions_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """The fault that the test above must notice: (10) posed where the acceleration need not fade."""
    true = Columns._times_to_fade
    monkeypatch.setattr(
        Frame, "_times_to_fade", lambda frame: (true(frame)[0], ~(true(frame)[1] & False))
    )
    worst = 0.0
    for seed in range(30):
        made = scenario(np.random.default_rng(seed), "free", n=3)
        frame = framed(made, 1.5)
        if frame is None:
            continue
        x = point_of(frame, made)
        cuts = separate(frame, x, -math.inf)
        cuts = cuts[np.isin(cuts.kind, PEAKS)]
        rows = frame.of(cuts)
        worst = max(worst, float((rows.matrix @ x - rows.upper).max(initial=0.0)))
    assert worst > 1e-3


def _weaker(terms: Terms, column: int) -> Terms:
    """The same rows, with a hundredth less room through the term in one column."""
    coefficients = terms.coefficients.copy()
    coefficients[:, column] *= 0.99
    return replace(terms, coefficients=coefficients)


@pytest.mark.parametrize(
    ("method", "kind", "column"),
    [
        ("_of_duration", Kind.HULL_TIMES_T, 1),  # (h + 2 t) T^2
        ("_distance", Kind.DISTANCE_TIMES_T, 6),  # J T^3
        ("_change", Kind.CHANGE, 2),  # J T
    ],
)
def test_a_wrong_row_of_a_short_segment_would_be_noticed(
    method: str, kind: Kind, column: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The faults that the first test must notice: rows times T with a little less room."""
    true = getattr(Frame, method)

    def wrong(frame: Frame, *posed: Any) -> Terms:
        found: Terms = true(frame, *posed)
        named = posed[0] if len(posed) > 1 else kind
        return _weaker(found, column) if named == kind else found

    monkeypatch.setattr(Frame, method, wrong)
    worst = 0.0
    for seed in range(30):
        rng = np.random.default_rng(seed)
        frame = framed(made := scenario(rng, "rest"), 1.5)
        if frame is None:
            continue
        x, cuts = point_of(frame, made), random_cuts(frame, rng)
        with np.errstate(all="ignore"):
            cuts = Cuts.joined([cuts, separate(frame, x, -math.inf)])
        rows = frame.of(cuts[cuts.kind == kind])
        rows = rows[np.flatnonzero(rows.finite)]
        worst = max(worst, float((rows.matrix @ x - rows.upper).max(initial=0.0)))
    assert worst > 1e-5
