"""What is exported is judged as a controller would run it: by the file's own numbers, read here."""

from __future__ import annotations

import csv
import functools
import json
from pathlib import Path

import numpy as np
import pytest
import yaml
from conftest import Array

from formulations import (
    Conditions,
    InputError,
    Limits,
    NoFeasibleMotion,
    Problem,
    Trajectory,
    check,
    free_form,
    read_motion,
    write_motion,
)
from formulations.optima.at_rate.export import check_export, export_motion

SUFFIXES = (".csv", ".json", ".yaml", ".npz", ".pieces.json")


@functools.cache
def task(seed: int) -> tuple[Problem, Trajectory]:
    """A random problem of two joints and two or three segments, and its fastest motion."""
    rng = np.random.default_rng(seed)
    limits = Limits.of(rng.uniform(1, 3, 2), rng.uniform(3, 15, 2), rng.uniform(100, 5000, 2), dof=2)
    problem = Problem.of(rng.uniform(-1.5, 1.5, (3 + seed % 2, 2)), limits)
    found = free_form(problem).trajectory
    assert found is not None
    return problem, found


def points_of(path: Path) -> tuple[Array, Array]:
    """Times and (3, n_points, dof), read without the project."""
    if path.suffix == ".csv":
        with path.open() as file:
            table = np.array([[float(x) for x in row] for row in list(csv.reader(file))[1:]])
        return table[:, 0], np.moveaxis(table[:, 1:].reshape(len(table), 3, -1), 1, 0)
    if path.suffix == ".npz":
        with np.load(path) as arrays:
            return arrays["time"], np.stack(
                [arrays[k] for k in ("position", "velocity", "acceleration")]
            )
    text = path.read_text()
    data = json.loads(text) if path.suffix == ".json" else yaml.safe_load(text)
    stamps = [point["time_from_start"] for point in data["points"]]
    times = np.array([(stamp["sec"] * 10**9 + stamp["nanosec"]) / 1e9 for stamp in stamps])
    keys = ("positions", "velocities", "accelerations")
    return times, np.array([[point[key] for point in data["points"]] for key in keys])


def factors(path: Path, problem: Problem) -> Array:
    """Largest velocity, acceleration and jerk over their limits, by dense samples of Hermite quintics.

    The quintic solves six linear equations in normalised time, so that it shares nothing with the project.
    """
    times, (p, v, a) = points_of(path)
    h = np.diff(times)[:, None]
    given = [p[:-1], v[:-1] * h, a[:-1] * h**2, p[1:] - p[:-1], v[1:] * h, a[1:] * h**2]
    given[0] = np.zeros_like(p[:-1])
    powers = np.arange(6)
    rows = []
    for s in (0.0, 1.0):
        for order in range(3):
            falling = np.prod([powers - k for k in range(order)], axis=0) if order else np.ones(6)
            rows.append(falling * s ** np.maximum(powers - order, 0) * (powers >= order))
    c = np.tensordot(np.linalg.inv(np.array(rows)), np.stack(given), 1)  # (6, n, dof)
    s = np.linspace(0.0, 1.0, 41)
    found = []
    for order in (1, 2, 3):
        falling = np.prod([powers - k for k in range(order)], axis=0)
        basis = falling[:, None] * s ** np.maximum(powers - order, 0)[:, None]
        value = np.abs(np.tensordot(basis.T, c, 1)).max(axis=0) / h**order
        found.append((value / problem.limits.derivatives[order - 1]).max())
    return np.array(found)


@pytest.mark.parametrize(
    "seed", [*range(4), *(pytest.param(k, marks=pytest.mark.slow) for k in range(4, 16))]
)
def test_every_export_keeps_the_limits(seed: int, tmp_path: Path) -> None:
    problem, fastest = task(seed)
    for rate in (None, 125.0):
        for suffix in SUFFIXES:
            path = tmp_path / f"m{suffix}"
            written = export_motion(path, problem, fastest, rate)
            back = read_motion(path, waypoints=problem.waypoints)
            verdict = check(problem, back)
            assert verdict.feasible, (suffix, rate, verdict.faults)
            assert back.seconds == pytest.approx(written.seconds, rel=1e-12)
            assert written.verdict.feasible
            assert 0.0 <= written.cost <= (2e-3 * fastest.seconds if rate is None else 2.0 * 3 / rate)
            if suffix != ".pieces.json":
                assert (factors(path, problem) <= 1.0 + 1e-8).all(), (suffix, rate)
            if rate is not None:
                assert np.diff(back.breaks).max() >= 1.0 / rate - 1e-12


def test_samples_of_the_fastest_motion_do_not_keep_them(tmp_path: Path) -> None:
    problem, fastest = task(0)
    write_motion(tmp_path / "m.csv", fastest, rate=125.0)
    assert factors(tmp_path / "m.csv", problem)[2] > 1.02


def test_the_lines_say_what_the_file_does(tmp_path: Path) -> None:
    problem, fastest = task(0)
    written = export_motion(tmp_path / "m.csv", problem, fastest, 125.0, names=("elbow", "wrist"))
    first, second, third = written.lines()
    assert "written" in first
    assert f"{written.n_points} points at 125 per second" in first
    used = factors(tmp_path / "m.csv", problem)
    stated = [float(part.split()[-1]) for part in second.split("used of them:")[1].split(",")]
    np.testing.assert_allclose(stated, used, rtol=1e-2)
    assert all(stated[k] >= used[k] - 1e-6 for k in range(3))  # samples never exceed exact extremes
    assert "round segments up to whole periods" in third
    assert written.cost == pytest.approx(written.seconds - fastest.seconds)
    assert (
        (tmp_path / "m.csv").read_text().startswith("time,position_elbow,position_wrist,velocity_elbow")
    )


def test_points_too_coarse_name_the_rate_that_does(tmp_path: Path) -> None:
    problem, fastest = task(1)
    # at a stop in the middle of a short motion two points per second are too few, whatever their number
    asked = Conditions(total=fastest.seconds)
    rate = 1.0 / fastest.seconds
    with pytest.raises(
        NoFeasibleMotion, match="not written: no motion with its jerk constant"
    ) as caught:
        export_motion(tmp_path / "m.csv", problem, fastest, rate, conditions=asked)
    assert not (tmp_path / "m.csv").exists()
    if "points per second they keep" in str(caught.value):
        finer = float(str(caught.value).split("; at ")[1].split()[0])
        export_motion(tmp_path / "m.csv", problem, fastest, finer, conditions=asked)


@pytest.mark.parametrize(
    ("name", "rate", "limits", "message"),
    [
        ("m.xyz", None, (1.0, 2.0, 3.0), "not '.xyz'"),
        ("m.csv", 1e9, (1.0, 2.0, 3.0), "at most 5000000"),
        ("m.csv", -1.0, (1.0, 2.0, 3.0), "a positive number"),
        ("m.csv", None, (1.0, np.inf, np.inf), "limits.acceleration: joint 1 has none"),
        ("m.pieces.json", None, (1.0, np.inf, np.inf), "limits.acceleration: joint 1 has none"),
    ],
)
def test_a_bad_request_is_refused_before_anything_is_computed(
    name: str, rate: float | None, limits: tuple[float, float, float], message: str
) -> None:
    problem = Problem.of([[0.0], [1.0]], Limits.of(*limits, dof=1))
    with pytest.raises(InputError) as caught:
        check_export(name, problem, rate)
    assert message in str(caught.value)
