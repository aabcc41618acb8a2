"""Run a comparison on all cores: bounds first, then swarms; each result is on disk as it ends."""

from __future__ import annotations

import hashlib
import sys
from collections import Counter
from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from compare.audit import audit, load_papers
from compare.audit.paper import published_text
from compare.benchmark.below_bound import require_above
from compare.benchmark.grade import Graded, Run, grade
from compare.benchmark.known_times import KnownTime, table_of_known_times
from compare.benchmark.ladders import LadderRecord, ladder_record
from compare.benchmark.objective import Objective
from compare.benchmark.records.mismatch import mismatch
from compare.benchmark.records.proof_cache import proof_key
from compare.benchmark.records.provenance import machine, versions_text
from compare.benchmark.records.rejudge import judged_again
from compare.benchmark.records.rows import BoundProof, Row
from compare.benchmark.records.store import Store
from compare.benchmark.summaries import bound_of
from compare.engines import Engine, each
from formulations import FAMILIES, InputError, Problem, ladder

_BATCH = 5  # runs per call: a run takes milliseconds


def climb(pool: Engine, problems: dict[str, Problem], store: Store, *, certify: bool = True) -> None:
    """Find every bound of every case and write it to the store; the longest task first.

    What this code has proved before, in this store or one that was merged into it, is not proved again.

    Parameters
    ----------
    pool : Engine
    problems : dict of str to Problem
        By case.
    store : Store
    certify : bool
        Whether the bound of the spline family is proved.
    """
    keys = {
        case: proof_key(problem, "all" if certify else "uncertified")
        for case, problem in problems.items()
    }
    calls = []
    for case, problem in sorted(problems.items(), key=lambda item: -item[1].n_segments):
        known = store.proved(keys[case])
        if known is None:
            calls.append((case, problem, certify))
        else:
            store.write_ladder(case, known)
    for case, found in each(pool, "bounds", _ladder, calls):
        store.write_proof(keys[case], found)
        store.write_ladder(case, found)


def _ladder(case: str, problem: Problem, certify: bool) -> tuple[str, LadderRecord]:
    return case, ladder_record(ladder(problem, certify=certify))


def swarm(
    pool: Engine,
    runs: list[Run],
    problems: dict[str, Problem],
    store: Store,
    *,
    allow: Collection[str] = (),
    tell: Callable[[Graded], None] | None = None,
) -> None:
    """Grade every run that the store does not have yet, and write ``rows.csv`` in the order of the runs.

    Stored rows count only if they belong to one of these runs and were made by the same code,
    parameters, versions and problem. The others stay in the store and are not read; a line on stderr
    says how many and why. The gaps of the rows that stay are measured against the bounds that the store
    has now.

    Parameters
    ----------
    pool : Engine
    runs : list of Run
        The plan.
    problems : dict of str to Problem
        By case.
    store : Store
        With the bounds of all cases.
    allow : collection of str
        Columns in which the rows of one cell may differ: ``machine``, or none.
    tell : callable, optional
        Called with each run as it ends, once it is stored.

    Raises
    ------
    InputError
        If another machine has made part of a cell, unless that is allowed; nothing is run then. Also if
        workers have other code or versions than this process.
    """
    ladders = store.ladders()
    bounds = {case: bound_of(ladders[case]) for case in problems}
    store.write_plan(runs, problems)
    if (others := store.other_machines(machine())) and "machine" not in allow:
        raise InputError(
            f"{store.folder}: holds rows of another machine ({others[0]}; this is {machine()}), which are not"
            " pooled unless --machines is given"
        )
    _tell_what_is_left_out(runs, problems, store)
    store.measure(bounds)
    left = store.left()
    batches = range(0, len(left), _BATCH)
    # one by one, so that memory does not hold every call
    calls = (
        ([(runs[k], problems[runs[k].case], *bounds[runs[k].case]) for k in left[i : i + _BATCH]],)
        for i in batches
    )
    try:
        for graded in each(pool, f"swarms (x{_BATCH} runs)", _grades, calls, total=len(batches)):
            for one in graded:
                require_above(one.row, ladders[one.run.case])
            store.add_all((one.row, one.traces) for one in graded)  # what arrives together
            if tell is not None:
                for one in graded:
                    tell(one)
    finally:
        store.write_csv()
    if foreign := store.left():
        raise InputError(
            f"{len(foreign)} of {len(runs)} runs were made by workers with other code or versions than here;"
            " they are stored, and not read"
        )


def measured(pool: Engine, runs: list[Run], problems: dict[str, Problem], store: Store) -> list[Row]:
    """Make runs without keeping them, for an estimate of the time.

    Parameters
    ----------
    pool : Engine
    runs : list of Run
    problems : dict of str to Problem
        By case.
    store : Store
        With the bounds of all cases.

    Returns
    -------
    list of Row
    """
    ladders = store.ladders()
    calls = [([(run, problems[run.case], *bound_of(ladders[run.case]))],) for run in runs]
    return [one.row for graded in each(pool, "estimate", _grades, calls) for one in graded]


def _grades(batch: list[tuple[Run, Problem, float | None, BoundProof]]) -> list[Graded]:
    return [grade(*one) for one in batch]


def _tell_what_is_left_out(runs: list[Run], problems: dict[str, Problem], store: Store) -> None:
    """Say on stderr how many stored rows the plan cannot use, and why."""
    outside = store.outside()
    if not outside:
        return
    reasons: Counter[str] = Counter()
    for maker, count in outside:
        reasons[mismatch(maker, runs, problems)] += count
    kept = len(runs) - len(store.left())
    told = ", ".join(f"{count} with {reason}" for reason, count in reasons.most_common())
    print(
        f"resume: {kept} of {kept + reasons.total()} stored rows fit the plan; {reasons.total()} do not"
        f" and are left out ({told})",
        file=sys.stderr,
        flush=True,
    )


def audits(pool: Engine, papers: list[str], store: Store) -> None:
    """Audit every paper whose audit the store does not have yet; the longest first.

    Parameters
    ----------
    pool : Engine
    papers : list of str
        Names of shipped papers.
    store : Store
    """
    made_of = {
        paper: {
            "digest": hashlib.sha256(published_text(paper).encode()).hexdigest()[:12],
            "versions": versions_text(),
            "machine": machine(),
        }
        for paper in papers
    }
    kept = store.audits()
    left = [
        paper
        for paper in papers
        if any(kept.get(paper, {}).get(key) != made_of[paper][key] for key in ("digest", "versions"))
    ]
    calls = [(paper,) for paper in sorted(left, key=_work, reverse=True)]
    for paper, found in each(pool, "audits", _audit, calls):
        store.write_audit(paper, made_of[paper], found)


def _work(paper: str) -> float:
    """How long an audit takes, in no unit: its proofs, whose boxes double with every segment."""
    return sum(len(p.rows) * 2.0**p.n_waypoints for p in load_papers(paper))


def _audit(name: str) -> tuple[str, list[dict[str, Any]]]:
    return name, [audit(paper).to_json() for paper in load_papers(name)]


def tabulate_known_times(pool: Engine, problems: dict[str, Problem], store: Store) -> None:
    """Write what is known of the task of each case, from the bounds and rows of the store.

    Parameters
    ----------
    pool : Engine
    problems : dict of str to Problem
        By case.
    store : Store
    """
    ladders = store.ladders()
    rows = judged_again(store.rows(), problems, ladders)
    allow = store.settings().allow
    calls = [
        (case, problem, ladders[case], [row for row in rows if row.case == case], allow)
        for case, problem in problems.items()
    ]
    for case, lines in each(pool, "known times", _known_times, calls):
        store.write_known_times(case, lines)


def _known_times(
    case: str, problem: Problem, ladder: LadderRecord, rows: list[Row], allow: tuple[str, ...]
) -> tuple[str, list[KnownTime]]:
    return case, table_of_known_times(problem, ladder, rows, allow=allow)


def warm_up(problems: dict[str, Problem]) -> None:
    """Compile the kernels once in this process, so that the workers find them in the cache.

    Parameters
    ----------
    problems : dict of str to Problem
        By case.
    """
    for problem in problems.values():
        family = FAMILIES[problem.family]
        ones = np.ones((2, problem.n_segments))  # a single candidate is not compiled
        family.stretch(problem, ones)
        family.position_excess(problem, ones)
        Objective(problem, stretch=True)(ones)
