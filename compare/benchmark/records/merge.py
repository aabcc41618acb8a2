"""The results of several folders made into what one comparison would have given.

Equal rows stand once. Two results of one run are a contradiction and are refused, and so is what no one
comparison could hold: one case with two problems, one cell with two codes, versions or budgets.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.database import documents, makers, runs
from compare.benchmark.records.pooled import require_pooled
from compare.benchmark.records.rows import BoundProof
from compare.benchmark.records.settings import Settings, budget_words
from compare.benchmark.records.store import Store
from compare.benchmark.summaries import bound_of
from formulations import InputError

# what tells one cell of a plan from another, in the order of the loops that make a plan
_LOOPS = ("case", "coding", "track", "coordinates", "swarm", "budget", "population", "problem")
_SIZES = ("quick", "default", "suite", "full")


def merge(sources: Sequence[Path], target: Path, *, allow: Collection[str] = ()) -> Store:
    """Merge the results of folders.

    Parameters
    ----------
    sources : sequence of Path
        Folders with results. Where they hold the same, that of the first stays.
    target : Path
        Folder of the merged results: one of the sources, which then holds those of the others too, or
        one without results.
    allow : collection of str
        Columns in which the rows of one cell may differ: ``machine``, or none.

    Returns
    -------
    Store
        The merged results.

    Raises
    ------
    InputError
        If a folder holds no results, or if they contradict each other; nothing is changed then.
    """
    stores = {folder.resolve(): Store(folder) for folder in sources}
    settings = [store.settings() for store in stores.values()]
    ladders = _best([store.ladders() for store in stores.values()])
    _require_one_problem_per_case(stores.values())
    merged = stores.get(target.resolve(), Store(target))
    if merged not in stores.values() and merged.file.exists():
        raise InputError(f"{merged.file}: is there already; to keep it, name {target} as a source too")
    made = not merged.file.exists()
    try:
        with merged.database.writing() as connection:
            entries: list[tuple[int, int]] = []
            for store in stores.values():
                entries += _copied(store, connection, same=store is merged)
            known = makers.makers(connection)
            plan = makers.enter_plan(connection, _in_order(entries, known))
            budgets = sorted({known[maker]["budget"] for maker, _ in entries})
            united = _united(settings, budget_words(budgets), allow)
            for kind, name, data in (
                ("settings", "", asdict(united)),
                *(("ladder", case, ladder) for case, ladder in ladders.items()),
            ):
                documents.write_document(connection, kind, name, data)
            runs.measure(connection, plan, {case: bound_of(one) for case, one in ladders.items()})
            for _ in require_pooled(runs.read_rows(connection, plan), allow=united.allow):
                pass
    except BaseException:
        merged.close()
        for end in ("", "-wal", "-shm") if made else ():
            merged.file.with_name(merged.file.name + end).unlink(missing_ok=True)
        raise
    merged.write_csv()
    return merged


def _copied(store: Store, connection: sqlite3.Connection, *, same: bool) -> list[tuple[int, int]]:
    """Copy all that a store holds, and give the makers and seeds of its plan."""
    with store.database.reading() as source:
        plan = makers.last_plan(source)
        entries = makers.entries_of(source, plan)
        if same:
            return entries
        digests = makers.digests(source)
        # code that cannot be read is the same as no other, here as there
        number = {
            maker: makers.maker_id(connection, columns, digests[maker])
            for maker, columns in makers.makers(source).items()
        }
        results = zip(runs.numbered_rows(source, None), runs.read_traces(source, None), strict=True)
        for (maker, row), (_, traces) in results:
            try:
                runs.write_run(connection, number[maker], row, traces)
            except ValueError as error:
                raise InputError(f"{store.folder}: {error}") from None
        for table in ("instances", "proofs", "documents"):
            documents.copy_table(source, connection, table)
    return [(number[maker], seed) for maker, seed in entries]


def _in_order(
    entries: Iterable[tuple[int, int]], known: Mapping[int, dict[str, Any]]
) -> list[tuple[int, int]]:
    """The runs, each once, in the order in which one plan would name them."""
    unique = list(dict.fromkeys(entries))
    rank: dict[tuple[str, Any], int] = {}
    for maker, _ in unique:
        for name in _LOOPS:
            rank.setdefault((name, known[maker][name]), len(rank))

    def place(entry: tuple[int, int]) -> tuple[int, ...]:
        columns = known[entry[0]]
        return (*(rank[name, columns[name]] for name in _LOOPS), entry[1], entry[0])

    return sorted(unique, key=place)


def _united(settings: Sequence[Settings], budget: str, allow: Collection[str]) -> Settings:
    """What one comparison would have been asked for."""
    return Settings(
        size=max((one.size for one in settings), key=_SIZES.index),
        cases=tuple(dict.fromkeys(case for one in settings for case in one.cases)),
        seeds=tuple(sorted({seed for one in settings for seed in one.seeds})),
        budget=budget,
        allow=tuple(sorted({*allow, *(name for one in settings for name in one.allow)})),
    )


def _best(found: Sequence[Mapping[str, LadderRecord]]) -> dict[str, LadderRecord]:
    """The first bounds of each case; the first proved ones where some are."""
    best: dict[str, LadderRecord] = {}
    for ladders in found:
        for case, ladder in ladders.items():
            proved = bound_of(ladder)[1] is BoundProof.certified
            if case not in best or (proved and bound_of(best[case])[1] is not BoundProof.certified):
                best[case] = ladder
    return best


def _require_one_problem_per_case(stores: Iterable[Store]) -> None:
    first: dict[str, tuple[str, Store]] = {}
    for store in stores:
        for case, digest in store.problem_digests().items():
            known, other = first.setdefault(case, (digest, store))
            if known != digest:
                raise InputError(
                    f"{case}: {other.folder} and {store.folder} hold results of two problems of this name"
                )
