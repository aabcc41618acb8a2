"""Rivals: rows tell the truth, whatever a program does or says."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare.__main__ import main
from compare.rivals import RIVALS, Rival
from compare.rivals.isolated import installed
from compare.rivals.justblend_ import kinks
from compare.rivals.pieces import along
from compare.rivals.rows import RivalRow, limit_factor, path_length, run_rival
from compare.rivals.run_study import STUDY, beside, calls, count_rows, summarise, with_zones
from compare.rivals.shown import as_page, cells
from compare.rivals.terminal import as_text
from compare.studies.study import finished, run
from formulations import Conditions, Problem, Trajectory, free_form, free_form_bound

TINY = Problem(
    [[0.0, 0.0], [1.0, 0.3], [0.4, 1.0]],
    {"velocity": 1.0, "acceleration": 2.0, "jerk": 10.0},
    name="tiny",
)
BOUND, FASTEST = free_form_bound(TINY).seconds, free_form(TINY).seconds
OURS = RivalRow("tiny", "timebound", "1", "keeps all", seconds=FASTEST, bound=BOUND)


def fake(monkeypatch: pytest.MonkeyPatch, name: str, problem: Problem = TINY) -> RivalRow:
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    rival = Rival(name, name, f"fake_rivals:{name}", "numpy", (), "", "")
    seconds = 0.5 if name == "hang" else 60.0
    (row,) = run_rival([problem], rival, seconds=seconds, memory=4_000_000_000)
    return beside([row, replace(OURS, problem=problem.name)])[0]


@pytest.mark.long
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
    assert row.faults.startswith("claims 0.5 s, takes ")


def test_broken_limits_are_told_and_mended(monkeypatch: pytest.MonkeyPatch) -> None:
    row = fake(monkeypatch, "hasten")
    assert row.status == "breaks"
    assert row.over_bound < 1.0
    assert row.factor == pytest.approx(0.9**-3, rel=1e-3)  # of the jerk
    assert row.mended == pytest.approx(FASTEST, rel=1e-3)
    assert f"jerk {0.9**-3:.3f} of its limit (joint " in row.faults
    assert f"velocity {1 / 0.9:.3f} of its limit (joint " in row.faults


def test_a_motion_that_keeps_all_is_said_to(monkeypatch: pytest.MonkeyPatch) -> None:
    row = fake(monkeypatch, "honest")
    assert (row.status, row.faults) == ("keeps all", "")
    assert row.seconds == pytest.approx(1.5 * FASTEST, rel=1e-3)
    assert row.over_bound == row.seconds / BOUND
    assert row.over_fastest == row.seconds / FASTEST
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
    task = with_zones(TINY, 0.1) if rival.zones else TINY
    (row,) = run_rival([task], rival, seconds=20.0, memory=8_000_000_000)
    assert row.status in ("keeps all", "breaks"), row
    assert row.seconds == pytest.approx(row.claimed, rel=1e-6)
    if row.status == "keeps all":
        assert row.seconds >= free_form_bound(task).seconds
    if key in ("justblend_blends", "justblend_stops", "ruckig"):  # exact programs
        assert row.status == "keeps all", row
    if key == "scip":  # its tolerance
        assert row.factor < 1.0 + 1e-5, row


@pytest.mark.parametrize("limits", [{"velocity": 1.0}, {"velocity": 1.0, "acceleration": 2.0}])
def test_scip_keeps_limits_between_its_nodes_too(limits: dict[str, float]) -> None:
    if not installed(RIVALS["scip"]):
        pytest.skip("needs pyscipopt")
    task = Problem(TINY.waypoints, limits, name="less limited")
    (row,) = run_rival([task], RIVALS["scip"], seconds=20.0, memory=8_000_000_000)
    assert row.factor < 1.0 + 1e-5, row
    assert row.seconds >= free_form_bound(task).seconds * (1.0 - 1e-5)


@pytest.mark.parametrize("key", [key for key, rival in RIVALS.items() if rival.refusal])
def test_a_program_that_may_not_run_says_why(key: str) -> None:
    (row,) = run_rival([TINY], RIVALS[key], seconds=1.0, memory=1)
    assert (row.status, row.reason) == ("not run", RIVALS[key].refusal)
    (zoned,) = run_rival([with_zones(TINY, 0.1)], RIVALS[key], seconds=1.0, memory=1)
    assert not zoned.exact  # nothing was passed


def test_a_missing_program_says_what_to_install() -> None:
    rival = Rival("x", "x", "nowhere:x", "not-there", ("not_there",), "", "")
    (row,) = run_rival([TINY], rival, seconds=1.0, memory=1)
    assert (row.status, row.reason) == ("not installed", "pip install not-there")


def test_an_interrupted_run_loses_nothing_that_is_finished(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    listed = calls([TINY], ["ruckig", "jacobi"], zone=0.1, seconds=20.0, memory=4_000_000_000)
    true, asked = STUDY.compute, []

    def interrupted(*call: Any) -> list[RivalRow]:
        asked.append(call[2])
        if call[2] == stop:
            raise KeyboardInterrupt
        return list(true(*call))

    # the same name: rows are kept for the function that made them
    interrupted.__module__, interrupted.__qualname__ = true.__module__, true.__qualname__
    study, stop = replace(STUDY, compute=interrupted), "jacobi"
    with pytest.raises(KeyboardInterrupt):
        run(study, listed, folder=tmp_path)
    assert [row.rival for row in finished(study, listed, tmp_path).rows] == ["timebound", "ruckig"]
    stop = ""
    whole = run(study, listed, folder=tmp_path, resume=True)
    assert asked == ["timebound", "ruckig", "jacobi", "jacobi"]
    assert [row.rival for row in whole.rows] == ["timebound", "ruckig", "jacobi"]
    assert whole.rows[1].over_bound == whole.rows[1].seconds / whole.rows[0].bound


def test_ctrl_c_shows_what_is_finished(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def pressed(rival: Rival, *rest: Any, **named: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("compare.rivals.rows.run_apart", pressed)
    assert main(["rivals", "sr4c", "--rivals", "ruckig", "--out", str(tmp_path)]) == 130
    shown = capsys.readouterr()
    assert "interrupted: 1 of 2 rows are left for --resume" in shown.err
    assert "timebound" in shown.out


def test_corners_are_cut_by_both_and_the_others_are_run_once() -> None:
    listed = calls([TINY], ["ruckig", "justblend_blends"], zone=0.1, seconds=1.0, memory=1)
    zones = "tiny, zones of 0.1 rad"
    assert [(call[0].name, call[1] and call[1].name, call[2]) for call in listed] == [
        ("tiny", None, "timebound"),
        (zones, None, "timebound"),
        ("tiny", zones, "ruckig"),
        ("tiny", None, "justblend_blends"),
        (zones, None, "justblend_blends"),
    ]
    assert count_rows(listed) == 6
    exact, zoned = listed[0][0], listed[1][0]
    assert exact.conditions.none
    assert {k: box.tolist() for k, box in zoned.conditions.tolerance.items()} == {1: [0.1, 0.1]}
    (row,) = run_rival([exact], RIVALS["justblend_blends"], seconds=1.0, memory=1)
    assert row.status == "cannot be asked"
    assert "passes no inner waypoint exactly" in row.reason


def test_a_program_without_zones_is_given_the_points_and_marked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    zoned = with_zones(TINY, 0.1)
    rival = Rival("plain", "plain", "fake_rivals:plain", "numpy", (), "", "")  # refuses any condition
    rows = run_rival([TINY, zoned], rival, seconds=60.0, memory=4_000_000_000)
    assert [(row.problem, row.status, row.exact) for row in rows] == [
        ("tiny", "keeps all", False), ("tiny, zones of 0.1 rad", "keeps all", True),
    ]  # fmt: skip
    assert rows[0].seconds == rows[1].seconds
    assert rows[0].computation == rows[1].computation  # it was run once
    assert max(row.deviation for row in rows) < 1e-8
    marked = [cells(row)[-1] for row in rows]
    assert marked == ["", "passes the points exactly"]
    (own,) = run_rival([zoned], rival, seconds=60.0, memory=4_000_000_000)  # a file with zones
    assert (own.status, own.exact) == ("keeps all", True)
    waiting = replace(zoned, conditions=replace(zoned.conditions, waits={1: 0.5}))
    (row,) = run_rival([waiting], rival, seconds=60.0, memory=4_000_000_000)
    assert (row.status, row.reason) == (
        "cannot be asked", "plain: knows no conditions, the problem has conditions.waits",
    )  # fmt: skip


def test_each_task_is_judged_on_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """A motion within the zones keeps all there, and misses the point of the task without zones."""
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    rival = Rival("cut", "cut", "fake_rivals:cut", "numpy", (), "", "")
    exact, zoned = run_rival([TINY, with_zones(TINY, 0.1)], rival, seconds=60.0, memory=4_000_000_000)
    assert (exact.status, zoned.status) == ("breaks", "keeps all")
    assert exact.faults.startswith("misses waypoint 2 by 0.0")


def test_the_summary_counts_every_row() -> None:
    rows = [
        OURS,
        replace(OURS, rival="ruckig", seconds=2.0 * FASTEST),
        replace(OURS, rival="scip", status="breaks", mended=3.0 * FASTEST, factor=1.2),
        RivalRow("tiny", "toppra", "1", "crashed"),
        RivalRow("tiny", "jacobi", "1", "not run"),
    ]
    found = {entry["rival"]: entry for entry in summarise(beside(rows))}
    assert found["ruckig"]["over"] == pytest.approx((2.0, 2.0))
    assert found["scip"]["over"] is None
    assert found["scip"]["mended"] == pytest.approx((3.0, 3.0))
    assert found["scip"]["factor"] == 1.2
    counts = {
        key: tuple(found[key][name] for name in ("tasks", "kept", "broken", "none")) for key in found
    }
    assert counts == {
        "timebound": (1, 1, 0, 0), "ruckig": (1, 1, 0, 0), "scip": (1, 0, 1, 0), "toppra": (1, 0, 0, 1),
        "jacobi": (0, 0, 0, 0),
    }  # fmt: skip


def test_an_excess_within_rounding_is_seen() -> None:
    assert [limit_factor(f) for f in (0.5, 1.0, 1.0 + 8e-7, 1.305)] == [
        "0.500", "1.000", "1 + 8.0e-07", "1.305",
    ]  # fmt: skip


def test_command_writes_table_json_and_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, page = tmp_path / "rows.json", tmp_path / "page.html"
    options = ["--rivals", "ruckig,jacobi", "--json", str(out), "--page", str(page)]
    options += ["--out", str(tmp_path / "rows")]
    assert main(["rivals", "sr4c", *options]) == 0
    data = json.loads(out.read_text())["rows"]
    assert [row["rival"] for row in data] == ["timebound", "ruckig", "jacobi"]
    assert data[0]["seconds"] >= data[0]["bound"]
    shown = capsys.readouterr().out
    for value in (data[1]["seconds"], data[1]["over_fastest"], data[0]["over_bound"]):
        assert f"{value:.4f}" in shown
    assert "Rivals in one run" in page.read_text()
    assert f"{data[1]['seconds']:.4f}" in page.read_text()


def test_tables_fit_into_eighty_columns() -> None:
    """Every program with the longest entries, whatever they say."""
    words = "velocity 1 + 1.5e-04 of its limit (joint 3, and 6 more); " * 3
    rows = [
        RivalRow(
            "tiny", key, "1", "no motion", words, 25.0, 12.0, 17.8380, 10.0, 10.0, 9.0, 1.0, 1.0, 9.0, 1.0,
            1.0 + 8.1e-7, 17.8380, words, 20.23, exact,
        )
        for exact in (False, True)
        for key in RIVALS
    ]  # fmt: skip
    shown = as_text(rows, summarise(rows)).splitlines()
    assert max(len(line) for line in shown if "velocity" not in line and "----" not in line) <= 80
    assert sum(line == "points passed exactly:" for line in shown) == 2
    assert sum(line.count("1+8.1e-07") for line in shown) == 4 * len(RIVALS)


def test_programs_that_are_not_given_a_task_stand_at_the_end_with_reasons() -> None:
    absent = RivalRow("tiny", "scip", "", "not installed", "pip install pyscipopt")
    rows = beside([OURS, absent, replace(absent, problem="other"), replace(OURS, problem="other")])
    tables, _, end = as_text(rows, summarise(rows)).partition("not given a task\n")
    assert "SCIP" not in tables
    assert "points passed exactly" not in tables + end
    assert "SCIP         2  not installed: pip install pyscipopt" in end


def test_names_of_a_page_are_escaped() -> None:
    row = RivalRow("<b>x", "timebound", "1", "no motion", "<script>")
    assert "<b>x" not in as_page([row], summarise([row]))
    assert "<b>x" in as_text([row], summarise([row]))


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
