"""Rows that tie the variables of the relaxation to one another, with the numbers of ``rows``.

Those of a duration and its powers, (6) to (8), and the products, (9) and (11), are equations that a linear
program cannot hold; the rows bound their convex hulls. (10) and (14) say what the jerk limit leaves of the
acceleration at a waypoint.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array, Indices, Truths
from formulations.proofs.every_motion.relaxation.columns import Columns
from formulations.proofs.every_motion.relaxation.cuts import (
    CRUISES,
    FADES,
    PRODUCTS,
    SPEED_PRODUCTS,
    SQUARE_PRODUCTS,
    TANGENTS,
    ZONES,
    Cuts,
    Kind,
)
from formulations.proofs.every_motion.relaxation.inequalities import Rows, Terms
from formulations.proofs.every_motion.relaxation.relaxed_problem import DOWN, UP

_ALLOWANCE = 64.0 * 2.0**-53
_FIRST = 1e-12  # of the typical duration: (7) is posed no earlier


class Ties(Columns):
    """Rows (5) to (11) and (14) in the boxes of one relaxed problem."""

    def fixed(self) -> Rows:
        """Rows (5) and (6); the bounds of the sums before waypoints come last."""
        T, typical = self.T[: self.K], self.typical[: self.K]
        share = list(typical[:, None] / self.relaxed.horizon)
        total = self._rows([np.array([column]) for column in T], share, np.ones(1))
        blocks = [total.rows(self.size)]
        for which, times_T in ((self.long, False), (self.short, True)):
            low, high = self.low[which], self.high[which]
            one = np.ones(len(low))
            if times_T:  # and times both bounds
                columns, a = [self.square[which], self.T[which]], [one, -(low + high)]
                upper = -low * high
            else:
                columns, a = [self.inverse[which], self.T[which]], [one, 1.0 / (low * high)]
                upper = 1.0 / low + 1.0 / high
            blocks.append(self._rows(columns, a, upper).normal().rows(self.size))
        for leg in range(self.K, self.L):  # the time of a leg is the sum of its segments'
            i, k = self.relaxed.legs[leg]
            columns = [np.array([c]) for c in (self.T[leg], *T[i:k])]
            terms = np.concatenate([self.typical[[leg]], -typical[i:k]])[:, None] / self.typical[leg]
            blocks += [
                self._rows(columns, list(sign * terms), np.zeros(1)).rows(self.size)
                for sign in (1.0, -1.0)
            ]
        for i, side in self.bounded_sums:
            bound = float(self.relaxed.arrivals[i, side])
            sign = 1.0 if side else -1.0
            terms = list(sign * typical[:i, None])
            row = self._rows([np.array([c]) for c in T[:i]], terms, np.array([sign * bound]))
            blocks.append(row.rows(self.size))
        return Rows.joined(blocks)

    @property
    def bounded_sums(self) -> list[tuple[int, int]]:
        """Waypoints and sides (0 earliest, 1 latest) whose arrival is bounded, in the order of rows (5)."""
        arrivals = self.relaxed.arrivals[1:]
        asked = (arrivals > 0.0) & np.isfinite(arrivals)
        return [(i + 1, side) for i, side in np.argwhere(asked).tolist()]

    def place(self, cuts: Cuts) -> Array:
        """Where the rows (7) and (8) of these cuts are posed, in units of ``typical``, in the boxes.

        Parameters
        ----------
        cuts : Cuts

        Returns
        -------
        Array, shape (m,)
        """
        k = cuts.segment
        low = np.maximum(self.low[k], _FIRST)
        return np.asarray(np.clip(cuts.at[:, 0] / self.typical[k], low, self.high[k]))

    def _of_duration(self, kind: Kind, cuts: Cuts) -> Terms:
        k, t, one = cuts.segment, self.place(cuts), np.ones(len(cuts))
        T, square = (columns[k] for columns in self.parts[kind.times_T][:2])
        if kind in TANGENTS:
            column, a, upper = self._anchored(kind, cuts, -one, -2.0 / t)
            return self._rows([T, column], [-1.0 / t**2, a], upper).normal()
        h = self.high[k]
        column, a, upper = self._anchored(kind, cuts, -h * t**2, -(2.0 * h * t + t**2))
        return self._rows([square, T, column], [one, -(h + 2.0 * t), a], upper).normal()

    def _anchored(
        self, kind: Kind, cuts: Cuts, of_inverse: Array, upper: Array
    ) -> tuple[Indices, Array, Array]:
        """The term in 1 / T and the right hand side of a row.

        Times T they are the right hand side and the term in T. The row is not posed where its variables are
        not there.

        Returns
        -------
        column : Indices, shape (m,)
        coefficient, upper : Array, shape (m,)
        """
        k = cuts.segment
        if not kind.times_T:
            return self.inverse[k], of_inverse, np.where(self.long[k], upper, np.inf)
        there = self.short[k] | (self.relaxed.by_speed_alone[cuts.joint] & (kind in CRUISES))
        return self.T[k], -upper, np.where(there, -of_inverse, np.inf)

    def _product(self, kind: Kind, cuts: Cuts) -> Terms:
        k, j, end = cuts.segment, cuts.joint, kind.end
        at = self.relaxed.legs[k, end]
        if kind in PRODUCTS:
            columns = [self.W[k, j, end], self.a[at, j], self.T[k]]
        elif kind in SPEED_PRODUCTS:
            columns = [self.g[k, j, end], self.v[at, j], self.T[k]]
        elif kind in SQUARE_PRODUCTS:
            columns = [self.X[k, j, end], self.a[at, j], self.square[k]]
        else:
            columns = [self.p[k, j, end], self.e[at, j], self.inverse[k]]
        t, f, side = self.corner(kind, cuts)
        bound = side * t * f
        if kind not in PRODUCTS:  # such a product is not there in every segment
            there = self.long if kind in ZONES else self.short
            bound = np.where(there[k], bound, np.inf)
        return self._rows(columns, [-side, side * t, side * f], bound)

    def corner(self, kind: Kind, cuts: Cuts) -> tuple[Array, Array, Array]:
        """Return the bounds of both factors of products (9) and (11), and the sign of their rows.

        Parameters
        ----------
        kind : Kind
        cuts : Cuts

        Returns
        -------
        t, f, sign : Array, shape (m,)
            A bound of T, T^2 or 1 / T, and one of a, v or e, in the units of the variables.
        """
        k, j, corner = cuts.segment, cuts.joint, cuts.at[:, 0]
        at, least, upper = (
            self.relaxed.legs[k, kind.end],
            corner % 2 == 0,
            (corner == 1) | (corner == 2),
        )
        if kind in (*PRODUCTS, *SPEED_PRODUCTS):
            t = np.where(least, self.low[k], self.high[k])
        elif kind in SQUARE_PRODUCTS:
            t = np.where(least, self.low[k] ** 2 * DOWN, self.high[k] ** 2 * UP)
        else:
            with np.errstate(divide="ignore"):
                t = np.where(least, 1.0 / self.high[k] * DOWN, 1.0 / self.low[k] * UP)
        if kind in (*PRODUCTS, *SQUARE_PRODUCTS):
            low, high = self.a_low, self.a_high
        elif kind in SPEED_PRODUCTS:
            low, high = self.v_low, self.v_high
        else:
            low, high = self.e_low, self.e_high
        f = np.where(upper, high[at, j], low[at, j])
        return t, f, np.where(corner < 2, 1.0, -1.0)

    def _peak(self, kind: Kind, cuts: Cuts) -> Terms:
        k, j, sign, end = cuts.segment, cuts.joint, cuts.sign, kind.end
        require(self.relaxed.has_jerk[j])
        top, bend, sound = self.peak(end, cuts)
        share, at = self.ramp[k, j] ** 2 / bend, self.relaxed.legs[k, end]
        place = cuts.at[:, 0] / self.relaxed.acceleration[j]
        # LinearProgram leaves infinite rows out
        if kind in FADES:
            columns = [self.v[at, j], self.a[at, j]]
            upper = np.where(sound, top + 0.5 * share * place**2, np.inf)
            return self._rows(columns, [sign, share * place], upper)
        c = cuts.at[:, 0] * self.typical[k] / self.relaxed.acceleration[j]
        columns = [self.v[at, j], self.W[k, j, end], self.square[k]]
        upper = np.where(sound & self.long[k], top, np.inf)
        return self._rows(columns, [sign, share * c, -0.5 * share * c**2], upper)

    def peak(self, end: int, cuts: Cuts) -> tuple[Array, Array, Truths]:
        """Find the limits of (10): those of the segment where the acceleration fades, or of all segments.

        With c along the motion the speed rises after the waypoint, else it fell before it.

        Parameters
        ----------
        end : int
            0 for the start of a segment, 1 for its end.
        cuts : Cuts

        Returns
        -------
        top, bend : Array, shape (m,)
            V, and J T^2 for the typical duration, in units of the velocity limit.
        sound : Truths, shape (m,)
            Whether there is certainly the time.
        """
        i, j = self.relaxed.legs[cuts.segment, end], cuts.joint
        forwards, after = forwards_of(cuts.sign), cuts.sign * cuts.at[:, 0] > 0.0
        k = np.where(after, i, i - 1)  # the segment on that side
        there = (k >= 0) & (k < self.K)
        k = np.clip(k, 0, self.K - 1)
        own = there & self.fades_within[k, np.where(after, 0, 1), j]
        top = np.where(own, self.top[k, j, forwards], self.top[:, j, forwards].max(axis=0))
        bend = np.where(own, self.relaxed.jerks[k, j], self.relaxed.jerk[j]) / self.relaxed.velocity[j]
        sound = own | self.fades[after.astype(np.intp), i, j]
        return top, self.typical[cuts.segment] ** 2 * bend, sound

    def _change(self, cuts: Cuts) -> Terms:
        k, j, sign = cuts.segment, cuts.joint, cuts.sign
        require(self.relaxed.has_jerk[j])
        per_T = self.bend[k, j] / self.ramp[k, j]
        start, end = self.relaxed.legs[k].T
        columns = [self.a[end, j], self.a[start, j], self.T[k]]
        return self._rows(columns, [sign, -sign, -per_T], np.zeros(len(k)))

    def _rows(self, columns: list[Indices], coefficients: list[Array], upper: Array) -> Terms:
        """Rows of w coefficients each, with the allowance for rounding; ``columns[i]`` is (m,)."""
        where, a = np.stack(columns, axis=1), np.stack(coefficients, axis=1)
        moduli = np.abs(a)
        size = (moduli * self._sizes[where]).sum(axis=1) + np.abs(upper)
        largest = moduli.max(axis=1, initial=0.0)
        return Terms(where, a, upper + _ALLOWANCE * size, np.ones(len(upper)), largest)


def forwards_of(sign: Array) -> Indices:
    """Return the side of a limit that a sign chooses: 1 forwards, 0 backwards.

    Parameters
    ----------
    sign : Array, shape (m,)

    Returns
    -------
    Indices, shape (m,)
    """
    return (sign > 0.0).astype(np.intp)


def require(sound: Truths) -> None:
    """Refuse rows with a term in the jerk limit of a joint that has none.

    Parameters
    ----------
    sound : Truths, shape (m,)

    Raises
    ------
    ValueError
    """
    if not sound.all():
        raise ValueError("a row needs the jerk limit of a joint that has none")
