"""Lu 2024: what its chapter says follows from the numbers beside it, and they are right."""

from __future__ import annotations

import json
import re
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

from compare.papers.lu_2024 import (
    equations_4_5,
    equations_17_22,
    figure_1,
    figure_5,
    figures_6_8,
    other_waypoints,
)
from compare.papers.lu_2024.full_stops import FullStops
from compare.papers.lu_2024.plan import between, drawn_waypoints, plan, task
from compare.papers.measure import every_motion
from compare.papers.verdicts import Reproduction, shown_gain
from compare.statistics.medians import Estimate
from formulations import check, ladder, load
from formulations.problem.problem import Limits, Problem

NONE: dict[str, Any] = {"seconds": None, "durations": None, "excess": [0.2, 0.1, 0.1004], "program": ""}


def test_figure_1() -> None:
    data = figure_1.make_chaos(False)
    assert "is not reproduced" in figure_1.show_chaos(data).remarks[0]
    data["found"]["an orbit per coordinate, beta 0.5"]["discrepancy"] = [1e-6] * 3
    assert "is reproduced" in figure_1.show_chaos(data).remarks[0]
    plt.close("all")


# --- Eqs 4, 5 -------------------------------------------------------------------------------------


def test_chord_lengths_on_z1() -> None:
    data = json.loads(json.dumps(equations_4_5.make_chords(False)))
    chord = data["5"][equations_4_5.EQ_5]
    assert chord["seconds"] == pytest.approx(18.646, abs=1e-3)
    assert chord["excess"] == pytest.approx(0.350, abs=1e-3)
    told = equations_4_5.show_chords(data).remarks
    assert (
        "take 18.65 s, 20.4\u00a0% more than the best known, and leave the position limits by 0.35 rad"
        in told[0]
    )
    assert "square roots of chord lengths" in told[1]
    for motion in data["5"].values():
        motion["keeps"] = False
    assert len(equations_4_5.show_chords(data).remarks) == 1
    chord["keeps"] = True
    told = equations_4_5.show_chords(data).remarks
    assert told[0].endswith("keep all limits.")
    assert "is: chord lengths" in told[1]


# --- Eqs 17, 22 -----------------------------------------------------------------------------------


def test_constants_are_judged_by_their_intervals() -> None:
    names = ["b = 1, s = 1", "b = 2", "s = 5", "s = 50"]
    ends = [10.0, 8.0, 10.0, 12.0]
    data = {
        name: {"seconds": [end + 0.1 * k for k in range(9)]}
        for name, end in zip(names, ends, strict=True)
    }
    told = equations_17_22.show_constants(data).remarks[0]
    assert "better than the default: b = 2; to be worse: s = 50. For 1 of the 3 other readings" in told


def test_every_reading_of_b_and_s_runs_once(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[dict[str, Any]] = []

    def planned(*_: Any, **changed: Any) -> dict[str, Any]:
        asked.append(changed)
        return {"seconds": [1.0], "descent": {}}

    monkeypatch.setattr(equations_17_22, "plan", planned)
    found = equations_17_22.make_constants(False)
    assert asked == [{}, {"b": 0.5}, {"b": 2.0}, {"s": -0.9}, {"s": 0.0}, {"s": 5.0}, {"s": 50.0}]
    assert list(found)[:2] == ["b = 1, s = 1", "b = 0.5"]


def test_a_constant_reaches_the_swarm() -> None:
    ends = []
    for changed in ({}, {"b": 2.0}, {"s": 5.0}):
        found = plan(lambda x: ((x - 1.0) ** 2).sum(axis=1), 2, "whale-lu-2024", 1, **changed)
        ends += found["seconds"]
    assert len(set(ends)) == 3


# --- Fig. 5 ---------------------------------------------------------------------------------------


def test_no_motion_at_all_has_one_number() -> None:
    keys = ("displacement", "ruckig_end_to_end", "free_form_lower", "free_form", "ruckig_stop_and_go")
    report = ladder(load("z1"), rungs=keys).seconds("free_form_lower")
    assert every_motion(task("b-spline-5")) == every_motion(task("quintic")) == report
    assert report == pytest.approx(12.958604, abs=1e-5)


def descents(bound: float) -> list[str]:
    curve = {"iterations": list(range(101)), "quartiles": [[20.0] + [17.0] * 100] * 3}
    found = {swarm: {"seconds": [17.0] * 6, "descent": curve} for swarm in figure_5.SWARMS}
    data = {"found": found, "optimum": 15.5, "bound": bound, "every_motion": 12.9}
    return figure_5._remarks_5(data)


def test_figure_5_tells_both_bounds_where_they_differ() -> None:
    assert "no motion at all takes less than 12.900 s. The best known" in descents(12.9)[-1]
    told = descents(15.4)[-1]
    assert "less than 12.900 s, and no B-spline less than 15.400 s. The best known" in told
    assert told.endswith("0.6\u00a0% lie between it and what is proved.")


def test_medians_tell_where_runs_are_too_few_or_found_nothing() -> None:
    assert between(Estimate(2.0, 1.0, 3.0)) == "2.00 (1.00 to 3.00)"
    assert between(Estimate(2.0, 1.0, np.inf)) == "2.00 (1.00 to none found)"
    assert between(Estimate(2.0, -np.inf, np.inf)) == "2.00 (too few runs for an interval)"
    assert between(Estimate(np.inf, 1.0, np.inf)) == "none"


# --- Figs 6 to 8 ----------------------------------------------------------------------------------


def curves(bspline: list[float], quintic: list[float]) -> list[str]:
    rule = {"seconds": 9.5, "keeps": True, "excess": 0.0}
    data = {
        "found": {
            key: {"seconds": bspline if key.startswith("b-spline") else quintic}
            for key in figures_6_8.METHODS
        },
        "medians": {"b-spline-5": {"most": "x"}},
        "optima": {"b-spline-5": 8.9, "quintic": 9.9, "stops": 9.0},
        "stops_keep": True,
        "rules": {"some rule": rule},
        "others": [],
        "ends": {"b-spline-5": {"jump": 1e-12, "edge": 1e-12}},
    }
    return figures_6_8._remarks(data)


def test_figures_6_to_8() -> None:
    def near(end: float) -> list[float]:
        return [end + 0.001 * k for k in range(11)]

    # printed: 11.71 against 13.08 s, 10.5 % shorter
    told = curves(near(9.0), near(10.0))
    assert told[1].startswith("Reproduced: by the medians of 11 runs each, the B-spline is 10.0")
    assert "which lies outside" in told[1]
    assert "takes 9.00 s at best (keeps all limits)" in told[2]
    assert "5.5\u00a0% longer than the whales' median of 9.01 s and outside" in told[4]
    assert curves(near(9.8), near(10.0))[1].startswith("Reproduced in kind: ")
    assert curves(near(10.0), near(9.0))[1].startswith("Not reproduced: ")
    assert "longer than the quintic" in curves(near(10.0), near(9.0))[1]
    wide = list(np.linspace(8.0, 12.0, 11))
    assert curves(wide, [*wide[1:], 12.5])[1].startswith("Not decided by these runs: ")
    assert "as the paper says" in told[-1]


def test_a_gain_is_shown_only_if_its_interval_has_one_sign() -> None:
    assert shown_gain(0.1, 0.1, 0.05, 0.2) is Reproduction.REPRODUCED
    assert shown_gain(0.1, 0.1, -0.01, 0.2) is Reproduction.UNDECIDED
    assert shown_gain(0.1, -0.1, -0.2, -0.05) is Reproduction.NOT


def test_full_stops_are_the_fastest_quintics_from_rest_to_rest() -> None:
    stops = FullStops(task("quintic"))
    least = stops.least
    motion = stops.trajectory(least)
    assert least.sum() == pytest.approx(18.939, abs=1e-3)
    assert check(stops.problem, motion).feasible
    np.testing.assert_allclose(motion.at(motion.breaks, 1), 0.0, atol=1e-9)
    np.testing.assert_allclose(motion.at(motion.breaks, 2), 0.0, atol=1e-9)
    for k in range(len(least)):  # no segment can be shorter by a millionth
        shorter = least.copy()
        shorter[k] *= 1.0 - 1e-6
        assert not check(stops.problem, stops.trajectory(shorter)).feasible
        assert np.isinf(stops(shorter[None])[0])
    assert stops(least[None])[0] == least.sum()


def test_full_stops_by_hand() -> None:
    # peaks of 10 u^3 - 15 u^4 + 6 u^5, sampled
    u = np.linspace(0.0, 1.0, 200_001)
    fastest = (30 * u**2 - 60 * u**3 + 30 * u**4).max()
    hardest = np.abs(60 * u - 180 * u**2 + 120 * u**3).max()
    limits = Limits.of(velocity=[1.0, 9.0], acceleration=[100.0, 2.0], dof=2)
    problem = Problem.of([[0.0, 0.0], [2.0, 0.1], [2.0, -1.0]], limits)
    expected = [2.0 * fastest, np.sqrt(1.1 * hardest / 2.0)]
    np.testing.assert_allclose(FullStops(problem).least, expected, rtol=1e-9)


# --- further sets of waypoints --------------------------------------------------------------------


def test_the_search_finds_a_spline_where_random_shapes_have_none() -> None:
    problem = task("b-spline-5")
    kept = Problem.of(
        drawn_waypoints(0), problem.limits, name="drawn from 0", family="b-spline-5", display_unit="deg"
    )
    found = other_waypoints.search(kept, False)
    assert max(found["excess"]) <= kept.position_slack
    assert len(found["excess"]) == 1
    assert found["seconds"] == pytest.approx(20.018, abs=2e-3)  # as 3 starts of the nonlinear program


@pytest.mark.parametrize(("seed", "least"), [(1, 0.105), (5, 0.069)])
def test_two_sets_have_no_spline_that_any_start_finds(seed: int, least: float) -> None:
    problem = Problem.of(drawn_waypoints(seed), task("b-spline-5").limits, family="b-spline-5")
    found = other_waypoints.search(problem, False)
    assert found["seconds"] is None
    np.testing.assert_allclose(found["excess"], least, atol=1e-3)


def test_remarks_on_further_sets() -> None:
    def some(seconds: float) -> dict[str, Any]:
        return {"seconds": seconds, "durations": [], "excess": [0.0], "program": ""}

    sets = [
        {"seed": 0, "b-spline-5": some(9.0), "quintic": some(10.0)},
        {"seed": 1, "b-spline-5": NONE, "quintic": some(10.0), "b-spline-3": NONE},
        {"seed": 2, "b-spline-5": some(11.0), "quintic": some(10.0)},
    ]
    told = other_waypoints.sets_remarks(sets)
    assert "a quintic within all limits was found on 3 of 3, a B-spline on 2 of 3" in told[0]
    assert told[0].endswith("Only the B-spline fails.")
    assert "Set 1: no B-spline" in told[1]
    assert "3 starts. 2 of them end at the same least excess, 0.100 rad" in told[1]
    assert "no proof" in told[1]
    assert told[1].endswith("degree, 3, 3 starts find none either: 0.1000 rad.")
    assert "(2 sets) the B-spline is the shorter one on 1," in told[2]
    assert told[2].endswith("Sets without a B-spline: 1.")
    cells = other_waypoints.sets_table(sets).rows
    assert [row[3] for row in cells] == ["10.0\u00a0%", "", "-10.0\u00a0%"]
    assert re.search(r"0\.100 rad \(5\.7 deg\) out", cells[1][1])
    sets[1]["b-spline-3"] = some(12.0)
    assert other_waypoints.sets_remarks(sets)[1].endswith("degree, 3, there is one: 12.000 s.")
    sets[0]["quintic"] = NONE
    assert "fails" not in other_waypoints.sets_remarks(sets)[0]  # both families do
