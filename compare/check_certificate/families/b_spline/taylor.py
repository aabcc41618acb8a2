"""Taylor models of third order, for many boxes at once.

In e = (t - c) / h, whose entries lie in [-1, 1], a model encloses a function by a polynomial of third order
and a rest: |f(e) - P(e)| <= rest. The terms of P stand on one axis of length K: the constant, the m slopes,
then the squares e_q e_r for q <= r and the cubes e_q e_r e_s for q <= r <= s, in lexicographic order.

Rounding. u = 2^-53, and there are at most ``MOST_VARIABLES``. A term that is computed below is a sum of at
most 100 products of at most three floats, so its error is at most 110 u times the sum of their sizes,
whatever the order of summation: where terms enter, ``ERR`` = 128 u times the product of their sizes is added
to the rest. A rest is computed from numbers >= 0 by sums, products and quotients, with less than 2^18
operations one after the other: the factor ``GROW`` covers their roundings, and ``TINY`` what underflow loses.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations_with_replacement, pairwise
from typing import Any

import numpy as np

ERR, GROW, TINY = 2.0**-46, 1.0 + 2.0**-34, 1e-290
MOST_VARIABLES = 23


class Monomials:
    """Where the monomials of m variables stand.

    K: their number. linear, square, cube: slices of the axis. row[q]: place of e_q e_q among the squares.
    cell[q, r]: place of e_q e_r e_r among the cubes. pairs: how products of slopes become squares.
    triples: how products of slopes and squares become cubes. share: (cubes, m), how the bound of a
    cube is spread over squares of the variables.
    """

    def __init__(self, m: int) -> None:
        squares = list(combinations_with_replacement(range(m), 2))
        cubes = list(combinations_with_replacement(range(m), 3))
        ends = np.cumsum([1, m, len(squares), len(cubes)])
        self.m, self.K = m, int(ends[-1])
        self.linear, self.square, self.cube = (slice(int(a), int(b)) for a, b in pairwise(ends))
        place = {s: i for i, s in enumerate(squares)}
        self.row = [place[q, q] for q in range(m)]
        at = {c: i for i, c in enumerate(cubes)}
        self.cell = {(q, r): at[q, r, r] for q, r in squares}
        self.pairs = (
            np.array([q * m + r for q, r in squares], int),
            np.array([r * m + q for q, r in squares], int),
            np.array([float(q != r) for q, r in squares]),
        )
        k = len(squares)
        self.triples = (
            np.array([q * k + place[r, s] for q, r, s in cubes], int),
            np.array([r * k + place[q, s] for q, r, s in cubes], int),
            np.array([float(q != r) for q, r, s in cubes]),
            np.array([s * k + place[q, r] for q, r, s in cubes], int),
            np.array([float(r != s) for q, r, s in cubes]),
        )
        self.of_square = np.array(squares, int).reshape(-1, 2)
        self.share = np.zeros((len(cubes), m))
        for i, factors in enumerate(cubes):
            for q in factors:
                self.share[i, q] += 1.0 / 3.0

    def squares_of(self, full: Any) -> Any:
        """Add up products of slopes.

        Parameters
        ----------
        full : ndarray, shape (.., m, m)
            Products of e_q and e_r.

        Returns
        -------
        ndarray, shape (.., squares)
            Two products each at most.
        """
        flat = full.reshape(*full.shape[:-2], full.shape[-2] * full.shape[-1])
        first, second, apart = self.pairs
        return flat[..., first] + apart * flat[..., second]

    def cubes_of(self, full: Any) -> Any:
        """Add up products of slopes and squares.

        Parameters
        ----------
        full : ndarray, shape (.., m, squares)
            Products of e_q and a square.

        Returns
        -------
        ndarray, shape (.., cubes)
            Three products each at most.
        """
        flat = full.reshape(*full.shape[:-2], full.shape[-2] * full.shape[-1])
        a, b, ab, c, bc = self.triples
        return flat[..., a] + ab * flat[..., b] + bc * flat[..., c]


@lru_cache(maxsize=4)
def monomials(m: int) -> Monomials:
    """Find the monomials of m variables.

    Parameters
    ----------
    m : int
        Number of variables.

    Returns
    -------
    Monomials
        Kept, as they are asked for again and again.
    """
    return Monomials(m)


def raised(of: Monomials, order: int, x: Any, a: Any) -> Any:
    """Multiply the terms of one order by a linear form.

    Parameters
    ----------
    of : Monomials
        The variables.
    order : int
        1, 2 or 3: that of the product.
    x : ndarray, shape (m, ..)
        The form.
    a : ndarray, shape (terms of order - 1, ..)
        The terms.

    Returns
    -------
    ndarray, shape (terms of the order, ..)
        Each is a sum of at most three products.
    """
    m = of.m
    if order == 1:
        return x * a
    if order == 2:
        out = np.empty((of.square.stop - of.square.start, *a.shape[1:]))
        for q in range(m):
            at = of.row[q]
            np.multiply(x[q], a[q:], out=out[at : at + m - q])
            out[at + 1 : at + m - q] += x[q + 1 :] * a[q]
        return out
    out = np.empty((of.cube.stop - of.cube.start, *a.shape[1:]))
    for q in range(m):
        first, at = of.cell[q, q], of.row[q]
        np.multiply(x[q], a[at:], out=out[first : first + len(a) - at])
        for r in range(q, m):
            cell = of.cell[q, r]
            if r > q:
                out[cell : cell + m - r] += x[r] * a[at + r - q : at + m - q]
            out[cell + 1 : cell + m - r] += x[r + 1 :] * a[at + r - q]
    return out


def size(terms: Any, axis: int = 0) -> Any:
    """Add up sizes of terms.

    Parameters
    ----------
    terms : ndarray
        Terms of models.
    axis : int
        Along which they stand.

    Returns
    -------
    ndarray
        The sums, rounded to nearest.
    """
    return np.abs(terms).sum(axis=axis)


def sum_of_products(of: Monomials, a: Any, rest: Any, constant: Any, motion: Any) -> tuple[Any, Any]:
    """Enclose sum_l a_l (constant_l + motion_l) for models a_l and polynomials motion_l.

    The terms of fourth order are added up over l before their sizes are taken.

    Parameters
    ----------
    of : Monomials
        The variables.
    a : ndarray, shape (batch, rows, l, K)
        Terms of the models.
    rest : ndarray, shape (batch, rows, l)
        Their rests.
    constant : ndarray, shape (batch, rows, l)
        Floats, each with a relative error of at most u.
    motion : ndarray, shape (batch, l, K)
        Polynomials without a constant term, exact.

    Returns
    -------
    terms : ndarray, shape (batch, rows, K)
        Of the sum.
    rest : ndarray, shape (batch, rows)
        Its rest.
    """
    m, (batch, rows, count, _) = of.m, a.shape
    terms = np.matmul(constant[:, :, None, :], a)[:, :, 0, :]
    terms += np.matmul(a[..., 0], motion)
    across = np.ascontiguousarray(a.swapaxes(2, 3))  # (batch, rows, K, l)
    orders = of.linear, of.square, of.cube
    parts = [across[:, :, s].reshape(batch, rows * (s.stop - s.start), count) for s in orders]
    p = [np.ascontiguousarray(motion[:, :, s]) for s in orders]
    terms[:, :, of.square] += of.squares_of(np.matmul(parts[0], p[0]).reshape(batch, rows, m, m))
    k = p[1].shape[2]
    low = np.matmul(parts[0], p[1]).reshape(batch, rows, m, k)
    high = np.matmul(parts[1], p[0]).reshape(batch, rows, k, m)
    terms[:, :, of.cube] += of.cubes_of(low + high.swapaxes(2, 3))
    products = (np.abs(np.matmul(parts[i], p[2 - i])).sum(axis=2) for i in range(3))
    fourth = sum(x.reshape(batch, rows, x.shape[1] // max(rows, 1)).sum(axis=2) for x in products)
    sizes = [size(a[..., s], axis=3) for s in (of.square, of.cube)]
    moves = [size(x, axis=2)[:, None, :] for x in p]
    whole = size(a, axis=3)
    far = np.abs(constant) + moves[0] + moves[1] + moves[2]
    beyond = sizes[0] * moves[2] + sizes[1] * (moves[1] + moves[2]) + rest * far + ERR * whole * far
    return terms, (fourth + beyond.sum(axis=2)) * GROW + TINY
