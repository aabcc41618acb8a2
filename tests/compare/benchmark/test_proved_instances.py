"""Proof, features and the stop below a bound, against numbers computed here."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from graded_runs import graded

from compare.benchmark import proving
from compare.benchmark.below_bound import BelowBoundError
from compare.benchmark.estimate import estimate, part
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.plan import runs
from compare.benchmark.proving import prove_all
from compare.benchmark.records.store import Store
from compare.benchmark.run import swarm
from compare.benchmark.suite import Instance, Split, suite
from compare.benchmark.suite.features import active_limits, conditioning, count_basins, features_of
from compare.benchmark.summaries import Summary
from compare.engines import Engine, ThisProcess
from compare.report.suite_page import standing
from formulations import FAMILIES, Limits, Problem, family_optimum, load


@pytest.fixture
def pool() -> Engine:
    return ThisProcess()


@pytest.fixture
def store(tmp_path: Path) -> Store:
    made = Store(tmp_path)
    made.clear()
    return made


def small() -> Instance:
    problem = Problem(
        [[0.0, 0.1], [1.0, 0.4], [0.3, 0.9], [0.8, 0.2]],
        {"velocity": 1.0, "acceleration": 2.0},
        name="small",
    )
    return Instance("small", problem, Split.own, "file", "here")


def test_an_instance_is_proved_once(
    pool: Engine, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = []
    real = proving.prove
    monkeypatch.setattr(proving, "prove", lambda *given: calls.append(given) or real(*given))
    prove_all(pool, [small()], store)
    rungs = store.ladders()["small"]["ladder"]
    lower, upper = rungs["family_lower"]["seconds"], rungs["family"]["seconds"]
    assert lower is not None
    assert upper is not None
    assert lower <= upper <= lower * (1.0 + 2e-7)
    assert store.instances()["small"]["features"]["joints"] == 2
    prove_all(pool, [small()], store)
    assert len(calls) == 1
    other = replace(
        small(), problem=replace(small().problem, waypoints=small().problem.waypoints * 1.01)
    )
    prove_all(pool, [other], store)
    assert len(calls) == 2
    assert store.instances()["small"]["digest"] == other.digest


def test_a_motion_below_the_certified_bound_stops_the_run(
    pool: Engine, store: Store, capsys: pytest.CaptureFixture[str]
) -> None:
    """The planted fault: a bound that is one per cent above the optimum, said to be certified."""
    one = small()
    prove_all(pool, [one], store)
    record = store.ladders()["small"]
    wrong: LadderRecord = {**record, "ladder": {k: dict(v) for k, v in record["ladder"].items()}}  # type: ignore[typeddict-item]
    optimum = record["ladder"]["family"]["seconds"]
    assert optimum is not None
    wrong["ladder"]["family_lower"]["seconds"] = optimum * 1.01
    plan = runs({"small": one.problem}, swarms=["cma-es"], codings=["stretched"], seeds=1)
    swarm(pool, plan, {"small": one.problem}, store)  # the true bound holds
    store.clear()
    store.write_ladder("small", wrong)
    with pytest.raises(BelowBoundError) as caught:
        swarm(pool, plan, {"small": one.problem}, store)
    assert store.rows() == []
    for words in ("small, stretched, cma-es, seed 0", "bug of timebound", one.digest):
        assert words in str(caught.value)


# --- features -------------------------------------------------------------------------------------


def test_active_limits_of_a_motion_known_by_heart() -> None:
    """One joint that is limited by its speed alone: each piece of the optimum touches it or does not."""
    problem = Problem.of([[0.0], [1.0], [2.0], [3.0]], Limits.of(velocity=1.0, dof=1))
    motion = FAMILIES["3-5-3"].trajectory(problem, family_optimum(problem).durations)
    speeds = np.abs(motion.at(np.linspace(0.0, motion.seconds, 20001), 1)[:, 0])
    pieces = np.searchsorted(motion.breaks, np.linspace(0.0, motion.seconds, 20001), side="right") - 1
    touched = {int(p) for p, v in zip(pieces, speeds, strict=True) if v > 1.0 - 1e-6 and p < 3}
    found = active_limits(problem, motion)
    assert len(touched) <= found <= 3
    assert found >= 1
    assert active_limits(problem, motion.stretched(1.1)) == 0


def test_a_waypoint_on_its_limit_is_no_active_limit() -> None:
    free = Limits.of(velocity=1.0, acceleration=1.0, dof=1)
    kept = replace(free, position=np.array([[0.0, 9.0]]))
    waypoints = [[0.0], [1.0], [2.0], [3.0]]  # from rest on the limit, and away
    counts = []
    for limits in (free, kept):
        problem = Problem.of(waypoints, limits)
        motion = FAMILIES["3-5-3"].trajectory(problem, np.full(3, 4.0))
        counts.append(active_limits(problem, motion))
    assert counts == [0, 0]


def test_basins_are_told_apart_by_time_and_by_shape() -> None:
    a, b = np.array([1.0, 2.0, 3.0]), np.array([1.0, 3.0, 2.0])
    assert count_basins([a, b, a + 1e-9]) == 2
    assert count_basins([a, a * (1.0 + 1e-4)]) == 2
    assert count_basins([a, a, a]) == 1
    assert count_basins([]) == 0


def test_conditioning_of_a_symmetric_task_is_small_and_grows_with_a_neglected_segment() -> None:
    """A segment that a joint crosses a thousand times faster than the others hardly counts."""

    def of(middle: float) -> float:
        problem = Problem.of(
            [[0.0], [1.0], [1.0 + middle], [2.0 + middle]],
            Limits.of(velocity=1.0, acceleration=4.0, dof=1),
        )
        found = conditioning(problem, family_optimum(problem).durations)
        assert found is not None
        return found

    assert 0.0 <= of(1.0) < of(0.02)
    alone = Problem.of([[0.0], [1.0]], Limits.of(velocity=1.0, dof=1), family="quintic")
    assert conditioning(alone, np.array([2.0])) is None


def test_features_of_a_paper_case() -> None:
    problem = load("cobot")
    found = features_of(problem, family_optimum(problem))
    assert (found.dimension, found.joints) == (3, 6)
    assert found.basins >= 1
    assert found.starts >= found.basins
    assert found.active >= 1


# --- estimate and page ----------------------------------------------------------------------------


def test_an_estimate_is_the_measured_cost_times_the_budgets() -> None:
    problems = {one.name: one.problem for one in suite(4)}
    plan = runs(problems, swarms=["pso", "random"], codings=["stretched"], seeds=3, evaluations=200)
    chosen = part(plan)
    assert {run.swarm for run in chosen} == {"pso", "random"}
    assert len(chosen) == 4
    assert len({run.case for run in chosen}) > 1
    row = graded(load("cobot"), 3.4, "stretched", "pso", 0, 200).row
    measured = [
        replace(row, swarm=name, evaluations=200, seconds_algorithm=t, seconds_objective=t)
        for name, t in (("pso", 0.1), ("random", 0.3))
    ]
    # 12 runs of each: 0.2 and 0.6 s a run, on two workers
    assert estimate(measured, plan, 2) == pytest.approx(12 * (0.2 + 0.6) / 2)


def test_no_average_over_unequal_sets_and_a_miss_is_infinite() -> None:
    def of(case: str, gap: float | None, unsolved: int = 0) -> Summary:
        return Summary(case, "stretched", "s", 5, unsolved, 0, gap, gap, gap, gap, None)

    key = ("stretched", "s")
    found = {(case, *key): of(case, gap) for case, gap in (("a", 1e-7), ("b", 1e-3), ("c", 0.5))}
    whole = standing(found, ["a", "b", "c"], key)
    assert (whole.gap, whole.reached, whole.missing) == (1e-3, (2, 1, 1), ())
    assert standing(found, ["a", "b", "c", "d"], key).missing == ("d",)
    assert standing(found, ["a", "b", "c", "d"], key).gap is None
    found["a", "stretched", "s"] = of("a", 1e-7, unsolved=3)  # most of its runs failed
    assert standing(found, ["a", "b", "c"], key).gap == 0.5
    found["b", "stretched", "s"] = of("b", None, unsolved=5)
    assert standing(found, ["a", "b", "c"], key).gap is None
