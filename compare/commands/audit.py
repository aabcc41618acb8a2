"""``timebound audit [PAPER]``: published results, judged from their own numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from compare.audit.chapters import HEADER, chapter
from compare.audit.paper import PAPERS, load_papers
from compare.audit.paper.reference import template as paper_template
from compare.audit.whole_paper import audit
from compare.commands import DONE
from compare.commands.options import Json
from compare.screen import save, stages, table
from formulations import InputError

_SHOWN = 3  # findings of one kind that are shown without --every


def audit_papers(
    paper: Annotated[
        str | None,
        Parameter(
            name="PAPER",
            help=f"A paper ({', '.join(PAPERS)}) or a TOML file (docs/paper_file.md); all if left out.",
        ),
    ] = None,
    /,
    *,
    every: bool = False,
    template: bool = False,
    json: Json = None,
) -> int:
    """Judge published results from their own numbers.

    Does a published motion keep its limits? Could any motion be that fast? Do the sums, percentages
    and Cartesian points that stand beside it agree with it? Where they do not, which single change (a unit,
    a sign, two columns, the form of the DH table) would explain it?

    Parameters
    ----------
    every
        Show every finding, not only the first three of a kind.
    template
        Write a commented paper file to PAPER, or to the screen, and audit nothing.
    """
    if template:
        return _write_template(paper)
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


def _write_template(file: str | None) -> int:
    """Write the template of a paper file; a file that is there already is not replaced."""
    if file is None or file == "-":
        print(paper_template(), end="")
        return DONE
    path = Path(file)
    try:
        # not replaced: it may hold a paper's numbers
        with path.open("x", encoding="utf-8") as opened:
            opened.write(paper_template())
    except FileExistsError:
        raise InputError(f"--template: {path} is there already") from None
    except OSError as error:
        raise InputError(f"--template: {path}: cannot be written: {error.strerror}") from None
    print(f"{path}: put your paper's numbers in, then: timebound audit {path}")
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
    lines += [f"HINT: {hint['question']}\n  - {hint['text']}" for hint in paper["hints"]]
    return "\n".join([*lines, ""])
