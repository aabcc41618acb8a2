"""Lu 2024, Fig. 1: the chaotic start of the population (eq. 23)."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from scipy.stats import qmc

from compare.audit.paper import settings
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import held
from compare.papers.words import percent
from compare.report.style import BLUE, VERMILION, styled
from formulations.problem.arrays import Array
from metaheuristics.swarms.tent import tent_map

_STARTS = {False: 2000, True: 20_000}  # populations whose evenness is compared


def orbit(start: Array, n: int, beta: float) -> Array:
    """Follow the orbit of each start (eq. 23).

    Parameters
    ----------
    start : Array, shape (m,)
        In [0, 1].
    n : int
        Number of states.
    beta : float
        Peak of the map.

    Returns
    -------
    Array, shape (n, m)
        The first row is one map after the start.
    """
    states = np.empty((n, len(start)))
    for row in states:
        row[:] = start = tent_map(start, beta)
    return states


def per_coordinate(rng: np.random.Generator, n: int, dim: int, beta: float) -> Array:
    """Make a population from an orbit of its own for each coordinate.

    Parameters
    ----------
    rng : numpy.random.Generator
        Draws the starts.
    n, dim : int
        Shape of the population.
    beta : float
        Peak of the map.

    Returns
    -------
    Array, shape (n, dim)
        In [0, 1].
    """
    return orbit(rng.random(dim), n, beta)


def one_orbit(rng: np.random.Generator, n: int, dim: int, beta: float) -> Array:
    """Make a population from one orbit that runs through all numbers, whale by whale.

    Parameters
    ----------
    rng : numpy.random.Generator
        Draws the start.
    n, dim : int
        Shape of the population.
    beta : float
        Peak of the map.

    Returns
    -------
    Array, shape (n, dim)
        In [0, 1].
    """
    return orbit(rng.random(1), n * dim, beta).reshape(n, dim)


READINGS = {
    "an orbit per coordinate, beta 0.5": (per_coordinate, 0.5),
    "an orbit per coordinate, beta 0.499": (per_coordinate, 0.499),
    "one orbit through all numbers, beta 0.5": (one_orbit, 0.5),
}
_PLAIN = "uniform random numbers"


def make_chaos(full: bool) -> dict[str, Any]:
    """Draw a population by each reading, and measure how even many of them are."""
    setup = settings("z1")["chaos"]
    n, dim = setup["population"], setup["dimensions"]
    starts = _STARTS[full]

    def draw(name: str, rng: np.random.Generator, size: int = n) -> Array:
        if name == _PLAIN:
            return rng.random((size, dim))
        way, beta = READINGS[name]
        return way(rng, size, dim, beta)

    found = {}
    for name in (*READINGS, _PLAIN):
        rng = np.random.default_rng(0)
        many = [draw(name, rng) for _ in range(starts)]
        spread = [qmc.discrepancy(x) for x in many]
        low = setup["low"]
        found[name] = {
            "points": (low + many[0] * (setup["high"] - low)).tolist(),
            "discrepancy": np.quantile(spread, [0.25, 0.5, 0.75]).tolist(),
            "zeros": float(np.mean([(x == 0.0).any(axis=1) for x in many])),
            "zeros_of_100": float((draw(name, rng, 100) == 0.0).all(axis=1).mean()),
        }
    return {"starts": starts, "found": found}


@styled
def chaos_figure(data: dict[str, Any]) -> Figure:
    """Draw a panel per reading."""
    setup, found = settings("z1")["chaos"], data["found"]
    figure, grid = plt.subplots(1, len(found), figsize=(11.0, 3.3), sharex=True, sharey=True)
    for axes, (name, entry) in zip(grid, found.items(), strict=True):
        points: Array = np.array(entry["points"])
        colour = VERMILION if name == _PLAIN else BLUE
        axes.plot(*points.T, "o", ms=4, color=colour, ls="")
        axes.set_title(name.replace(", ", ",\n").replace(" numbers", "\nnumbers" * (name == _PLAIN)),
                       loc="left", fontsize=8.5)  # fmt: skip
        axes.set_aspect("equal")
        axes.set_xlim(setup["low"] - 0.15, setup["high"] + 0.15)
        axes.set_ylim(setup["low"] - 0.15, setup["high"] + 0.15)
        axes.set_xlabel("x [s]")
    grid[0].set_ylabel("y [s]")
    return figure


def show_chaos(data: dict[str, Any]) -> Shown:
    """Show the populations, and how even they are."""
    rows = [
        [name, *(f"{q:.4f}" for q in entry["discrepancy"]), f"{percent(entry['zeros'])}",
         f"{percent(entry['zeros_of_100'], 0)}"]
        for name, entry in data["found"].items()
    ]  # fmt: skip
    caption = (
        f"Squared centred L2 discrepancy (0 is perfectly even) of {data['starts']} populations of "
        f"{settings('z1')['chaos']['population']}; share of individuals with a coordinate that is exactly 0; "
        "share of individuals at the origin if there were 100."
    )
    header = ["start", "25 %", "median", "75 %", "on the edge at 0", "at the origin, of 100"]
    plain, chaotic, _, single = (data["found"][k]["discrepancy"][1] for k in (_PLAIN, *READINGS))
    low, _, high = data["found"][_PLAIN]["discrepancy"]
    half = data["found"]["an orbit per coordinate, beta 0.5"]
    more_even = held(chaotic < low)
    return Shown(
        [chaos_figure(data), Table(header, rows, caption, range(1, 6))],
        [
            f"That a chaotic start is more even than a random one is {more_even.inside}: its median "
            f"discrepancy is {chaotic:.4f}, that of random numbers is {plain:.4f}, and half of all random "
            f"starts lie between {low:.4f} and {high:.4f}.",
            "With one orbit through all numbers every individual lies on the graph of the map, two straight "
            + f"lines. The median discrepancy is {single:.4f}: "
            + (
                "more even than random numbers."
                if single < low
                else "not more even than random numbers."
            ),
            "At beta = 0.5, as printed, a double loses one bit at each step and any orbit ends in 0 after "
            "some "
            f"54 steps. Of 30 whales with an orbit per coordinate {percent(half['zeros'])} touch 0; of 100 "
            f"whales {percent(half['zeros_of_100'], 0)} would start at the origin. Beta = 0.499 does not end "
            "there.",
        ],
        [ItemVerdict("that a chaotic start is more even than a random one", more_even)],
    )


FIGURE_1 = Item(
    "Fig 1",
    "chaotic start of the population",
    make_chaos,
    show_chaos,
    "The paper does not say what the sequence of eq. 23 runs over: an orbit per coordinate over the whales, or "
    "one orbit over all numbers. At the printed beta = 0.5 the sequence ends in 0 in floating point.",
    cost=2.0,
)
