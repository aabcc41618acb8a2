"""Rivals: rows tell the truth, whatever a program does or says."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from compare.rivals import RIVALS, Rival
from compare.rivals.isolated import installed
from compare.rivals.justblend_ import kinks
from compare.rivals.pieces import along
from compare.rivals.rows import RivalRow, path_length, rows, run_rival
from compare.rivals.shown import as_page, as_text
from formulations import Conditions, Problem, Trajectory, free_form, free_form_bound

TINY = Problem(
    [[0.0, 0.0], [1.0, 0.3], [0.4, 1.0]],
    {"velocity": 1.0, "acceleration": 2.0, "jerk": 10.0},
    name="tiny",
)
BOUND = free_form_bound(TINY).seconds


def fake(monkeypatch: pytest.MonkeyPatch, name: str, problem: Problem = TINY) -> RivalRow:
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    rival = Rival(name, name, f"fake_rivals:{name}", "numpy", (), "", "")
    seconds = 0.5 if name == "hang" else 60.0
    return run_rival(problem, rival, BOUND, seconds=seconds, memory=4_000_000_000)


def test_a_program_that_crashes_fails_or_hangs_has_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    assert (fake(monkeypatch, "crash").status, fake(monkeypatch, "crash").reason) == (
        "crashed", "ended by SIGABRT",
    )  # fmt: skip
    failed = fake(monkeypatch, "fail")
    assert (failed.status, failed.reason) == ("crashed", "exit code 1: ValueError: no such thing")
    late = fake(monkeypatch, "hang")
    assert (late.status, late.reason, late.seconds) == ("timed out", "took more than 0.5 s", None)


def test_a_claim_is_set_beside_the_truth(monkeypatch: pytest.MonkeyPatch) -> None:
    row = fake(monkeypatch, "lie")
    assert row.claimed == 0.5
    assert row.seconds >= BOUND
    assert row.status == "breaks"
    assert row.faults[0].startswith("claims 0.5 s, takes ")


def test_broken_limits_are_told_and_mended(monkeypatch: pytest.MonkeyPatch) -> None:
    row, fastest = fake(monkeypatch, "hasten"), free_form(TINY).seconds
    assert row.status == "breaks"
    assert row.gap < 0.0
    assert row.factor == pytest.approx(0.9**-3, rel=1e-3)  # of the jerk
    assert row.mended == pytest.approx(fastest, rel=1e-3)
    assert any("jerk" in fault for fault in row.faults)


def test_a_motion_that_keeps_all_is_said_to(monkeypatch: pytest.MonkeyPatch) -> None:
    row = fake(monkeypatch, "honest")
    assert (row.status, row.faults) == ("keeps all", ())
    assert row.seconds == pytest.approx(1.5 * free_form(TINY).seconds, rel=1e-3)
    assert row.gap == pytest.approx(row.seconds / BOUND - 1.0)
    assert row.deviation < 1e-8


def test_conditions_are_never_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    stops = Problem(TINY.waypoints, TINY.limits, conditions=Conditions(stops={1}))
    row = fake(monkeypatch, "honest", stops)
    assert row.status == "cannot be asked"
    assert "conditions" in row.reason


@pytest.mark.parametrize("key", [key for key, rival in RIVALS.items() if not rival.refusal])
def test_every_program_that_is_installed_answers(key: str) -> None:
    rival = RIVALS[key]
    if not installed(rival):
        pytest.skip(f"needs {rival.package}")
    row = run_rival(TINY, rival, BOUND, seconds=20.0, memory=8_000_000_000)
    assert row.status in ("keeps all", "breaks"), row
    assert row.seconds == pytest.approx(row.claimed, rel=1e-6)
    if row.status == "keeps all":
        assert row.seconds >= BOUND


@pytest.mark.parametrize("key", [key for key, rival in RIVALS.items() if rival.refusal])
def test_a_program_that_may_not_run_says_why(key: str) -> None:
    row = run_rival(TINY, RIVALS[key], BOUND, seconds=1.0, memory=1)
    assert (row.status, row.reason) == ("not run", RIVALS[key].refusal)


def test_a_missing_program_says_what_to_install() -> None:
    rival = Rival("x", "x", "nowhere:x", "not-there", ("not_there",), "", "")
    row = run_rival(TINY, rival, BOUND, seconds=1.0, memory=1)
    assert (row.status, row.reason) == ("not installed", "pip install not-there")


def test_an_interrupt_keeps_the_finished_rows() -> None:
    asked: list[int] = []

    def stop() -> bool:
        return len(asked) >= 1

    found = []
    for row in rows([TINY, TINY], [RIVALS["jacobi"]] * 3, seconds=20.0, memory=1, stop=stop):
        found.append(row)
        asked += [1] if len(found) == 2 else []
    assert [row.rival for row in found] == ["timebound", "jacobi"]


def test_command_writes_table_json_and_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, page = tmp_path / "rows.json", tmp_path / "page.html"
    options = ["--rivals", "ruckig,jacobi", "--json", str(out), "--page", str(page)]
    assert main(["rivals", "sr4c", *options]) == 0
    data = json.loads(out.read_text())["rows"]
    assert [row["rival"] for row in data] == ["timebound", "ruckig", "jacobi"]
    assert data[0]["seconds"] >= data[0]["bound"]
    shown = capsys.readouterr().out
    assert f"{data[1]['seconds']:.4f}" in shown
    assert "Rivals in one run" in page.read_text()
    assert f"{data[1]['seconds']:.4f}" in page.read_text()


def test_names_of_a_page_are_escaped() -> None:
    row = RivalRow("<b>x", "timebound", "1", "no motion", "<script>")
    assert "<b>x" not in as_page([row], 1.0)
    assert "<b>x" in as_text([row])


def test_a_path_and_its_pace_are_composed_exactly() -> None:
    path = Trajectory(np.array([1.0, 1.0]), np.array([[[0.0, 1.0, 0.0]], [[1.0, 1.0, -0.5]]]))
    pace = Trajectory(np.array([2.0]), np.array([[[0.0, 0.0, 0.5]]]))  # s = t^2 / 2, from 0 to 2
    motion = along(path, pace)
    for t in np.linspace(0.0, 2.0, 11):
        assert motion.at(t)[0] == pytest.approx(path.at(min(0.5 * t * t, 2.0))[0], abs=1e-12)


def test_kinks_and_lengths() -> None:
    t = np.linspace(0.0, 1.0, 101)
    assert kinks(t, np.interp(t, [0.0, 0.3333, 0.71, 1.0], [0, 1, 1, 0])) == pytest.approx(
        [0.3333, 0.71]
    )
    line = Trajectory(np.array([2.0]), np.array([[[0.0, 1.5], [0.0, 2.0]]]))
    assert path_length(line) == pytest.approx(5.0)
