"""Run a comparison on all cores: ladders first, then swarms; each result on disk as it ends."""

from __future__ import annotations

import hashlib
import multiprocessing
import os
import platform
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import asdict
from typing import Any, TypeVar

import numpy as np
from tqdm import tqdm

from compare.audit import audit, load_papers
from compare.audit.paper import published_text
from compare.benchmark.grade import Graded, Run, grade
from compare.benchmark.honest import honest_table
from compare.benchmark.statistics import bound_of
from compare.benchmark.store import Store, key_of
from formulations import FAMILIES, Problem, ladder
from formulations.diagnosis import diagnose
from formulations.rungs import versions
from metaheuristics import algorithm

T = TypeVar("T")
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@contextmanager
def workers(jobs: int) -> Iterator[ProcessPoolExecutor]:
    """Worker processes, started afresh on every platform; an interrupt drops what waits."""
    pool = ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"))
    # workers inherit that they ignore an interrupt, which is this process's to handle, and that they
    # are the threads: linear algebra with threads of its own would only wait for the others
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    unset = [name for name in _THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(unset, "1"))
    try:
        for _ in range(jobs):
            pool.submit(os.getpid)
    finally:
        signal.signal(signal.SIGINT, before)
        for name in unset:
            del os.environ[name]
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()


def each(
    pool: ProcessPoolExecutor,
    title: str,
    function: Callable[..., T],
    calls: Iterable[tuple[Any, ...]],
) -> Iterator[T]:
    """Results of ``function(*call)`` as they end, under a progress bar with the time left."""
    waiting = list(calls)[::-1]
    with tqdm(total=len(waiting), desc=title, unit="", disable=None, leave=False) as bar:
        if not sys.stderr.isatty():
            print(f"{title}: {len(waiting)}", file=sys.stderr, flush=True)
        running: set[Future[T]] = set()
        while waiting or running:
            while waiting and len(running) < 64:  # enough to keep every worker busy
                running.add(pool.submit(function, *waiting.pop()))
            done, running = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                bar.update()
                yield future.result()


def climb(
    pool: ProcessPoolExecutor, problems: dict[str, Problem], store: Store, *, certify: bool = True
) -> None:
    """Every bound of every case, written to the store; the longest task first."""
    longest_first = sorted(problems.items(), key=lambda item: -item[1].n_segments)
    calls = [(case, problem, certify) for case, problem in longest_first]
    for case, found in each(pool, "bounds", _ladder, calls):
        store.write_ladder(case, found)


def swarm(
    pool: ProcessPoolExecutor, runs: list[Run], problems: dict[str, Problem], store: Store
) -> None:
    """Every run that the store does not have yet; rows in the order of the runs when all are done."""
    ladders = store.ladders()
    bounds = {case: bound_of(ladders[case]) for case in problems}
    facts = {
        case: {"problem": digest(problem), "versions": versions_text(), "machine": machine()}
        for case, problem in problems.items()
    }
    libraries = {name: algorithm(name).versions for name in {run.swarm for run in runs}}
    finished = {
        key_of(row)
        for row in store.rows()
        if row["case"] in facts
        and all(row[name] == facts[row["case"]][name] for name in ("problem", "versions"))
        and row["library"] == libraries.get(row["swarm"])
    }
    left = [run for run in runs if run.key not in finished]
    batches = [left[i : i + _BATCH] for i in range(0, len(left), _BATCH)]
    calls = [([(run, problems[run.case], *bounds[run.case]) for run in batch],) for batch in batches]
    for graded in each(pool, f"swarms (x{_BATCH} runs)", _grades, calls):
        for one in graded:
            store.add(one, facts[one.run.case])
    store.sort(runs)


def audits(pool: ProcessPoolExecutor, papers: list[str], store: Store) -> None:
    """The audit of every paper that the store does not have yet; the longest first."""
    facts = {
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
        if any(kept.get(paper, {}).get(name) != facts[paper][name] for name in ("digest", "versions"))
    ]
    for paper, found in each(pool, "audits", _audit, [(paper,) for paper in sorted(left, key=_work)]):
        store.write_audit(paper, facts[paper], found)


def _work(paper: str) -> float:
    """Less for what takes longer: proofs, whose boxes double with every segment."""
    return -sum(len(p.rows) * 2.0**p.n_waypoints for p in load_papers(paper))


def _audit(name: str) -> tuple[str, list[dict[str, Any]]]:
    return name, [audit(paper).to_json() for paper in load_papers(name)]


def honest(pool: ProcessPoolExecutor, problems: dict[str, Problem], store: Store) -> None:
    """What each case's paper should have found, from the ladders and rows of the store."""
    rows, ladders = store.rows(), store.ladders()
    calls = [
        (case, problem, ladders[case], [row for row in rows if row["case"] == case])
        for case, problem in problems.items()
    ]
    for case, lines in each(pool, "honest tables", _honest, calls):
        store.write_honest(case, lines)


def _honest(
    case: str, problem: Problem, ladder: dict[str, Any], rows: list[dict[str, Any]]
) -> tuple[str, list[dict[str, Any]]]:
    return case, [asdict(line) for line in honest_table(problem, ladder, rows)]


_BATCH = 5  # runs per call: a run takes milliseconds


def _ladder(case: str, problem: Problem, certify: bool) -> tuple[str, dict[str, Any]]:
    climbed = ladder(problem, certify=certify)
    found = climbed.to_json()
    found["alone"] = [None if one is None else one.seconds for one in climbed.alone]
    found["title"], found["family"] = problem.title, problem.family
    if climbed.free_form is not None:
        found["held_up_by"] = diagnose(problem, climbed.free_form).lines()
    return case, found


def _grades(batch: list[tuple[Run, Problem, float | None, str]]) -> list[Graded]:
    return [grade(*one) for one in batch]


def digest(problem: Problem) -> str:
    """Short hash of what defines a problem: waypoints, limits, family."""
    limits = problem.limits
    parts = (problem.waypoints, limits.derivatives, limits.position)
    data = b"".join(np.ascontiguousarray(part).tobytes() for part in parts)
    return hashlib.sha256(data + problem.family.encode()).hexdigest()[:12]


def versions_text() -> str:
    """Versions of what made the numbers, on one line."""
    return " ".join(f"{name}={version}" for name, version in versions().items())


def machine() -> str:
    """Processor, cores and system, on one line."""
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
        model = names[0] if names else model
    except OSError:
        pass  # not Linux: the general name will do
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"


def warm_up(problems: dict[str, Problem]) -> None:
    """Compile the kernels once here, so that the workers find them in the cache."""
    for problem in problems.values():
        family = FAMILIES[problem.family]
        ones = np.ones((2, problem.n_segments))  # a single one is not compiled
        family.stretch(problem, ones)
        family.position_excess(problem, ones)
