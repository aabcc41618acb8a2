"""Quintic: the conditions of a piece, linear in x but for one power of x_k (see quintic).

Derivative ``order`` of piece k at normalised time s, times sign and divided by x_k^(order - 1):

    sign (B x_{k-1} + A x_k + E x_{k+1}) - limit / x_k^(order-1) <= 0          order 1, 2, 3
    sign (B x_{k-1} + A x_k + E x_{k+1}) - room x_k <= 0                       position, order 0

    A = d_k (P(s) + 1/2 P0(s) + 1/2 P1(s)),  B = 1/2 d_{k-1} P0(s),  E = 1/2 d_{k+1} P1(s)

with integer polynomials P, P0, P1; without the terms of P0 where the joint does not go on in its
direction at the start of the piece, of P1 at its end. As x > 0, lower bounds of A, B, E are enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.arithmetic.intervals import down, polynomial, times
from formulations.proofs.domain import Data

# ascending powers of s; their derivatives (order, part, power)
_P, _P0, _P1 = [0.0, 0, 0, 10, -15, 6], [0.0, 1, 0, -6, 8, -3], [0.0, 0, 0, -4, 7, -3]
_DERIVATIVES = np.zeros((6, 3, 6))
_DERIVATIVES[0] = _P, _P0, _P1
for _order in range(5):
    _DERIVATIVES[_order + 1, :, :5] = _DERIVATIVES[_order, :, 1:] * np.arange(1.0, 6.0)
_PLACES = np.linspace(0.0, 1.0, 33)
_ON_PLACES = _DERIVATIVES @ _PLACES ** np.arange(6.0)[:, None]  # (order, part, place)
_COARSE = np.linspace(0.0, 1.0, 9)


@dataclass(frozen=True)
class Rows:
    """m conditions: joint among the moving ones, segment, order (m,) integers, place, sign (m,) floats.

    before, own, after: lower bounds of the coefficients of x_{k-1}, x_k, x_{k+1}; limit: 0 for the
    position, whose room is in ``own``.
    """

    joint: Any
    segment: Any
    order: Any
    place: Array
    sign: Array
    before: Array
    own: Array
    after: Array
    limit: Array

    def __len__(self) -> int:
        return len(self.joint)

    def __getitem__(self, which: Any) -> Rows:
        return Rows(*(part[which] for part in vars(self).values()))

    @staticmethod
    def of(parts: list[Rows]) -> Rows:
        """All rows of several."""
        columns = zip(*(vars(part).values() for part in parts), strict=True)
        return Rows(*(np.concatenate(column) for column in columns))

    @property
    def power(self) -> Any:
        """The limit stands over x_k to this power, (m,)."""
        return np.maximum(self.order - 1, 0)

    def at(self, x: Array) -> tuple[Array, Array]:
        """Values of the conditions at x (n+2,), padded, and their slopes (m, n+2); not rounded."""
        slopes, every, own = np.zeros((len(self), len(x))), np.arange(len(self)), x[self.segment + 1]
        slopes[every, self.segment] = self.before
        slopes[every, self.segment + 1] = self.own
        slopes[every, self.segment + 2] = self.after
        held = self.limit / own**self.power
        values = slopes @ x - held
        slopes[every, self.segment + 1] += self.power * held / own
        return values, slopes


class Pieces:
    """Rows of the pieces of one problem, and where a motion comes closest to its limits."""

    def __init__(self, data: Data) -> None:
        self.data = data
        self.n, self.dof = data.d.shape
        self._d = np.pad(data.d, ((1, 1), (0, 0)))  # nothing moves before and after
        self._ends = tuple(np.pad(d, ((1, 1), (0, 0))) for d in (data.d_lo, data.d_hi))
        lo, hi = (np.sign(end) for end in self._ends)
        sure = (lo * hi > 0.0) | ((lo == 0.0) & (hi == 0.0))  # the direction, where it is blurred
        self._sure = sure[:-2] & sure[1:-1] & sure[2:]
        onward = self._d[:-1] * self._d[1:] > 0.0
        self._before, self._after = 0.5 * onward[:-1], 0.5 * onward[1:]

    def rows(self, joint: Any, segment: Any, order: int, place: Array, sign: float) -> Rows:
        """Conditions at places (m,) of pieces, each of one order and sign."""
        p, p0, p1 = _DERIVATIVES[order]
        before, after = self._before[segment, joint], self._after[segment, joint]
        own = p + before[:, None] * p0 + after[:, None] * p1  # exact: multiples of 1/2

        def lower(neighbour: int, coefficients: Array) -> Array:
            lo, hi = (d[segment + neighbour, joint] for d in self._ends)
            return times((lo, hi), polynomial(sign * coefficients, place))[0]

        coefficient, limit = lower(1, own), np.zeros(len(place))
        if order:
            limit = self.data.derivatives[order - 1, joint]
        else:
            room = self.data.room_above if sign > 0.0 else self.data.room_below
            coefficient = down(coefficient - room[segment, joint])
        return Rows(
            joint,
            segment,
            np.full(len(place), order),
            place,
            np.full(len(place), sign),
            lower(0, before[:, None] * p0),
            coefficient,
            lower(2, after[:, None] * p1),
            limit,
        )

    def _limited(self, order: int, sign: float) -> Any:
        """Which pieces (n, dof) have such a limit."""
        if order:
            limited = np.isfinite(self.data.derivatives[order - 1])[None]
        else:
            limited = np.isfinite(self.data.room_above if sign > 0.0 else self.data.room_below)
        return limited & self._sure & (self.data.d != 0.0)

    def grid(self) -> Rows:
        """Rows at even places of all pieces."""
        parts = []
        for order in range(4):
            for sign in (1.0, -1.0):
                segment, joint = np.nonzero(self._limited(order, sign))
                places = np.tile(_COARSE, len(joint))
                segment, joint = np.repeat(segment, len(_COARSE)), np.repeat(joint, len(_COARSE))
                parts.append(self.rows(joint, segment, order, places, sign))
        return Rows.of(parts)

    def peaks(self, x: Array) -> Rows:
        """Rows where the motion of x (n+2,), padded, comes closest to each of its limits."""
        own = x[1:-1, None]
        before = self._before * (self._d[1:-1] + self._d[:-2] * x[:-2, None] / own)
        after = self._after * (self._d[1:-1] + self._d[2:] * x[2:, None] / own)
        weights = np.stack([self._d[1:-1], before, after], axis=-1)
        parts = []
        for order in range(4):
            for sign in (1.0, -1.0):
                limited = self._limited(order, sign)
                if not limited.any():
                    continue
                segment, joint = np.nonzero(limited)
                w = weights[limited]
                place = _PLACES[(sign * w @ _ON_PLACES[order]).argmax(axis=1)]
                for _ in range(3):  # Newton to the extreme; any place will do
                    slope, bend = (
                        np.sum((w @ _DERIVATIVES[order + i]) * place[:, None] ** np.arange(6), axis=1)
                        for i in (1, 2)
                    )
                    turns = sign * bend < 0.0
                    step = np.divide(slope, bend, out=np.zeros_like(slope), where=turns)
                    place = np.clip(place - np.clip(step, -_PLACES[1], _PLACES[1]), 0.0, 1.0)
                parts.append(self.rows(joint, segment, order, place, sign))
        return Rows.of(parts)
