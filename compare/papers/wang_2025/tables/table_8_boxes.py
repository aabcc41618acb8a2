"""Wang 2025, Table 8 in other readings of the search box, which the paper does not print."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.papers.item import ItemVerdict, Table
from compare.papers.verdicts import Reproduction, same_gain
from compare.papers.wang_2025.joint_1 import IN_FORCE, RIVALS, TABLE_6, cells, repeat, statistics
from compare.papers.wang_2025.paper import SWARM, boxes, in_words
from compare.papers.words import above, listed, seconds


def make_boxes(runs: range) -> list[dict[str, Any]]:
    """Run MIPSO and its rivals in each other box, under both readings of the limits.

    Parameters
    ----------
    runs : range
        Seeds.

    Returns
    -------
    list of dict
        box [s], limit, swarm, and what ``statistics`` gives.
    """
    found = []
    for box in boxes().values():
        for limit in (IN_FORCE, TABLE_6):
            for swarm in (SWARM, *RIVALS):
                times = [r.seconds for r in repeat(limit, swarm, runs, box)]
                described = statistics(np.array(times, dtype=float))
                found.append({"box": list(box), "limit": limit, "swarm": swarm, **described})
    return found


def box_table(data: dict[str, Any]) -> Table:
    """Show the same runs in other readings of the search box.

    Parameters
    ----------
    data : dict
        Of ``make_table_8``.

    Returns
    -------
    Table
    """
    header = ["search box", "limit [deg/s²]", "swarm", "runs", "mean [s]", "95 % interval", "deviation",
              "best", "worst", "mean in the first box"]  # fmt: skip
    lines = []
    for entry in data["boxes"]:
        facts = data["summary"][entry["limit"]]
        lines.append([in_words(*entry["box"]), f"{facts['acceleration']:.0f}",
                      entry["swarm"], *cells(entry),
                      seconds(facts["swarms"][entry["swarm"]]["all"]["mean"])])  # fmt: skip
    caption = (
        "Other readings of the search box, from the least time of a segment in Tables 9 and 10: to the "
        "greatest time there, and, as for Li 2022, to the first plan. Half as many runs as above, where the "
        "box ends at 3 times the shortest plan of equal segments."
    )
    return Table(header, lines, caption, (1, 3, 4, 5, 6, 7, 8, 9))


def box_remarks(data: dict[str, Any], printed_means: dict[str, float]) -> list[str]:
    """Say what each other reading of the search box does to the means and to the gain.

    Parameters
    ----------
    data : dict
        Of ``make_table_8``.
    printed_means : dict
        Printed mean of each method [s].

    Returns
    -------
    list of str
    """
    remarks = []
    for (low, high, limit), swarms in _groups(data).items():
        facts, mean = data["summary"][limit], swarms[SWARM]["mean"]
        start = f"In a search box of {in_words(low, high)}, under {facts['acceleration']:.0f} deg/s²,"
        if mean is None or swarms["pso"]["mean"] is None:
            remarks.append(f"{start} no run of MIPSO or of PSO is feasible.")
            continue
        outcome = gain_over_pso(_means(swarms), printed_means)
        rivals = "; ".join(
            f"{swarms[swarm]['mean'] - mean:+.4f} s over {name}"
            for swarm, name in RIVALS.items()
            if swarms[swarm]["mean"] is not None
        )
        failed = [f"{e['unsolved']} of {name}" for name, e in swarms.items() if e["unsolved"]]
        remarks.append(
            f"{start} MIPSO takes {mean:.4f} s in the mean, {above(mean, facts['bound'])} against the bound; "
            f"its gain over PSO is {outcome.inside}: {rivals}."
            + (f" Without a feasible motion, and not in the means: {listed(failed)}." if failed else "")
        )
    return remarks


def box_verdicts(data: dict[str, Any], printed_means: dict[str, float]) -> list[ItemVerdict]:
    """Judge the printed gain over PSO in each other reading of the search box.

    Parameters
    ----------
    data : dict
        Of ``make_table_8``.
    printed_means : dict
        Printed mean of each method [s].

    Returns
    -------
    list of ItemVerdict
    """
    return [
        ItemVerdict(
            f"the gain of MIPSO over PSO, {data['summary'][limit]['acceleration']:.0f} deg/s², in a box of "
            f"{in_words(low, high)}",
            gain_over_pso(_means(swarms), printed_means),
        )
        for (low, high, limit), swarms in _groups(data).items()
    ]


def _groups(data: dict[str, Any]) -> dict[tuple[float, float, str], dict[str, Any]]:
    """Swarms by box [s] and limit."""
    groups: dict[tuple[float, float, str], dict[str, Any]] = {}
    for entry in data["boxes"]:
        groups.setdefault((*entry["box"], entry["limit"]), {})[entry["swarm"]] = entry
    return groups


def _means(swarms: dict[str, Any]) -> dict[str, float | None]:
    return {swarm: entry["mean"] for swarm, entry in swarms.items()}


def gain_over_pso(means: dict[str, float | None], printed_means: dict[str, float]) -> Reproduction:
    """Judge the printed gain of MIPSO over PSO.

    Parameters
    ----------
    means : dict
        Mean of each swarm [s]; None if it has no feasible run.
    printed_means : dict
        Printed mean of each method [s].

    Returns
    -------
    Reproduction
        Not decided where one of both has no feasible run.
    """
    mine, other = means[SWARM], means["pso"]
    if mine is None or other is None:
        return Reproduction.UNDECIDED
    return same_gain(1.0 - printed_means["MIPSO"] / printed_means["PSO"], 1.0 - mine / other)
