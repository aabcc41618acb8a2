"""A study beside the main comparison: rows as they end, a summary, a picture in the report's folder."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any, TypeVar

import matplotlib as mpl
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from compare.benchmark.run import each, machine, versions_text
from compare.commands import shared as commands

Row = TypeVar("Row")

# studies that the report shows if they are there: title, what the picture says
STUDIES = {
    "proofs": (
        "What a proof costs",
        "Random problems, proved one by one by <code>python -m compare.proofs</code>.",
    ),
    "bias": (
        "Who is drawn to zero",
        "How much worse each swarm does when the optimum is moved away from x = 0, or the coordinates"
        " are: median error there over median error here; 1 is unbiased"
        " (<code>python -m compare.bias</code>).",
    ),
    "table8": (
        "Table 8 of paper 000, run again",
        "Joint 1 of the SR4C alone, 50 particles, 50 iterations: every run, the printed values, and the"
        " certified bound that none can beat (<code>python -m compare.table8</code>).",
    ),
    "ablation": (
        "The ablation of paper 000, run again",
        "Factor by which the mean best fitness grows without one strategy, beside the printed one"
        " (<code>python -m compare.ablation</code>).",
    ),
    "readings": (
        "As printed, and as it can be meant",
        "Gap in the stretched coding for each reading of what a paper leaves open"
        " (<code>python -m compare.readings</code>).",
    ),
}


def collect(
    pool: ProcessPoolExecutor,
    folder: Path,
    name: str,
    function: Callable[..., Iterable[Row]],
    calls: Sequence[tuple[Any, ...]],
    columns: Sequence[str],
) -> list[Row]:
    """Rows (dataclasses) of ``function(*call)``, written to DIR/NAME.csv as they end."""
    rows: list[Row] = []
    with (folder / f"{name}.csv").open("w", newline="", encoding="utf-8") as lines:
        writer = csv.DictWriter(lines, columns)
        writer.writeheader()
        for found in each(pool, name, function, calls):
            batch = list(found)
            writer.writerows(asdict(row) for row in batch)  # type: ignore[call-overload]
            lines.flush()
            rows += batch
    return rows


def finish(folder: Path, name: str, summary: Any, figure: Figure) -> None:
    """Write DIR/NAME.json with machine and versions, and the picture as SVG and PNG."""
    facts = {"summary": summary, "machine": machine(), "versions": versions_text()}
    commands.write_json(folder / f"{name}.json", facts)
    mpl.use("Agg")
    (folder / "figures").mkdir(exist_ok=True)
    figure.savefig(folder / "figures" / f"{name}.svg", metadata={"Date": None})
    figure.savefig(folder / "figures" / f"{name}.png")
    plt.close(figure)
