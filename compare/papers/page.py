"""The page of one paper, DIR/papers/KEY.html, made from the stored items alone."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import matplotlib as mpl
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from compare.audit.paper import load_papers
from compare.files import write_text
from compare.papers.item import Item, Table
from compare.papers.shelf import DIED, FAILED, MISSING, OK, Made, kept
from compare.report.style import STYLE

MEANINGS = {
    FAILED: "failed",
    MISSING: "not made yet: timebound papers makes it",
    DIED: "its process died",
}


@dataclass(frozen=True)
class Entry:
    """An item ready for the page; parts are tables, and pictures as data: URIs."""

    item: Item
    made: Made | None
    status: str
    note: str
    parts: Sequence[Table | str]
    remarks: Sequence[str]


def render(folder: str, key: str, items: Sequence[Item]) -> tuple[str, dict[str, str]]:
    """Write the page of a paper.

    Parameters
    ----------
    folder : str
        Of the report.
    key : str
        Case of the paper (sr4c); names the page.
    items : sequence of Item
        In the order of the page.

    Returns
    -------
    (str, dict)
        The key; by label, what is wrong with an item.
    """
    mpl.use("Agg")  # a worker has no screen
    entries = [_entry(Path(folder), key, item) for item in items]
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("compare.report"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    paper = load_papers(key)[0]
    made = [entry.made for entry in entries if entry.made is not None]
    context: dict[str, Any] = {
        "key": key,
        "title": paper.title,
        "source": " ".join(paper.source.split()),
        "left_out": paper.left_out,
        "entries": entries,
        "meanings": MEANINGS,
        "ok": OK,
        "is_table": lambda part: isinstance(part, Table),
        "machines": sorted({m.machine for m in made}),
        "versions": sorted({m.versions for m in made}),
        "seconds": sum(m.seconds for m in made),
        "report": (Path(folder) / "index.html").exists(),
    }
    path = Path(folder) / "papers" / f"{key}.html"
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, environment.get_template("paper.html.j2").render(context))
    return key, {e.item.label: f"{e.status}: {e.note}" for e in entries if e.status != OK}


def _entry(folder: Path, key: str, item: Item) -> Entry:
    made = kept(folder, key, item)
    if made is None:
        return Entry(item, None, MISSING, "", (), ())
    if made.status != OK or made.data is None:
        return Entry(item, made, made.status, made.note, (), ())
    try:
        with mpl.rc_context(STYLE):
            shown = item.show(made.data)
            parts = [_svg(part) if isinstance(part, Figure) else part for part in shown.parts]
    except Exception as error:  # one faulty item must not cost the others their page
        plt.close("all")
        return Entry(item, made, FAILED, f"cannot be shown: {type(error).__name__}: {error}", (), ())
    return Entry(item, made, OK, "", parts, shown.remarks)


def _svg(figure: Figure) -> str:
    """Encode a picture as a data: URI and close it."""
    text = io.BytesIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    plt.close(figure)
    return "data:image/svg+xml;base64," + base64.b64encode(text.getvalue()).decode()
