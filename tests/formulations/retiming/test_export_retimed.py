"""The file of a retimed path keeps the limits between its points, or is not written."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Array
from scipy.interpolate import BPoly

from formulations import InputError, Limits, NoFeasibleMotion, Problem, Trajectory, check
from formulations.retiming.export import export_retimed
from formulations.retiming.retime import Retimed

V, A, J = 2.0, 6.0, 30.0


def bang_bang(distance: float, pace: float = 1.0) -> Trajectory:
    """Rest to rest in four phases of full jerk: distance = 2 J h^3."""
    h = (distance / (2.0 * J)) ** (1.0 / 3.0)
    pieces, state = [], np.zeros(3)
    for jerk in (J, -J, -J, J):
        x, v, a = state
        pieces.append([[x, v, a / 2.0, jerk / 6.0]])
        state = np.array(
            [
                x + v * h + a * h**2 / 2.0 + jerk * h**3 / 6.0,
                v + a * h + jerk * h**2 / 2.0,
                a + jerk * h,
            ]
        )
    return Trajectory(np.full(4, h), np.array(pieces)).stretched(pace)


def way(motion: Trajectory, top: float = np.inf, key: str = "copp") -> Retimed:
    ends = motion.at([0.0, motion.seconds])
    limits = Limits.of(V, A, J, (-np.inf, top), dof=motion.dof)
    problem = Problem.of(ends, limits, name="path", names=("elbow",))
    return Retimed(key, problem, None, motion)


def largest(times: Array, states: Array) -> tuple[float, list[float]]:
    """Highest position, and largest velocity, acceleration and jerk, of the quintics through states."""
    spline = BPoly.from_derivatives(times, states)
    at = np.linspace(times[0], times[-1], 20_001)
    sizes = [float(np.abs(spline.derivative(order)(at)).max()) for order in (1, 2, 3)]
    return float(spline(at).max()), sizes


def rows(path: Path) -> Array:
    return np.loadtxt(path, delimiter=",", skiprows=1)


@pytest.mark.parametrize("rate", [10.0, 37.0, 125.0, 1000.0])
def test_points_between_which_the_jerk_overshoots_cost_a_stretch_that_is_stated(
    rate: float, tmp_path: Path
) -> None:
    motion = bang_bang(0.3)
    # the truth: samples of this motion, joined by quintics, break the jerk limit
    periods = int(np.ceil(motion.seconds * rate))
    slower = motion.stretched(periods / rate / motion.seconds)
    times = np.arange(periods + 1) / rate
    states = np.stack([slower.at(times.clip(0.0, slower.seconds), k)[:, 0] for k in range(3)], axis=1)
    overshoot = largest(times, states)[1][2] / J
    written = export_retimed(tmp_path / "m.csv", way(motion), rate)
    table = rows(tmp_path / "m.csv")
    np.testing.assert_allclose(np.diff(table[:, 0]), 1.0 / rate, rtol=1e-6)  # the last step too
    sizes = largest(table[:, 0], table[:, 1:])[1]
    assert sizes[0] <= V
    assert sizes[1] <= A
    assert sizes[2] <= J * (1.0 + 1e-6)
    assert table[-1, 1] == pytest.approx(0.3, abs=1e-12)
    assert written.seconds == pytest.approx(table[-1, 0])
    assert written.seconds >= motion.seconds
    said = written.lines()
    assert f"stretched by {written.seconds / motion.seconds:.9g}" in said[2]
    if overshoot > 1.001:
        assert "between its points: jerk of joint elbow in segment 1" in said[3]
        stated = float(said[3].split("factor ")[1].split(";")[0])
        assert stated == pytest.approx(overshoot, rel=1e-2)
        assert "a stretch of " in said[3]
        # no file of this rate is much faster: a period less breaks the limit
        assert written.seconds <= motion.seconds * overshoot ** (1.0 / 3.0) * 1.1 + 1.0 / rate
    else:
        assert len(said) == 3


def test_the_rate_that_is_named_needs_no_stretch(tmp_path: Path) -> None:
    said = export_retimed(tmp_path / "m.csv", way(bang_bang(0.3)), 10.0).notes
    assert said[0].endswith("; at 40 points per second none is needed")
    assert export_retimed(tmp_path / "n.csv", way(bang_bang(0.3)), 40.0).notes == ()


@pytest.mark.parametrize("suffix", [".json", ".yaml", ".npz", ".pieces.json"])
def test_every_format_is_judged(suffix: str, tmp_path: Path) -> None:
    motion = bang_bang(0.3)
    for rate in (None, 50.0):
        written = export_retimed(tmp_path / f"m{suffix}", way(motion), rate)
        assert written.verdict.feasible
        assert (tmp_path / f"m{suffix}").stat().st_size > 100
        assert written.seconds >= motion.seconds * (1.0 - 1e-9)
    if suffix == ".json":
        assert json.loads((tmp_path / "m.json").read_text())["joint_names"] == ["elbow"]


def touching(top: float) -> Trajectory:
    """Up to the top and half the way back, each from rest to rest."""
    up, down = bang_bang(top), bang_bang(top / 2.0)
    back = -down.coefficients
    back[:, :, 0] += top
    return Trajectory(
        np.concatenate([up.durations, down.durations]), np.concatenate([up.coefficients, back])
    )


def test_a_position_that_no_stretch_mends_is_refused(tmp_path: Path) -> None:
    motion = touching(0.3)
    problem = way(motion, top=0.3).problem
    assert problem is not None
    kept = check(problem, Trajectory(motion.durations, motion.coefficients, motion.breaks[[0, -1]]))
    assert kept.feasible, kept.faults
    reasons = []
    for rate in np.linspace(1.2, 12.0, 25):
        path = tmp_path / f"{rate:.3f}.csv"
        try:
            export_retimed(path, way(motion, top=0.3), float(rate))
        except NoFeasibleMotion as error:
            reasons.append(str(error))
            assert not path.exists()
            continue
        table = rows(path)
        highest, sizes = largest(table[:, 0], table[:, 1:])
        assert highest <= 0.3 + 1e-9
        assert sizes[2] <= J * (1.0 + 1e-6)
    assert reasons
    assert all("not written" in text and "position of joint elbow" in text for text in reasons)


def test_what_cannot_be_written_is_refused(tmp_path: Path) -> None:
    with pytest.raises(NoFeasibleMotion, match="no motion of copp keeps every limit"):
        export_retimed(tmp_path / "m.csv", Retimed("copp", reason="because"))
    with pytest.raises(InputError, match=r"not '\.xyz'"):
        export_retimed(tmp_path / "m.xyz", way(bang_bang(0.3)))
    with pytest.raises(InputError, match="points per second"):
        export_retimed(tmp_path / "m.csv", way(bang_bang(0.3)), 1e9)
