"""``timebound grade`` and ``versus`` as a user calls them, on small instances; the swarm of the docs runs."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pytest

from compare.__main__ import main
from compare.grading import running

ROOT = Path(__file__).parents[3]
CASES = "sr4c,ur5,cobot"
SMALL = ["--cases", CASES, "--seeds", "4", "--budget", "200", "--jobs", "1"]
RAISES = """

def raises(task, *, population=20):
    yield task.sample(population)
    raise ValueError("no luck today")
"""


def documented() -> str:
    """The swarm that docs/howto/own_swarm.md shows."""
    text = (ROOT / "docs" / "howto" / "own_swarm.md").read_text("utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    return str(block)


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setenv("PYTHONPATH", str(ROOT))  # of the processes that load it
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(documented() + RAISES)
    return tmp_path


@pytest.mark.long
def test_the_documented_swarm_is_graded_and_a_second_call_computes_nothing(
    mine: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["grade", "mine.py:swarm", *SMALL, "--out", "out", "--json", "verdict.json"]) == 0
    said = capsys.readouterr()
    assert "failed" not in said.err
    found = json.loads((mine / "verdict.json").read_text())
    assert (found["swarm"], found["against"]) == ("mine.py:swarm", "pso")
    assert found["verdict"] in ("better", "worse", "equal", "undecided")
    assert found["wins"] + found["losses"] + found["ties"] == found["instances"] == 3
    assert 0.0 <= found["p"] <= 1.0
    assert 0.0 <= found["a12"] <= 1.0
    assert [p["swarm"] for p in found["standing"]].index("cma-es") == 0
    assert {p["swarm"] for p in found["standing"]} == {"mine:swarm", "pso", "cma-es", "de", "random"}
    assert found["drawn_to_zero"] is False
    assert said.out.startswith(found["sentence"])
    page = (mine / "out" / "grade.html").read_text()
    assert re.search(r'<p class="verdict">(.*?)</p>', page, re.DOTALL)[1] == found["sentence"]  # type: ignore[index]
    assert page.count("data:image/svg+xml;base64") == 4

    def nothing(*_: object, **__: object) -> None:
        raise AssertionError("computed again")

    before = (mine / "out" / "rows.csv").read_text()
    monkeypatch.setattr("compare.benchmark.run._grades", nothing)
    monkeypatch.setattr("compare.benchmark.proving.prove", nothing)
    assert main(["grade", "mine.py:swarm", *SMALL, "--out", "out", "--json", "again.json"]) == 0
    assert json.loads((mine / "again.json").read_text()) == found
    assert (mine / "out" / "rows.csv").read_text() == before


@pytest.mark.slow
def test_failures_are_said_as_they_happen_and_stand_on_the_page(
    mine: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    small = ["--cases", "sr4c", "--seeds", "2", "--budget", "100", "--jobs", "1"]
    assert main(["versus", "mine.py:raises", "random", *small, "--out", "out", "--json", "-"]) == 0
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert "failed: mine:raises on sr4c, seed 0: raised: ValueError: no luck today" in said.err
    assert said.err.count("failed: ") == 1  # the second seed fails in the same way
    (failure,) = found["failures"]
    assert (failure["swarm"], failure["count"]) == ("mine:raises", 2)
    assert found["median_gap"]["swarm"] is None
    assert "2 of its runs failed" in found["sentence"]
    page = (mine / "out" / "versus.html").read_text()
    assert "Runs that failed" in page
    assert "no luck today" in page


def test_the_instances_are_the_held_out_ones_and_can_be_named(monkeypatch: pytest.MonkeyPatch) -> None:
    found, kind = running.chosen_instances("sr4c, ur5")
    assert ([one.name for one in found], kind) == (["sr4c", "ur5"], "instances")
    with pytest.raises(ValueError, match="named twice"):
        running.chosen_instances("sr4c,sr4c")
    with pytest.raises(ValueError, match="none given"):
        running.chosen_instances(" , ")
