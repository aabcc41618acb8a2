"""The papers' tables and figures again: nothing left out, true data, nothing lost, faults shown."""

from __future__ import annotations

import json
import os
import re
import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from compare.papers.panels import Curve, panels
from compare.papers.printed_motions import printed

from compare.audit.paper import load_papers, settings
from compare.audit.paper.digits import values
from compare.benchmark.objective import Objective, search_box
from compare.benchmark.suite import PAPER_BUDGETS
from compare.commands import shared as commands
from compare.papers import ITEMS, page
from compare.papers import __main__ as papers
from compare.papers.inverse import make_inverse
from compare.papers.item import Item, Shown, Table
from compare.papers.li_2022.figure_5 import evolution
from compare.papers.li_2022.paper import budget as budget_of_001
from compare.papers.wang_2025 import cec2017 as ablation
from compare.papers.wang_2025 import swarm as sr4c_swarm
from compare.papers.wang_2025 import table_8 as table8
from compare.papers.wang_2025.paper import budget as budget_of_000
from compare.papers.wang_2025.paper import spline, with_speed
from formulations import load
from metaheuristics import ALGORITHMS, minimise

# --- the registry ---------------------------------------------------------------------------------

ASKED = {
    "sr4c": "Tables 3, 5, 8-10; Figs 4, 5, 7-14",
    "bagging": "Tables 2, 3; Figs 4-6",
    "ur5": "Tables 2, 4-6; Figs 5-7",
    "z1": "Figs 1, 4-8",
    "cobot": "Tables 3, 4; Figs 6-9",
}


def numbered(labels: str) -> set[str]:
    """What a list like "Tables 2, 4-6; Fig 5" names, one by one."""
    found = set()
    for kind, numbers in re.findall(r"(Table|Fig)s? ([\d, -]+)", labels):
        for first, last in re.findall(r"(\d+)(?:-(\d+))?", numbers):
            found |= {f"{kind} {n}" for n in range(int(first), int(last or first) + 1)}
    return found


def test_every_table_and_figure_that_was_asked_for_is_there() -> None:
    assert list(ITEMS) == list(ASKED)
    for paper, asked in ASKED.items():
        assert numbered("; ".join(item.label for item in ITEMS[paper])) >= numbered(asked), paper
        assert len({item.key for item in ITEMS[paper]}) == len(ITEMS[paper])
        assert all(item.title and item.reading for item in ITEMS[paper])


# --- printed numbers ------------------------------------------------------------------------------


def test_numbers_that_stand_in_two_files_are_the_same() -> None:
    paper = load_papers("sr4c")[0]
    for swarm, times in table8.PRINTED.items():
        assert times == [t.value.value for t in paper.totals if t.by == swarm]
    protocol, swarm = settings("sr4c")["ablation"], settings("sr4c")["swarm"]
    full = ablation.FULL
    assert [full.population, full.dim, full.iterations, full.runs] == [
        protocol[name] for name in ("population", "dimensions", "iterations", "runs")
    ]
    mipso = ALGORITHMS["mipso"].parameters
    assert swarm["alpha"] == settings("sr4c")["tent"]["alpha"] == mipso["lam"]
    assert swarm["inertia"] == [mipso["w_max"], mipso["w_min"]]
    assert swarm["mutation"] == [mipso["pm1"], mipso["pm2"]]
    assert budget_of_000() == PAPER_BUDGETS["sr4c"]

    # the plans that the claimed savings start from
    for key in ("sr4c", "bagging"):
        claims = [c for c in load_papers(key)[0].claims if "first plan" in c.says]
        assert [c.of[0].value for c in claims] == [sum(settings(key)["first_plan"]["times"])]
    mpso, swarm = ALGORITHMS["mpso"].parameters, settings("bagging")["swarm"]
    assert swarm["factors"] == [mpso["c_start"], mpso["c_end"]]
    assert swarm["inertia"] == [mpso["w_max"], mpso["w_min"]]
    assert budget_of_001() == PAPER_BUDGETS["bagging"]
    single = [row for row in load_papers("bagging")[0].rows if row.joint is not None]
    assert settings("bagging")["box"]["seconds"][0] == min(values(row.times).min() for row in single)
    for key, names in (("ur5", "population"), ("cobot", "population"), ("z1", "population")):
        swarm = settings(key)["swarm"]
        assert (swarm[names], swarm["iterations"]) == (
            PAPER_BUDGETS[key].population,
            PAPER_BUDGETS[key].iterations,
        )


def test_printed_vectors_are_judged_with_their_rounding() -> None:
    paper = load_papers("sr4c")[0]
    found = {(row.where, row.joint): printed(paper, row) for row in paper.rows}
    assert found["Table 9, joint 1", 0]["keeps"] == "yes"
    assert found["Table 9, joint 1", 0]["most"].startswith("acceleration of joint 1, 54.5 %")
    whole = found["sec. 4.2.2", None]
    assert whole["stretch"] > 1.0  # by its digits it breaks a limit, by 16 millionths
    assert whole["keeps"] == "within rounding"


# --- Figs 4 and 5 of 000 --------------------------------------------------------------------------


def test_the_tent_orbit_follows_its_formula() -> None:
    z, points = 0.3, []
    for _ in range(12):
        z = z / 0.499 if z < 0.499 else (1 - z) / 0.501
        points.append(z)
    found = sr4c_swarm.orbits(np.array([0.3, 0.7]), 12, 0.499)
    np.testing.assert_allclose(found[:, 0], points, rtol=1e-12)
    np.testing.assert_array_equal(
        sr4c_swarm.counts(found, 10)[:, 0], np.histogram(points, 10, (0, 1))[0]
    )
    assert sr4c_swarm.counts(np.array([[0.0], [1.0]]), 10)[:, 0].tolist() == [1, *[0] * 8, 1]
    data = sr4c_swarm.make_tent(False)
    assert all(sum(found) == data["population"] for found in data["counts"].values())
    assert data["zeros"] > 0.8  # at 0.5 a double loses a bit at each of 500 steps
    # uniform numbers mapped once are uniform: the same scatter as without the map
    assert data["scatter"]["tent map, once on each"][1] == pytest.approx(
        data["scatter"]["random"][1], rel=0.05
    )


def test_the_learning_factors_are_one_plus_and_minus_a_cosine() -> None:
    data = sr4c_swarm.make_factors(False)
    cosine = np.cos(np.pi * np.arange(data["iterations"] + 1) / data["iterations"])
    np.testing.assert_allclose(data["c1"], 1 + cosine, atol=1e-12)
    np.testing.assert_allclose(data["c2"], 1 - cosine, atol=1e-12)
    assert (np.diff(data["w_printed"]) > 0).all()  # the text wants it to fall
    assert (np.diff(data["w_resolved"]) <= 0).all()
    assert data["w_resolved"][0] == 0.9
    assert data["w_resolved"][-1] == pytest.approx(0.4) == data["w_printed"][-1]


# --- arms, motions, swarms ------------------------------------------------------------------------


def test_inverse_kinematics_finds_the_printed_angles_and_the_point_that_is_off() -> None:
    def outside(key: str) -> list[tuple[str, float]]:
        found = []
        for p in make_inverse(load_papers(key)[0])["points"]:
            apart = np.abs(np.subtract(p["found"], p["printed"]))
            if (apart > np.array(p["allowed"]) + 1e-9).any():
                found.append((p["where"], p["miss"]))
        return found

    assert outside("sr4c") == []
    assert outside("bagging") == [("Fig. 4, point A", pytest.approx(2.55e-3, abs=1e-5))]


def test_the_best_particle_only_gets_better_and_ends_as_the_answer() -> None:
    one = load("bagging").joint(1)
    seen = evolution(one, "mpso", 3)
    totals = [np.inf if x is None else sum(x) for x in seen]
    assert len(seen) == budget_of_001().iterations + 1
    assert (np.diff(totals) <= 0.0).all()
    lo, hi = search_box(one)
    parameters = ALGORITHMS["mpso"].parameters
    result = minimise(ALGORITHMS["mpso"].function, Objective(one, stretch=False), lo, hi,
                      budget=budget_of_001().evaluations, seed=3, **parameters)  # fmt: skip
    assert totals[-1] == pytest.approx(result.fitness)


def test_a_curve_is_marked_where_it_is_beyond_its_limit_and_only_there() -> None:
    times = [0.866, 0.7869, 2.0901]  # peaks at 44.998 deg/s and 60.0 deg/s²
    curves = [
        Curve(name, ("k", "-"), with_speed(*limits), spline(with_speed(*limits), times))
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


CHEAP = {("sr4c", "Fig 4"), ("sr4c", "Fig 5"), ("sr4c", "Table 5"), ("bagging", "Table 2")}


@pytest.mark.parametrize(("paper", "label"), sorted(CHEAP))
def test_an_item_is_the_same_when_made_again_and_can_be_shown(paper: str, label: str) -> None:
    (item,) = (item for item in ITEMS[paper] if item.label == label)
    first, second = (json.dumps(item.make(False), allow_nan=False) for _ in range(2))
    assert first == second
    shown = item.show(json.loads(first))
    assert shown.parts
    assert shown.remarks
    for part in shown.parts:
        if isinstance(part, Table):
            assert all(len(row) == len(part.header) for row in part.rows)
    plt.close("all")


# --- the command ----------------------------------------------------------------------------------


def fine(full: bool) -> dict[str, Any]:
    with open(os.environ["TIMEBOUND_COUNT"], "a", encoding="utf-8") as lines:
        lines.write("made\n")
    return {"answer": 42}


def broken(full: bool) -> dict[str, Any]:
    raise ArithmeticError("planted <fault>")


def deadly(full: bool) -> dict[str, Any]:
    os._exit(3)


def unstorable(full: bool) -> dict[str, Any]:
    return {"answer": float("nan")}


def show(data: dict[str, Any]) -> Shown:
    return Shown([Table(["answer"], [[str(data["answer"])]])], ["It is what it is."])


def run(monkeypatch: pytest.MonkeyPatch, *options: str) -> int:
    monkeypatch.setattr(sys, "argv", ["papers", *options])
    with pytest.raises(SystemExit) as end:
        commands.run(papers.main)
    assert isinstance(end.value.code, int)
    return end.value.code


def test_failing_items_have_a_status_and_cost_no_other_item(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = {"Table 1": fine, "Table 2": broken, "Table 3": deadly, "Table 4": unstorable}
    items = tuple(
        Item(label, "planted", make, show, "as planted", cost=float(make is deadly))
        for label, make in made.items()
    )
    count = tmp_path / "count"
    monkeypatch.setenv("TIMEBOUND_COUNT", str(count))
    monkeypatch.setitem(ITEMS, "sr4c", items)
    options = ("sr4c", "--out", str(tmp_path), "--jobs", "1")
    assert run(monkeypatch, *options) == 1
    errors = capsys.readouterr().err
    assert "sr4c: Table 2: failed: ArithmeticError: planted <fault> (test_papers.py, line" in errors
    assert "sr4c: Table 3: died: its process ended" in errors
    folder = tmp_path / "papers" / "sr4c"
    stored = {path.stem: json.loads(path.read_text("utf-8")) for path in folder.glob("*.json")}
    assert {name: entry["status"] for name, entry in stored.items()} == {
        "table-1": "ok", "table-2": "failed", "table-3": "died", "table-4": "failed",
    }  # fmt: skip
    assert stored["table-1"]["data"] == {"answer": 42}
    assert stored["table-2"]["data"] is None
    text = (tmp_path / "papers" / "sr4c.html").read_text("utf-8")
    assert "<td>42</td>" in text
    assert "planted &lt;fault&gt;" in text
    assert count.read_text("utf-8") == "made\n"

    # what is finished is not made again, unless it is of another size; with nothing failing, all is well
    monkeypatch.setitem(ITEMS, "sr4c", items[:1])
    assert run(monkeypatch, *options, "--resume") == 0
    assert count.read_text("utf-8") == "made\n"
    assert papers.shelf.finished(tmp_path, "sr4c", items[0], False)
    assert not papers.shelf.finished(tmp_path, "sr4c", items[0], True)
    assert not papers.shelf.finished(tmp_path, "sr4c", items[1], False)


def test_an_item_that_cannot_be_shown_costs_no_other_item(tmp_path: Path) -> None:
    items = [
        Item("Table 1", "", fine, show),
        Item("Table 2", "", fine, show),
        Item("Table 3", "", fine, show),
    ]
    for item, data in zip(items, ({"answer": 1}, {"other": 2}), strict=False):
        stored = papers.shelf.Made(False, "ok", "", 0.0, "v", "m", data)
        papers.shelf.keep(tmp_path, "sr4c", item, stored)
    _, faults = page.render(str(tmp_path), "sr4c", items)
    assert faults == {
        "Table 2": "failed: cannot be shown: KeyError: 'answer'",
        "Table 3": "not made: ",
    }
    assert "<td>1</td>" in (tmp_path / "papers" / "sr4c.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (["sr4x"], "KEY: 'sr4x' is not known (known: sr4c, bagging"),
        (
            ["bagging", "--item", "Table 99"],
            "--item: 'Table 99' is not an item of bagging (known: Table 2",
        ),
        (["--jobs", "0"], "--jobs: 0 is not positive"),
    ],
)
def test_bad_input_is_one_line_that_names_it(
    options: list[str],
    named: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    assert run(monkeypatch, *options, "--out", str(tmp_path)) == 2
    error = capsys.readouterr().err
    assert named in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())
