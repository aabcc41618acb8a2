"""``timebound papers [KEY ...]``: the tables and figures of the papers, made again."""

from __future__ import annotations

import sys
import time
from typing import Annotated

from cyclopts import Parameter

from compare.audit.paper import CASE_OF
from compare.commands import DONE, FAILED
from compare.commands.names import several
from compare.commands.options import CORES, Jobs, Json, Out, Resume
from compare.files import output_folder
from compare.papers import ITEMS
from compare.papers.making import choose, draw, left_to_make, make
from compare.papers.shelf import OK
from compare.papers.verdicts import counted
from compare.screen import show
from formulations import InputError

_KEYS = ", ".join(f"{case} or {name}" for name, case in CASE_OF.items() if case in ITEMS)


def papers(
    *papers: Annotated[
        str,
        Parameter(name="KEY", help=f"Papers, by case or by author and year: {_KEYS}; all if none."),
    ],
    full: bool = False,
    item: Annotated[str | None, Parameter(metavar="LABEL")] = None,
    listing: Annotated[bool, Parameter(name="--list")] = False,
    out: Out = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Make the tables and figures of the papers again, printed beside reproduced.

    Each item is stored in DIR/papers/KEY/ITEM.json; each paper gets a page, DIR/papers/KEY.html.

    Parameters
    ----------
    full
        Take the papers' own budgets, and more runs.
    item
        Make one item alone, as the paper calls it: "Table 9".
    listing
        List the items, and make none.
    """
    started = time.perf_counter()
    try:
        wanted = ",".join(CASE_OF.get(key, key) for key in papers)  # wang_2025 and sr4c are the same
        keys = several(wanted, ITEMS) if papers else tuple(ITEMS)
    except ValueError as error:
        raise InputError(f"KEY: {error}") from None
    chosen = choose(keys, item)
    total = sum(len(items) for items in chosen.values())
    if listing:
        labels = {paper: [item.label for item in items] for paper, items in chosen.items()}
        show("\n".join(f"{paper}: {', '.join(names)}" for paper, names in labels.items()), labels, json)
        return DONE
    folder = output_folder(out)
    calls = left_to_make(folder, chosen, full=full, resume=resume)
    before = f", {total - len(calls)} of them finished before" if total > len(calls) else ""
    print(f"{total} tables and figures of {', '.join(chosen)}{before}", file=sys.stderr)
    made = []
    for paper, one, result in make(calls, jobs):
        status = "made" if result.status == OK else result.status
        print(f"{paper}: {one.label}: {status}, {result.seconds:.1f} s", file=sys.stderr)
        made.append({"paper": paper, "item": one.label, "status": str(result.status)})
    text, failed, verdicts = [], [], []
    for chapter in draw(folder, chosen, jobs):
        for one in chosen[chapter.key]:
            if one.label in chapter.faults:
                failed.append(f"{chapter.key}: {one.label}: {chapter.faults[one.label]}")
                continue
            found = chapter.verdicts[one.label]
            text.append(f"{chapter.key}: {one.label}: {counted([v.outcome for v in found])}")
            verdicts += [
                {"paper": chapter.key, "item": one.label, "what": v.what, "outcome": v.outcome.inside}
                for v in found
            ]
        text.append(f"chapter: {folder / 'papers' / f'{chapter.key}.html'}")
    failed.sort()
    for line in failed:
        print(f"error: {line}", file=sys.stderr)
    text.append(f"{len(calls)} made, {len(failed)} failed, {time.perf_counter() - started:.0f} s")
    show("\n".join(text), {"made": made, "failed": failed, "verdicts": verdicts}, json)
    return FAILED if failed else DONE
