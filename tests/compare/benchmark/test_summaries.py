"""Statistics over seeds: every row is counted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from graded_runs import graded

from compare.benchmark.grade import Trace
from compare.benchmark.summaries import convergence, summaries
from formulations import load


def test_a_summary_counts_every_row_and_leaves_none_out() -> None:
    row = graded(load("sr4c"), 4.7, "published", "random", 0, 30).row
    rows = [
        replace(
            row, case="c", swarm="s", seed=seed, gap=gap, claimed_gap=gap, keeps_limits=kept,
            stretch=1.2 if kept is False else 1.0, seconds=gap,
        )
        for seed, (gap, kept) in enumerate(((0.1, True), (0.3, False), (0.2, False), (None, None)))
    ]  # fmt: skip
    found = summaries(rows)["c", "published", "s"]
    assert (found.seeds, found.unsolved, found.breaking) == (4, 1, 2)
    assert found.gap == pytest.approx(0.2)
    assert (found.least, found.most, found.stretch) == (0.1, 0.3, 1.2)


def test_convergence_is_infinite_before_the_first_feasible_point_and_ends_at_the_best() -> None:
    traces = [[Trace(-1, [10, 40, 100], [4.0, 3.0, 2.0])]]
    grid, (_, middle, _) = convergence(traces, {-1: 2.0}, 100)
    assert np.isinf(middle[grid < 10]).all()
    assert (middle[(grid >= 10) & (grid < 40)] == 1.0).all()
    assert middle[-1] == 0.0
