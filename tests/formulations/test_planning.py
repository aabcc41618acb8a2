"""The Python face for an engineer: from files to a verified motion, a picture and a file in ten lines."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

import formulations as f
from formulations import planning

mpl.use("Agg")

from small_robot import ARM, CSV, YAML


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, text in (("arm.urdf", ARM), ("joint_limits.yaml", YAML), ("path.csv", CSV)):
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_ten_lines_from_files_to_a_motion(folder: Path) -> None:
    robot = f.Robot.from_urdf("arm.urdf", limits="joint_limits.yaml")
    waypoints = f.waypoints_of("path.csv", robot, unit="deg")
    problem = f.Problem(waypoints, limits=robot.limits, names=robot.names)
    motion = f.plan(problem)
    assert problem.units == ("rad", "rad", "m")  # carried by the limits
    assert motion.bound is not None
    assert motion.gap is not None
    assert motion.bound <= motion.seconds
    assert motion.gap == pytest.approx(motion.seconds / motion.bound - 1.0)
    # the test's own truth: sampled derivatives under the numbers of the files
    times = np.linspace(0.0, motion.seconds, 4001)
    for order, limit in ((1, [2, 1, 0.5]), (2, [4, 3, 2]), (3, [40, 30, 20])):
        assert (np.abs(motion.trajectory.at(times, order)) <= np.array(limit) * (1 + 1e-7)).all()
    written = motion.to_csv("motion.csv", rate=100.0)
    assert written.verdict.feasible
    rows = (folder / "motion.csv").read_text().splitlines()
    assert "slide" in rows[0]
    assert len(rows) - 1 == round(written.seconds * 100) + 1


def test_the_picture_shows_names_units_and_limits(folder: Path) -> None:
    robot = f.robot_of("arm.urdf", limits="joint_limits.yaml")
    waypoints = f.waypoints_of("path.csv", robot, unit="deg")
    problem = f.Problem(waypoints, robot.limits, names=robot.names, display_unit="deg")
    figure = f.plan(problem, bound=False).plot()
    titles = [axes.get_title() for axes in figure.axes[:3]]
    assert titles == ["joint turn", "joint bend", "joint slide"]
    assert figure.axes[3].get_ylabel() == "velocity\n[deg/s]"
    assert figure.axes[5].get_ylabel() == "velocity\n[m/s]"
    dashed = [line for line in figure.axes[3].get_lines() if line.get_linestyle() == "--"]
    assert sorted(line.get_ydata()[0] for line in dashed) == pytest.approx(
        [-np.rad2deg(2), np.rad2deg(2)]
    )
    mpl.pyplot.close(figure)


def test_answers_print_short() -> None:
    motion = f.plan(f.load("sr4c"))
    for thing in (motion, motion.found, motion.trajectory, motion.problem):
        assert len(repr(thing)) < 120
        assert "array" not in repr(thing)


def test_the_bound_is_that_of_the_conditions_without_their_total_time() -> None:
    problem = f.Problem([[0.0], [1.0]], {"velocity": 1, "acceleration": 1})
    fast = f.plan(problem, conditions=f.Conditions(start_velocity=np.array([1.0])))
    # 1.5 s: from 1 rad/s on, half a radian at top speed, then braking for 1 s; this is proved too
    assert fast.seconds == pytest.approx(1.5, rel=1e-6)
    assert fast.bound == pytest.approx(1.5, rel=1e-6)
    slow = f.plan(problem, conditions=f.Conditions(total=3.0))
    assert slow.gap == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize(
    ("limit", "bound", "motion"),
    [(8.0, True, 6.0), (200.0, True, 180.0), (8.0, False, 8.0), (None, True, None)],
)
def test_a_time_limit_keeps_a_share_for_the_bound(
    monkeypatch: pytest.MonkeyPatch, limit: float | None, bound: bool, motion: float | None
) -> None:
    """A quarter, or the 20 s that a bound of few segments takes at most; the rest is the motion's."""
    found, given = planning.free_form, []

    def searched(*arguments: Any, **options: Any) -> Any:
        given.append(options["time_limit"])
        return found(*arguments, **options)

    monkeypatch.setattr(planning, "free_form", searched)
    f.plan(
        f.Problem([[0.0], [1.0]], {"velocity": 1.0, "acceleration": 1.0}), time_limit=limit, bound=bound
    )
    assert given == [motion]


@pytest.mark.long
def test_a_search_that_uses_its_time_up_leaves_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = f.load("sr4c")
    found = planning.free_form

    def slow(*arguments: Any, **options: Any) -> Any:
        begun = time.perf_counter()
        answer = found(*arguments, **options)
        time.sleep(max(options["time_limit"] - (time.perf_counter() - begun), 0.0))
        return answer

    monkeypatch.setattr(planning, "free_form", slow)
    motion = f.plan(problem, time_limit=8.0)
    assert motion.gap is not None
    assert motion.gap < 1e-3


def test_a_time_limit_and_a_stop_end_the_search_with_a_verified_motion() -> None:
    rng = np.random.default_rng(1)
    waypoints = rng.uniform(-2.0, 2.0, (60, 6))
    limits = {"velocity": 1.0, "acceleration": 3.0, "jerk": 20.0}
    problem = f.Problem(waypoints, limits)
    started = time.perf_counter()
    motion = f.plan(problem, time_limit=2.0)
    assert time.perf_counter() - started < 60.0  # wide: the machine may be busy
    times = np.linspace(0.0, motion.seconds, 20_001)
    for order, limit in enumerate(limits.values(), 1):
        assert np.abs(motion.trajectory.at(times, order)).max() <= limit * (1.0 + 1e-7)
    assert motion.bound is not None
    assert motion.bound <= motion.seconds
    with pytest.raises(f.InputError, match="time_limit"):
        f.plan(problem, time_limit=-1.0)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda m: m.to_csv("m.json"), "path: m.json does not end in .csv"),
        (lambda m: m.to_csv("m.csv", rate=0.0), "rate: 0"),
        (lambda m: m.to_csv("m.csv", rate=1e9), "rate: 1e+09"),
        (lambda m: m.to_csv("nowhere/m.csv", rate=100.0), "nowhere/m.csv: cannot be written"),
        (lambda m: m.trajectory.at(1e3), "times: 1000 s is not within the motion, which takes 0 to 2"),
        (lambda m: m.trajectory.at([0.5, -0.1]), "times: -0.1 s is not within the motion"),
        (lambda m: m.trajectory.at(float("nan")), "times: nan s"),
        (lambda m: m.trajectory.at(1.0, -1), "order: -1"),
    ],
)  # fmt: skip
def test_misuse_names_the_argument(call: object, words: str, folder: Path) -> None:
    motion = f.plan(
        f.Problem([[0.0], [1.0]], {"velocity": 1, "acceleration": 1, "jerk": 1000}), bound=False
    )
    with pytest.raises(f.InputError) as caught:
        call(motion)  # type: ignore[operator]
    assert words in str(caught.value)


def test_times_within_rounding_of_the_ends_are_the_ends() -> None:
    ramp = f.Trajectory(np.array([2.0]), np.array([[[0.0, 0.5]]]))
    assert ramp.at([-1e-10, 2.0 + 1e-10]).tolist() == [[0.0], [1.0]]
