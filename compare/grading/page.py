"""The page of a grading: one verdict in its first sentence, and what it rests on."""

from __future__ import annotations

import math
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt

from compare.files import write_text
from compare.grading import contest
from compare.grading.figures import FIGURES
from compare.grading.grading import Grading
from compare.grading.reasons import telling
from compare.grading.standing import TARGET
from compare.grading.words import p_text, seeds_sentence
from compare.report.frame import TABLES, environment
from compare.report.words import percent
from compare.screen import table


def write_page(found: Grading, folder: Path, name: str) -> Path:
    """Draw the pictures and write the page.

    Parameters
    ----------
    found : Grading
    folder : Path
        Where it goes; the pictures go to its folder ``figures``.
    name : str
        Name of the page without its ending.

    Returns
    -------
    Path
        The page, one file that needs no other.
    """
    mpl.use("Agg")
    (folder / "figures").mkdir(exist_ok=True)
    for key, draw in FIGURES.items():
        figure = draw(found)
        figure.savefig(folder / "figures" / f"{name}-{key}.svg", metadata={"Date": None})
        plt.close(figure)
    pages = environment(folder)
    pages.filters["p"] = p_text
    pages.filters["gap"] = _gap
    pages.filters["count"] = lambda value: f"{value:,.0f}" if math.isfinite(value) else "never"
    row = next(iter(found.cells.values())).rows[0]
    text = pages.get_template("grade.html.j2").render(
        found=found,
        name=name,
        wins=found.contest.counts,
        needed=seeds_sentence(found.contest),
        telling=telling(found.reasons),
        rule=(contest.__doc__ or "").partition("The rule.")[2].strip().split("\n\n"),
        target=percent(TARGET),
        row=row,
        scripts=TABLES,
    )
    page = folder / f"{name}.html"
    write_text(page, text)
    return page


def as_text(found: Grading) -> str:
    """Return the verdict and the standing for the terminal.

    Parameters
    ----------
    found : Grading

    Returns
    -------
    str
    """
    header = ["swarm", "rank", "median gap", "within 0.1 %", "A12", "p (Holm)", "us/evaluation"]
    lines = [
        [
            place.swarm,
            f"{place.rank:.2f}",
            _gap(place.gap),
            f"{100 * place.success.rate:.0f} %",
            "" if place.a12 is None else f"{place.a12:.2f}",
            "" if place.p is None else p_text(place.p),
            f"{place.own:.1f} + {place.objective:.1f}",
        ]
        for place in found.standing.places
    ]
    parts = [found.sentence, "", table(header, lines, right=range(1, len(header)))]
    parts += ["", f"A12: probability that a run of {found.called} beats one of that swarm."]
    if found.zero is not None:
        parts.append(found.zero.sentence)
    parts += [reason.sentence for reason in telling(found.reasons)]
    parts += [
        f"{f.count} runs of {f.swarm} failed: {f.status}, first on {f.first}"
        + (f": {f.note}" * bool(f.note))
        for f in found.failures
    ]
    return "\n".join(parts)


def _gap(gap: float) -> str:
    """A gap in per cent; none for a miss."""
    return percent(max(gap, 0.0)) if math.isfinite(gap) else "none"
