"""What each search is blind to: batches, transforms of the objective, the place of zero; does it search?"""

from __future__ import annotations

import numpy as np
import pytest
from loops import HI, LO, NAMES, Recorder, bowl, holed, recorded, run_entry

from compare.benchmark.objective import Objective, search_box
from formulations import load
from metaheuristics import ALGORITHMS, minimise
from metaheuristics.swarms.random_search import random_search

pytestmark = pytest.mark.filterwarnings("error")


def test_random_points_do_not_depend_on_the_batch() -> None:
    one = recorded(random_search, budget=120, seed=3, population=7)
    other = recorded(random_search, budget=120, seed=3, population=50)
    assert np.array_equal(one.points, other.points)


@pytest.mark.parametrize("name", ["random", "pso", "pso-linear", "pso-1995", "mipso-pso3", "whale"])
def test_a_search_by_comparison_ignores_a_monotone_transform(name: str) -> None:
    plain, cubed = Recorder(holed), Recorder(lambda x: 8 * holed(x) ** 3)
    run_entry(name, plain)
    run_entry(name, cubed)
    assert np.array_equal(plain.points, cubed.points)


def test_mipso_ignores_an_affine_transform_alone() -> None:
    plain, affine, cubed = (
        Recorder(f) for f in (holed, lambda x: 8 * holed(x), lambda x: 8 * holed(x) ** 3)
    )
    for f in (plain, affine, cubed):
        run_entry("mipso", f)
    assert np.array_equal(plain.points, affine.points)
    assert not np.array_equal(plain.points, cubed.points)


def drift(name: str, shift: float, budget: int) -> float:
    """Return how far a run moves, as a share of the box, when box and f are translated."""
    algorithm = ALGORITHMS[name]
    at_home, away = Recorder(bowl), Recorder(lambda x: bowl(x - shift))
    for f, by in ((at_home, 0.0), (away, shift)):
        minimise(algorithm.function, f, LO + by, HI + by, budget=budget, seed=2, **algorithm.parameters)
    return float(np.abs((away.points - shift - at_home.points) / (HI - LO)).max())


@pytest.mark.parametrize("name", ["random", "pso", "pso-linear", "pso-1995", "mipso", "mipso-printed"])
def test_swarms_do_not_know_where_zero_is(name: str) -> None:
    assert drift(name, 64.0, 500) < 1e-9


def test_whales_know_where_zero_is() -> None:
    assert drift("whale", 64.0, 500) > 0.1


KNOWS_WHERE_ZERO_IS = {
    "sparrow", "sparrow-printed", "butterfly", "issa", "issa-blended",
    "whale", "whale-lu-2024", "whale-lu-2024-printed",
}  # fmt: skip


OWN = [name for name, a in ALGORITHMS.items() if not a.libraries]


@pytest.mark.parametrize("name", OWN)
def test_particle_swarms_do_not_know_where_zero_is_and_the_animals_do(name: str) -> None:
    if name in KNOWS_WHERE_ZERO_IS:
        assert drift(name, 64.0, 400) > 0.1
    else:
        assert drift(name, 64.0, 400) < 1e-7


SEARCH_NO_BETTER = {"random", "sobol", "butterfly", "whale-lu-2024", "whale-lu-2024-printed"}


@pytest.mark.parametrize("name", [name for name in NAMES if name != "random"])
def test_every_search_but_the_named_beats_random_search_on_a_shifted_sphere(name: str) -> None:
    """The named are drawn to x = 0, or do not search at all."""
    centre = np.array([1.1, -1.8, 1.6, -0.4, 2.1])

    def median(name: str) -> float:
        algorithm = ALGORITHMS[name]
        found = [
            minimise(
                algorithm.function,
                lambda x: ((x - centre) ** 2).sum(1),
                np.full(5, -5.0),
                np.full(5, 5.0),
                budget=2000,
                seed=seed,
                **algorithm.parameters,
            ).fitness
            for seed in range(5)
        ]
        return float(np.median(found))

    better = median(name) < 0.2 * median("random")
    assert better == (name not in SEARCH_NO_BETTER)


@pytest.mark.parametrize("name", list(ALGORITHMS))
def test_every_algorithm_reaches_the_optimum_of_sr4c_or_says_why_not(name: str) -> None:
    """Within 20,000 evaluations. What falls short misses in five of 30 seeds or more; three show it."""
    objective = Objective(load("sr4c"), stretch=True)
    algorithm = ALGORITHMS[name]
    lo, hi = search_box(objective.problem)

    def reached(seed: int, budget: int) -> bool:
        result = minimise(
            algorithm.function, objective, lo, hi, budget=budget, seed=seed, **algorithm.parameters
        )
        return result.fitness < 4.700657 * (1 + 1e-3)

    if algorithm.shortfall:
        assert not all(reached(seed, 20_000) for seed in (17, 18, 19))
    else:  # what a smaller budget does, the larger one need not show
        seeds = range(1 if algorithm.libraries else 3)
        assert all(reached(seed, 2_000) or reached(seed, 20_000) for seed in seeds)
