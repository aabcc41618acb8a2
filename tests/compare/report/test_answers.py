"""The report's answers and its table: counted by hand on made rows."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from graded_runs import graded

from compare.benchmark.protocol import Track
from compare.benchmark.records.rows import Row, RowStatus
from compare.benchmark.suite.instance import Split
from compare.benchmark.summaries import summaries
from compare.report.answers import answers, headline
from compare.report.overview import cells, columns, proof_words, shade, to_best_known
from compare.report.papers_at_a_glance import CANNOT_BE_JUDGED, PaperAtAGlance
from compare.report.suite_page import Standing, answer
from formulations import load


@pytest.fixture(scope="module")
def row() -> Row:
    return graded(load("sr4c"), 4.7, "published", "random", 0, 30).row


def made(row: Row, case: str, swarm: str, seed: int, seconds: float | None, **more: Any) -> Row:
    """A verified run that takes so long; the bound of its case is 1 s."""
    given: dict[str, Any] = {
        "variant": "stretched", "claimed": seconds, "keeps_limits": None if seconds is None else True,
        "stretch": 1.0, "worst": "", "status": RowStatus.ok, "budget": 100, **more,
    }  # fmt: skip
    coding = given.pop("variant")
    gap = None if seconds is None else seconds - 1.0
    return replace(
        row, case=case, swarm=swarm, coding=coding, seed=seed, seconds=seconds, bound=1.0, gap=gap,
        claimed_gap=gap, **given,
    )  # fmt: skip


def ladder(optimum: float | None = 1.0, lower: float | None = 1.0) -> Any:
    def rung(seconds: float | None) -> dict[str, Any]:
        return {"seconds": seconds, "certified": seconds is not None}

    return {"ladder": {"family": rung(optimum), "family_lower": rung(lower)}}


def test_who_reaches_the_optimum_on_every_arm_is_counted(row: Row) -> None:
    rows = [made(row, case, "good", 0, 1.0 + 1e-7) for case in ("a", "b")]
    rows += [made(row, "a", "half", 0, 1.0), made(row, "b", "half", 0, 1.2)]
    # most of its seeds have no motion: the median of the others does not count
    rows += [
        made(row, case, "lucky", seed, 1.0 if seed == 0 else None) for case in "ab" for seed in range(3)
    ]
    found = summaries(rows)
    first = answers(found, rows, {"a": ladder(), "b": ladder()}, [])[0]
    assert first.text == "1 of 3 swarms reaches the optimum on all 2 arms"
    assert "In the stretched coding: good." in first.detail
    assert "Nearest on its worst arm: good (stretched coding), 1e-5 %." in first.detail


def test_claims_that_break_limits_are_counted_by_the_papers_own_protocol(row: Row) -> None:
    rows = [
        made(row, "a", "pso", 0, 1.5, variant="published", track=Track.paper, claimed=1.1,
             keeps_limits=False, stretch=1.36),
        made(row, "a", "pso", 1, 1.5, variant="published", track=Track.paper),
        # another protocol: it does not count where the papers' own was run
        made(row, "a", "pso", 0, 1.5, variant="published", keeps_limits=False, stretch=9.0),
    ]  # fmt: skip
    found = answers(summaries(rows), rows, {"a": ladder()}, [])[1]
    assert found.text == "1 of 2 claimed motions break their limits"
    assert "slowed down by 1.36 (pso on a)" in found.detail


def test_a_motion_below_a_bound_would_be_said(row: Row) -> None:
    rows = [made(row, "a", "pso", seed, seconds) for seed, seconds in enumerate((1.0, 1.3, None))]
    said = answers(summaries(rows), rows, {"a": ladder()}, [])
    assert said[-1].text == "None of 2 verified motions beats a proved bound"
    rows.append(made(row, "a", "pso", 3, 0.9))
    said = answers(summaries(rows), rows, {"a": ladder()}, [])
    assert said[-1].text == "1 of 3 verified motions beats a proved bound"


def paper(case: str, stretch: float | None, keeps: str) -> PaperAtAGlance:
    slowed = None if stretch is None else 2.0 * stretch
    return PaperAtAGlance(
        case, case, f"Smith 2024: {case}", 2.0, "PSO", keeps, stretch, slowed, False, 3.0, True, 1.0, ()
    )


def test_published_totals_that_cannot_be_judged_are_not_counted(row: Row) -> None:
    rows = [made(row, "a", "pso", 0, 1.0)]
    papers = [paper("a", 2.5, "no"), paper("b", None, "yes"), paper("c", None, CANNOT_BE_JUDGED)]
    said = answers(summaries(rows), rows, {"a": ladder()}, papers)[1]
    assert said.text == "1 of 2 published totals belongs to a motion that breaks limits"
    assert said.detail == "a: published 2 s, 5 s once it keeps them, best of its family 3 s."


def test_gaps_are_measured_against_the_best_motion_known_whoever_found_it(row: Row) -> None:
    rows = [
        made(row, "a", "pso", 0, 1.21),
        made(row, "a", "pso", 1, 1.1),
        made(row, "a", "pso", 2, None),
    ]
    measured, best = to_best_known(rows, {"a": ladder(1.1, 1.0), "b": ladder(None, None)})
    assert best == {"a": 1.1, "b": None}
    assert [r.gap for r in measured] == [pytest.approx(0.1), 0.0, None]
    measured, best = to_best_known([made(row, "a", "pso", 0, 1.05)], {"a": ladder(1.1, 1.0)})
    assert (best["a"], measured[0].gap) == (1.05, 0.0)
    assert headline("a", ladder(1.1, 1.0), measured).endswith(
        "The best swarm is pso (stretched coding), at the best motion known."
    )


def test_proofs_are_said_as_far_as_they_go() -> None:
    assert proof_words(ladder(1.0001, 1.0), 1.0001) == "proved to 0.01 %"
    assert proof_words(ladder(1.1, 1.0), 1.1) == "not proved"
    assert proof_words(ladder(None, None), None) == "no optimum"


def test_columns_say_their_evaluations_and_cells_mark_failed_runs(row: Row) -> None:
    rows = [
        made(row, "b", "pso", 0, 1.0, budget=2550),
        made(row, "a", "pso", 0, 1.5),
        made(row, "a", "pso", 1, None, status=RowStatus.timed_out),
        made(row, "a", "pso", 2, None, status=RowStatus.no_feasible_point),
    ]
    found = columns(rows, ["a", "b"])
    assert [(c.case, c.variant, c.evaluations) for c in found] == [
        ("a", "stretched", "100"),
        ("b", "stretched", "2,550"),
    ]
    table = cells(summaries(rows), rows)
    assert table["a", "stretched", "pso"].failed == ("timed-out",)
    assert table["a", "stretched", "pso"].summary.unsolved == 2
    assert table["b", "stretched", "pso"].failed == ()
    assert [shade(gap) for gap in (None, 0.0, 1e-5, 1e-3, 0.03, 0.3)] == [
        "none", "g0", "g1", "g2", "g3", "g4",
    ]  # fmt: skip


def test_the_suite_says_who_is_nearest_on_the_held_out_instances() -> None:
    standings = {
        (Split.open, "stretched", "a"): Standing(9, (), 0.0),
        (Split.held_out, "stretched", "a"): Standing(3, (), 0.02),
        (Split.held_out, "shared", "b"): Standing(3, (), 0.01),
        (Split.held_out, "shared", "c"): Standing(3, (), None),
    }
    said = "b (shared coding) is nearest to the optimum over 3 held-out instances: median gap 1 %"
    assert answer(standings) == said
    del standings[Split.held_out, "stretched", "a"], standings[Split.held_out, "shared", "b"]
    assert "a (stretched coding)" in answer(standings)
    assert answer({}) == "No swarm has a verified motion on half of the instances"
