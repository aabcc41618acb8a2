"""The frame of every page: its templates, their filters, and the scripts that stand in the page itself."""

from __future__ import annotations

import base64
from importlib.resources import files
from pathlib import Path

import jinja2

from compare.report.words import percent, seconds

TABLES = ("vendor/sortable.min.js", "script/page.js", "script/table.js")
"""Scripts of a page without charts: themes, printing, tables that can be sorted and filtered."""
CHARTS = ("vendor/plotly-gl3d.min.js", *TABLES, *(
    f"script/{name}.js" for name in ("arms", "ladder", "curves", "motion", "arm", "split")
))  # fmt: skip
"""Scripts of a page with charts."""


def environment(folder: Path) -> jinja2.Environment:
    """Return the templates of every page, with their filters.

    Parameters
    ----------
    folder : Path
        Folder of the report; ``inline(NAME)`` puts DIR/NAME.svg into a page.

    Returns
    -------
    jinja2.Environment
    """
    made = jinja2.Environment(
        loader=jinja2.PackageLoader("compare.report"),
        autoescape=jinja2.select_autoescape(["html.j2"]),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    made.filters["percent"] = percent
    made.filters["seconds"] = seconds
    made.globals["inline"] = lambda name: _inline(folder / f"{name}.svg")
    made.globals["source"] = _source
    return made


def _source(name: str) -> str:
    """A script of this package, to stand in a page."""
    text = files("compare.report").joinpath(name).read_text("utf-8")
    assert "</script" not in text
    return text


def _inline(path: Path) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(path.read_bytes()).decode()
