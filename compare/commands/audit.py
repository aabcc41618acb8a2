"""``timebound audit [PAPER]``: published results, judged from their own numbers."""

from __future__ import annotations

from typing import Annotated, Any

from cyclopts import Parameter

from compare.audit.chapters import HEADER, chapter
from compare.audit.paper import PAPERS, load_papers
from compare.audit.whole_paper import audit
from compare.commands import DONE
from compare.commands.options import Json
from compare.screen import save, stages, table

_SHOWN = 3  # findings of one kind that are shown without --every


def audit_papers(
    paper: Annotated[
        str | None,
        Parameter(
            name="PAPER",
            help=f"A paper ({', '.join(PAPERS)}) or a TOML file like theirs; all if left out.",
        ),
    ] = None,
    /,
    *,
    every: bool = False,
    json: Json = None,
) -> int:
    """Judge published results from their own numbers.

    Does a published motion keep its limits? Could any motion be that fast? Do the sums, percentages
    and Cartesian points that stand beside it agree with it?

    Parameters
    ----------
    every
        Show every finding, not only the first three of a kind.
    """
    stored = []
    for name in [paper] if paper else PAPERS:
        for one in load_papers(name):
            with stages(one.name) as stage:
                found = audit(one, stage)
            stored.append(found.to_json())
            if json != "-":
                print(as_text(stored[-1], every=every), flush=True)
    save(stored, json)
    return DONE


def as_text(data: dict[str, Any], *, every: bool = False) -> str:
    """Lay an audit out for the terminal: time vectors as a table, then the verdicts by kind.

    Parameters
    ----------
    data : dict
        ``Audit.to_json()``.
    every : bool
        All findings, not only the first of each kind.

    Returns
    -------
    str
        Its lines.
    """
    (paper,) = chapter([data])
    lines = [f"{paper['name']}: {paper['title']}", paper["source"], ""]
    if paper["rows"]:
        rows = [row["cells"] for row in paper["rows"]]
        lines += [table(HEADER, rows, right=(1, 3, 4, 5, 6)), "", paper["caption"], ""]
    if not paper["faults"]:
        lines += ["nothing wrong was found", ""]
    groups = [("WRONG" if group["proved"] else "DOUBT", group) for group in paper["faults"]]
    groups += [("note", group) for group in paper["notes_found"]]
    for mark, group in groups:
        items = group["items"]
        lines.append(f"{mark}: {group['meaning']}")
        lines += [f"  - {item['where']}: {item['text']}" for item in items[: None if every else _SHOWN]]
        if len(items) > _SHOWN and not every:
            lines.append(f"  - and {len(items) - _SHOWN} more like these (--every shows them)")
    return "\n".join([*lines, ""])
