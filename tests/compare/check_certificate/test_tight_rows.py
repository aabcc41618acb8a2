"""Motions that use all limits keep a row with equality: no coefficient could be less."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from few_demands import FREE, demands
from handmade_certificates import certificate, with_multiplier

from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.relaxation import Relaxation


def farthest(rng: np.random.Generator, s: np.ndarray, T: float, J: float) -> dict[str, Any]:
    """A motion of jerk J, 0, -J, 0, -J, 0, J with switches at shares s of its time, and its limits.

    Its velocity is greatest between the third and the fourth switch.
    """
    h = np.diff([0.0, *s, 1.0]) * T
    x, v, a = 0.0, float(rng.uniform(19.0, 20.0)), J * (h[2] - h[0])
    states = [(x, v, a)]
    for step, jerk in zip(h, (J, 0.0, -J, 0.0, -J, 0.0, J), strict=True):
        x, v, a = (
            x + v * step + a * step**2 / 2 + jerk * step**3 / 6,
            v + a * step + jerk * step**2 / 2,
            a + jerk * step,
        )
        states.append((x, v, a))
    return {
        "states": (states[0], states[-1]),
        "velocity": [-99.0, states[3][1]],
        "acceleration": [-J * h[4], J * h[2]],
    }


def values(ends: tuple[Any, Any], T: float, middles: tuple[float, float]) -> dict[Any, float]:
    """All variables of one joint on one leg."""
    found = {("T", 0): T, ("u", 0): 1 / T, ("q", 0): T**2, ("r", 0): T**3}
    for end, ((x, v, a), c) in enumerate(zip(ends, middles, strict=True)):
        found |= {("v", end, 0): v, ("a", end, 0): a, ("e", end, 0): x - c}
        found |= {("g", 0, 0, end): T * v, ("W", 0, 0, end): T * a}
        found |= {("X", 0, 0, end): T * T * a, ("p", 0, 0, end): (x - c) / T}
    return found


def one_leg(made: dict[str, Any], J: float, **more: Any) -> Relaxation:
    """A leg of at least 1e-3 s with zones around both ends of a motion."""
    around = np.array([-0.25, 0.5])
    asked = demands([[made["states"][i][0] + around] for i in (0, 1)], [1.0], 1.0, J)
    asked["velocity"] = np.array([[made["velocity"]]])
    asked["acceleration"] = np.array([[made["acceleration"]]])
    asked["end_velocity"], asked["end_acceleration"] = asked["velocity"][[0, 0]] * 9.0, [[FREE]] * 2
    asked["durations"] = np.array([[1e-3, np.inf]])
    return Relaxation(Claim(certificate(asked | more, 1e-9, 9.0, [])))


def slack(checker: Relaxation, raw: list[Any], at: dict[Any, float], spoilt: Any = None) -> float:
    """Right-hand side minus left; ``spoilt``: a variable whose coefficient is 1 % off."""
    row, upper = checker.row(with_multiplier(raw, 1.0))
    return float(upper) - sum(
        float(x) * at[key] * (1.01 if key == spoilt else 1) for key, x in row.items()
    )


@pytest.mark.parametrize("kind", ["d", "D", "k", "K", "r", "R"])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_motion_that_uses_all_limits_keeps_a_row_with_equality(kind: str, sign: int) -> None:
    """So no coefficient could be less: each that is 1 % off makes the row false or loose."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        T, J = float(rng.uniform(0.1, 2.0)), float(rng.uniform(1.0, 9.0))
        s = np.sort(rng.uniform(0.0, 1.0, 6))
        if kind in "kKrR":
            s[2:4] = (s[1] + s[4]) / 2.0 if kind in "kK" else s[1]
        made = farthest(rng, s, T, J)
        places = [float(x) for x in s]
        raw: list[Any] = [kind, 0, 0, sign, *places]
        more: dict[str, Any] = {}
        if kind in "rR":
            made, more = stopping(s[:2], T, J), {}
            more["position"] = np.array([[[-np.inf, made["room"]]]])
            raw = [kind, 0, 0, 0, sign, *places[:2]]
        if sign < 0:
            made = {key: mirrored(value) for key, value in made.items()}
            more = {key: -value[..., ::-1] for key, value in more.items()}
        checker = one_leg(made, J, **more)
        at = values(made["states"], T, tuple(float(checker.c[i][0]) for i in (0, 1)))
        size = sum(abs(x) for x in at.values())
        assert slack(checker, raw, at) == pytest.approx(0.0, abs=1e-12 * size)
        for key, x in checker.row(with_multiplier(raw, 1.0))[0].items():
            if abs(float(x) * at[key]) > 1e-6:
                assert abs(slack(checker, raw, at, spoilt=key)) > 1e-9


def stopping(s: np.ndarray, T: float, J: float) -> dict[str, Any]:
    """A motion of jerk -J and then of none that stands still, as far as it may go, at a share s[1] of T."""
    h0, h1 = s[0] * T, (s[1] - s[0]) * T
    A = J * T
    a, v1 = J * h0 - A, A * h1
    v = v1 - a * h0 + J * h0**2 / 2
    x1 = v * h0 + a * h0**2 / 2 - J * h0**3 / 6
    start = (0.0, v, a)
    return {
        "states": (start, (0.1, 0.0, -A)),
        "velocity": [-9.0, 99.0],
        "acceleration": [-A, 2.0 * A],
        "room": x1 + v1 * h1 - A * h1**2 / 2,
    }


def mirrored(value: Any) -> Any:
    """The same in the other direction."""
    if isinstance(value, tuple):
        return tuple(mirrored(x) if isinstance(x, tuple) else -x for x in value)
    return [-x for x in reversed(value)] if isinstance(value, list) else -value
