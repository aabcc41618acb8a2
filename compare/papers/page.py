"""The page of one paper, DIR/papers/KEY.html, made from the stored items alone."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from compare.audit.paper import load_papers
from compare.files import write_text
from compare.papers.item import Item, ItemVerdict, Table
from compare.papers.shelf import DIED, FAILED, MISSING, OK, Made, kept
from compare.papers.verdicts import Reproduction
from compare.papers.words import result
from compare.report.frame import TABLES, environment
from compare.report.style import STYLE

MEANINGS = {
    FAILED: "failed",
    MISSING: "not made yet: timebound papers makes it",
    DIED: "its process died",
}
MARKS = {
    Reproduction.REPRODUCED: "✓",
    Reproduction.IN_KIND: "≈",
    Reproduction.NOT: "✕",
    Reproduction.UNDECIDED: "?",
}
"""Beside the words of each outcome, so that it does not rest on colour."""


@dataclass(frozen=True)
class Entry:
    """An item ready for the page; parts are tables, and pictures as data: URIs."""

    item: Item
    made: Made | None
    status: str
    note: str
    parts: Sequence[Table | str]
    remarks: Sequence[str]
    verdicts: Sequence[ItemVerdict]

    @property
    def alt(self) -> str:
        """What its pictures show: the first verdict, then the sentence that gives its numbers."""
        found = [f"{v.outcome}: {v.what}." for v in self.verdicts[:1]]
        return " ".join([f"{self.item.label}, {self.item.title}.", *found, *self.remarks[:1]])


@dataclass(frozen=True)
class Chapter:
    """What a page says, for those who have written it.

    Attributes
    ----------
    key : str
        Case of the paper.
    faults : dict
        By label, what is wrong with an item.
    verdicts : dict
        By label, the verdicts of each item that is made.
    """

    key: str
    faults: dict[str, str]
    verdicts: dict[str, Sequence[ItemVerdict]]


def render(folder: str, key: str, items: Sequence[Item], pages: Sequence[str] = ()) -> Chapter:
    """Write the page of a paper.

    Parameters
    ----------
    folder : str
        Of the report.
    key : str
        Case of the paper (sr4c); names the page.
    items : sequence of Item
        In the order of the page.
    pages : sequence of str
        Cases of the papers that have a page, too; links lead there.

    Returns
    -------
    Chapter
    """
    mpl.use("Agg")  # a worker has no screen
    entries = [_entry(Path(folder), key, item) for item in items]
    paper = load_papers(key)[0]
    made = [entry.made for entry in entries if entry.made is not None]
    verdicts = {entry.item.label: entry.verdicts for entry in entries if entry.status == OK}
    context: dict[str, Any] = {
        "key": key,
        "paper": paper,
        "result": result(verdicts),
        "entries": entries,
        "others": {page: load_papers(page)[0].author_year for page in pages if page != key},
        "marks": MARKS,
        "order": list(Reproduction),
        "meanings": MEANINGS,
        "ok": OK,
        "is_table": lambda part: isinstance(part, Table),
        "machines": sorted({m.machine for m in made}),
        "versions": sorted({m.versions for m in made}),
        "seconds": sum(m.seconds for m in made),
        "report": (Path(folder) / "index.html").exists(),
        "scripts": TABLES,
    }
    path = Path(folder) / "papers" / f"{key}.html"
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, environment(Path(folder)).get_template("paper.html.j2").render(context))
    faults = {e.item.label: f"{e.status}: {e.note}" for e in entries if e.status != OK}
    return Chapter(key, faults, verdicts)


def _entry(folder: Path, key: str, item: Item) -> Entry:
    made = kept(folder, key, item)
    if made is None:
        return Entry(item, None, MISSING, "", (), (), ())
    if made.status != OK or made.data is None:
        return Entry(item, made, made.status, made.note, (), (), ())
    try:
        with mpl.rc_context(STYLE):
            shown = item.show(made.data)
            parts = [_svg(part) if isinstance(part, Figure) else part for part in shown.parts]
    except Exception as error:  # one faulty item must not cost the others their page
        plt.close("all")
        return Entry(
            item, made, FAILED, f"cannot be shown: {type(error).__name__}: {error}", (), (), ()
        )
    return Entry(item, made, OK, "", parts, shown.remarks, shown.verdicts)


def _svg(figure: Figure) -> str:
    """Encode a picture as a data: URI and close it."""
    text = io.BytesIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    plt.close(figure)
    return "data:image/svg+xml;base64," + base64.b64encode(text.getvalue()).decode()
