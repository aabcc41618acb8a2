"""Where the time of one swarm's motion goes, from the proved bound upwards."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row
from compare.report.figures.case import splits_of
from compare.studies.time_split import MEANINGS
from formulations import Problem


def split_chart(problem: Problem, ladder: LadderRecord, rows: Sequence[Row]) -> dict[str, Any]:
    """Return a bar per variant of a coding.

    Parameters
    ----------
    problem : Problem
    ladder : LadderRecord
    rows : sequence of Row
        Of this problem.

    Returns
    -------
    dict
        ``bars``: name, and where each share begins and ends [s], the proved bound first; ``meanings`` of the
        shares.
    """
    if not rows:
        return {"bars": [], "meanings": {}, "alt": "No run."}
    swarm, splits = splits_of(problem, ladder, rows)
    bars = [
        {
            "name": f"{swarm}, {variant}",
            "shares": {
                "bound": [0.0, shares[0].low],
                **{share.name: [share.low, share.high] for share in shares},
            },
        }
        for variant, shares in splits.items()
    ]
    said = []
    for variant, shares in splits.items():
        largest = max(shares, key=lambda share: share.seconds)
        said.append(f"{variant}: {shares[-1].high:.4f} s, most of it above the bound by {largest.name}")
    return {
        "bars": bars,
        "meanings": {"bound": "no motion is faster (proved)", **MEANINGS},
        "alt": f"Median motion of {swarm}. {'; '.join(said)}.",
    }
