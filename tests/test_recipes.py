"""The recipes of CONTRIBUTING: each is followed word by word in a copy of the repository, and works."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from recipes import Copy

pytestmark = pytest.mark.long


@pytest.fixture
def copy(tmp_path: Path) -> Copy:
    return Copy(tmp_path)


CASE = """\
name = "mine"
source = "made up; all limits are assumed"
unit = "deg"
waypoints = [[0, 10], [20, -15], [35, 30], [60, 0]]

[limits]
velocity = [90, 120]
acceleration = 300
"""

REFERENCE = '''\
"""The mean of nothing: a reference that is there to be added."""

from __future__ import annotations

from formulations.problem.problem import Problem
from formulations.references.reference import RungKind, Outcome, Rung


def mine(problem: Problem) -> Outcome:
    """One second for each segment."""
    if problem.n_segments < 2:
        return Outcome.not_applicable("needs two segments")
    return Outcome.ok(float(problem.n_segments), note="a second each")


MINE = Rung(
    key="mine", kind=RungKind.REFERENCE, name="one second each", meaning="a second per segment", find=mine
)
'''

FAMILY = '''\
"""Quintics that rest at every waypoint."""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled
from formulations.families.family import Family, on_symbols


@compiled
def joint(x: Any, t: Any, c: Any) -> None:
    """Coefficients of one joint on normalised time, c (n, 6), from x (n+1,) and durations t (n,)."""
    for k in range(len(t)):
        d = x[k + 1] - x[k] + 0.0 * t[k]
        c[k, 0] = x[k]
        c[k, 3] = 10.0 * d
        c[k, 4] = -15.0 * d
        c[k, 5] = 6.0 * d


@compiled
def population(waypoints: Any, durations: Any, lengths: Any, out: Any) -> None:
    """Whole populations, one piece per segment (see ``Family``)."""
    lengths[:] = durations
    for i in range(len(durations)):
        for j in range(waypoints.shape[1]):
            joint(waypoints[:, j], durations[i], out[i, :, j])


MINE = Family(
    name="mine",
    title="quintics with stops",
    source="made up",
    population=population,
    symbols=on_symbols(joint),
    degrees=lambda n_segments: (5,) * n_segments,
)
'''


def ladder_of(copy: Copy, problem: str) -> dict[str, dict[str, object]]:
    """The ladder that ``compare.solve`` writes."""
    copy.run("-m", "compare.solve", problem, "--json", "out.json")
    found = json.loads((copy.root / "out.json").read_text())["ladder"]
    assert isinstance(found, dict)
    return found


def test_add_a_case(copy: Copy) -> None:
    copy.write("formulations/problem/cases/mine.toml", CASE)
    found = ladder_of(copy, "mine")
    assert found["family"]["status"] == "ok"
    # and the tests over all cases run over it
    assert "[mine]" in copy.test("tests/formulations/problem", "--collect-only")


def test_add_a_reference(copy: Copy) -> None:
    copy.write("formulations/references/mine_.py", REFERENCE)
    copy.insert(
        "formulations/rungs.py",
        "from formulations.references.reference import",
        "from formulations.references.mine_ import MINE",
    )
    copy.insert("formulations/rungs.py", "TOPPRA_CUBIC,", "MINE,")
    found = ladder_of(copy, "cobot")
    assert found["mine"]["seconds"] == 3.0
    assert found["mine"]["kind"] == "reference"
    assert found["mine"]["certified"] is False
    # it is drawn, and listed in the report
    copy.run(
        "-c",
        "import json; from formulations import load; from compare.report.figures import ladder_figure\n"
        "ladder = json.load(open('out.json'))\n"
        "axes = ladder_figure(load('cobot'), ladder, []).axes[0]\n"
        "assert 'one second each' in [label.get_text() for label in axes.get_yticklabels()]",
    )
    copy.test("tests/formulations/test_ladder.py", "-k", "agreed_keys or every_rung or two_waypoints")
    copy.test("tests/formulations/references", "-k", "signature")


def test_add_a_spline_family(copy: Copy) -> None:
    copy.write("formulations/families/stops.py", FAMILY)
    copy.insert(
        "formulations/families/__init__.py",
        "from formulations.families.three_five_three import",
        "from formulations.families.stops import MINE",
    )
    path = copy.root / "formulations/families/__init__.py"
    path.write_text(
        path.read_text().replace("B_SPLINE_3, B_SPLINE_5)", "B_SPLINE_3, B_SPLINE_5, MINE)")
    )
    copy.write("mine.toml", CASE.replace('unit = "deg"\n', 'unit = "deg"\nfamily = "mine"\n'))
    found = ladder_of(copy, "mine.toml")
    for key in ("family", "family_lower", "family_longest_segment", "toppra_cubic"):
        assert found[key]["status"] == "ok", found[key]
    copy.test("tests/formulations/families", "-k", "mine")
