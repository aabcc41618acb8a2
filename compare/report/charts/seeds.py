"""The gap of every run: a lane per swarm and variant of a coding, a mark per seed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from compare.benchmark.records.rows import Row
from compare.benchmark.summaries import by_variant_and_swarm, gaps_of, median
from compare.report.words import percent


def seeds_chart(rows: Sequence[Row]) -> dict[str, Any]:
    """Return the gap of every run of one problem.

    Parameters
    ----------
    rows : sequence of Row

    Returns
    -------
    dict
        ``swarms``, in the order of the rows, and ``lanes``: of each variant and swarm the seeds, gaps [1]
        (None without a verified motion) and whether the claimed motion keeps its limits.
    """
    groups = by_variant_and_swarm(rows)
    lanes = [
        {
            "variant": variant,
            "swarm": swarm,
            "seed": [row.seed for row in mine],
            "gap": [row.gap for row in mine],
            "keeps": [bool(row.keeps_limits) for row in mine],
        }
        for (variant, swarm), mine in groups.items()
    ]
    middles = {key: median(gaps_of(mine)) for key, mine in groups.items()}
    found = {key: gap for key, gap in middles.items() if gap is not None}
    alt = "No run has a verified motion."
    if found:
        best, worst = min(found, key=lambda key: found[key]), max(found, key=lambda key: found[key])
        alt = (
            f"Median gaps reach from {percent(found[best])} ({best[1]}, {best[0]} coding) to "
            f"{percent(found[worst])} ({worst[1]}, {worst[0]})."
        )
    return {"swarms": list(dict.fromkeys(row.swarm for row in rows)), "lanes": lanes, "alt": alt}
