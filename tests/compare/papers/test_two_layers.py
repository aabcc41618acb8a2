"""Zhang 2025, sec. 2.3: the second layer begins where the first one ended."""

from __future__ import annotations

import numpy as np
import pytest

from compare.benchmark import grade as grading
from compare.benchmark.grade import durations_of
from compare.benchmark.protocol import Budget
from compare.papers.zhang_2025 import layers
from formulations import load

RUNS = 2


@pytest.fixture(autouse=True)
def _small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layers, "BUDGET", Budget(20, 5))


def first_populations(monkeypatch: pytest.MonkeyPatch, starts, reading: str) -> list[np.ndarray]:
    """What the objective of the whole arm is asked first in each run."""
    seen, minimise = [], grading.minimise

    def watched(search, f, lo, hi, **rest):
        asked = []

        def noting(x):
            asked.append(x.copy())
            return f(x)

        result = minimise(search, noting, lo, hi, **rest)
        seen.append(asked[0])
        return result

    with monkeypatch.context() as patch:
        patch.setattr(grading, "minimise", watched)
        layers.second_layer(load("cobot"), starts, reading)
    return seen


def test_the_whole_arm_starts_from_the_joints_results(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = load("cobot")
    alone = layers.first_layer(problem, RUNS)
    starts = layers.integrated(problem, alone)
    fresh = first_populations(monkeypatch, starts, "afresh")
    for seed, start in enumerate(starts):
        joints = np.array([durations_of(runs[seed].row) for runs in alone])
        np.testing.assert_array_equal(start[0], joints.max(axis=0))  # longest per segment, by hand
        np.testing.assert_array_equal(start[1:-1], joints)
        assert (start[-1] / start[0]).std() < 1e-12
    for reading, given in (("longest", slice(1)), ("all", slice(7)), ("slowed", slice(7, 8))):
        for x, start, plain in zip(
            first_populations(monkeypatch, starts, reading), starts, fresh, strict=True
        ):
            m = len(start[given])
            np.testing.assert_array_equal(x[:m], start[given])
            np.testing.assert_array_equal(x[m:], plain[m:])  # paired: the same random numbers


def test_the_evaluations_of_both_layers_are_counted() -> None:
    problem = load("cobot")
    found = layers.make_layers(problem, layers.first_layer(problem, RUNS))
    counted = {key: reading["evaluations"] for key, reading in found["readings"].items()}
    assert counted.pop("afresh") == 120
    assert set(counted.values()) == {7 * 120}
    assert all(len(reading["by_seed"]) == RUNS for reading in found["readings"].values())
