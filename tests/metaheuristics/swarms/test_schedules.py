"""Schedules: where they start and end, as the papers say."""

from __future__ import annotations

from math import e, sqrt

import pytest

from metaheuristics.swarms.butterfly import grown
from metaheuristics.swarms.mipso import learning_factors, printed_inertia, resolved_inertia
from metaheuristics.swarms.mpso import linear_factor
from metaheuristics.swarms.particles import linear_inertia
from metaheuristics.swarms.whale_lu_2024 import inertia

pytestmark = pytest.mark.filterwarnings("error")


def test_inertia_and_factors_start_and_end_where_the_papers_say() -> None:
    for schedule, start in [
        (linear_inertia, 0.9),
        (resolved_inertia, 0.9),
        (printed_inertia, 0.9 - 0.5 * e),
    ]:
        assert [schedule(0), schedule(1)] == pytest.approx([start, 0.4])
    assert printed_inertia(0) == pytest.approx(-0.459, abs=2e-4)
    assert [*learning_factors(0), *learning_factors(1)] == pytest.approx([2.0, 0.0, 0.0, 2.0])
    assert [*learning_factors(1 / 3)] == pytest.approx([1.5, 0.5])


def test_schedules_start_and_end_where_the_papers_say() -> None:
    assert [linear_factor(0), linear_factor(1)] == pytest.approx([0.05, 0.02])
    assert [linear_factor(0, 0.5, 0.2), linear_factor(1, 0.5, 0.2)] == pytest.approx([0.5, 0.2])
    for s in (-0.5, 0.0, 1.0, 9.0):
        assert [inertia(0, s), inertia(1, s)] == [1.0, 0.0]
    assert inertia(0.5, 0.0) == 0.5 > inertia(0.5, 1.0)
    c = 0.01
    for _ in range(500):
        c = grown(c, 500)
    assert c == pytest.approx(sqrt(0.01**2 + 2 * 0.025), rel=0.02)  # c dc = 0.025 dk
