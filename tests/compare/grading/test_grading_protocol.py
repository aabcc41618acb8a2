"""The runs of a grading: equal budgets, nested seeds, moved coordinates for the graded swarm alone; ranks."""

from __future__ import annotations

import math
from collections import defaultdict

import numpy as np
import pytest
from made_cells import cell, flock
from small_problems import variants

from compare.benchmark.protocol import Coordinates
from compare.grading.cells import Cell
from compare.grading.contest import contest
from compare.grading.protocol import GradingProtocol
from compare.grading.reasons import reasons, telling
from compare.grading.standing import costs


def test_every_swarm_has_the_same_budget_and_the_standing_the_same_seeds() -> None:
    problems = variants(36)
    protocol = GradingProtocol("mpso", "pso")
    runs = protocol.runs(problems)
    assert len({run.key for run in runs}) == len(runs)
    assert {(run.budget, run.coding) for run in runs} == {(2550, "stretched")}
    seeds: dict[tuple[str, str, Coordinates], set[int]] = defaultdict(set)
    for run in runs:
        seeds[run.case, run.swarm, run.coordinates].add(run.seed)
    for case in problems:
        for swarm in protocol.swarms:
            count = 31 if swarm in ("mpso", "pso") else 11
            assert seeds[case, swarm, Coordinates.printed] == set(range(count))
    moved = {key for key in seeds if key[2] is not Coordinates.printed}
    assert {swarm for _, swarm, _ in moved} == {"mpso"}
    assert len(moved) == 2 * 12
    assert {case for case, _, _ in moved} == set(protocol.zero_cases(problems))


def test_two_swarms_alone_count_all_their_seeds() -> None:
    protocol = GradingProtocol("mpso", "pso", (), seeds=20, zero_instances=0)
    assert protocol.even_seeds == 20
    assert len(protocol.runs(variants(3))) == 3 * 2 * 20


def test_the_first_runs_of_a_cell_are_its_first_runs() -> None:
    whole = cell([-3.0, -1.0, math.inf, -2.0])
    part = whole.first(3)
    assert len(part) == 3
    assert part.losses.tolist() == [-3.0, -1.0, math.inf]
    assert part.gap == pytest.approx(0.1)  # the middle one
    assert math.isinf(cell([-3.0, math.inf]).gap)  # half of them are misses


def test_the_cost_of_a_target_charges_failures() -> None:
    class Made:
        budget = 500

    def made(losses: list[float]) -> Cell:
        one = cell(losses)
        return Cell(one.losses, one.gaps, one.hits, one.areas, one.targets, (Made(), Made()))  # type: ignore[arg-type]

    cells = {
        ("a", "x", Coordinates.printed): made([-4.0, -1.0]),  # one reaches 0.1 % after 100 evaluations
        ("a", "y", Coordinates.printed): made([-1.0, -1.0]),
    }
    assert costs(cells, ["x", "y"]).tolist() == [[600.0, math.inf]]


def test_a_feature_that_makes_the_difference_is_named_and_no_other() -> None:
    mine, other = flock(1), flock(2)
    features = {}
    for k, name in enumerate(mine):
        large = k % 2
        mine[name] = cell(mine[name].losses - 2.0 * large)
        features[name] = {"size": float(3 + large + k % 3 * 0.01), "noise": float((k * 7) % 11)}
    found = reasons(contest(mine, other), features)
    assert [reason.feature for reason in telling(found)] == ["size"]
    assert found[0].sentence.startswith("Its advantage is the larger, the larger the size")
    assert sum(sum(counts) for _, *counts in found[0].values) == 36
    assert np.isfinite([reason.p for reason in found]).all()
    assert reasons(contest(flock(1, instances=3), flock(2, instances=3)), features) == []
