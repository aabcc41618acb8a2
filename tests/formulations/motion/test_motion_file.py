"""Motions on disk: what is written is the motion, what is read is what was written."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from formulations import FAMILIES, InputError, Trajectory, check, load
from formulations.motion.files.motion_file import read_motion, write_motion


@pytest.fixture
def motion() -> Trajectory:
    return FAMILIES["3-5-3"].trajectory(load("sr4c"), [1.5, 2.0, 1.4])


@pytest.mark.parametrize("suffix", ["csv", "json"])
@pytest.mark.parametrize("rate", [None, 100.0])
def test_a_motion_comes_back(
    suffix: str, rate: float | None, motion: Trajectory, tmp_path: Path
) -> None:
    path = tmp_path / f"motion.{suffix}"
    write_motion(path, motion, rate=rate)
    back = read_motion(path, passages=motion.passage_times)
    t = np.linspace(0.0, motion.seconds, 777)
    exact = 1e-13 if suffix == "csv" else 1e-8  # JSON holds the times to a nanosecond
    for order, loss in ((0, 1.0), (1, 10.0), (2, 1e3)):
        error = abs(back.at(t, order) - motion.at(t, order)).max()
        # at a fixed rate a step across a break is smoothed by the quintic
        assert error < (exact * loss * 10.0 if rate is None else 2e-3 * loss), order


def test_points_at_the_breaks_judge_like_the_motion(motion: Trajectory, tmp_path: Path) -> None:
    write_motion(tmp_path / "m.csv", motion)
    back = read_motion(tmp_path / "m.csv")
    problem = load("sr4c")
    first, second = check(problem, motion), check(problem, back)
    assert first.stretch == pytest.approx(second.stretch, rel=1e-9)
    assert first.seconds == second.seconds


def test_the_rate_is_kept_and_the_end_included(motion: Trajectory, tmp_path: Path) -> None:
    write_motion(tmp_path / "m.csv", motion, rate=250.0)
    table = np.genfromtxt(tmp_path / "m.csv", delimiter=",", skip_header=1)
    assert np.diff(table[:-1, 0]) == pytest.approx(0.004)
    assert table[-1, 0] == motion.seconds
    np.testing.assert_allclose(table[-1, 1:7], load("sr4c").waypoints[-1], atol=1e-14)
    np.testing.assert_allclose(table[-1, 7:], 0.0, atol=1e-12)


def test_the_json_is_a_joint_trajectory(motion: Trajectory, tmp_path: Path) -> None:
    write_motion(tmp_path / "m.json", motion)
    data = json.loads((tmp_path / "m.json").read_text())
    assert data["joint_names"] == [f"joint_{j}" for j in range(1, 7)]
    last = data["points"][-1]["time_from_start"]
    assert last["sec"] + 1e-9 * last["nanosec"] == pytest.approx(4.9, abs=1e-9)
    assert 0 <= last["nanosec"] < 10**9


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("m.csv", "time,position_1\n0,0\n", "two points"),
        (
            "m.csv",
            "time,position_1,velocity_1,acceleration_1\n0,0,0,0\n1,0,0\n",
            "line 3: 3 values for 4 columns",
        ),
        ("m.csv", "time,position_1,velocity_1,acceleration_1\n0,0,0,0\n1,nan,0,0\n", "finite"),
        ("m.csv", "time,position_1,velocity_1,acceleration_1\n0,0,0,0\n0,1,0,0\n", "point 2 is at 0 s"),
        (
            "m.csv",
            "time,position_1,velocity_1,acceleration_1\n0,0,0,x\n0,1,0,0\n",
            "line 2: acceleration_1: 'x' is not a finite",
        ),
        ("m.csv", "time,position_1,velocity_1,acceleration_1\n0,0,0,0\n", "two points"),
        ("m.csv", "", "is empty"),
        ("m.json", "{}", "points is missing"),
        ("m.json", "[" * 100_000, "more than 32 levels deep"),
        ("m.json", '{"points": [1, 2]}', r"points\[0\]: expected keys"),
    ],
)
def test_a_broken_file_is_one_line(name: str, text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        read_motion(tmp_path / name)
    assert "\n" not in str(caught.value)


def test_misuse_is_one_line(motion: Trajectory, tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"as \.csv, \.json, \.yaml, \.npz or \.pieces\.json, not '\.txt'"
    ):
        write_motion(tmp_path / "m.txt", motion)
    with pytest.raises(InputError, match="rate"):
        write_motion(tmp_path / "m.csv", motion, rate=0.0)
    with pytest.raises(InputError, match="cannot be written"):
        write_motion(tmp_path / "no" / "m.csv", motion)
    with pytest.raises(InputError, match="no such file"):
        read_motion(tmp_path / "none.csv")
