"""The page of rivals: its figures are those of the stored run, and its programs those of the registry."""

from __future__ import annotations

import runpy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from compare.rivals import RIVALS
from compare.rivals.rows import RivalRow
from compare.rivals.run_study import beside

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def maker() -> dict[str, Any]:
    return runpy.run_path(str(DOCS / "pictures" / "rivals.py"))


def test_the_page_shows_the_stored_run(maker: dict[str, Any]) -> None:
    rows, machine = maker["stored"]()
    made = maker["section"](rows, machine)
    assert f"{maker['BEGIN']}\n{made}\n\n{maker['END']}" in maker["PAGE"].read_text("utf-8")


def test_the_run_is_whole(maker: dict[str, Any]) -> None:
    rows, _ = maker["stored"]()
    tasks = {row.problem for row in rows if ", zones" not in row.problem}
    assert len(tasks) == 11
    for task in tasks:
        assert {row.rival for row in rows if row.problem == task} == {"timebound", *RIVALS}
        zoned = [row for row in rows if row.problem.startswith(f"{task}, zones")]
        assert {row.rival for row in zoned} == {"timebound", *RIVALS}
        refused = {key for key, rival in RIVALS.items() if rival.refusal}
        others = {row.rival for row in zoned if not row.exact}
        assert others == {"timebound", "justblend_blends", *refused}
        assert all((row.deviation or 0.0) < 1e-9 for row in zoned if row.exact)
    assert beside(rows) == rows
    for row in rows:
        assert row.status == "keeps all" or row.faults or row.reason, row


def test_programs_that_are_given_the_same_points_answer_the_same(maker: dict[str, Any]) -> None:
    """Those without a limit of time in their work, in the task with zones and in the one without."""
    found = {(row.problem, row.rival): row for row in maker["stored"]()[0]}
    compared = 0
    for (task, rival), row in found.items():
        other = found.get((f"{task}, zones of 0.1 rad", rival))
        if other is not None and other.exact and rival not in ("drake_spline", "scip"):
            assert (row.status, row.faults) == (other.status, other.faults)
            assert (row.seconds or 0.0) == pytest.approx(other.seconds or 0.0, rel=1e-9)
            compared += 1
    assert compared == 11 * 7


def test_the_page_lists_the_programs_of_the_registry(maker: dict[str, Any]) -> None:
    text = maker["PAGE"].read_text("utf-8")
    for rival in RIVALS.values():
        cannot = f"not run: {rival.refusal}" if rival.refusal else rival.cannot
        assert f"| {rival.name} | {rival.optimises} | {cannot} |" in text


def test_its_sentences_are_counted_from_the_rows(maker: dict[str, Any]) -> None:
    ours = RivalRow("a", "timebound", "", "keeps all", seconds=2.0, bound=2.0, computation=1.0)
    broken = "velocity 1.200 of its limit (joint 2, and 1 more); acceleration jumps by 3.0e+00 rad/s² (joint 1)"
    slow = replace(ours, rival="ruckig", seconds=3.0, bound=None)
    rows = beside(
        [
            ours, slow,
            replace(slow, rival="toppra", status="breaks", mended=4.0, faults=broken),
            replace(ours, problem="b"), replace(slow, problem="b", seconds=2.5),
            RivalRow("b", "toppra", "", "crashed", "ended by SIGABRT"),
        ]
    )  # fmt: skip
    said = maker["section"](rows, "A machine")
    assert "**Ruckig, stop and go** keeps all on 2 of 2 tasks, 25 % to 50 % above" in said
    assert (
        "**toppra** keeps all on 0 of 2 tasks. It breaks something on 1: velocity limit (1, up to 1.200) and "
        "acceleration jumps (1, up to 3.0e+00 rad/s²); slowed down, 1 of them keep all, 100 % above the "
        "fastest motion. Without a motion on 1 (crashed: ended by SIGABRT)."
    ) in said
    assert "has the fastest motion that keeps all on 2 of 2 tasks" in said
