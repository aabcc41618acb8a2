"""What a zone at each inner waypoint saves on every arm: motions and bounds of both tasks, by zone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.report.style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, styled
from compare.screen import table
from compare.studies.study import Call, Study
from formulations import Conditions, Problem, load
from formulations.costs.demand_costs import SolvedTask, solved

_MARKS = ((BLUE, "o"), (ORANGE, "s"), (GREEN, "D"), (VERMILION, "^"), (PURPLE, "v"), (GREY, "X"))


@dataclass(frozen=True)
class ZoneSaving:
    """What zones of one size save on one arm.

    case: its name. zone: to either side of every joint [rad]. exact, seconds: the fastest motions without
    and with zones, bound: what no motion with zones beats [s]. saved: by the motions, least and greatest:
    what is proved [s].
    """

    case: str
    zone: float
    exact: float
    seconds: float
    bound: float
    saved: float
    least: float
    greatest: float


def savings(problem: Problem, zones: Sequence[float]) -> list[ZoneSaving]:
    """Solve a problem through its inner waypoints, and within zones around them.

    Parameters
    ----------
    problem : Problem
    zones : sequence of float [rad]
        Sizes of the zones.

    Returns
    -------
    list of ZoneSaving
        A row per size.
    """
    exact = _solved(problem)
    rows = []
    for zone in zones:
        inner = range(1, problem.n_segments)
        asked = Conditions(tolerance={k: np.full(problem.dof, zone) for k in inner})
        within = _solved(replace(problem, conditions=asked))
        rows.append(ZoneSaving(problem.name, zone, exact.motion, *within, *exact.over(within)))
    return rows


def _solved(problem: Problem) -> SolvedTask:
    found = solved(problem)
    assert found is not None  # there is no time limit
    return found


def calls(cases: Iterable[str], zones: Sequence[float]) -> list[Call]:
    """List the calls of the study, one per arm.

    Parameters
    ----------
    cases : iterable of str
    zones : sequence of float [rad]

    Returns
    -------
    list of tuples
        Arguments of ``savings``.
    """
    return [(load(case), tuple(zones)) for case in cases]


def summarise(rows: list[ZoneSaving]) -> list[dict[str, Any]]:
    """Return all rows as plain data.

    Parameters
    ----------
    rows : list of ZoneSaving

    Returns
    -------
    list of dict
    """
    return [asdict(row) for row in rows]


def as_text(rows: list[ZoneSaving], summary: list[dict[str, Any]]) -> str:
    """Lay the rows out as a table.

    Parameters
    ----------
    rows : list of ZoneSaving
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    str
    """
    head = ["arm", "zone [rad]", "through the points [s]", "with zones [s]", "saved [s]", "proved [s]"]
    lines = [
        [
            row.case, f"{row.zone:g}", f"{row.exact:.5f}", f"{row.seconds:.5f}", f"{row.saved:.5f}",
            f"{row.least:.5f} to {row.greatest:.5f}",
        ]
        for row in rows
    ]  # fmt: skip
    return table(head, lines, right=(1, 2, 3, 4, 5))


@styled
def figure(rows: list[ZoneSaving], summary: list[dict[str, Any]]) -> Figure:
    """Draw the seconds saved against the size of the zones, a line per arm.

    Parameters
    ----------
    rows : list of ZoneSaving
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    Figure
    """
    drawn, axes = plt.subplots(figsize=(7.0, 3.6))
    for case, (colour, mark) in zip(dict.fromkeys(row.case for row in rows), _MARKS * 9, strict=False):
        mine = [row for row in rows if row.case == case]
        # no zone saves nothing
        saved = np.array([0.0, *(row.saved for row in mine)])
        proved = np.array([[0.0, *(row.least for row in mine)], [0.0, *(row.greatest for row in mine)]])
        axes.errorbar(
            [0.0, *(row.zone for row in mine)], saved, yerr=np.abs(proved - saved), color=colour, marker=mark,
            ms=5, capsize=3, label=case,
        )  # fmt: skip
    axes.set_xlim(left=0.0)
    axes.set_xlabel("zone to either side of every joint at each inner waypoint [rad]")
    axes.set_ylabel("saved [s]")
    axes.set_ylim(bottom=min(0.0, *(row.least for row in rows), 0.0))
    axes.legend(frameon=False, fontsize=8)
    return drawn


STUDY = Study(
    name="zones",
    row=ZoneSaving,
    compute=savings,
    summarise=summarise,
    text=as_text,
    figure=figure,
)
