"""The rule of the verdict: equal swarms are equal, worse ones worse, little evidence is undecided."""

from __future__ import annotations

import math

import numpy as np
import pytest
from made_cells import cell, flock

from compare.grading.contest import Contest, DuelOutcome, SwarmVerdict, contest
from compare.statistics.cells import MissingCellError


def test_a_swarm_under_another_name_is_equal_in_20_of_20_repetitions() -> None:
    against = flock(1000)
    found = [contest(flock(seed), against) for seed in range(20)]
    assert [one.verdict for one in found] == [SwarmVerdict.equal] * 20


def test_a_swarm_that_is_behind_is_worse_and_its_rival_better() -> None:
    mine, other = flock(1, ahead=-0.8), flock(2)
    found, back = contest(mine, other), contest(other, mine)
    assert (found.verdict, back.verdict) == (SwarmVerdict.worse, SwarmVerdict.better)
    assert found.counts == (back.counts[1], back.counts[0], back.counts[2])
    assert found.effect.p < 1e-6
    assert found.effect.mean == pytest.approx(1.0 - back.effect.mean)


def test_a_small_advantage_on_all_instances_is_better_though_no_instance_shows_it() -> None:
    found = contest(flock(3, ahead=0.3), flock(4))
    assert found.verdict is SwarmVerdict.better
    assert found.counts[0] <= 3


def test_little_evidence_is_undecided_and_says_what_it_takes() -> None:
    few = contest(flock(5, instances=4, runs=5), flock(6, instances=4, runs=5))
    assert few.verdict is SwarmVerdict.undecided
    short = contest(flock(7, ahead=5.0, runs=3), flock(8, runs=3))
    assert short.counts == (0, 0, 36)  # three seeds show nothing after Holm
    assert not short.needed.possible
    assert short.needed.least_seeds == 7


def test_a_negligible_difference_is_equal_however_significant() -> None:
    found = contest(flock(9, ahead=0.1, runs=200), flock(10, runs=200))
    assert found.effect.p < 0.05
    assert found.verdict is SwarmVerdict.equal


def test_misses_lose_and_all_misses_tie() -> None:
    good, lost = flock(11), {name: cell([math.inf] * 31) for name in flock(11)}
    found = contest(good, lost)
    assert found.counts == (36, 0, 0)
    assert found.verdict is SwarmVerdict.better
    assert math.isinf(found.gaps[1])
    nothing = contest(lost, lost)
    assert nothing.verdict is SwarmVerdict.equal
    assert {duel.outcome for duel in nothing.duels} == {DuelOutcome.tie}


def test_a_missing_instance_or_run_is_named() -> None:
    whole, part = flock(12), flock(13)
    del part["i07"]
    with pytest.raises(MissingCellError, match="the other on i07: 0 of 31 runs"):
        contest(whole, part)
    part = flock(13)
    part["i09"] = cell(part["i09"].losses[:30])
    with pytest.raises(MissingCellError, match="the other on i09: 30 of 31 runs"):
        contest(whole, part)


def test_the_order_of_runs_and_the_unit_of_losses_do_not_matter() -> None:
    mine, other = flock(14, ahead=0.4), flock(15)

    def told(found: Contest) -> tuple[SwarmVerdict, tuple[int, int, int], float]:
        return found.verdict, found.counts, found.effect.p

    mixed = {n: cell(np.random.default_rng(1).permutation(c.losses)) for n, c in mine.items()}
    assert told(contest(mixed, other)) == told(contest(mine, other))
    twice = [{n: cell(2.0 * c.losses - 1.0) for n, c in each.items()} for each in (mine, other)]
    assert told(contest(*twice)) == told(contest(mine, other))
