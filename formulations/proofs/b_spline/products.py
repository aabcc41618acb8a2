"""Products and quotients of Taylor models; see ``taylor`` for the rounding."""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled
from formulations.proofs.b_spline.taylor import (
    CUBE,
    ERROR,
    GROW,
    LINEAR,
    REST,
    SLOPES,
    SQUARE,
    VALUE,
    clear,
    close,
    size_of,
    sum_of_sizes,
)


@compiled
def add_product(n: int, k: float, a: Any, b: Any, out: Any) -> None:
    """Add k a b to a sum.

    Parameters
    ----------
    n : int
        Number of variables.
    k : float
        A factor, exact.
    a, b : ndarray, shape (width,)
        Models.
    out : ndarray, shape (width,)
        The sum, to be closed.
    """
    add_terms(n, k, a, b, out)
    out[REST] += abs(k) * (a[LINEAR] * b[CUBE] + a[SQUARE] * b[SQUARE] + a[CUBE] * b[LINEAR])


@compiled
def add_terms(n: int, k: float, a: Any, b: Any, out: Any) -> None:
    """Add k a b to a sum, but for the terms of fourth order, which ``fourth_order`` bounds.

    Parameters
    ----------
    n : int
        Number of variables.
    k : float
        A factor, exact.
    a, b : ndarray, shape (width,)
        Models.
    out : ndarray, shape (width,)
        The sum, to be closed.
    """
    a0, b0 = k * a[VALUE], k * b[VALUE]
    out[VALUE] += a0 * b[VALUE]
    for i in range(SLOPES, len(a)):
        out[i] += a0 * b[i] + b0 * a[i]
    row_q = SLOPES + n  # Q_qs stands at row_q + s - q
    i = SLOPES + n + (n * (n + 1)) // 2  # C_qrs at i + s - r
    for q in range(n):
        aq, bq = k * a[SLOPES + q], k * b[SLOPES + q]
        aqq, bqq = a[row_q], b[row_q]
        out[row_q] += aq * b[SLOPES + q]
        for s in range(q + 1, n):
            out[row_q + s - q] += aq * b[SLOPES + s] + a[SLOPES + s] * bq
        out[i] += aq * bqq + bq * aqq
        for s in range(q + 1, n):
            out[i + s - q] += (
                aq * b[row_q + s - q]
                + bq * a[row_q + s - q]
                + k * (a[SLOPES + s] * bqq + b[SLOPES + s] * aqq)
            )
        i += n - q
        row_r = row_q + n - q
        for r in range(q + 1, n):
            ar, br = k * a[SLOPES + r], k * b[SLOPES + r]
            aqr, bqr = k * a[row_q + r - q], k * b[row_q + r - q]
            out[i] += aq * b[row_r] + bq * a[row_r] + ar * b[row_q + r - q] + br * a[row_q + r - q]
            for s in range(r + 1, n):
                out[i + s - r] += (
                    aq * b[row_r + s - r]
                    + bq * a[row_r + s - r]
                    + ar * b[row_q + s - q]
                    + br * a[row_q + s - q]
                    + aqr * b[SLOPES + s]
                    + bqr * a[SLOPES + s]
                )
            i += n - r
            row_r += n - r
        row_q += n - q
    size_a, size_b = size_of(a), size_of(b)
    out[REST] += abs(k) * (
        a[SQUARE] * b[CUBE]
        + a[CUBE] * (b[SQUARE] + b[CUBE])
        + a[REST] * (size_b + b[REST])
        + b[REST] * size_a
        + ERROR * size_a * size_b
    )


@compiled
def share_out(n: int, a: Any, b: Any, up: Any, work: Any) -> None:
    """Add a b to one model and keep (1 - a) b of the other.

    The rest of (1 - a) b is that of a product with 1 - a: as a difference it would grow.

    Parameters
    ----------
    n : int
        Number of variables.
    a : ndarray, shape (width,)
        A model of a share in [0, 1].
    b : ndarray, shape (width,)
        A model; is replaced by (1 - a) b.
    up : ndarray, shape (width,)
        Is increased by a b, and closed.
    work : ndarray, shape (width,)
        Scratch.
    """
    clear(work)
    add_product(n, 1.0, a, b, work)
    rest = (
        work[REST]
        - a[VALUE] * b[REST]
        + (abs(1.0 - a[VALUE]) + ERROR * (1.0 + abs(a[VALUE]))) * b[REST]
    )
    rest = max(rest, 0.0) * GROW + ERROR * size_of(b) * (1.0 + size_of(a))
    for i in range(len(a)):
        up[i] += work[i]
        b[i] -= work[i]
    b[REST] = rest
    close(n, up)
    close(n, b)


@compiled
def fourth_order(n: int, a: Any, b: Any, work: Any) -> float:
    """Bound the terms of fourth order of sum_l a_l b_l; what cancels in the sum over l does not count.

    Parameters
    ----------
    n : int
        Number of variables.
    a, b : ndarray, shape (m, width)
        Models; ``add_terms`` of the same models charges the rounding.
    work : ndarray, shape (width,)
        Scratch.

    Returns
    -------
    float
        The bound, up to a factor GROW.
    """
    square, cube, width = SLOPES + n, SLOPES + n + (n * (n + 1)) // 2, a.shape[1]
    total = 0.0
    for side in range(3):  # linear times cubic, square times square, cubic times linear
        lo, hi = (SLOPES, square) if side == 0 else (square, cube) if side == 1 else (cube, width)
        at, end = (cube, width) if side == 0 else (square, cube) if side == 1 else (SLOPES, square)
        for q in range(lo, hi):
            for i in range(end - at):
                work[i] = 0.0
            for col in range(len(a)):
                k = a[col, q]
                for i in range(end - at):
                    work[i] += k * b[col, at + i]
            total += sum_of_sizes(work, 0, end - at)
    return total


@compiled
def quotient(n: int, a: Any, b: Any, out: Any) -> bool:
    """Divide two linear models.

    With v = a0 / b0, y = (a - v b) / b0 and x = (b - b0) / b0:

        a / b = v + y (1 - x + x^2 - x^3 / (1 + x)).

    Parameters
    ----------
    n : int
        Number of variables.
    a, b : ndarray, shape (width,)
        Models with Q = C = 0; b is positive in the middle.
    out : ndarray, shape (width,)
        Is filled.

    Returns
    -------
    bool
        False if b may vanish.
    """
    b0 = b[VALUE]
    v = a[VALUE] / b0
    least = (b0 - (b[LINEAR] + b[REST]) * GROW) * (1.0 - 2.0**-50)
    if not least > 0.0:
        return False
    out[VALUE] = v
    linear = 0.0
    for q in range(SLOPES, SLOPES + n):
        out[q] = (a[q] - v * b[q]) / b0
        linear += abs(out[q])
    i = SLOPES + n
    for q in range(SLOPES, SLOPES + n):  # - y x
        yq, xq = out[q], b[q] / b0
        out[i] = -yq * xq
        i += 1
        for r in range(q + 1, SLOPES + n):
            out[i] = -(yq * b[r] + out[r] * b[q]) / b0
            i += 1
    for q in range(SLOPES, SLOPES + n):  # y x^2
        xq, yq = b[q] / b0, out[q]
        for r in range(q, SLOPES + n):
            xr, yr = b[r] / b0, out[r]
            for s in range(r, SLOPES + n):
                xs, ys = b[s] / b0, out[s]
                if q == s:
                    out[i] = yq * xq * xq
                elif q == r:
                    out[i] = ys * xq * xq + 2.0 * yq * xq * xs
                elif r == s:
                    out[i] = yq * xr * xr + 2.0 * yr * xq * xr
                else:
                    out[i] = 2.0 * (yq * xr * xs + yr * xq * xs + ys * xq * xr)
                i += 1
    x, z = b[LINEAR] / b0, (b[LINEAR] + b[REST]) / b0
    lost = a[REST] + abs(v) * b[REST] + ERROR * (size_of(a) + abs(v) * size_of(b))
    out[REST] = (
        linear * (z * z * z * (b0 / least) + b[REST] / b0 * (1.0 + 2.0 * z))
        + lost / least
        + ERROR * (abs(v) + linear * (1.0 + x) * (1.0 + x))
    )
    close(n, out)
    return True
