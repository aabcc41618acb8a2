"""The registry: the papers' constants, and any algorithm by its name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from loops import HI, LO, Array, Recorder, bowl

from metaheuristics import (
    ALGORITHMS,
    NOT_REPRODUCIBLE,
    MissingLibraryError,
    Result,
    Status,
    UnknownAlgorithmError,
    algorithm,
    minimise,
)
from metaheuristics.driver.task import Search
from metaheuristics.libraries.shared import INFEASIBLE, finite, library
from metaheuristics.swarms.mipso import mipso

pytestmark = pytest.mark.filterwarnings("error")


def run(search: Search, f: Callable[[Array], Array] = bowl, *, budget: int = 20) -> Result:
    return minimise(search, f, LO, HI, budget=budget, seed=1)


def test_the_registry_holds_the_papers_constants() -> None:
    assert ALGORITHMS["mipso"].parameters == {
        "population": 50,
        "tent": True,
        "dynamic": True,
        "mutation": True,
        "lam": 0.499,
        "w_max": 0.9,
        "w_min": 0.4,
        "pm1": 0.1,
        "pm2": 0.2,
    }
    for name, switch in [
        ("mipso-pso1", "tent"),
        ("mipso-pso2", "dynamic"),
        ("mipso-pso3", "mutation"),
    ]:
        ablation = ALGORITHMS[name]
        assert ablation.function is mipso
        assert ablation.parameters == ALGORITHMS["mipso"].parameters | {switch: False}
    assert ALGORITHMS["pso"].parameters == {
        "population": 50,
        "w": 0.7298,
        "c1": 1.49618,
        "c2": 1.49618,
    }
    assert ALGORITHMS["pso-1995"].parameters == {"population": 50, "c1": 2.0, "c2": 2.0}
    assert all(key == algorithm.name for key, algorithm in ALGORITHMS.items())


def test_a_renamed_algorithm_keeps_the_random_numbers_of_its_old_name() -> None:
    renamed = {name: entry.seeded_as for name, entry in ALGORITHMS.items() if entry.seeded_as}
    assert renamed == {
        "pso-zhang-2025": "pso-004",
        "pso-zhang-2025-printed": "pso-004-printed",
        "whale-lu-2024": "whale-003",
        "whale-lu-2024-printed": "whale-003-printed",
    }
    assert not set(renamed.values()) & set(ALGORITHMS)


def test_what_cannot_be_reproduced_is_named_with_its_reason() -> None:
    assert "no equation" in NOT_REPRODUCIBLE["ipso"].reason
    assert not set(NOT_REPRODUCIBLE) & set(ALGORITHMS)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("psoo", ("psoo", "pso-linear", "module:function")),
        ("ipso", ("not reproducible", "no equation")),
        ("nowhere:swarm", ("nowhere:swarm", "ModuleNotFoundError")),
        ("hostile:nothing", ("hostile:nothing", "AttributeError")),
        ("hostile:not_callable", ("hostile:not_callable", "int")),
        ("mealpy:NoSuchSwarm", ("mealpy:NoSuchSwarm",)),
        ("pymoo:NoSuchSwarm", ("pymoo:NoSuchSwarm",)),
        ("nevergrad:NoSuchSwarm", ("nevergrad:NoSuchSwarm",)),
        ("minion:MinionResult", ("minion:MinionResult", "no minimiser")),
    ],
)
def test_an_unknown_name_is_refused_in_words(name: str, words: tuple[str, ...]) -> None:
    if name.startswith("mealpy"):
        pytest.importorskip("mealpy")
    with pytest.raises(UnknownAlgorithmError) as caught:
        algorithm(name)
    for word in words:
        assert word in str(caught.value)


def test_a_plug_in_is_found_by_name() -> None:
    entry = algorithm("hostile:honest")
    assert run(entry.function).status is Status.ok
    assert entry.group == "rivals"


def test_a_missing_library_says_how_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "nevergrad", None)
    with pytest.raises(MissingLibraryError, match=r"pip install 'timebound\[rivals\]'"):
        library("nevergrad")


def test_a_library_is_never_sent_infinity() -> None:
    assert finite(np.array([1.0, np.inf])).tolist() == [1.0, INFEASIBLE]


RIVALS = ["mealpy:OriginalPSO", "pymoo:PSO", "pymoo:NelderMead", "nevergrad:OnePlusOne", "minion:ARRDE"]


@pytest.mark.parametrize("name", RIVALS)
@pytest.mark.filterwarnings("default")  # theirs are not ours
def test_a_rival_library_runs_under_the_driver_and_repeats_itself(name: str) -> None:
    pytest.importorskip({"minion": "minionpy"}.get(name.split(":")[0], name.split(":")[0]))
    entry = algorithm(name)

    def one(seed: int) -> tuple[Result, Recorder]:
        f = Recorder(lambda x: np.where(x[:, 0] > 2.0, np.inf, bowl(x)))
        return minimise(entry.function, f, LO, HI, budget=150, seed=seed, **entry.parameters), f

    (first, f), (again, g), (other, h) = one(1), one(1), one(2)
    assert first.status in (Status.ok, Status.global_random)
    assert first.evaluations == len(f.values) == 150
    assert np.array_equal(f.points, g.points)
    assert not np.array_equal(f.points[:50], h.points[:50])
    assert first.fitness == again.fitness == min(f.values)
    assert other.fitness < 1.0
    assert f"{entry.libraries[0]}=" in entry.versions
    assert entry.versions[-1].isdigit()
