"""``python -m compare.audit [PAPER]``: published results, judged from their own numbers."""

from __future__ import annotations

import sys
from pathlib import Path

from compare import commands
from compare.audit.audit import Audit, audit
from compare.audit.findings import FAULTS, NOTES, Finding
from compare.audit.paper_file import PAPERS, load_papers

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
    audits = []
    for name in [options.paper] if options.paper else PAPERS:
        for paper in load_papers(name):

            def progress(what: str, name: str = paper.name) -> None:
                if live:
                    print(f"\r\033[K{name}: {what} ...", end="", file=sys.stderr, flush=True)

            done = audit(paper, progress)
            if live:
                print("\r\033[K", end="", file=sys.stderr)
            print(as_text(done, every=options.every), flush=True)
            audits.append(done)
    if options.json:
        commands.write_json(Path(options.json), [done.to_json() for done in audits])
    return commands.DONE


def as_text(done: Audit, *, every: bool = False) -> str:
    """An audit for the terminal: time vectors as a table, then the verdicts by kind."""
    paper = done.paper
    lines = [f"{paper.name}: {paper.title}", paper.source, ""]
    rows = [_cells(row) for row in done.rows()]
    if rows:
        header = ["time vector", "total", "keeps limits", "stretch", "honest", "optimum", "own limits"]
        lines += [commands.table(header, rows, right=(1, 3, 4, 5, 6)), ""]
        lines += [
            "stretch: least factor on all times that keeps the limits; honest: the total after it;",
            "optimum: certified, of the stated limits; own limits: of the least the motion keeps [s]",
            "",
        ]
    if not done.faults:
        lines += ["nothing wrong was found", ""]
    for kind, meaning in (FAULTS | NOTES).items():
        found = [f for f in done.findings if f.kind == kind]
        if found:
            mark = "note" if kind in NOTES else "WRONG" if any(f.proved for f in found) else "DOUBT"
            lines.append(f"{mark}: {meaning}")
            lines += [_line(f) for f in (found if every else found[:_SHOWN])]
            if len(found) > _SHOWN and not every:
                lines.append(f"  - and {len(found) - _SHOWN} more like these (--every shows them)")
    return "\n".join([*lines, ""])


def _line(finding: Finding) -> str:
    return f"  - {finding.where}: {finding.text}"


def _cells(row: dict[str, object]) -> list[str]:
    numbers = [row[key] for key in ("stretch", "honest", "optimum", "implied_optimum")]
    cells = ["-" if value is None else f"{value:.4f}" for value in numbers]
    return [str(row["where"]), f"{row['total']:.4f}", str(row["feasible"]), *cells]


if __name__ == "__main__":
    commands.run(main)
