"""Whales, against loops over whales and coordinates."""

from __future__ import annotations

from math import cos, exp, inf, pi
from typing import Any

import numpy as np
import pytest
from loops import HI, LO, D, assert_same_batches, boxed, clipped, recorded, value

from metaheuristics.swarms.whale import whale
from metaheuristics.swarms.whale_lu_2024 import whale_lu_2024

pytestmark = pytest.mark.filterwarnings("error")


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


@pytest.mark.parametrize("printed", [False, True])
def test_the_whales_of_lu_2024_move_as_the_loops_say(printed: bool) -> None:
    n, steps, s, b, lam = 11, 12, 2.0, 0.7, 0.4
    rng = np.random.default_rng(8)
    z = rng.random(3)
    x = np.empty((n, 3))
    for i in range(n):
        z = np.array([v / lam if v < lam else (1 - v) / (1 - lam) for v in z])  # (23)
        x[i] = LO + z * (HI - LO)
    expected, branches = [x], set()
    best, best_f = x[0], inf
    for step in range(1, steps):
        for row in x:
            if value(row) < best_f:
                best, best_f = row, value(row)
        k = step / steps
        w, delta = (1 - k) / (1 + s * k), 2 - 2 * k  # (22)
        r1, r2, choice, r3 = rng.random((4, n))
        other = rng.integers(n, size=n)
        new = []
        for i in range(n):
            A, C, g = 2 * delta * r1[i] - delta, 2 * (r1[i] if printed else r2[i]), 2 * r3[i] - 1
            branch = "spiral" if choice[i] >= 0.5 else "round" if printed or abs(A) < 1 else "search"
            branches.add(branch)
            moved = []
            for d in D:
                if branch == "spiral":
                    turn = exp(b * g) * cos(2 * pi * g)
                    moved.append(abs(best[d] - x[i, d]) * turn + w * best[d])
                elif branch == "round":
                    moved.append(w * best[d] - A * abs(C * best[d] - x[i, d]))
                else:
                    leader = x[other[i], d]
                    moved.append(leader - A * abs(C * leader - x[i, d]))
            new.append(boxed(moved))
        x = np.array(new)
        expected.append(x)
    assert branches == {"spiral", "round"} | (set() if printed else {"search"})
    parameters: dict[str, Any] = {"population": n, "s": s, "b": b, "lam": lam, "printed": printed}
    actual = recorded(whale_lu_2024, budget=n * steps, seed=8, **parameters)
    assert_same_batches(actual.batches, expected)
