"""``python -m compare.audit [PAPER]``: published results, judged from their own numbers."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from compare.audit.chapters import HEADER, chapter
from compare.audit.paper import PAPERS, load_papers
from compare.audit.whole_paper import audit
from compare.commands import shared as commands

_SHOWN = 3  # findings of one kind that are shown without --every


def main() -> int:
    """Audit one paper or all."""
    parser = commands.parser(
        "audit",
        "Does a published motion keep its limits, is it the best there is, do its numbers add up?",
        "python -m compare.audit sr4c --json audit.json",
    )
    parser.add_argument(
        "paper",
        nargs="?",
        metavar="PAPER",
        help=f"a paper ({', '.join(PAPERS)}) or a TOML file like theirs; all of them if left out",
    )
    parser.add_argument("--json", metavar="OUT", help="write everything as JSON too")
    parser.add_argument("--every", action="store_true", help="show every finding of a kind")
    options = parser.parse_args()

    live = sys.stderr.isatty()
    stored = []
    for name in [options.paper] if options.paper else PAPERS:
        for paper in load_papers(name):

            def progress(what: str, name: str = paper.name) -> None:
                if live:
                    print(f"\r\033[K{name}: {what} ...", end="", file=sys.stderr, flush=True)

            stored.append(audit(paper, progress).to_json())
            if live:
                print("\r\033[K", end="", file=sys.stderr)
            print(as_text(stored[-1], every=options.every), flush=True)
    if options.json:
        commands.write_json(Path(options.json), stored)
    return commands.DONE


def as_text(data: dict[str, Any], *, every: bool = False) -> str:
    """An audit for the terminal: time vectors as a table, then the verdicts by kind."""
    (paper,) = chapter([data])
    lines = [f"{paper['name']}: {paper['title']}", paper["source"], ""]
    if paper["rows"]:
        rows = [row["cells"] for row in paper["rows"]]
        lines += [commands.table(HEADER, rows, right=(1, 3, 4, 5, 6)), "", paper["caption"], ""]
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


if __name__ == "__main__":
    commands.run(main)
