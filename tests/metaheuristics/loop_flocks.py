"""Sparrows and butterflies written as loops; they draw the same random numbers in the same order."""

from __future__ import annotations

from math import exp, inf
from typing import Any

import numpy as np
from loops import Array, D, boxed, start, value


class LoopFlock:
    """Sparrows one by one; ``batches`` collects what is evaluated."""

    def __init__(self, rng: np.random.Generator, n: int, generations: float, printed: bool) -> None:
        self.rng, self.n, self.generations, self.printed = rng, n, generations, printed
        self.x = start(rng, n)
        self.f = [value(row) for row in self.x]
        self.batches = [np.array(self.x)]
        self.branches: set[str] = set()

    def generation(self, t: int, combine: Any = None) -> None:
        """Producers, scroungers, scouts."""
        order = sorted(range(self.n), key=lambda i: self.f[i])
        self.x, self.f = [self.x[i] for i in order], [self.f[i] for i in order]
        producers, scouts = max(1, round(0.2 * self.n)), max(1, round(0.1 * self.n))
        self.batch(range(producers), self.produce(producers, t), combine)
        self.batch(range(producers, self.n), self.scrounge(producers), combine)
        rows = self.rng.permutation(self.n)[:scouts].tolist()
        self.batch(rows, self.scout(rows), combine)

    def batch(self, rows: Any, moves: list[list[float]], combine: Any) -> None:
        """Evaluate moves and keep what is better."""
        moves = [boxed(move) for move in moves]
        if combine is not None:
            moves = combine(list(rows), moves)
        self.batches.append(np.array(moves))
        for i, move in zip(rows, moves, strict=True):
            if value(move) < self.f[i]:
                self.x[i], self.f[i] = move, value(move)

    def produce(self, m: int, t: int) -> list[list[float]]:
        """Xue & Shen 2020, eq. 3; Zhou 2025, eq. 8 and 9."""
        x = self.x
        if self.printed:
            alpha, Q = 1 - self.rng.random(m), self.rng.standard_normal(m)
            M = float(np.median(self.f))
            self.branches |= {"low" if self.f[i] < M else "high" for i in range(m)}
            return [
                [
                    x[i][d] * exp(-t * self.f[i] / (alpha[i] * self.generations))
                    if self.f[i] < M
                    else x[i][d] + Q[i]
                    for d in D
                ]
                for i in range(m)
            ]
        if self.rng.random() < 0.8:
            self.branches.add("safe")
            alpha = 1 - self.rng.random(m)
            return [
                [x[i][d] * exp(-(i + 1) / (alpha[i] * self.generations)) for d in D] for i in range(m)
            ]
        self.branches.add("alarm")
        Q = self.rng.standard_normal(m)
        return [[x[i][d] + Q[i] * 1 for d in D] for i in range(m)]

    def scrounge(self, m: int) -> list[list[float]]:
        """Xue & Shen 2020, eq. 4; Zhou 2025, eq. 10; the pseudo-inverse is computed as one."""
        best = self.x[self.f[:m].index(min(self.f[:m]))]
        worst = self.x[self.f.index(max(self.f))]
        Q = self.rng.standard_normal(self.n - m)
        shape = (self.n - m, 3)
        A = self.rng.random(shape) if self.printed else 2.0 * self.rng.integers(2, size=shape) - 1
        moves = []
        for row, i in enumerate(range(m, self.n)):
            if i + 1 > self.n / 2:
                moves.append([Q[row] * exp((worst[d] - self.x[i][d]) / (i + 1) ** 2) for d in D])
            elif self.printed:
                moves.append([best[d] + abs(self.x[i][d] - best[d]) * A[row, d] for d in D])
            else:
                plus = np.linalg.pinv(A[row][None])  # A+ = A^T (A A^T)^-1, (3, 1)
                step = float((np.abs(np.array(self.x[i]) - best) @ plus)[0])
                moves.append([best[d] + step for d in D])
        return moves

    def scout(self, rows: list[int]) -> list[list[float]]:
        """Xue & Shen 2020, eq. 5; Zhou 2025, eq. 11."""
        best, worst = self.f.index(min(self.f)), self.f.index(max(self.f))
        beta, K = self.rng.standard_normal((len(rows), 3)), 2 * self.rng.random(len(rows)) - 1
        moves = []
        for row, i in enumerate(rows):
            x = self.x[i]
            if self.f[i] > self.f[best]:
                moves.append([self.x[best][d] + beta[row, d] * abs(x[d] - self.x[best][d]) for d in D])
                continue
            self.branches.add("the best scouts")
            step = K[row] / (self.f[i] - self.f[worst] + 1e-50)
            moves.append([x[d] + step * abs(x[d] - self.x[worst][d]) for d in D])
        return moves


def loop_butterflies(
    rng: np.random.Generator, x: Array, rows: list[int], f: list[float], c: float
) -> list[list[float]]:
    """Eq. 2 and 3 of Arora & Singh for some rows of x (n, 3); fitness f is positive or infinite."""
    n, m = len(x), len(rows)
    best = x[f.index(min(f))]
    largest = max((v for v in f if v < inf), default=1.0)
    r, u = rng.random(m), rng.random(m)
    j = rng.integers(n, size=m)
    k = [(j[row] + 1 + step) % n for row, step in enumerate(rng.integers(n - 1, size=m))]
    moves = []
    for row, i in enumerate(rows):
        smell = c * min(f[i], largest) ** 0.1
        towards = (
            [r[row] ** 2 * x[j[row]][d] - x[k[row]][d] for d in D]
            if u[row] >= 0.8
            else [r[row] ** 2 * best[d] - x[i][d] for d in D]
        )
        moves.append(boxed([x[i][d] + towards[d] * smell for d in D]))
    return moves
