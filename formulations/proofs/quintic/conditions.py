"""Quintic: the conditions of a piece, linear in x except for one power of x_k (see ``bound``).

Derivative ``order`` of piece k at normalised time s, times sign and divided by x_k^(order - 1):

    sign (B x_{k-1} + A x_k + E x_{k+1}) - limit / x_k^(order-1) <= 0          order 1, 2, 3
    sign (B x_{k-1} + A x_k + E x_{k+1}) - room x_k <= 0                       position, order 0

    A = d_k (P(s) + 1/2 P0(s) + 1/2 P1(s)),  B = 1/2 d_{k-1} P0(s),  E = 1/2 d_{k+1} P1(s)

with integer polynomials P, P0, P1. The terms of P0 are left out where the joint changes its direction
(or rests) at the start of the piece, those of P1 where it does so at the end: there the mean rule sets
the velocity to 0. As x > 0, lower bounds of A, B, E are enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.proofs.arithmetic.intervals import down, polynomial, times
from formulations.proofs.conditions import with_derivatives
from formulations.proofs.domain import ProblemData

# P, P0, P1 in ascending powers of s, and their derivatives: (order, part, power)
_DERIVATIVES = with_derivatives([[0, 0, 0, 10, -15, 6], [0, 1, 0, -6, 8, -3], [0, 0, 0, -4, 7, -3]], 5)
_PLACES = np.linspace(0.0, 1.0, 33)
_ON_PLACES = _DERIVATIVES @ _PLACES ** np.arange(6.0)[:, None]  # (order, part, place)
_COARSE = np.linspace(0.0, 1.0, 9)


@dataclass(frozen=True)
class PieceConditions:
    """m conditions as columns.

    Attributes
    ----------
    joint, segment, order : ndarray of int, shape (m,)
        The joint among the moving ones, the piece, the order of the derivative.
    place, sign : Array, shape (m,)
        Normalised time, and +1 or -1 for the upper or lower limit.
    before, own, after : Array, shape (m,)
        Lower bounds of the coefficients of x_{k-1}, x_k, x_{k+1}.
    limit : Array, shape (m,)
        The limit; 0 for the position, whose room is in ``own``.
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

    def __getitem__(self, which: Any) -> PieceConditions:
        return PieceConditions(*(part[which] for part in vars(self).values()))

    @staticmethod
    def of(parts: list[PieceConditions]) -> PieceConditions:
        """Join several sets of conditions.

        Parameters
        ----------
        parts : list of PieceConditions
            The sets.

        Returns
        -------
        PieceConditions
            All conditions, in this order.
        """
        columns = zip(*(vars(part).values() for part in parts), strict=True)
        return PieceConditions(*(np.concatenate(column) for column in columns))

    @property
    def power(self) -> Any:
        """The power of x_k that divides the limit, shape (m,)."""
        return np.maximum(self.order - 1, 0)

    def at(self, x: Array) -> tuple[Array, Array]:
        """Evaluate the conditions and their slopes, not rounded.

        Parameters
        ----------
        x : Array, shape (n+2,) [1/s]
            Inverse durations, padded at both ends.

        Returns
        -------
        values : Array, shape (m,)
            Values.
        slopes : Array, shape (m, n+2)
            Derivatives with respect to x.
        """
        slopes, every, own = np.zeros((len(self), len(x))), np.arange(len(self)), x[self.segment + 1]
        slopes[every, self.segment] = self.before
        slopes[every, self.segment + 1] = self.own
        slopes[every, self.segment + 2] = self.after
        held = self.limit / own**self.power
        values = slopes @ x - held
        slopes[every, self.segment + 1] += self.power * held / own
        return values, slopes


class Pieces:
    """The pieces of one problem: their conditions, and where a motion comes closest to its limits."""

    def __init__(self, data: ProblemData) -> None:
        self.data = data
        self.n, self.dof = data.d.shape
        self._d = np.pad(data.d, ((1, 1), (0, 0)))  # nothing moves before and after
        self._ends = tuple(np.pad(d, ((1, 1), (0, 0))) for d in (data.d_lo, data.d_hi))
        lo, hi = (np.sign(end) for end in self._ends)
        sure = (lo * hi > 0.0) | ((lo == 0.0) & (hi == 0.0))  # the direction, where it is blurred
        self._sure = sure[:-2] & sure[1:-1] & sure[2:]
        onward = self._d[:-1] * self._d[1:] > 0.0
        self._before, self._after = 0.5 * onward[:-1], 0.5 * onward[1:]

    def conditions(
        self, joint: Any, segment: Any, order: int, place: Array, sign: float
    ) -> PieceConditions:
        """Pose conditions of one order and sign.

        Parameters
        ----------
        joint, segment : ndarray of int, shape (m,)
            The joints among the moving ones, and the pieces.
        order : int
            Order of the derivative; 0 for the position.
        place : Array, shape (m,)
            Normalised times.
        sign : float
            +1 for the upper limit, -1 for the lower.

        Returns
        -------
        PieceConditions
            The conditions, their coefficients rounded down.
        """
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
        return PieceConditions(
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

    def grid(self) -> PieceConditions:
        """Conditions at evenly spaced places of all pieces."""
        parts = []
        for order in range(4):
            for sign in (1.0, -1.0):
                segment, joint = np.nonzero(self._limited(order, sign))
                places = np.tile(_COARSE, len(joint))
                segment, joint = np.repeat(segment, len(_COARSE)), np.repeat(joint, len(_COARSE))
                parts.append(self.conditions(joint, segment, order, places, sign))
        return PieceConditions.of(parts)

    def peaks(self, x: Array) -> PieceConditions:
        """Pose conditions where one motion comes closest to each of its limits.

        Parameters
        ----------
        x : Array, shape (n+2,) [1/s]
            Inverse durations, padded at both ends.

        Returns
        -------
        PieceConditions
            One condition per piece, joint, order and sign.
        """
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
                parts.append(self.conditions(joint, segment, order, place, sign))
        return PieceConditions.of(parts)
