"""Problems under limits on tool and torques: the same seed draws the same one, and gaps are summed up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from small_arms import SIX, six_axes

from compare.studies import tool_gaps, torque_gaps
from compare.studies.limit_gaps import LimitAnswer, as_text, summarise
from formulations.problem.torque import TorqueLimits

ROW = LimitAnswer(0, 2, 0.5, 1.1, 2.0, 1.0, "program", "ok", 1.0, 0.5)


def test_the_same_seed_draws_the_same_problem() -> None:
    assert tool_gaps.drawn_problem(3) == tool_gaps.drawn_problem(3)
    assert tool_gaps.drawn_problem(3) != tool_gaps.drawn_problem(4)
    assert 0.2 <= (tool_gaps.drawn_problem(3).conditions.tool_speed or 0.0) <= 1.0
    pytest.importorskip("pinocchio", reason="pin is not installed (extra dynamics)")
    pytest.importorskip("yourdfpy", reason="yourdfpy is not installed (extra robot)")
    arm = TorqueLimits(six_axes(), SIX)
    (problem, share), (again, _) = (torque_gaps.drawn_problem(arm, 3) for _ in range(2))
    assert problem == again
    assert problem.conditions.torque is not None
    assert np.allclose(problem.conditions.torque.limits, share * np.array([120, 120, 70, 20, 20, 20.0]))


def test_a_motion_below_its_bound_and_one_that_is_missing_are_counted() -> None:
    rows = [ROW, replace(ROW, seed=1, seconds=0.9), replace(ROW, seed=2, seconds=None, status="none")]
    summary = summarise(rows)
    assert (summary["problems"], summary["found"], summary["below"], summary["near"]) == (3, 2, 1, 1)
    assert summary["gap"][-1] == pytest.approx(0.1)
    assert summary["slowed"][1] == pytest.approx(1.0)
    assert rows[2].gap == np.inf
    assert as_text(rows, summary).endswith("seed 2: none")


@pytest.mark.long  # a search and a proof
def test_a_problem_is_answered() -> None:
    (row,) = tool_gaps.answered(*tool_gaps.calls(3)[2])
    assert row.seed == 2
    assert row.seconds is not None
    assert -1e-9 <= row.gap < 0.02
    assert row.slowed > row.seconds
