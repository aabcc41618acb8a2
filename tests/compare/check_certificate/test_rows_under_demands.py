"""The rows of the relaxation under demands hold for every motion that keeps the demands."""

from __future__ import annotations

import numpy as np
import pytest
from demanded_motions import ENDS, scenario
from relaxation_oracle import Oracle, certificate, with_multiplier

from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.relaxation import Relaxation

ROWS = 300


def excesses(ends: str, seeds: range, **options: bool) -> dict[str, float]:
    """The greatest relative violation of each kind of row, over random motions and places."""
    worst: dict[str, float] = {}
    for seed in seeds:
        rng = np.random.default_rng(seed)
        made = scenario(rng, ends, n=int(rng.integers(2, 6)))
        horizon = made.arrivals[-1] * float(rng.choice([1.0 + 1e-9, 1.5]))
        oracle = Oracle(made.demands, horizon, **options)
        if oracle.none:
            continue
        values = oracle.values(made)
        for key, value in values.items():
            lo, hi = oracle.box[key]
            room = 1e-8 * (1.0 + abs(value))
            assert lo - room <= value <= hi + room, (seed, key, lo, value, hi)
        for _ in range(ROWS):
            raw = oracle.random_row(rng)
            if raw is not None:
                excess = oracle.excess(raw, values)
                worst[raw[0]] = max(worst.get(raw[0], -np.inf), excess)
                if not options:
                    assert excess < 1e-8, (seed, raw, excess)
    return worst


@pytest.mark.parametrize("ends", ENDS)
def test_every_row_holds_for_every_motion_that_keeps_the_demands(ends: str) -> None:
    worst = excesses(ends, range(40))
    assert set(worst) >= set("hblstcwmardk")


def test_a_peak_row_beside_a_free_end_is_violated() -> None:
    """The acceleration need not fade inside the motion: that condition of the row is needed."""
    assert excesses("free", range(40), free_peaks=True)["v"] > 1e-3


@pytest.mark.parametrize("ends", ENDS)
def test_the_checker_builds_the_same_boxes_and_rows(ends: str) -> None:
    kinds: set[str] = set()
    for seed in range(12):
        rng = np.random.default_rng(100 + seed)
        made = scenario(rng, ends, n=int(rng.integers(2, 6)))
        horizon = made.arrivals[-1] * float(rng.choice([1.0 + 1e-9, 1.5]))
        oracle = Oracle(made.demands, horizon)
        if oracle.none:
            continue
        checker = Relaxation(Claim(certificate(made.demands, 1e-9, horizon, [])))
        assert checker.kept == oracle.kept
        assert not checker.void
        for key, box in oracle.box.items():
            if key[0] in "TuqWvaep" and (key[0] not in "ep" or box[1] > box[0]):
                if key[0] == "W" and not oracle.jerky[key[2]]:
                    continue
                found = [float(x) for x in checker.box(key)]
                assert found == pytest.approx(list(box), rel=1e-9, abs=1e-12), (seed, key)
        for _ in range(ROWS):
            raw = oracle.random_row(rng)
            if raw is None:
                continue
            kinds.add(raw[0])
            (row, upper), (mine, my_upper) = checker.row(with_multiplier(raw, 1.0)), oracle.row(raw)
            size = max([abs(x) for x in mine.values()], default=0.0) + abs(my_upper) + 1e-12
            assert float(upper) == pytest.approx(my_upper, rel=1e-9, abs=1e-9 * size), (seed, raw)
            for key in set(row) | {key for key, x in mine.items() if x and oracle.box[key] != (0, 0)}:
                assert float(row.get(key, 0.0)) == pytest.approx(
                    mine.get(key, 0.0), rel=1e-9, abs=1e-9 * size
                ), (seed, raw, key)
    assert kinds >= set("hblstcwmardk")
