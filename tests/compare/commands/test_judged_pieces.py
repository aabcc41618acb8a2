"""``check`` and ``view`` of exact polynomials: what the pieces do, joint by joint, and no points between."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from formulations import FAMILIES, InputError, check, load, write_motion
from formulations.motion.files.motion_file import read_points_or_pieces
from formulations.motion.judgement import judge
from formulations.motion.trajectory import Trajectory


@pytest.fixture(scope="module")
def spline() -> Trajectory:
    """A 3-5-3 spline of sr4c at its limits."""
    problem = load("sr4c")
    found = FAMILIES["3-5-3"].trajectory(problem, [2.0, 1.0, 2.0])
    return found.stretched(check(problem, found).stretch * (1.0 + 1e-6))


def test_pieces_are_judged_as_they_are(
    spline: Trajectory, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, fast = tmp_path / "mine.pieces.json", tmp_path / "fast.pieces.json"
    write_motion(path, spline)
    write_motion(fast, spline.stretched(1.0 / 1.1))
    assert main(["check", "sr4c", str(path), "--no-bound", "--json", "-"]) == 0
    said = capsys.readouterr()
    answer = json.loads(said.out)
    assert answer["interpolation"] == "pieces"
    assert answer["seconds"] == spline.seconds  # to the last bit
    assert answer["stretch_for_limits"] == pytest.approx(1.0, abs=2e-6)
    assert main(["check", "sr4c", str(fast), "--no-bound"]) == 3
    said = capsys.readouterr()
    assert f"; {len(spline.durations)} exact polynomials\n" in said.out
    assert "stretched by 1.1" in said.out
    assert main(["check", "sr4c", str(path), "--no-bound", "--interpolation", "cubic"]) == 2
    assert (
        "interpolation: 'cubic': exact pieces are not joined; leave it out" in capsys.readouterr().err
    )


def test_joints_of_pieces_are_put_in_the_order_of_the_problem(
    spline: Trajectory, tmp_path: Path
) -> None:
    problem = load("sr4c")
    names = tuple(f"axis {j}" for j in range(problem.dof))
    shuffled = np.random.default_rng(0).permutation(problem.dof)
    path = tmp_path / "mine.pieces.json"
    mixed = Trajectory(spline.durations, spline.coefficients[:, shuffled])
    write_motion(path, mixed, names=tuple(names[j] for j in shuffled))
    back = read_points_or_pieces(path, names)
    assert isinstance(back, Trajectory)
    np.testing.assert_array_equal(back.coefficients, spline.coefficients)
    assert judge(problem, back).feasible
    unnamed = read_points_or_pieces(path)
    assert isinstance(unnamed, Trajectory)
    assert not judge(problem, unnamed).feasible  # the planted fault: in the wrong order
    with pytest.raises(InputError, match="motion: joints axis"):
        read_points_or_pieces(path, ("another", *names[1:]))


def test_a_page_of_pieces_is_written(
    spline: Trajectory, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, page = tmp_path / "mine.pieces.json", tmp_path / "page.html"
    write_motion(path, spline)
    argv = ["view", "sr4c", str(path), "--out", str(page), "--no-open", "--rungs", "ruckig_stop_and_go"]
    assert main(argv) == 0
    capsys.readouterr()
    assert f"{len(spline.durations)} exact polynomials" in page.read_text("utf-8")
