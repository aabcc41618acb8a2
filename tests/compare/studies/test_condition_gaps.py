"""Motions under each kind of condition come near to their bounds, and none is faster."""

from __future__ import annotations

from dataclasses import replace

import pytest

from compare.studies.condition_gaps import KINDS, answered, calls, drawn_problem, summarise


@pytest.mark.long  # searches and proofs
@pytest.mark.parametrize("kind", KINDS)
def test_a_motion_under_a_condition_is_near_its_bound(kind: str) -> None:
    rows = [row for seed in (0, 1) for row in answered(kind, seed)]
    for row in rows:
        assert row.feasible
        assert -1e-9 <= row.gap <= 1e-4
        assert row.certified == pytest.approx(row.bound, rel=1e-3)
    (summary,) = summarise(rows)
    assert (summary["problems"], summary["found"], summary["near"], summary["below"]) == (2, 2, 2, 0)


def test_the_same_seed_draws_the_same_problem() -> None:
    for kind, seed in calls(3):
        assert drawn_problem(kind, seed) == drawn_problem(kind, seed)
    assert not drawn_problem("two directions", 0).limits.symmetric
    assert all(not drawn_problem(kind, 0).plain for kind in KINDS)


def test_a_motion_below_its_bound_would_be_counted() -> None:
    (row,) = answered("wait", 0)
    broken = type(row)(**{**vars(row), "bound": row.seconds * 1.001})
    assert summarise([broken])[0]["below"] == 1


def test_a_bound_of_nothing_leaves_an_infinite_gap() -> None:
    """Zones that all meet, so that nothing forces time between them, are proved all the same."""
    (row,) = answered("zones", 88)
    assert 0.0 <= row.gap <= 1e-4
    assert summarise([row])[0]["near"] == 1
    nothing = replace(row, bound=0.0)
    assert nothing.gap == float("inf")
    assert summarise([nothing])[0]["near"] == 0
