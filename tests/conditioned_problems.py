"""Random problems with conditions that fit them, for tests that hold for every problem."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from hypothesis import strategies as st

from formulations import Conditions, Limits, Problem

Draw = Any
LEAST, MOST = 0.2, 3.0


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


@st.composite
def limits(draw: Draw, dof: int, *, jerk: bool, acceleration: bool) -> Limits:
    """Limits with the given quantities finite; each may differ between the directions."""

    def quantity(high: float) -> Any:
        rows = draw(st.lists(numbers(LEAST, high), min_size=2 * dof, max_size=2 * dof))
        if draw(st.booleans()):
            return np.array(rows).reshape(dof, 2) * [-1.0, 1.0]
        return rows[:dof]

    given: dict[str, Any] = {"velocity": quantity(MOST)}
    if acceleration:
        given["acceleration"] = quantity(9.0)
    if jerk:
        given["jerk"] = draw(st.lists(numbers(1.0, 90.0), min_size=dof, max_size=dof))
    if draw(st.booleans()):
        given["position"] = np.tile([-9.0, 9.0], (dof, 1))
    return Limits.of(**given, dof=dof)


@st.composite
def end_states(draw: Draw, interval: np.ndarray, acceleration: bool) -> Any:
    """None, "free", or a value inside the limits."""
    kind = draw(st.sampled_from(["none", "free", "given"]))
    if kind != "given" or (acceleration and not np.isfinite(interval).all()):
        return None if kind == "none" else "free"
    share = draw(st.lists(numbers(0.0, 1.0), min_size=len(interval), max_size=len(interval)))
    low, high = interval.T
    return np.clip(low + (high - low) * np.array(share), low, high)


@st.composite
def conditioned_problems(draw: Draw, *, named: bool | None = None) -> Problem:
    """A problem with any of the conditions, all of which fit it."""
    dof, n = draw(st.integers(1, 3)), draw(st.integers(1, 5))
    jerk, acceleration = draw(st.booleans()), draw(st.booleans())
    jerk = jerk and acceleration
    points = np.array(
        draw(st.lists(numbers(-3.0, 3.0), min_size=dof * (n + 1), max_size=dof * (n + 1)))
    )
    points = points.reshape(n + 1, dof)
    cyclic = draw(st.booleans())
    if cyclic:
        points[-1] = points[0]
    whole = draw(limits(dof, jerk=jerk, acceleration=acceleration))
    inner = list(range(1, n))
    chosen = st.sets(st.sampled_from(range(n + 1)))
    zones = {
        k: np.array(draw(st.lists(numbers(0.0, 0.5), min_size=dof, max_size=dof))) for k in draw(chosen)
    }
    if cyclic:
        zones.pop(0, None)
        zones.pop(n, None)
    segments = draw(st.sets(st.sampled_from(range(n))))
    own = {k: draw(limits(dof, jerk=jerk, acceleration=acceleration)) for k in segments}
    asked: dict[str, Any] = {
        "tolerance": zones,
        "windows": {
            k: (draw(numbers(0.0, 5.0)), draw(st.sampled_from([9.0, math.inf])))
            for k in draw(chosen)
            if k
        },
        "segment_times": {
            k: (draw(numbers(0.0, 1.0)), draw(st.sampled_from([2.0, math.inf])))
            for k in draw(st.sets(st.sampled_from(range(n))))
        },
        "stops": frozenset(draw(st.sets(st.sampled_from(inner)))) if inner else frozenset(),
        "waits": {k: draw(numbers(0.1, 1.0)) for k in inner if draw(st.booleans())},
        "segment_limits": own,
        "cyclic": cyclic,
        "total": draw(st.sampled_from([None, 60.0])),
    }
    if draw(st.booleans()):
        asked["passage"] = {k: 10.0 * k for k in inner if k not in asked["windows"]}
    if not cyclic:
        for end, k in (("start", 0), ("end", n - 1)):
            speeds, steepest = own.get(k, whole).intervals
            asked[f"{end}_velocity"] = draw(end_states(speeds, acceleration=False))
            if jerk:
                asked[f"{end}_acceleration"] = draw(end_states(steepest, acceleration=True))
    with_names = draw(st.booleans()) if named is None else named
    return Problem(
        points,
        whole,
        names=[f"a joint {j}" for j in range(dof)] if with_names else (),
        conditions=Conditions(**asked),
        display_unit=draw(st.sampled_from(["rad", "deg"])),
    )
