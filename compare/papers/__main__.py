"""``python -m compare.papers [KEY ...]``: every table and figure of the papers, made again."""

from __future__ import annotations

import multiprocessing
import os
import sys
import time
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool

from tqdm import tqdm

from compare.audit.paper import CASE_OF
from compare.benchmark.run import each, workers
from compare.commands import shared as commands
from compare.papers import ITEMS, page, shelf
from compare.papers.item import Item
from compare.papers.shelf import Made
from formulations import InputError

Call = tuple[str, str, Item, bool]  # of shelf.make


def main() -> int:
    """Make what was asked for and write a chapter per paper."""
    parser = commands.parser(
        "papers",
        "Every table and figure of the papers again, printed beside reproduced: a page per paper,\n"
        "DIR/papers/KEY.html, from DIR/papers/KEY/ITEM.json.",
        'python -m compare.papers sr4c --item "Table 9" --out report',
    )
    parser.add_argument(
        "paper", nargs="*", metavar="KEY", help=f"some of {', '.join(ITEMS)}; all if none"
    )
    parser.add_argument("--full", action="store_true", help="the papers' own budgets and more runs")
    parser.add_argument(
        "--item", metavar="LABEL", help='one item alone, as the paper calls it: "Table 9"'
    )
    parser.add_argument("--out", default="report", metavar="DIR", help="folder of the report")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="worker processes")
    parser.add_argument(
        "--resume", action="store_true", help="keep the finished items of an interrupted run"
    )
    options = parser.parse_args()

    started = time.perf_counter()
    jobs = commands.positive("--jobs", options.jobs)
    chosen = choose(options.paper, options.item)
    folder = commands.output_folder(options.out)
    calls: list[Call] = []
    for paper, items in chosen.items():
        for item in items:
            if options.resume and shelf.finished(folder, paper, item, options.full):
                continue
            shelf.forget(folder, paper, item)
            calls.append((str(folder), paper, item, options.full))
    calls.sort(key=lambda call: -call[2].cost)  # the longest first

    total = sum(len(items) for items in chosen.values())
    print(
        f"{total} tables and figures of {', '.join(chosen)}"
        + (f", {total - len(calls)} of them finished before" if total > len(calls) else ""),
        file=sys.stderr,
    )
    try:
        for paper, item, made in make(calls, jobs):
            tqdm.write(f"{paper}: {item.label}: {made.status}, {made.seconds:.1f} s", file=sys.stderr)
        failed = draw(str(folder), chosen, jobs)
    except KeyboardInterrupt:
        for worker in multiprocessing.active_children():
            worker.terminate()  # what it makes may take minutes more
        raise
    for line in failed:
        print(f"error: {line}", file=sys.stderr)
    for paper in chosen:
        print(f"chapter: {folder / 'papers' / f'{paper}.html'}")
    print(f"{len(calls)} made, {len(failed)} failed, {time.perf_counter() - started:.0f} s")
    return commands.FAILED if failed else commands.DONE


def choose(keys: list[str], label: str | None) -> dict[str, list[Item]]:
    """Choose items of papers. Raises InputError that names what is known.

    keys: cases (sr4c) or authors and years (wang_2025); all papers if there are none. label: of one
    item, "Table 8"; all if it is None.
    """
    cases = [CASE_OF.get(key, key) for key in keys]  # wang_2025 and sr4c name the same paper
    papers = commands.chosen("KEY", ",".join(cases) if cases else None, ITEMS)
    found = {paper: [i for i in ITEMS[paper] if label in (None, i.label)] for paper in papers}
    found = {paper: items for paper, items in found.items() if items}
    if not found:
        known = ", ".join(item.label for paper in papers for item in ITEMS[paper])
        raise InputError(f"--item: {label!r} is not an item of {', '.join(papers)} (known: {known})")
    return found


def make(calls: list[Call], jobs: int) -> Iterator[tuple[str, Item, Made]]:
    """Items as they are made and stored, in worker processes."""
    left = {(paper, item.key): (folder, paper, item, full) for folder, paper, item, full in calls}
    if not left:
        return
    try:
        with workers(min(jobs, len(left))) as pool:
            for paper, item, made in each(pool, "papers", shelf.make, calls):
                del left[paper, item.key]
                yield paper, item, made
    except BrokenProcessPool:  # an item ended its process; one by one it shows which
        yield from _one_by_one(list(left.values()))


def _one_by_one(calls: list[Call]) -> Iterator[tuple[str, Item, Made]]:
    while calls:
        try:
            with workers(1) as pool:
                while calls:
                    made = pool.submit(shelf.make, *calls[0]).result()
                    calls = calls[1:]
                    yield made
        except BrokenProcessPool:
            _, paper, item, _ = calls[0]
            yield paper, item, shelf.died(*calls[0])
            calls = calls[1:]


def draw(folder: str, chosen: dict[str, list[Item]], jobs: int) -> list[str]:
    """Write the chapters; a line for each chosen item that has failed."""
    calls = [(folder, paper, ITEMS[paper]) for paper in chosen]
    if min(jobs, len(calls)) == 1:  # not worth a process
        chapters = [page.render(*call) for call in calls]
    else:
        with workers(min(jobs, len(calls))) as pool:
            chapters = list(each(pool, "chapters", page.render, calls))
    return sorted(
        f"{paper}: {item.label}: {faults[item.label]}"
        for paper, faults in chapters
        for item in chosen[paper]
        if item.label in faults
    )


if __name__ == "__main__":
    commands.run(main)
