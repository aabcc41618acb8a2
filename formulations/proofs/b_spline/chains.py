"""What holds for every motion, as one inequality per joint that is convex in the durations.

A joint with speed at most V and acceleration at most A covers in a segment of duration T, from velocity v0
to v1 (positive in its direction), for any shares a, b >= 0 with a + b <= 1, at most

    a T v0 + b T v1 + (1 - a - b) T V + (a^2 + b^2) A T^2 / 2,

because it is at most v0 + A t in the first part, v1 + A (T - t) in the last, V between. Divided by T:

    d / T - (1 - a - b) V - (a^2 + b^2) A T / 2 - a v0 - b v1 <= 0,        +-(v1 - v0) - A T <= 0.

The velocities stand there with constant factors: a sum with multipliers >= 0 leaves |factor| V of each.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.multipliers import minimax

_SHARES = 11


@compiled
def _pairs(s: float, shares: Any) -> None:
    """s: share of the segment in which a joint at rest reaches its speed, at most 1/2."""
    half = 0.5 * s
    values = (
        (s, s), (s, half), (half, s), (half, half), (0.0, s), (s, 0.0), (0.0, 0.0),
        (1.0, 0.0), (0.0, 1.0), (0.75, 0.25), (0.25, 0.75),
    )  # fmt: skip
    for i in range(_SHARES):
        shares[i, 0], shares[i, 1] = values[i]


@compiled
def chain_row(j: int, data: Any, t: Any, rows: Any, a: Any, g: Any, lam: Any, slopes: Any) -> float:
    """Value at t and slopes (n-1,) of the best inequality of joint j found; a lower bound to first order.

    rows (m, 5): kind, segment, a, b, multiplier.
    """
    n = data.forms.n
    V, A = data.speed[j], data.acceleration[j]
    shares = np.empty((_SHARES, 2))
    count = 0
    for k in range(n):
        T = t[k + 1] - t[k]
        d = data.least[k, j]
        for side in range(2):
            if A == np.inf:
                break
            sign = 1.0 - 2.0 * side
            rows[count, 0], rows[count, 1], rows[count, 2], rows[count, 3] = 1.0, k, -sign, sign
            count += 1
        if d > 0.0:
            share = min(0.5, V / (A * T))
            _pairs(share, shares)
            for i in range(_SHARES):
                x, y = shares[i]
                if A == np.inf and (x > 0.0 or y > 0.0):
                    continue
                rows[count, 0], rows[count, 1] = 0.0, k
                rows[count, 2], rows[count, 3] = x, y
                count += 1
    value = 0.0
    for round_ in range(2):
        for r in range(count):
            k = int(rows[r, 1])
            T = t[k + 1] - t[k]
            x, y = rows[r, 2], rows[r, 3]
            for q in range(n - 1):
                g[r, q] = 0.0
            if rows[r, 0] == 1.0:
                a[r] = -A * T / V
                s = -1.0
            else:
                a[r] = (data.least[k, j] / T - (1.0 - x - y) * V) / V
                if x > 0.0 or y > 0.0:
                    a[r] -= 0.5 * (x * x + y * y) * A * T / V
                s = data.sign[k, j]
            if k > 0:
                g[r, k - 1] = -s * x
            if k < n - 1:
                g[r, k] = -s * y
        value = minimax(a, g, count, n - 1, lam, 100)
        if round_ == 1 or A == np.inf:
            break
        # velocities of the dual are not at hand: refine the shares that are used
        more = count
        for r in range(count):
            if lam[r] > 1e-9 and rows[r, 0] == 0.0 and more + 4 < len(rows):
                for side in range(4):
                    x, y = rows[r, 2], rows[r, 3]
                    step = 0.8 if side % 2 == 0 else 1.25
                    if side < 2:
                        x = min(x * step, 1.0 - y)
                    else:
                        y = min(y * step, 1.0 - x)
                    rows[more, 0], rows[more, 1], rows[more, 2], rows[more, 3] = 0.0, rows[r, 1], x, y
                    more += 1
        count = more
    for q in range(n - 1):
        slopes[q] = 0.0
    for r in range(count):
        if not lam[r] > 1e-13:
            continue
        k = int(rows[r, 1])
        T = t[k + 1] - t[k]
        x, y = rows[r, 2], rows[r, 3]
        if rows[r, 0] == 1.0:
            slope = -A / V
        else:
            slope = -data.least[k, j] / (T * T) / V
            if x > 0.0 or y > 0.0:
                slope -= 0.5 * (x * x + y * y) * A / V
        slope *= lam[r]
        if k < n - 1:
            slopes[k] += slope
        if k > 0:
            slopes[k - 1] -= slope
    return value
