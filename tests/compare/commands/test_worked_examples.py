"""The README's way from a URDF to a verified file, and docs/robots.md, run as they stand."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from robot_files import ROBOTS, shared

mpl.use("Agg")
pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]

README = (ROOT / "README.md").read_text("utf-8").split("**Engineer:**")[1].split("\n**")[0]
DOCS = (ROOT / "docs" / "robots.md").read_text("utf-8")
LIMITS = {  # velocity and acceleration in force, typed once more from the data sheets [rad or m, s]
    "panda": ([2.175] * 4 + [2.61] * 3, [15, 7.5, 10, 12.5, 15, 20, 20]),
    "ur5": ([np.pi] * 6, [5.0] * 6),
    "iiwa": (np.deg2rad([98, 98, 100, 130, 140, 180, 180]), [10.0] * 7),
    "scara": (
        0.5 * np.array([*np.deg2rad([415.0, 659.0]), 1.02, np.deg2rad(2400.0)]),
        5.0 * np.array([*np.deg2rad([415.0, 659.0]), 1.02, np.deg2rad(2400.0)]),
    ),
}


def blocks(text: str, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for path in ROBOTS.iterdir():
        shutil.copy(path, tmp_path)
    for ending in ("panda.urdf", "panda.srdf", "ur5_robot.urdf"):
        shutil.copy(shared(f"/{ending}"), tmp_path)
    shutil.copy(tmp_path / "panda_joint_limits.yaml", tmp_path / "joint_limits.yaml")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(script: str, folder: Path) -> str:
    """Run a block of shell, with ``timebound`` of this tree."""
    shim = f'timebound() {{ {sys.executable} -m compare "$@"; }}\nset -e\n'
    done = subprocess.run(
        ["bash", "-c", f"export PYTHONPATH={ROOT}\n{shim}{script}"],
        cwd=folder, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def keeps_limits(problem: object, path: Path, robot: str) -> None:
    """Judge a written file by samples of the test's own, against numbers of the test's own."""
    import formulations as f

    motion = f.read_motion(path)
    times = np.linspace(0.0, motion.seconds, 5001)
    for order, limit in enumerate(LIMITS[robot], 1):
        assert (np.abs(motion.at(times, order)) <= np.asarray(limit) * (1 + 1e-6)).all()
    assert isinstance(problem, f.Problem)
    nearest = [np.abs(motion.at(times) - w).max(axis=1).min() for w in problem.waypoints]
    assert max(nearest) < 5e-3  # between two samples


def test_the_engineers_commands_of_the_readme(folder: Path) -> None:
    import formulations as f

    run(blocks(DOCS, "sh")[0].split("timebound")[0], folder)  # waypoints.csv
    commands = blocks(README, "sh")[0].splitlines()
    assert len(commands) == 3
    started = time.perf_counter()
    said = run("\n".join(commands), folder)
    assert (
        time.perf_counter() - started < 180.0
    )  # the user's time, which is mostly the three starts of Python
    assert "motion.csv: keeps what mine asks for" in said
    assert "quintics between" in said
    assert "5 of 5 waypoints passed" in said
    assert "no motion that keeps the limits takes less than" in said
    assert "mine.toml: written, 5 waypoints of 7 joints" in said
    assert [command.split()[1] for command in commands] == ["new", "plan", "check"]
    assert "panda_joint" in said
    assert "motion.csv: written" in said
    keeps_limits(f.load(folder / "mine.toml"), folder / "motion.csv", "panda")


OUTPUTS = {
    "panda": "panda.csv",
    "ur5": "ur5.json",
    "iiwa": "iiwa.csv.json",
    "scara": "scara_motion.csv",
}


@pytest.mark.long
@pytest.mark.parametrize(("index", "robot"), list(enumerate(OUTPUTS)))
def test_each_robot_of_the_docs(index: int, robot: str, folder: Path) -> None:
    import formulations as f
    from compare.commands.motions.problem_options import OwnRobot

    script = blocks(DOCS, "sh")[index]
    said = run(script, folder)
    assert f"{OUTPUTS[robot]}: written" in said
    if robot == "panda":
        problem = f.load(folder / "panda.toml")
    else:
        words = script.splitlines()[-1].split()
        keys = ("robot", "waypoints", "unit", "srdf", "group", "unlimited")
        given = {key: words[words.index(f"--{key}") + 1] for key in keys if f"--{key}" in words}
        limits = (words[words.index("--limits") + 1],)
        problem = OwnRobot(**given, limits=limits).problem()  # type: ignore[arg-type]
    keeps_limits(problem, folder / OUTPUTS[robot], robot)


@pytest.mark.long
def test_a_path_is_timed_anew_under_the_limits_of_the_docs(folder: Path) -> None:
    import formulations as f

    first, *others = blocks(DOCS, "sh")
    retimings = [block for block in others if "timebound retime" in block]
    assert len(retimings) == 2
    run(first, folder)
    problem = f.load(folder / "panda.toml")
    for block, name in zip(retimings, ("panda_again.csv", "panda_toppra.json"), strict=True):
        said = run(block, folder)
        assert f"{name}: written" in said
        motion = f.read_motion(folder / name)
        times = np.linspace(0.0, motion.seconds, 20_001)
        for order, limit in enumerate(LIMITS["panda"], 1):
            assert (np.abs(motion.at(times, order)) <= np.asarray(limit) * (1 + 1e-6)).all()
        np.testing.assert_allclose(
            motion.at([0.0, motion.seconds]), problem.waypoints[[0, -1]], atol=1e-6
        )


def test_the_other_blocks_of_the_docs(folder: Path) -> None:
    import formulations as f

    run(blocks(DOCS, "sh")[0].split("END\ntimebound")[0] + "END\n", folder)
    (python,) = blocks(DOCS, "python")
    found: dict[str, object] = {}
    exec(python, found)
    keeps_limits(found["problem"], folder / "motion.csv", "panda")
    assert (folder / "motion.png").stat().st_size > 10_000
    (toml,) = blocks(DOCS, "toml")
    (folder / "keys.toml").write_text(toml)
    problem = f.load(folder / "keys.toml")
    assert problem.limits.velocity[0] == pytest.approx(np.pi / 3)
    assert problem.limits.velocity[1] == pytest.approx(2.175)
    mpl.pyplot.close("all")
