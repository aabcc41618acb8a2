"""Make items in worker processes, store each as it ends, and write the chapters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from compare.engines import WorkerLostError, each, workers
from compare.papers import ITEMS, page, shelf
from compare.papers.item import Item
from compare.papers.page import Chapter
from compare.papers.shelf import Made
from formulations import InputError

Call = tuple[str, str, Item, bool]  # the arguments of shelf.make


def choose(papers: Sequence[str], label: str | None) -> dict[str, list[Item]]:
    """Choose items by paper.

    Parameters
    ----------
    papers : sequence of str
        Keys of ``ITEMS``.
    label : str or None
        One item alone, as the paper calls it; None: all of them.

    Returns
    -------
    dict
        Items by paper; no paper without one.

    Raises
    ------
    InputError
        No item has that label.
    """
    found = {paper: [i for i in ITEMS[paper] if label in (None, i.label)] for paper in papers}
    found = {paper: items for paper, items in found.items() if items}
    if not found:
        known = ", ".join(item.label for paper in papers for item in ITEMS[paper])
        raise InputError(f"--item: {label!r} is not an item of {', '.join(papers)} (known: {known})")
    return found


def left_to_make(
    folder: Path, chosen: dict[str, list[Item]], *, full: bool, resume: bool
) -> list[Call]:
    """List what has to be made, the longest first, and forget what is stored of it.

    Parameters
    ----------
    folder : Path
        Folder of the report.
    chosen : dict
        Items by paper.
    full : bool
        The papers' own budgets.
    resume : bool
        Leave out what an earlier run has finished.

    Returns
    -------
    list of tuples
        Arguments of ``shelf.make``.
    """
    calls: list[Call] = []
    for paper, items in chosen.items():
        for item in items:
            if resume and shelf.finished(folder, paper, item, full):
                continue
            shelf.forget(folder, paper, item)
            calls.append((str(folder), paper, item, full))
    return sorted(calls, key=lambda call: -call[2].cost)


def make(calls: list[Call], jobs: int) -> Iterator[tuple[str, Item, Made]]:
    """Make items in worker processes, each stored as it ends.

    An item that ends its process costs no other item.

    Parameters
    ----------
    calls : list of tuples
        Arguments of ``shelf.make``.
    jobs : int
        Worker processes.

    Yields
    ------
    tuple
        Paper, item, and what was made.
    """
    left = {(call[1], call[2].key): call for call in calls}
    while left:
        with workers(min(jobs, len(left))) as engine:
            try:
                for paper, item, made in each(engine, "papers", shelf.make, list(left.values())):
                    del left[paper, item.key]
                    yield paper, item, made
            except WorkerLostError as lost:
                _, paper, item, _ = lost.call
                del left[paper, item.key]
                yield paper, item, shelf.died(*lost.call)


def draw(folder: Path, chosen: dict[str, list[Item]], jobs: int) -> list[Chapter]:
    """Write the chapters.

    Parameters
    ----------
    folder : Path
        Folder of the report.
    chosen : dict
        Items by paper.
    jobs : int
        Worker processes.

    Returns
    -------
    list of Chapter
        In the order of ``chosen``.
    """
    pages = [key for key in ITEMS if key in chosen or (folder / "papers" / f"{key}.html").exists()]
    calls = [(str(folder), paper, ITEMS[paper], pages) for paper in chosen]
    if min(jobs, len(calls)) == 1:  # not worth a process
        return [page.render(*call) for call in calls]
    with workers(min(jobs, len(calls))) as pool:
        chapters = {made.key: made for made in each(pool, "chapters", page.render, calls)}
    return [chapters[paper] for paper in chosen]


def draw_again(folder: Path, jobs: int) -> None:
    """Write the chapters that are there anew, so that they lead back to a report that has joined them.

    Parameters
    ----------
    folder : Path
        Folder of the report.
    jobs : int
        Worker processes.
    """
    there = {
        key: list(items) for key, items in ITEMS.items() if (folder / "papers" / f"{key}.html").exists()
    }
    if there:
        draw(folder, there, jobs)
