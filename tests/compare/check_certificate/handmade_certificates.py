"""Certificates under demands from linear programs over the rows of the oracle."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from relaxation_oracle import Key, Oracle
from scipy.optimize import linprog
from scipy.sparse import diags, hstack, lil_array


def rows_everywhere(oracle: Oracle, rng: np.random.Generator, many: int = 30) -> list[list[Any]]:
    """Rows of every kind that is posed: the few kinds at all their places, the others at random ones."""
    rows: list[list[Any]] = [["h"]]
    for i in oracle.kept:
        early, late = oracle.demands["passages"][i]
        rows += [["b", i]] * bool(early > 0.0) + [["l", i]] * bool(np.isfinite(late))
    for p, i in oracle.after.items():
        rows += [["e", p, sign] for sign in (1, -1) if p not in oracle.ks]
        lo, hi = oracle.box["T", p]
        places = [float(t) for t in np.linspace(lo, hi, 12)]
        rows += [["S", p], *(["T", p, t] for t in places[1:]), *(["C", p, t] for t in places[::2])]
        if lo > 0.0:
            places = [float(t) for t in np.geomspace(lo, hi, 12)]
            rows += [["s", p], *(["t", p, t] for t in places), *(["c", p, t] for t in places[::2])]
        for j in range(oracle.dof):
            slopes = oracle.J_most[j] * np.linspace(-0.5, 0.5, 9) if oracle.jerky[j] else ()
            rows += [["j", j, p, sign] for sign in (1, -1) if oracle.jerky[j]]
            for end, at in ((0, oracle.start[p]), (1, i)):
                for kind, there in (
                    ("w", oracle.jerky[j]),
                    ("x", oracle.jerky[j]),
                    ("g", oracle.moves[j]),
                    ("m", oracle.w[at, j] > 0.0 and lo > 0.0),
                ):
                    rows += [[kind, j, p, end, corner] for corner in range(4) if there]
                for sign, c in product((-1, 1), map(float, slopes)):
                    if oracle.peak(at, j, sign * c > 0.0) is not None:
                        rows.append(["v", j, p, end, sign, c])
                        rows.append(["V", j, at, sign, sign * c])
    for _ in range(many * len(oracle.ks) * oracle.dof * 4):
        raw = oracle.random_row(rng)
        if raw is not None and raw[0] in "ardkRDK":
            rows.append(raw)
    return rows


def written(value: Any) -> Any:
    """Arrays as a certificate writes them: hexadecimal text, null for infinity."""
    if isinstance(value, bool):
        return value
    if isinstance(value, list | tuple | np.ndarray):
        return [written(x) for x in value]
    return float(value).hex() if np.isfinite(value) else None


def certificate(
    demands: dict[str, Any],
    seconds: float,
    horizon: float,
    events: list[Any],
    without: frozenset[int] = frozenset(),
) -> dict[str, Any]:
    """A certificate as a file holds it."""
    x = np.array(demands["waypoints"])
    middle = np.clip(x.mean(axis=2), x[..., 0], x[..., 1])
    V, A = (np.abs(demands[key]).max(axis=(0, 2)) for key in ("velocity", "acceleration"))
    J = np.max(demands["jerk"], axis=0)
    position = np.stack(
        [demands["position"][..., 0].min(axis=0), demands["position"][..., 1].max(axis=0)], axis=1
    )
    limits = {"velocity": V, "acceleration": A, "jerk": J, "position": position}
    return {
        "format": "timebound certificate 1",
        "name": "random",
        "family": "every-motion",
        "waypoints": written(middle),
        "limits": {key: written(value) for key, value in limits.items()},
        "position_slack": (0.0).hex(),
        "seconds": float(seconds).hex(),
        "horizon": float(horizon).hex(),
        "demands": {key: written(value) for key, value in demands.items()},
        "without": sorted(without),
        "events": events,
    }


def with_multiplier(raw: list[Any], y: float) -> list[Any]:
    """A row as a certificate writes it."""
    texts = (list(x) if isinstance(x, tuple) else x.hex() if isinstance(x, float) else x for x in raw)
    return [*texts, float(y).hex()]


def solved(oracle: Oracle, raws: list[Any], cost: dict[Key, float] | None = None) -> Any:
    """What multipliers prove of a cost, and the rows with them; the time is the default."""
    cost = {("T", p): 1.0 for p in oracle.ks} if cost is None else cost
    A, b, keys = _program(oracle, raws)
    c = np.array([cost.get(key, 0.0) for key in keys])
    found = linprog(c, A_ub=A, b_ub=b, bounds=[oracle.box[key] for key in keys], method="highs")
    assert found.status == 0, found.message
    y = np.maximum(-found.ineqlin.marginals, 0.0)
    shares = np.array([oracle.box[key] for key in keys]) * (c + A.T @ y)[:, None]
    return shares.min(axis=1).sum() - b @ y, _multiplied(raws, found, np.ones(len(raws)))


def contradiction(oracle: Oracle, raws: list[Any]) -> Any:
    """The least excess at which all rows hold, relative to their terms, and what proves it."""
    A, b, keys = _program(oracle, raws)
    size = np.maximum(abs(A).max(axis=1).toarray().ravel(), 1e-9)
    A = hstack([diags(1.0 / size) @ A, -np.ones((len(raws), 1))])
    bounds = [*(oracle.box[key] for key in keys), (0.0, None)]
    found = linprog(np.eye(len(bounds))[-1], A_ub=A, b_ub=b / size, bounds=bounds, method="highs")
    assert found.status == 0, found.message
    return found.fun, _multiplied(raws, found, 1.0 / size)


def _program(oracle: Oracle, raws: list[Any]) -> Any:
    keys = {key: at for at, key in enumerate(oracle.box)}
    A, b = lil_array((len(raws), len(keys))), np.zeros(len(raws))
    for at, raw in enumerate(raws):
        row, b[at] = oracle.row(raw)
        for key, value in row.items():
            if value:
                A[at, keys[key]] = value
    return A.tocsr(), b, list(keys)


def _multiplied(raws: list[Any], found: Any, scale: Any) -> list[list[Any]]:
    y = np.maximum(-found.ineqlin.marginals, 0.0) * scale
    return [with_multiplier(raws[k], y[k]) for k in np.flatnonzero(y)]
