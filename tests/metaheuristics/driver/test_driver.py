"""The driver, and every algorithm against a loop-written oracle, a law, or a closed form.

Shapes: n points, dim coordinates; oracles draw the same random numbers in the same order.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from math import cos, e, exp, inf, nan, pi, sin
from time import sleep
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from loops import (
    HI,
    LO,
    Array,
    LoopSwarm,
    Recorder,
    assert_same_batches,
    bowl,
    clipped,
    holed,
    loop_probability,
    recorded,
    task_on,
    value,
)

from metaheuristics import ALGORITHMS, ObjectiveError, Result, Status, Task, TaskError, minimise
from metaheuristics.driver.task import Moves
from metaheuristics.swarms.mipso import (
    MEAN_DECAY,
    learning_factors,
    mipso,
    mutate,
    mutation_probability,
    printed_inertia,
    resolved_inertia,
)
from metaheuristics.swarms.particles import linear_inertia
from metaheuristics.swarms.pso import pso, pso_1995, pso_linear
from metaheuristics.swarms.random_search import random_search
from metaheuristics.swarms.tent import tent_map, tent_population
from metaheuristics.swarms.whale import whale

pytestmark = pytest.mark.filterwarnings("error")

NAMES = list(ALGORITHMS)


def run(
    name: str,
    f: Callable[[Array], Array] = bowl,
    *,
    budget: int = 700,
    seed: int | np.random.SeedSequence = 1,
    **changed: Any,
) -> Result:
    """Run a registered algorithm on the 3-D box."""
    algorithm = ALGORITHMS[name]
    return minimise(
        algorithm.function, f, LO, HI, budget=budget, seed=seed, **(algorithm.parameters | changed)
    )


def same(a: Result, b: Result) -> bool:
    """Tell whether two results agree to the bit, times apart."""
    return (
        np.array_equal(np.asarray(a.x), np.asarray(b.x))
        and a.fitness == b.fitness
        and a.evaluations == b.evaluations
        and np.array_equal(a.trace_evaluations, b.trace_evaluations)
        and np.array_equal(a.trace_best, b.trace_best)
        and (a.status, a.note) == (b.status, b.note)
    )


# --------------------------------------------------------------- every algorithm, the driver's laws


@pytest.mark.parametrize("budget", [1, 7, 49, 50, 51, 100, 333])
@pytest.mark.parametrize("name", NAMES)
def test_the_budget_is_met_to_the_evaluation(name: str, budget: int) -> None:
    f = Recorder(bowl)
    result = run(name, f, budget=budget)
    assert result.status is Status.ok
    assert result.evaluations == budget == len(f.values)
    assert result.trace_evaluations[-1] == budget


@pytest.mark.parametrize("name", NAMES)
@given(budget=st.integers(1, 150), population=st.integers(1, 40), seed=st.integers(0, 2**32))
@settings(max_examples=10, deadline=None)
def test_the_answer_is_the_first_best_of_all_evaluated_points_of_the_box(
    name: str, budget: int, population: int, seed: int
) -> None:
    f = Recorder(holed)
    changed = {"population": population} if "population" in ALGORITHMS[name].parameters else {}
    result = run(name, f, budget=budget, seed=seed, **changed)
    assert len(f.values) == budget
    assert np.all((f.points >= LO) & (f.points <= HI))
    assert result.fitness == min(f.values)
    if result.fitness < inf:
        assert result.status is Status.ok
        assert result.x is not None
        assert np.array_equal(result.x, f.points[np.argmin(f.values)])
    else:
        assert result.status is Status.no_feasible_point
        assert result.x is None


@pytest.mark.parametrize("name", NAMES)
def test_same_seed_same_result_and_another_seed_another(name: str) -> None:
    assert same(run(name, seed=5), run(name, seed=5))
    assert same(run(name, seed=5), run(name, seed=np.random.SeedSequence(5)))
    assert not same(run(name, seed=5), run(name, seed=6))


def test_a_seed_sequence_that_has_spawned_is_the_same_seed() -> None:
    def spawner(task: Task) -> Moves:
        while True:
            child = task.rng.spawn(1)[0]
            yield task.lo + (task.hi - task.lo) * child.random((4, task.dim))

    seed = np.random.SeedSequence(3, spawn_key=(2,))
    first = minimise(spawner, bowl, LO, HI, budget=20, seed=seed)
    seed.spawn(5)
    assert same(first, minimise(spawner, bowl, LO, HI, budget=20, seed=seed))


@pytest.mark.parametrize("name", NAMES)
def test_nothing_feasible_is_a_status_without_a_warning(name: str) -> None:
    result = run(name, lambda x: np.full(len(x), inf))
    assert result.status is Status.no_feasible_point
    assert result.x is None
    assert result.fitness == inf
    assert result.evaluations == 700
    assert result.trace_evaluations.tolist() == [700]
    assert result.trace_best.tolist() == [inf]


@pytest.mark.parametrize("name", NAMES)
def test_an_infeasible_half_does_not_hide_the_optimum(name: str) -> None:
    result = run(name, holed, budget=3000)
    assert result.status is Status.ok
    assert result.fitness < 0.05


@pytest.mark.parametrize("name", NAMES)
def test_nan_counts_as_infeasible(name: str) -> None:
    assert same(run(name, holed), run(name, lambda x: np.where(x[:, 0] > 1.0, nan, bowl(x))))


@pytest.mark.parametrize("name", NAMES)
def test_an_objective_that_spoils_its_argument_or_reuses_its_buffer_changes_nothing(
    name: str,
) -> None:
    buffer = np.empty(1000)

    def rude(x: Array) -> Array:
        values = buffer[: len(x)]
        values[:] = bowl(x)
        x[:] = nan
        return values

    assert same(run(name), run(name, rude))


@pytest.mark.parametrize("name", NAMES)
def test_boxes_one_rounding_wide_are_never_left(name: str) -> None:
    lo = np.array([-0.1, 1.0, 1e-300, -3.3])
    hi = np.array([0.7, np.nextafter(1.0, 2.0), 2e-300, np.nextafter(-3.3, 0.0)])
    algorithm = ALGORITHMS[name]
    result = minimise(
        algorithm.function,
        lambda x: -x.sum(1),
        lo,
        hi,
        budget=500,
        seed=0,
        **algorithm.parameters,
    )
    assert (result.status, result.note) == (Status.ok, "")


class LargestDraw:
    """A generator stuck at the largest number `random` can give."""

    def random(self, size: tuple[int, ...]) -> Array:
        """Return 1 - 2^-53 everywhere."""
        return np.full(size, np.nextafter(1.0, 0.0))


@given(lo=st.floats(-1e300, 1e300), width=st.floats(1e-300, 1e300))
def test_the_largest_draw_does_not_round_past_the_box(lo: float, width: float) -> None:
    hi = lo + width
    assume(lo < hi)
    rng: Any = LargestDraw()
    task = Task(np.array([lo]), np.array([hi]), rng, 1, lambda: 0)
    assert lo <= task.sample(1)[0, 0] <= hi


# -------------------------------------------------------------------------------------- the archive


def script(sizes: list[int]) -> Callable[[Task], Moves]:
    """Yield random batches of the given sizes, then return."""

    def algorithm(task: Task) -> Moves:
        for n in sizes:
            yield task.sample(n)

    return algorithm


@given(
    sizes=st.lists(st.integers(1, 6), min_size=1, max_size=8),
    values=st.lists(st.sampled_from([inf, 3.0, 2.0, 1.0, 0.0, -1.0]), min_size=48, max_size=48),
    budget=st.integers(1, 48),
)
def test_the_trace_has_each_improvement_at_its_evaluation(
    sizes: list[int], values: list[float], budget: int
) -> None:
    stream = iter(values)
    f = Recorder(lambda x: np.array([next(stream) for _ in x]))
    result = minimise(script(sizes), f, LO, HI, budget=budget, seed=0)

    used = min(budget, sum(sizes))
    trace, best, best_x = [], inf, None
    for i in range(used):
        if values[i] < best:
            best, best_x = values[i], f.points[i]
            trace.append((i + 1, best))
    if not trace or trace[-1][0] != used:
        trace.append((used, best))
    assert len(f.values) == result.evaluations == used
    assert list(zip(result.trace_evaluations, result.trace_best, strict=True)) == trace
    assert result.fitness == best
    assert np.array_equal(np.asarray(result.x), np.asarray(best_x))
    if sum(sizes) < budget:
        assert result.status is Status.stopped_early
    else:
        assert result.status is (Status.ok if best < inf else Status.no_feasible_point)


def test_progress_is_the_share_of_evaluations_used() -> None:
    seen = []

    def algorithm(task: Task) -> Moves:
        for n in (3, 5, 8):
            seen.append(task.progress)
            yield task.sample(n)

    minimise(algorithm, bowl, LO, HI, budget=16, seed=0)
    assert seen == [0.0, 3 / 16, 8 / 16]


def test_time_is_booked_to_whoever_spent_it() -> None:
    def slow(task: Task) -> Moves:
        while True:
            sleep(0.05)
            yield task.sample(1)

    def slow_bowl(x: Array) -> Array:
        sleep(0.05)
        return bowl(x)

    one = minimise(slow, bowl, LO, HI, budget=2, seed=0)
    other = minimise(script([1, 1]), slow_bowl, LO, HI, budget=2, seed=0)
    assert one.seconds_algorithm >= 0.1 > 0.05 > one.seconds_objective
    assert other.seconds_objective >= 0.1 > 0.05 > other.seconds_algorithm


# ------------------------------------------------------------------------------- hostile algorithms


def after_one_good_batch(then: Callable[[Task], Any]) -> Callable[[Task], Iterator[Any]]:
    """Yield four good points, then whatever ``then`` gives."""

    def algorithm(task: Task) -> Iterator[Any]:
        yield task.sample(4)
        while True:
            yield then(task)

    return algorithm


def with_entry(value: float) -> Callable[[Task], Array]:
    """Make a good batch of five with one bad entry in its last row."""

    def batch(task: Task) -> Array:
        x = task.sample(5)
        x[4, 1] = value
        return x

    return batch


def stop(message: str) -> Any:
    """Raise, where only an expression fits."""
    raise RuntimeError(message)


MISDEEDS: dict[str, tuple[Status, str, Callable[[Task], Any]]] = {
    "one point": (Status.wrong_shape, "(3,)", lambda t: t.sample(1)[0]),
    "transposed": (Status.wrong_shape, "(3, 5)", lambda t: t.sample(5).T[:, :5]),
    "no rows": (Status.wrong_shape, "(0, 3)", lambda t: t.sample(0)),
    "nothing": (Status.wrong_shape, "()", lambda t: None),
    "words": (Status.wrong_shape, "ValueError", lambda t: [["a", "b", "c"]]),
    "ragged": (Status.wrong_shape, "ValueError", lambda t: [[1.0, 2.0, 3.0], [1.0]]),
    "a hair over": (Status.out_of_box, "x[4, 1]", with_entry(np.nextafter(2.5, 3.0))),
    "a hair under": (Status.out_of_box, "x[4, 1]", with_entry(np.nextafter(2.0, 1.0))),
    "nan": (Status.not_finite, "x[4, 1] = nan", with_entry(nan)),
    "infinite": (Status.not_finite, "x[4, 1] = -inf", with_entry(-inf)),
    "raises": (Status.raised, "RuntimeError: two lines", lambda t: stop("two\n lines")),
    "writes to the box": (Status.raised, "read-only", lambda t: t.lo.__setitem__(0, -9.0)),
}


@pytest.mark.parametrize("misdeed", MISDEEDS)
def test_a_misdeed_has_its_status_and_keeps_what_was_found(misdeed: str) -> None:
    status, note, then = MISDEEDS[misdeed]
    f = Recorder(bowl)
    result = minimise(after_one_good_batch(then), f, LO, HI, budget=100, seed=0)  # type: ignore[arg-type]
    assert result.status is status
    assert note in result.note
    assert "\n" not in result.note
    assert result.evaluations == len(f.values) == 4
    assert result.fitness == min(f.values)
    assert result.trace_evaluations[-1] == 4


def test_returning_early_is_a_status() -> None:
    result = minimise(script([4]), bowl, LO, HI, budget=5, seed=0)
    assert result.status is Status.stopped_early
    assert result.evaluations == 4
    at_once = minimise(script([]), bowl, LO, HI, budget=5, seed=0)
    assert (at_once.status, at_once.evaluations, at_once.x) == (Status.stopped_early, 0, None)
    assert at_once.trace_evaluations.tolist() == [0]


def test_a_population_overwritten_after_its_evaluation_does_not_reach_the_answer() -> None:
    def overwriter(task: Task) -> Moves:
        x = task.sample(4)
        for _ in range(3):
            yield x
            x[:] = task.hi

    f = Recorder(bowl)
    result = minimise(overwriter, f, LO, HI, budget=12, seed=0)
    assert result.status is Status.ok
    assert np.array_equal(np.asarray(result.x), f.points[np.argmin(f.values)])
    assert bowl(f.points).tolist() == f.values


def test_an_algorithm_that_asks_for_more_than_the_budget_gets_none_of_it() -> None:
    def clinging(task: Task) -> Moves:
        for _ in range(5):
            try:
                while True:
                    yield task.sample(2)
            except Exception:
                pass

    for budget in (4, 5):
        f = Recorder(bowl)
        result = minimise(clinging, f, LO, HI, budget=budget, seed=0)
        assert result.status is Status.over_budget
        assert f"more than {budget}" in result.note
        assert result.evaluations == len(f.values) == budget


def test_an_error_of_the_objective_passes_through() -> None:
    def broken(x: Array) -> Array:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        minimise(pso, broken, LO, HI, budget=100, seed=0)


@pytest.mark.parametrize(
    ("f", "message"),
    [
        (lambda x: x, "shape (50, 3) for 50"),
        (lambda x: bowl(x)[:, None], "shape (50, 1)"),
        (lambda x: 1.0, "shape ()"),
        (lambda x: np.where(np.arange(len(x)) == 7, -inf, nan), "-inf for point 7"),
    ],
)
def test_an_objective_that_returns_no_fitness_is_refused(f: Any, message: str) -> None:
    with pytest.raises(ObjectiveError) as caught:
        minimise(pso, f, LO, HI, budget=100, seed=0)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"lo": [0.0, 2.0]}, "(2,) and (3,)"),
        ({"lo": 0.0, "hi": 1.0}, "() and ()"),
        ({"lo": [], "hi": []}, "(0,)"),
        ({"lo": [-1.0, 2.5, -7.0]}, "coordinate 1"),
        ({"lo": [-1.0, 2.0, nan]}, "coordinate 2"),
        ({"hi": [inf, 2.5, -1.0]}, "coordinate 0"),
        ({"lo": [-1.7e308, 2.0, -7.0], "hi": [1.7e308, 2.5, -1.0]}, "coordinate 0"),
        ({"budget": 0}, "got 0"),
        ({"budget": 1.5}, "got 1.5"),
        ({"seed": None}, "got None"),
        ({"seed": -1}, "got -1"),
    ],
)
def test_what_makes_no_task_is_refused(changed: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"lo": LO, "hi": HI, "budget": 100, "seed": 0}
    with pytest.raises(TaskError) as caught:
        minimise(pso, bowl, **(arguments | changed))
    assert message in str(caught.value)


def test_an_unknown_parameter_is_refused() -> None:
    with pytest.raises(TypeError, match="wings"):
        minimise(pso, bowl, LO, HI, budget=100, seed=0, wings=2)


# ------------------------------------------------- moves, against oracles written as loops (n, dim)


@pytest.mark.parametrize(
    ("search", "factors"),
    [
        (pso, lambda k: (0.7298, 1.49618, 1.49618)),
        (pso_linear, lambda k: (0.9 - 0.5 * k, 2.0, 2.0)),
        (pso_1995, lambda k: (1.0, 2.0, 2.0)),
    ],
)
def test_pso_moves_as_the_loops_say(
    search: Callable[..., Moves], factors: Callable[[float], tuple[float, float, float]]
) -> None:
    n, steps = 9, 12
    rng = np.random.default_rng(4)
    swarm = LoopSwarm(LO + (HI - LO) * rng.random((n, 3)))
    expected = [np.array(swarm.x)]
    for step in range(1, steps):
        swarm.evaluate()
        swarm.move(rng, *factors(step / steps))
        expected.append(np.array(swarm.x))

    actual = recorded(search, budget=n * steps, seed=4, population=n)
    assert_same_batches(actual.batches, expected)
    assert inf in actual.values
    assert np.any((actual.points == LO) | (actual.points == HI)), "no position was ever clipped"


def test_whales_move_as_the_loops_say() -> None:
    n, steps = 11, 10
    rng = np.random.default_rng(8)
    x = LO + (HI - LO) * rng.random((n, 3))
    expected, branches = [x], set()
    best, best_f = x[0], inf
    for step in range(1, steps):
        for row in x:
            if value(row) < best_f:
                best, best_f = row, value(row)
        a = 2 - 2 * step / steps
        r1, r2, p, r3 = rng.random((4, n))
        other = rng.integers(n, size=n)
        new = np.empty_like(x)
        for i in range(n):
            A, C, l = 2 * a * r1[i] - a, 2 * r2[i], -1 + 2 * r3[i]  # noqa: E741
            branch = "spiral" if p[i] >= 0.5 else "encircle" if abs(A) < 1 else "search"
            branches.add(branch)
            for d in range(3):
                if branch == "spiral":
                    moved = abs(best[d] - x[i, d]) * exp(l) * cos(2 * pi * l) + best[d]
                else:
                    leader = best[d] if branch == "encircle" else x[other[i], d]
                    moved = leader - A * abs(C * leader - x[i, d])
                new[i, d] = clipped(moved, LO[d], HI[d])
        x = new
        expected.append(x)

    assert branches == {"spiral", "encircle", "search"}
    assert_same_batches(recorded(whale, budget=n * steps, seed=8, population=n).batches, expected)


@pytest.mark.parametrize("name", ["mipso", "mipso-pso1", "mipso-pso2", "mipso-pso3", "mipso-printed"])
def test_mipso_moves_as_the_loops_say(name: str) -> None:
    n, budget, pm1, pm2 = 9, 300, 0.4, 0.6
    rng = np.random.default_rng(16)
    if name == "mipso-pso1":
        x = LO + (HI - LO) * rng.random((n, 3))
    else:
        z = rng.random(3)
        x = np.empty((n, 3))
        for i, d in itertools.product(range(n), range(3)):
            z[d] = z[d] / 0.499 if z[d] < 0.499 else (1 - z[d]) / (1 - 0.499)
            x[i, d] = LO[d] + z[d] * (HI[d] - LO[d])

    swarm = LoopSwarm(x)
    expected, used, accepted, refused = [np.array(swarm.x)], n, 0, 0
    swarm.evaluate()
    while used < budget:
        k = used / budget
        w, c1 = 0.9 - 0.5 * exp(1 - 1 / k), 2 * cos(pi * k / 2) ** 2
        c2 = 2 * sin(pi * k / 2) ** 2
        if name == "mipso-printed":
            w = 0.9 - 0.5 * exp(1 - k)
        if name == "mipso-pso2":
            w, c1, c2 = 0.9 - 0.5 * MEAN_DECAY, 1.0, 1.0
        swarm.move(rng, w, c1, c2)
        expected.append(np.array(swarm.x))
        swarm.evaluate()
        used += n
        if used >= budget:
            break
        if name == "mipso-pso3":
            continue
        draws = rng.random(n)
        p = loop_probability(swarm.f, pm1, pm2)
        rows = [i for i in range(n) if draws[i] < p[i]]
        if not rows:
            continue
        genes, r = rng.integers(3, size=len(rows)), rng.random(len(rows))
        mutants = []
        for i, d, u in zip(rows, genes, r, strict=True):
            mutant = swarm.x[i][:]
            end = mutant[d] if name == "mipso-printed" else HI[d]
            mutant[d] = LO[d] + (end - LO[d]) * u
            mutants.append(mutant)
        expected.append(np.array(mutants))
        used += len(rows)
        for i, mutant in zip(rows, mutants, strict=True):
            if swarm.f[i] >= value(mutant):
                swarm.x[i], swarm.f[i] = mutant, value(mutant)
                accepted += 1
            else:
                refused += 1
        swarm.remember()
    expected[-1] = expected[-1][: len(expected[-1]) - (used - budget)]

    parameters = ALGORITHMS[name].parameters | {"population": n, "pm1": pm1, "pm2": pm2}
    actual = recorded(ALGORITHMS[name].function, budget=budget, seed=16, **parameters)
    assert_same_batches(actual.batches, expected)
    assert inf in actual.values
    if name != "mipso-pso3":
        assert accepted > 3
        assert refused > 3


# ------------------------------------------------------------------------------ MIPSO, by its parts


def test_the_tent_map_folds_at_its_peak() -> None:
    z = np.array([0.0, 0.25, 0.499, 0.7495, 1.0])
    np.testing.assert_allclose(tent_map(z, 0.499), [0.0, 0.25 / 0.499, 1.0, 0.5, 0.0], atol=1e-15)


def test_a_tent_population_follows_the_map_and_fills_the_box_evenly() -> None:
    x = tent_population(task_on(4, seed=2), 10_000)
    np.testing.assert_array_equal(x[1:], tent_map(x[:-1]))
    for d in range(4):
        counts = np.histogram(x[:, d], bins=10, range=(0, 1))[0]
        assert np.all(np.abs(counts - 1000) < 150)  # 5 standard deviations of uniform draws
    assert np.all(np.abs(np.corrcoef(x.T) - np.eye(4)) < 0.05)


def test_a_tent_orbit_through_its_peak_stays_in_the_box() -> None:
    peak = np.random.default_rng(0).random()  # the first state drawn
    x = tent_population(task_on(1, lo=-3.0, hi=0.1), 2, peak)
    assert x.tolist() == [[0.1], [-3.0]]


def test_the_tent_orbit_lives_on_at_0499_and_dies_at_one_half() -> None:
    alive = tent_population(task_on(5), 10_000, 0.499)
    assert len(np.unique(alive[:, 0])) == 10_000
    assert np.all(alive[-100:].max(0) > 0.5)
    dead = tent_population(task_on(5), 100, 0.5)
    assert np.all(dead[:40].max(1) > 0)
    assert np.all(dead[60:] == 0)


def test_inertia_and_factors_start_and_end_where_the_papers_say() -> None:
    for inertia, start in [
        (linear_inertia, 0.9),
        (resolved_inertia, 0.9),
        (printed_inertia, 0.9 - 0.5 * e),
    ]:
        assert [inertia(0), inertia(1)] == pytest.approx([start, 0.4])
    assert printed_inertia(0) == pytest.approx(-0.459, abs=2e-4)
    assert [*learning_factors(0), *learning_factors(1)] == pytest.approx([2.0, 0.0, 0.0, 2.0])
    assert [*learning_factors(1 / 3)] == pytest.approx([1.5, 0.5])


def test_resolved_inertia_falls_all_the_way_and_less_in_the_first_half() -> None:
    w = np.array([resolved_inertia(k) for k in np.linspace(0, 1, 501)])
    assert np.all(np.diff(w) <= 0)
    assert w[0] - w[250] < 0.6 * (w[250] - w[-1])
    assert np.all(np.diff([printed_inertia(k) for k in np.linspace(0, 1, 501)]) > 0)


def test_the_held_factors_are_the_means_of_their_schedules() -> None:
    k = (np.arange(20_000) + 0.5) / 20_000
    mean_w = np.mean([resolved_inertia(float(v)) for v in k])
    assert mean_w == pytest.approx(0.9 - 0.5 * MEAN_DECAY, abs=1e-8)
    assert np.mean([learning_factors(float(v))[0] for v in k]) == pytest.approx(1.0, abs=1e-8)


@given(
    st.lists(
        st.one_of(st.just(inf), st.integers(-1000, 1000).map(lambda v: v / 8)),
        min_size=1,
        max_size=20,
    )
)
def test_mutation_probability_is_eq_17_over_the_feasible(f: list[float]) -> None:
    p = mutation_probability(np.array(f), 0.1, 0.2)
    finite = [v for v in f if v < inf]
    on_average = {sum(finite) / len(finite)} if finite else set()
    for i, q in enumerate(loop_probability(f, 0.1, 0.2)):
        if f[i] not in on_average or f[i] == min(f):  # where rounding may choose the branch
            assert p[i] == pytest.approx(q, rel=1e-9, abs=1e-12)


def test_mutation_probability_where_eq_17_degenerates() -> None:
    assert mutation_probability(np.array([0.1] * 10)).tolist() == [0.0] + [0.2] * 9
    assert mutation_probability(np.array([inf, inf])).tolist() == [0.2, 0.2]
    assert mutation_probability(np.array([inf, 3.0])).tolist() == [0.2, 0.0]
    big = np.finfo(float).max
    p = mutation_probability(np.array([1.0, big, big, 2.0]))
    assert p.tolist() == pytest.approx([0.0, 0.2, 0.2, 0.0])


def test_a_mutant_has_one_new_gene_anywhere_in_the_domain() -> None:
    task = task_on(4, lo=-2.0, hi=6.0)
    x = task.sample(20_000)
    mutants = mutate(task, x)
    changed = mutants != x
    assert np.all(changed.sum(1) == 1)
    assert np.all(np.abs(changed.sum(0) - 5000) < 300)
    counts = np.histogram(mutants[changed], bins=10, range=(-2, 6))[0]
    assert np.all(np.abs(counts - 2000) < 220)


def test_a_mutant_as_printed_only_shrinks_towards_the_lower_bound() -> None:
    task = task_on(4, lo=-2.0, hi=6.0)
    x = task.sample(20_000)
    mutants = mutate(task, x, printed=True)
    changed = mutants != x
    assert np.all(changed.sum(1) == 1)
    assert np.all(mutants <= x)
    share = ((mutants + 2) / (x + 2))[changed]
    assert share.mean() == pytest.approx(0.5, abs=0.01)


# ----------------------------------------------------------------------------- laws of the searches


def test_random_points_do_not_depend_on_the_batch() -> None:
    one = recorded(random_search, budget=120, seed=3, population=7)
    other = recorded(random_search, budget=120, seed=3, population=50)
    assert np.array_equal(one.points, other.points)


@pytest.mark.parametrize("name", ["random", "pso", "pso-linear", "pso-1995", "mipso-pso3", "whale"])
def test_a_search_by_comparison_ignores_a_monotone_transform(name: str) -> None:
    plain, cubed = Recorder(holed), Recorder(lambda x: 8 * holed(x) ** 3)
    run(name, plain)
    run(name, cubed)
    assert np.array_equal(plain.points, cubed.points)


def test_mipso_ignores_an_affine_transform_alone() -> None:
    plain, affine, cubed = (
        Recorder(f) for f in (holed, lambda x: 8 * holed(x), lambda x: 8 * holed(x) ** 3)
    )
    for f in (plain, affine, cubed):
        run("mipso", f)
    assert np.array_equal(plain.points, affine.points)
    assert not np.array_equal(plain.points, cubed.points)


def drift(name: str, shift: float) -> float:
    """Return how far a run moves, as a share of the box, when box and f are translated."""
    algorithm = ALGORITHMS[name]
    at_home = Recorder(bowl)
    away = Recorder(lambda x: bowl(x - shift))
    for f, by in ((at_home, 0.0), (away, shift)):
        minimise(algorithm.function, f, LO + by, HI + by, budget=500, seed=2, **algorithm.parameters)
    return float(np.abs((away.points - shift - at_home.points) / (HI - LO)).max())


@pytest.mark.parametrize("name", ["random", "pso", "pso-linear", "pso-1995", "mipso", "mipso-printed"])
def test_swarms_do_not_know_where_zero_is(name: str) -> None:
    assert drift(name, 64.0) < 1e-9


def test_whales_know_where_zero_is() -> None:
    assert drift("whale", 64.0) > 0.1


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
