"""The rows of the relaxation under demands hold for every motion that keeps the demands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from demanded_motions import ENDS, Scenario
from handmade_certificates import certificate, with_multiplier
from meeting_zones import drawn
from relaxation_oracle import KINDS, Oracle

from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.relaxation import Relaxation

ROWS = 500


def some(rng: np.random.Generator, made: Scenario) -> frozenset[int]:
    """Now and then a waypoint to leave out."""
    inner = range(1, len(made.arrivals) - 1)
    return frozenset(i for i in inner if rng.random() < 0.15)


def excesses(
    ends: str, seeds: range, spoil: Callable[[Oracle], None] | None = None, **options: str
) -> dict[str, float]:
    """The greatest relative violation of each kind of row, over random motions and places.

    Unless the rows are spoilt, each is asserted to hold.
    """
    worst: dict[str, float] = {}
    for seed in seeds:
        rng = np.random.default_rng(seed)
        made = drawn(rng, ends)
        horizon = made.arrivals[-1] * float(rng.choice([1.0 + 1e-9, 1.5]))
        oracle = Oracle(made.demands, horizon, without=some(rng, made), **options)
        values = oracle.values(made)
        if spoil is not None:
            spoil(oracle)
        for key, value in values.items():
            lo, hi = oracle.box[key]
            room = 1e-8 * (1.0 + abs(value))
            assert lo - room <= value <= hi + room, (seed, key, lo, value, hi)
        for _ in range(ROWS):
            raw = oracle.random_row(rng)
            if raw is not None:
                excess = oracle.excess(raw, values)
                worst[raw[0]] = max(worst.get(raw[0], -np.inf), excess)
                if not options and spoil is None:
                    assert excess < 1e-7, (seed, raw, excess)
    return worst


@pytest.mark.parametrize("ends", ENDS)
def test_every_row_holds_for_every_motion_that_keeps_the_demands(ends: str) -> None:
    worst = excesses(ends, range(25))
    assert set(worst) >= set(KINDS) - {"v", "V"}


@pytest.mark.parametrize("wrong", ["free", "short"])
def test_a_peak_row_where_the_acceleration_need_not_fade_is_violated(wrong: str) -> None:
    worst = excesses("free", range(40), wrong_peaks=wrong)
    assert worst["v"] > 1e-3
    assert worst["V"] > 1e-3


def tightest_limits(oracle: Oracle) -> None:
    """Between waypoints that are kept, take the tightest limits of all segments in place of the loosest."""
    for p, i in oracle.after.items():
        for name, limits in (("velocity", oracle.V), ("acceleration", oracle.A)):
            part = oracle.demands[name][oracle.start[p] : i]
            tight = np.stack([part[..., 0].max(axis=0), part[..., 1].min(axis=0)], axis=1)
            limits[p] = np.where(np.isfinite(tight), tight, limits[p])


def sides_swapped(oracle: Oracle) -> None:
    """Take the accelerations of the other direction."""
    for p in oracle.A:
        oracle.A[p] = -oracle.A[p][:, ::-1]


def zones_shut(oracle: Oracle) -> None:
    """Measure distances and rooms from one end of each zone."""
    oracle.c = oracle.c + oracle.w


def no_waits(oracle: Oracle) -> None:
    """Forget the waits before an arrival."""
    oracle.waits = dict.fromkeys(oracle.waits, 0.0)


@pytest.mark.parametrize(
    ("spoil", "kinds"),
    [
        (tightest_limits, "dkaDK"),
        (sides_swapped, "dkarDKR"),
        (zones_shut, "dkrDKR"),
        (no_waits, "b"),
    ],
)
def test_wrong_rows_are_noticed(spoil: Callable[[Oracle], None], kinds: str) -> None:
    worst = excesses("given", range(40), spoil)
    assert all(worst[kind] > 1e-4 for kind in kinds), worst


@pytest.mark.parametrize("ends", ENDS)
def test_the_checker_builds_the_same_boxes_and_rows(ends: str) -> None:
    kinds: set[str] = set()
    for seed in range(12):
        rng = np.random.default_rng(100 + seed)
        made = drawn(rng, ends)
        horizon = made.arrivals[-1] * float(rng.choice([1.0 + 1e-9, 1.5]))
        without = some(rng, made)
        oracle = Oracle(made.demands, horizon, without=without)
        checker = Relaxation(Claim(certificate(made.demands, 1e-9, horizon, [], without)))
        assert checker.kept == oracle.kept
        assert {checker.span(*p) for p in oracle.after if p not in oracle.ks} == set(checker.spans)
        assert not checker.void
        for key, box in oracle.box.items():
            if key[0] not in "ep" or box[1] > box[0]:
                found = [float(x) for x in checker.box(key)]
                assert found == pytest.approx(list(box), rel=1e-9, abs=1e-12), (seed, key)
        assert checker.spans or len(oracle.ks) < 3 or checker.waits
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
    assert kinds >= set(KINDS) - {"v", "V"}


@pytest.mark.parametrize("ends", ENDS)
def test_narrower_accelerations_hold_every_motion(ends: str) -> None:
    """Two segments of given times bound the acceleration between them, zones and jerk limits as they are."""
    narrowed = 0
    for seed in range(15):
        rng = np.random.default_rng(200 + seed)
        made = drawn(rng, ends, times="all")
        horizon = made.arrivals[-1] * 1.01
        oracle = Oracle(made.demands, horizon)
        checker = Relaxation(Claim(certificate(made.demands, 1e-9, horizon, [["P"], ["F", []]])))
        first, values = checker.boxes, oracle.values(made)
        checker.replay()
        for key, (lo, hi) in checker.boxes.items():
            room = 1e-7 * (1.0 + abs(values[key]))
            assert float(lo) - room <= values[key] <= float(hi) + room, (seed, key)
            narrowed += float(hi - lo) < 0.9 * float(first[key][1] - first[key][0])
    assert narrowed > 5


class Forgetful(dict[int, Any]):
    """Remembers nothing."""

    def get(self, key: int, default: Any = None) -> Any:
        return default


@pytest.mark.parametrize("ends", ["rest", "cyclic"])
def test_accelerations_are_narrowed_again_only_where_that_narrows_more(ends: str) -> None:
    for seed in range(6):
        rng = np.random.default_rng(300 + seed)
        made = drawn(rng, ends, n=5, times="none")
        made.demands["passages"][1:] = made.arrivals[1:, None] * [1.0 - 1e-9, 1.0 + 1e-9]
        events: list[Any] = [["P"]]
        for k in rng.permutation(5).tolist():
            for side, kinds in enumerate(("bl", "lb")):  # arrivals at both ends of a segment
                rows = [[kinds[0], k + 1, (1.0).hex()], [kinds[1], k, (1.0).hex()]]
                events.append(["N", "T", k, side, rows if k else rows[:1]])
            events.append(["P"])
        data = certificate(made.demands, 1e-9, made.arrivals[-1] * 1.01, [*events, ["F", []]])
        checker, again = Relaxation(Claim(data)), Relaxation(Claim(data))
        again._seen = Forgetful()
        checker.replay()
        again.replay()
        for key, box in again.boxes.items():
            assert all(x == y for x, y in zip(checker.boxes[key], box, strict=True)), key
