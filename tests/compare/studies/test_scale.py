"""The study of scale: a problem drawn twice, gaps by hand, memory of a process of its own, files, resuming."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from compare.studies import scale, study

ROW = scale.ScaleAnswer(
    joints=2, waypoints=100, step=2.5, zones=0.0, seed=0, seconds=3.0, feasible=True, bound=2.0,
    status="proved", motion=1.5, proof=4.0, elapsed=6.0, memory=2e8,
)  # fmt: skip


def test_the_same_seed_draws_the_same_walk_and_no_step_is_longer() -> None:
    problem = scale.random_walk(3, 50, 0.4, seed=7)
    assert problem == scale.random_walk(3, 50, 0.4, seed=7)
    assert problem != scale.random_walk(3, 50, 0.4, seed=8)
    steps = np.abs(np.diff(problem.waypoints, axis=0))
    assert steps.shape == (49, 3)
    assert 0.3 < steps.max() <= 0.4


def test_zones_are_around_inner_waypoints() -> None:
    problem = scale.random_walk(3, 5, 0.4, zones=0.05)
    assert sorted(problem.conditions.tolerance) == [1, 2, 3]
    assert (problem.conditions.tolerance[2] == 0.05).all()
    assert scale.random_walk(3, 5, 0.4).conditions.none


def test_gap_whole_time_and_table_of_a_planted_row() -> None:
    assert ROW.gap == pytest.approx(0.5)
    assert ROW.whole == pytest.approx(5.5)
    (plain,) = scale.summarise([replace(ROW, memory=float("nan"))])
    assert (plain["gap"], plain["whole"], plain["memory"]) == (pytest.approx(0.5), 5.5, None)
    assert scale.as_text([ROW], []).splitlines()[-1].split() == [
        "100", "2", "3", "5.0e-01", "1.50", "4.00", "5.50", "6.00", "200", "proved",
    ]  # fmt: skip


def test_the_figure_has_a_slope_of_one_and_both_aims() -> None:
    rows = [ROW, replace(ROW, waypoints=1000, motion=20.0, proof=35.0, memory=4e8)]
    left, right = scale.figure(rows, []).axes
    for axes in (left, right):
        assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
        (line,) = (one for one in axes.lines if one.get_label() == "in proportion to waypoints")
        assert np.diff(np.log(line.get_ydata())) == pytest.approx(np.diff(np.log(line.get_xdata())))
    assert {text.get_text() for text in left.texts} == {"10 s for 100", "120 s for 1,000"}
    assert "[s]" in left.get_ylabel()
    assert "[MB]" in right.get_ylabel()


def test_files_of_tiny_counts_memory_apart_and_resuming(tmp_path: Path) -> None:
    hoard = np.ones(60_000_000)  # half a gigabyte here, which is not the problems' own
    calls = scale.calls(2, [3, 5], 1.0, 0.05, 0, 1e-3, 20.0)
    found = study.run(scale.STUDY, calls, folder=tmp_path)
    for row in found.rows:
        assert row.feasible
        assert row.bound <= row.seconds * (1.0 + 1e-9)
        assert row.gap < 1e-2
        assert 2e7 < row.memory < 8.0 * hoard.size
    assert [
        entry["waypoints"] for entry in json.loads((tmp_path / "scale.json").read_text())["summary"]
    ] == [3, 5]
    assert (tmp_path / "figures" / "scale.svg").stat().st_size > 1000
    again = study.run(scale.STUDY, calls, folder=tmp_path, resume=True)
    assert again.rows == found.rows  # times and all: nothing was measured again
