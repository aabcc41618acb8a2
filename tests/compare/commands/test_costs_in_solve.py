"""``timebound solve`` under demands: what is asked for, what each costs, and why there is no motion."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import pytest

from compare.__main__ import main
from compare.commands.motions import climbing
from formulations import Ladder, Problem

THERE_AND_BACK = """\
name = "turn"
waypoints = [[0.0], [1.0], [0.0]]

[limits]
velocity = 100
acceleration = [[{least}, 4]]
"""


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "turn.toml"
    path.write_text(THERE_AND_BACK.format(least=-4))
    return str(path)


def solved(*words: str) -> list[str]:
    return ["solve", *words, "--rungs", "free_form,free_form_lower"]


def test_the_head_and_the_costs(file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = tmp_path / "found.json"
    assert main(solved(file, "--wait", "1=0.5", "--json", str(found))) == 0
    text = capsys.readouterr().out
    assert "asked for:\n  It stands still at waypoint 2 for 0.5 s.\n" in text
    assert "what each demand costs\n  the wait at waypoint 2 costs 0.5 s (proved: at least 0.4" in text
    kept = json.loads(found.read_text())
    (row,) = kept["diagnosis"]["demands"]
    assert (row["demand"], row["place"], row["saves"]) == ("wait", 2, False)
    assert row["least"] <= 0.5 <= row["greatest"]
    assert kept["conditions"]["waypoint"][0]["wait"] == 0.5


def test_a_total_has_a_cost_too(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(solved(file, "--total", "3")) == 0
    assert "the given total time costs 1 s (proved: at least" in capsys.readouterr().out


def test_limits_of_one_direction_are_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "lift.toml"
    path.write_text(THERE_AND_BACK.format(least=-1))
    assert main(solved(str(path))) == 0
    text = capsys.readouterr().out
    assert "Its limits differ between the directions." in text
    assert "joint 1's lower acceleration limit on the way back costs " in text


def test_without_demands_nothing_is_said(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(solved(file)) == 0
    text = capsys.readouterr().out
    assert "asked for" not in text
    assert "what each demand costs" not in text


NOT_COMPUTED = (
    "what each demand costs\n  not computed, the time was over; a greater --time-limit computes more:\n"
)


def test_where_time_is_short_it_says_what_is_not_computed(
    file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(climbing, "_COSTS", 0.0)
    found = tmp_path / "found.json"
    assert main(solved(file, "--wait", "1=0.5", "--json", str(found))) == 0
    assert f"{NOT_COMPUTED}    the wait at waypoint 2\n" in capsys.readouterr().out
    (row,) = json.loads(found.read_text())["diagnosis"]["demands"]
    assert (row["seconds"], row["greatest"], row["unknown"]) == (None, None, "the time was over")


def test_a_time_limit_leaves_time_to_the_costs(
    file: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The limit replaces the 60 s that costs have without one, and the rungs do not use it up."""
    ladder, given = climbing.ladder, []

    def climbed(problem: Problem, **options: Any) -> Ladder:
        given.append(options["time_limit"])
        return ladder(problem, **options)

    monkeypatch.setattr(climbing, "ladder", climbed)
    monkeypatch.setattr(climbing, "_COSTS", 0.0)
    assert main(solved(file, "--wait", "1=0.5", "--time-limit", "20")) == 0
    assert "the wait at waypoint 2 costs 0.5 s" in capsys.readouterr().out
    assert main(solved(file, "--time-limit", "20")) == 0  # no demand, no costs
    assert given == pytest.approx([15.0, 20.0], rel=0.05)


def test_a_time_limit_that_is_over_names_every_cost(
    file: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    ladder = climbing.ladder

    def late(problem: Problem, **options: Any) -> Ladder:
        answer = ladder(problem, **{**options, "time_limit": None})
        time.sleep(0.2)
        return answer

    monkeypatch.setattr(climbing, "ladder", late)
    given = [f"{2 * k + 1}={0.5}" for k in range(5)]
    rows = [[float(k % 2)] for k in range(12)]
    text = Path(file).read_text().replace("[[0.0], [1.0], [0.0]]", str(rows))
    Path(file).write_text(text)
    waits = [word for one in [*given, "2=1", "4=1", "6=1", "8=1", "10=1"] for word in ("--wait", one)]
    assert main(solved(file, *waits, "--time-limit", "0.1")) == 0
    said = capsys.readouterr().out
    assert NOT_COMPUTED + "".join(f"    the wait at waypoint {k}\n" for k in range(2, 10)) in said
    assert "    and 2 more\n" in said


def test_a_window_that_nothing_keeps(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    """1 rad from rest at 4 rad/s^2, arriving with a speed that no limit forbids: at least sqrt(2 / 4) s."""
    assert main(solved(file, "--window", "1=0:0.5")) == 2
    said = capsys.readouterr().err
    assert (
        "waypoint 2: its latest time (conditions.windows[1]) is 0.5 s, 0.207 s before any motion can be there"
        in said
    )
    assert "none arrives before 0.707107 s" in said
