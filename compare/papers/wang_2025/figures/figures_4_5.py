"""Wang 2025, parts of its swarm: Fig. 4 (tent map, eq. 12) and Fig. 5 (learning factors, eq. 14).

The inertia of eq. 15, which the paper does not draw, stands beside Fig. 5.
"""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper import settings
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import held, more_often, seen_in_pairs, yes_no
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, styled
from formulations.problem.arrays import Array
from metaheuristics.swarms.mipso import learning_factors, printed_inertia, resolved_inertia
from metaheuristics.swarms.tent import tent_map

_STARTS = 1000  # populations whose evenness is compared


# --- Fig. 4 ---------------------------------------------------------------------------------------


def orbits(starts: Array, n: int, lam: float) -> Array:
    """Follow the tent orbit of each start (eq. 12).

    Parameters
    ----------
    starts : Array, shape (m,)
        In [0, 1].
    n : int
        Number of points.
    lam : float
        Peak of the map.

    Returns
    -------
    Array, shape (n, m)
        The first row is one map after the starts.
    """
    points = np.empty((n, len(starts)))
    state = starts
    for row in points:
        row[:] = state = tent_map(state, lam)
    return points


def counts(points: Array, bins: int) -> Array:
    """Count points in bins of equal width.

    Parameters
    ----------
    points : Array, shape (n, m)
        In [0, 1].
    bins : int
        Number of bins.

    Returns
    -------
    Array, shape (bins, m)
    """
    place = np.minimum((points * bins).astype(int), bins - 1)
    return np.stack([(place == b).sum(axis=0) for b in range(bins)])


def make_tent(full: bool) -> dict[str, Any]:
    """Make histograms of one start each, and the scatter of the counts over many starts."""
    printed = settings("sr4c")["tent"]
    n, bins, lam = printed["population"], printed["bins"], printed["alpha"]
    rng = np.random.default_rng(0)
    starts = rng.random(_STARTS)
    populations = {
        "tent map, one orbit": orbits(starts, n, lam),
        "random": rng.random((n, _STARTS)),
        "tent map, once on each": tent_map(rng.random((n, _STARTS)), lam),
    }
    found = {name: counts(points, bins) for name, points in populations.items()}
    collapsed = orbits(starts, n, 0.5)
    return {
        "particles": n, "bins": bins, "alpha": lam, "starts": _STARTS,
        "counts": {name: c[:, 0].tolist() for name, c in found.items()},
        "scatter": {name: np.quantile(c.std(axis=0), [0.25, 0.5, 0.75]).tolist() for name, c in found.items()},
        "pairs": _pairs(*(found[name].std(axis=0) for name in list(found)[:2])),
        "expected": float(np.sqrt(n / bins * (1.0 - 1.0 / bins))),
        "zeros": float((collapsed == 0.0).mean()),
    }  # fmt: skip


def _pairs(tent: Array, random: Array) -> float:
    """Share of pairs in which the first is smaller; equal pairs count half."""
    return float((tent < random).mean() + 0.5 * (tent == random).mean())


def show_tent(data: dict[str, Any]) -> Shown:
    """Show the histograms, and whether one population is more even than the other."""
    names = list(data["counts"])
    caption = (
        f"Standard deviation of the {data['bins']} counts (0 is perfectly even), quartiles over "
        f"{data['starts']} populations of {data['particles']}."
    )
    rows = [[name, *(f"{q:.2f}" for q in data["scatter"][name])] for name in names]
    table = Table(
        ["population", "lower quartile", "median", "upper quartile"], rows, caption, (1, 2, 3)
    )
    tent, random, once = (data["scatter"][name][1] for name in names)
    quarter_random, quarter_orbit = data["scatter"][names[1]][0], data["scatter"][names[0]][2]
    clear = quarter_random > quarter_orbit
    outcome = seen_in_pairs(data["pairs"], data["starts"], clear=clear)
    remarks = [
        "The paper shows the population of the tent map as the more even one. "
        f"{outcome}: of "
        f"{data['starts']} pairs of populations it is the more even one in {100 * data['pairs']:.0f} %, "
        f"{more_often(data['pairs'], data['starts'])} than the random one (50 % is no difference). The median "
        f"scatter is {tent:.2f} against {random:.2f}; independent numbers have about {data['expected']:.2f}.",
        f"A quarter of the random populations scatters by less than {quarter_random:.2f}, a quarter of the "
        f"orbits by more than {quarter_orbit:.2f}: a single pair of histograms, as printed, "
        + ("is enough to tell them apart in most cases." if clear else "decides nothing."),
        f"The other reading maps each random number once and scatters by {once:.2f}: uniform numbers stay "
        "uniform.",
        f"With the peak at 0.5 instead of {data['alpha']}, {100 * data['zeros']:.0f} % of the points are 0 in "
        "double precision, since the orbit loses one bit at each step.",
    ]
    verdict = ItemVerdict("that the tent map's population is the more even one", outcome)
    return Shown([tent_figure(data), table], remarks, [verdict])


@styled
def tent_figure(data: dict[str, Any]) -> Figure:
    """Draw the counts of one population each, and the even count."""
    figure, panels = plt.subplots(1, 3, figsize=(9.6, 2.7), sharey=True)
    edges = np.linspace(0.0, 1.0, data["bins"] + 1)
    even = data["particles"] / data["bins"]
    colours = (BLUE, ORANGE, GREEN)
    for axes, (name, found), colour in zip(panels, data["counts"].items(), colours, strict=True):
        axes.bar(
            edges[:-1], found, width=np.diff(edges), align="edge", color=colour, ec="white", lw=1.2
        )
        axes.axhline(even, color=BLACK, lw=0.9, ls="--")
        axes.set_title(f"{name}, seed 0", loc="left")
        axes.set_xlabel("position in the box [1]")
        axes.set_xlim(0.0, 1.0)
    top = max(max(found) for found in data["counts"].values())
    panels[0].set_ylim(0.0, 1.18 * top)
    panels[0].set_ylabel("particles [1]")
    panels[0].text(0.02, 1.1 * top, f"dashed: even, {even:g}", fontsize=8)
    return figure


# --- Fig. 5 ---------------------------------------------------------------------------------------


def make_factors(full: bool) -> dict[str, Any]:
    """Compute learning factors and inertia, printed and resolved, at every iteration."""
    last = settings("sr4c")["swarm"]["iterations"]
    high, low = settings("sr4c")["swarm"]["inertia"]
    k = np.arange(last + 1) / last
    return {
        "iterations": last,
        "inertia": [high, low],
        "c1": [learning_factors(x)[0] for x in k],
        "c2": [learning_factors(x)[1] for x in k],
        "w_printed": [printed_inertia(x, high, low) for x in k],
        "w_resolved": [resolved_inertia(x, high, low) for x in k],
    }


def show_factors(data: dict[str, Any]) -> Shown:
    """Show the curves, and what eq. 15 gives as it is printed."""
    c1, c2 = np.array(data["c1"]), np.array(data["c2"])
    w, resolved = data["w_printed"], data["w_resolved"]
    high, low = data["inertia"]
    cross = float(np.interp(0.0, c2 - c1, np.arange(len(c1))))
    shape = bool((np.diff(c1) <= 0.0).all() and (np.diff(c2) >= 0.0).all())
    falls = bool((np.diff(w) <= 0.0).all() and low <= min(w) and max(w) <= high)
    steps = -np.diff(resolved)
    slow_then_fast = bool((steps >= 0.0).all() and steps[: len(steps) // 2].sum() < 0.5 * steps.sum())
    remarks = [
        f"c1 goes from {c1[0]:g} to {c1[-1]:.0f} and c2 from {c2[0]:g} to {c2[-1]:g}; both are 1 at iteration "
        f"{cross:.1f} of {data['iterations']}. c1 falls and c2 rises, as the figure shows: "
        f"{yes_no(shape)}.",
        f"Eq. 15 as printed {'does' if falls else 'does not do'} what the text says, a fall from {high:g} to "
        f"{low:g} that is slow first and fast then: w starts at {w[0]:.3f}, is negative until iteration "
        f"{int(np.argmax(np.array(w) >= 0))} and ends at {w[-1]:g}.",
        f"Resolved, with k_max/k instead of the printed k/k_max, w goes from {resolved[0]:g} over "
        f"{resolved[len(w) // 2]:.3f} half way to {resolved[-1]:g}; this falls "
        f"{'slowly first and fast then' if slow_then_fast else 'in another way than the text says'}.",
    ]
    verdicts = [
        ItemVerdict("that c1 falls and c2 rises", held(shape)),
        ItemVerdict("that the inertia of eq. 15 falls, as printed", held(falls)),
        ItemVerdict("that it falls slowly first and fast then, with k_max/k", held(slow_then_fast)),
    ]
    return Shown([factors_figure(data)], remarks, verdicts)


@styled
def factors_figure(data: dict[str, Any]) -> Figure:
    """Draw learning factors on the left, both readings of the inertia on the right."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.0))
    k = np.arange(data["iterations"] + 1)
    left.plot(k, data["c1"], color=BLUE, label="c1, own best")
    left.plot(k, data["c2"], color=ORANGE, ls="--", label="c2, best of all")
    left.set_title("learning factors, eq. 14", loc="left")
    left.set_ylabel("factor [1]")
    left.set_ylim(-0.1, 2.6)
    right.plot(k, data["w_resolved"], color=BLUE, label="as the text wants it")
    right.plot(k, data["w_printed"], color=VERMILION, ls="--", label="as printed")
    for limit in data["inertia"]:
        right.axhline(limit, color=GREY, lw=0.8, ls=":")
    right.set_title("inertia, eq. 15", loc="left")
    right.set_ylabel("w [1]")
    right.set_ylim(-0.6, 1.35)
    for axes in (left, right):
        axes.set_xlabel("iteration [1]")
        axes.set_xlim(0, k[-1])
        axes.legend(frameon=False, ncols=2, loc="upper center", fontsize=8)
    return figure


FIGURE_4 = Item(
    "Fig 4",
    "populations by tent map and by random numbers",
    make_tent,
    show_tent,
    "The paper does not say what the sequence of eq. 12 runs over. One orbit over the particles, from a "
    "random state, is taken; the other reading maps each random number once.",
    cost=1.0,
)
FIGURE_5 = Item(
    "Fig 5",
    "learning factors over the iterations",
    make_factors,
    show_factors,
    "Drawn for the 50 iterations of Table 7. The inertia of eq. 15, which the paper does not draw, is added.",
    cost=0.1,
)
