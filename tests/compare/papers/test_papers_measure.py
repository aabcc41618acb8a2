"""What the items measure, and how it is drawn and written."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest

from compare.benchmark.grade import Trace
from compare.benchmark.objective import Objective, search_box
from compare.benchmark.protocol import Budget
from compare.papers.li_2022.figure_5 import evolution
from compare.papers.li_2022.paper import budget as li_budget
from compare.papers.measure import judged, least, spline, summary, trials
from compare.papers.pictures.descent import descent
from compare.papers.pictures.panels import Curve, panels
from compare.papers.wang_2025.joint_1 import under
from compare.papers.words import listed, percent
from formulations import load
from metaheuristics import ALGORITHMS, minimise


def test_the_best_particle_only_gets_better_and_ends_as_the_answer() -> None:
    one = load("bagging").joint(1)
    seen = evolution(one, "mpso", 3)
    totals = [np.inf if x is None else sum(x) for x in seen]
    assert len(seen) == li_budget().iterations + 1
    assert (np.diff(totals) <= 0.0).all()
    lo, hi = search_box(one)
    parameters = ALGORITHMS["mpso"].parameters
    result = minimise(ALGORITHMS["mpso"].function, Objective(one, stretch=False), lo, hi,
                      budget=li_budget().evaluations, seed=3, **parameters)  # fmt: skip
    assert totals[-1] == pytest.approx(result.fitness)


def test_printed_times_of_zhou_2025_break_even_the_first_segments_closed_form():
    problem = load("ur5-corrected")
    printed = judged(problem, [2.94, 3.918, 1.195])
    # a cube from rest ends at 3 d / T
    speed = 3.0 * np.abs(problem.displacements[2]) / 1.195
    assert not printed["keeps"]
    assert printed["stretch"] >= (speed / problem.limits.velocity).max() > 1.0
    assert printed["seconds"] == pytest.approx(8.053)


def test_the_least_time_is_proved_and_reached():
    joint = load("cobot").joint(2)
    found = least(joint)
    assert found["bound"] <= found["optimum"] <= found["bound"] * (1.0 + 1e-6)
    again = judged(joint, found["durations"])
    assert again["keeps"]
    assert again["seconds"] == pytest.approx(found["optimum"], rel=1e-9)
    runs = trials(joint, "pso-zhang-2025", Budget(20, 20), 4)
    seconds = summary(runs)
    assert seconds["median"] == sorted(g.row.seconds for g in runs)[1]
    assert sum(seconds["durations"]) == pytest.approx(seconds["median"])
    assert seconds["seconds"][0] >= found["bound"]


def test_a_curve_is_marked_where_it_is_beyond_its_limit_and_only_there() -> None:
    times = [0.866, 0.7869, 2.0901]  # peaks at 44.998 deg/s and 60.0 deg/s²
    curves = [
        Curve(name, ("k", "-"), under(*limits), spline(under(*limits), times))
        for name, limits in {"kept": (46.0, 61.0), "broken": (40.0, 61.0)}.items()
    ]
    figure = panels([("joint 1", curves)])
    marks = [line for axes in figure.axes for line in axes.lines if line.get_linewidth() == 4.5]
    shown = [bool(np.isfinite(np.asarray(line.get_ydata(), dtype=float)).any()) for line in marks]
    assert shown == [
        False,
        False,
        False,
        True,
        False,
        False,
    ]  # position, velocity, acceleration of both
    plt.close(figure)


def test_descents_are_quartiles_of_the_best_so_far_and_none_before():
    # five runs, two evaluations an iteration; improvements at evaluation 3 and 5
    traces = [Trace(-1, [3, 5, 8], [10.0 + r, 5.0 + r, 5.0 + r]) for r in range(5)]
    found = descent(traces, 2, 3)
    assert found["iterations"] == [0, 1, 2, 3]
    assert found["quartiles"] == [
        [None, 11.0, 6.0, 6.0],
        [None, 12.0, 7.0, 7.0],
        [None, 13.0, 8.0, 8.0],
    ]


def test_words():
    assert listed([1]) == "1"
    assert listed([1, 2, 5]) == "1, 2 and 5"
    assert percent(0.1567, 2) == "15.67\u00a0%"
