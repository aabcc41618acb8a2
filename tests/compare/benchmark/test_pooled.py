"""The gate before every statistic: what differs in more than its seed is refused and named."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import pytest
from graded_runs import graded

from compare.benchmark.known_times import SWARMS, table_of_known_times
from compare.benchmark.protocol import Coordinates, Track
from compare.benchmark.records.database.schema import RUN_COLUMNS
from compare.benchmark.records.pooled import pooled
from compare.benchmark.records.rows import Row
from compare.benchmark.summaries import summaries
from formulations import InputError, load

PLANTED: dict[str, tuple[dict[str, Any], str]] = {
    "budget": ({"budget": 60}, "two budgets cannot be pooled: 30 and 60"),
    "population": ({"population": 50}, "two populations cannot be pooled: 20 and 50"),
    "code": ({"code": "0" * 12}, "two versions of the swarm's code cannot be pooled: .* and 0{12}"),
    "versions": ({"versions": "numpy=1"}, "two versions of the programs cannot be pooled: .* and numpy=1"),
    "library": ({"library": "cmaes=0"}, "of the swarm's library cannot be pooled: none and cmaes=0"),
    "parameters": ({"parameters": "{}"}, "two sets of parameters cannot be pooled: .* and \\{\\}"),
    "problem": ({"problem": "0" * 12}, "two problems cannot be pooled: .* and 0{12}"),
    "time limit": ({"time_limit": 5.0}, "two time limits cannot be pooled: none and 5.0"),
    "machine": ({"machine": "a cluster"}, "two machines cannot be pooled: .* and a cluster"),
    "seed": ({"seed": 0}, "two rows of seed 0 cannot be pooled"),
}  # fmt: skip


@cache
def honest() -> list[Row]:
    problem = load("sr4c")
    return [graded(problem, 4.7, "stretched", "random", seed, 30).row for seed in range(3)]


def _known(rows: list[Row]) -> Any:
    return table_of_known_times(load("sr4c"), {"ladder": {}}, rows)  # type: ignore[typeddict-item]


GATED: dict[str, Callable[[list[Row]], Any]] = {
    "pooled": pooled,
    "summaries": summaries,
    "known times": _known,
}


@pytest.mark.parametrize("gate", GATED)
@pytest.mark.parametrize("plant", PLANTED)
def test_a_planted_row_is_refused_by_every_statistic(gate: str, plant: str) -> None:
    columns, words = PLANTED[plant]
    rows = honest()
    if gate == "known times":  # of the swarm of the case's paper
        rows = [replace(row, swarm=SWARMS["sr4c"]) for row in rows]
    planted = replace(rows[2], **columns)
    GATED[gate](rows)
    with pytest.raises(InputError, match=rf"^sr4c, stretched, equal, printed, \w+: .*{words}$"):
        GATED[gate]([*rows[:2], planted])


def test_honest_rows_pass_in_their_order() -> None:
    assert pooled(honest()) == honest()
    assert pooled([]) == []


@pytest.mark.parametrize(
    "other",
    [{"case": "ur5"}, {"coding": "shared"}, {"swarm": "pso"}, {"track": Track.tuned},
     {"coordinates": Coordinates.offset}],
)  # fmt: skip
def test_cells_may_differ_from_each_other(other: dict[str, Any]) -> None:
    rows = [*honest(), *(replace(row, budget=60, **other) for row in honest())]
    assert pooled(rows) == rows
    assert len(summaries(rows)) == 2


def test_what_is_measured_may_differ() -> None:
    measured = [name for name in RUN_COLUMNS if name not in ("status", "proof")]
    first, second, _ = honest()
    changed = replace(second, **{name: getattr(honest()[2], name) for name in measured})
    assert pooled([first, changed]) == [first, changed]


def test_machines_are_allowed_by_name_and_nothing_else_is() -> None:
    rows = [honest()[0], replace(honest()[1], machine="a cluster")]
    assert pooled(rows, allow=("machine",)) == rows
    assert summaries(rows, allow=("machine",))["sr4c", "stretched", "random"].seeds == 2
    with pytest.raises(InputError, match="allow: budget: only machine can be allowed"):
        pooled(rows, allow=("machine", "budget"))
