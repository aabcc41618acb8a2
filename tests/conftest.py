"""What the tests share: one stable hypothesis profile, problems to draw, the shipped ladders."""

from __future__ import annotations

import functools
import gc
import os
import pickle
from collections import Counter
from pathlib import Path
from typing import Any

# before numpy looks: the workers of a run are its threads
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from formulations import CASES, Ladder, Limits, Problem, ladder, load
from formulations.problem.arrays import Array

pytest_plugins = ["report_in_browser"]

# the shipped cases where their optima and proofs are needed: those of z1 take minutes
SOLVED = [pytest.param(case, marks=[pytest.mark.long] * (case == "z1")) for case in CASES]

settings.register_profile(
    "timebound",
    derandomize=True,
    database=None,
    deadline=None,
    max_examples=60,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("timebound")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The proof of z1 first, then the files with most slow tests: what begins last would end alone."""
    slow = Counter(
        item.path for item in items if {"slow", "long"} & {m.name for m in item.iter_markers()}
    )
    longest = {item.path for item in items if "[z1]" in item.name and "proved" in item.path.name}
    items.sort(key=lambda item: (item.path not in longest, -slow[item.path]))


def pytest_collection_finish() -> None:
    """Thousands of tests stay alive to the end: no collection of garbage need look at them again."""
    gc.freeze()


def powers_of_ten(low: float, high: float) -> st.SearchStrategy[float]:
    """Positive numbers, even in their logarithm."""
    return st.floats(low, high).map(lambda exponent: float(10.0**exponent))


@st.composite
def displacements(draw: st.DrawFn, low: float = -6.0, high: float = 3.0) -> float:
    """Zero one time in six, else 10^low to 10^high with either sign."""
    if draw(st.integers(0, 5)) == 0:
        return 0.0
    return draw(st.sampled_from([-1.0, 1.0])) * draw(powers_of_ten(low, high))


@st.composite
def problems(
    draw: st.DrawFn,
    *,
    segments: st.SearchStrategy[int] | int = 3,
    max_dof: int = 3,
    family: str | None = None,
    reach: tuple[float, float] = (-6.0, 3.0),
    limited: tuple[str, ...] = ("v", "va", "vj", "vaj"),
    position: bool = False,
) -> Problem:
    """A legal problem: any mix of limits, joints that stand still and equal waypoints included.

    reach: decimal exponents of the displacements. limited: which derivatives may have limits.
    """
    n = segments if isinstance(segments, int) else draw(segments)
    dof = draw(st.integers(1, max_dof))
    steps = [[draw(displacements(*reach)) for _ in range(dof)] for _ in range(n)]
    start = [draw(st.floats(-3.0, 3.0)) for _ in range(dof)]
    waypoints = np.cumsum([start, *steps], axis=0)
    kind = draw(st.sampled_from(limited))
    size = powers_of_ten(-1.0, 1.0)
    limits = {
        name: [draw(size) for _ in range(dof)]
        for letter, name in (("v", "velocity"), ("a", "acceleration"), ("j", "jerk"))
        if letter in kind
    }
    bounds: Array | tuple[float, float] = (-np.inf, np.inf)
    if position:
        width = np.maximum(np.ptp(waypoints, axis=0), 1e-3)
        margin = np.array([[draw(st.floats(0.01, 1.0)) for _ in range(2)] for _ in range(dof)])
        bounds = np.stack(
            [
                waypoints.min(axis=0) - margin[:, 0] * width,
                waypoints.max(axis=0) + margin[:, 1] * width,
            ],
            axis=1,
        )
    return Problem.of(waypoints, Limits.of(**limits, position=bounds, dof=dof), family=family)


def durations(n: int, low: float = -3.0, high: float = 3.0) -> st.SearchStrategy[Array]:
    """Durations (n,) [s] from 10^low to 10^high."""
    return st.lists(powers_of_ten(low, high), min_size=n, max_size=n).map(np.array)


_SHARED: list[Path] = []  # folder of this run, common to its workers


@pytest.fixture(scope="session", autouse=True)
def _shared_folder(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> None:
    base = tmp_path_factory.getbasetemp()
    _SHARED.append(base if worker_id == "master" else base.parent)


@functools.cache
def climbed(case: str) -> Ladder:
    """The ladder of a shipped case, climbed once for all tests and workers: it holds its optima."""
    path = _SHARED[0] / f"{case}.ladder"
    if path.exists():
        found = pickle.loads(path.read_bytes())
        assert isinstance(found, Ladder)
        return found
    found = ladder(load(case))
    part = path.with_suffix(f".{id(found)}")
    part.write_bytes(pickle.dumps(found))
    part.replace(path)
    return found


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """The tests of a file go to one worker, but those of notebooks and pages one by one: each runs alone."""
    from xdist.scheduler import LoadFileScheduling

    class ByFile(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            alone = "notebooks/" in nodeid or "docs/test_page_examples" in nodeid
            return nodeid if alone else super()._split_scope(nodeid)

    return ByFile(config, log) if config.getoption("dist") == "loadfile" else None
