"""``timebound all``: every case, swarm and coding, the papers' audits, the studies, and the report."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from typing import Annotated

from cyclopts import Parameter

from compare.benchmark.below_bound import BelowBoundError
from compare.benchmark.estimate import estimate, part
from compare.benchmark.grade import Run
from compare.benchmark.known_times import key_of_paper
from compare.benchmark.objective import CODINGS
from compare.benchmark.plan import quick_cases, runs
from compare.benchmark.protocol import RIVALS, SEEDS, Coordinates, Track, swarms_of
from compare.benchmark.proving import prove_all
from compare.benchmark.records.settings import Settings, budget_words
from compare.benchmark.records.store import Store
from compare.benchmark.run import audits, climb, measured, swarm, tabulate_known_times, warm_up
from compare.benchmark.suite import SIZE, Instance, chosen, suite
from compare.benchmark.tuning.constants import constants_for
from compare.commands import DONE, FAILED
from compare.commands.benchmark.seeds import SeedList
from compare.commands.options import (
    CORES,
    CasesOrFiles,
    Codings,
    Jobs,
    OnCluster,
    Out,
    SeenIn,
    Swarms,
    Tracks,
    positive,
)
from compare.engines import Engine, start
from compare.files import output_folder
from compare.papers.making import draw_again
from compare.report.page import render
from compare.report.suite_page import render_suite
from compare.studies import proofs, study, zones
from compare.studies.drawn_to_zero import bias
from compare.studies.drawn_to_zero.centred_functions import FUNCTIONS
from formulations import CASES, InputError

# random 3-5-3 problems, most segments, problems per size: what a proof costs, in the report
PROOFS = {"default": (40, 5, 1), "full": (1000, 8, 2)}
ZONES = (0.01, 0.1)  # rad: sizes of the zones at the inner waypoints of the papers' arms
# which swarms are drawn to zero: functions, arms, seeds, evaluations
BIAS: dict[str, tuple[list[str], list[str], int, int]] = {
    "default": (["sphere"], ["sr4c"], 5, 2550),
    "full": (list(FUNCTIONS), ["sr4c", "ur5", "cobot", "bagging"], 10, 5000),
}


def compare_all(
    *,
    quick: bool = False,
    full: bool = False,
    suite_: Annotated[bool, Parameter(name="--suite")] = False,
    instances: Annotated[int | None, Parameter(metavar="N", validator=positive)] = None,
    out: Out = "report",
    jobs: Jobs = CORES,
    cluster: OnCluster = None,
    cases: CasesOrFiles = None,
    swarms: Swarms = None,
    rivals: Annotated[bool, Parameter(help=f"Run these too: {', '.join(RIVALS)}.")] = False,
    apart: Annotated[float | None, Parameter(metavar="SECONDS", validator=positive)] = None,
    codings: Codings = None,
    tracks: Tracks = None,
    coordinates: SeenIn = (Coordinates.printed,),
    constants: Annotated[str | None, Parameter(metavar="FILE")] = None,
    seeds: SeedList = None,
    budget: Annotated[int | None, Parameter(validator=positive)] = None,
    budget_factor: Annotated[int, Parameter(validator=positive)] = 1,
    resume: bool = False,
    machines: bool = False,
) -> int:
    """Grade every swarm on every case, audit the papers, and write the report.

    Every swarm runs on every case in every coding, and is graded against the optimum of the spline
    family. The report is DIR/index.html and DIR/report.md, its rows are DIR/rows.csv.

    Parameters
    ----------
    quick
        2 seeds, 420 evaluations, few swarms; no proofs, no audits, no B-spline.
    full
        31 seeds, the papers' own budgets, more control algorithms.
    suite_
        Grade on the benchmark's 60 instances instead; with --full by 31 seeds.
    instances
        The same on the first N instances of an endless list; the first 60 are the suite.
    constants
        What timebound tune wrote, for --tracks tuned; the shipped constants if left out.
    apart
        Run every search in a process of its own, for at most so many seconds of the swarm's work.
    seeds
        Number of seeds, or which: 10-19, or 3,5,8; 5 if left out.
    budget
        Evaluations of a run over the whole motion, for all cases; 2550 if left out.
    budget_factor
        Multiply every budget by 10, say, or 100.
    resume
        Keep the proofs and rows that an interrupted run has finished.
    machines
        Let rows of one swarm on one case come from different machines.
    """
    started = time.perf_counter()
    on_suite = suite_ or instances is not None
    _require_one(**{"--quick": quick, "--full": full})
    _require_one(**{"--quick": quick, "--suite": on_suite, "--cases": cases is not None and on_suite})
    size = "quick" if quick else "suite" if on_suite else "full" if full else "default"
    named = cases or (quick_cases() if quick else CASES)
    graded_on = suite(instances or SIZE) if on_suite else chosen(named)
    wanted = list(swarms or swarms_of(size))
    if rivals:
        from compare.commands.names import found_swarms

        wanted = list(found_swarms(",".join([*wanted, *RIVALS])))
    problems = {one.name: one.problem for one in graded_on}
    followed = tracks or ((Track.equal,) if on_suite else (Track.equal, Track.paper))
    planned = runs(
        problems,
        size=size,
        swarms=wanted,
        codings=list(codings or CODINGS),
        tracks=followed,
        constants=constants_for(wanted, constants) if Track.tuned in followed else None,
        coordinates=coordinates,
        seeds=seeds or SEEDS["full" if full else size],
        evaluations=budget,
        factor=budget_factor,
        seconds=apart,
    )
    store = Store(output_folder(out))
    if not resume:
        store.clear()
    settings = Settings(
        size=size,
        cases=tuple(problems),
        seeds=tuple(sorted({run.seed for run in planned})),
        budget=budget_words(sorted({run.budget for run in planned})),
        allow=("machine",) if machines else (),
    )
    store.write_settings(settings)

    warm_up(problems)
    try:
        with start(jobs, cluster) as pool:
            if on_suite:
                prove_all(pool, graded_on, store)
            else:
                _bounds(pool, graded_on, store, quick=quick)
            if full:
                _announce(pool, planned, store, graded_on, jobs)
            swarm(pool, planned, problems, store, allow=settings.allow)
            if on_suite:
                page = render_suite(store, graded_on, settings)
            else:
                tabulate_known_times(pool, problems, store)
                if cases is None:
                    _studies(pool, size, wanted, store, resume=resume)
                page = render(pool, store.folder, problems, settings)
                draw_again(store.folder, jobs)
    except BelowBoundError as error:
        print(f"error: {error}", file=sys.stderr)
        return FAILED
    print(f"report: {page} ({len(planned)} runs, {time.perf_counter() - started:.0f} s)")
    return DONE


def _require_one(**given: bool) -> None:
    """Refuse options that exclude each other."""
    if sum(given.values()) > 1:
        raise InputError(f"{', '.join(given)}: only one of them can be given")


def _bounds(pool: Engine, instances: Sequence[Instance], store: Store, *, quick: bool) -> None:
    """Every bound of every case, and the audits of their papers."""
    for one in instances:
        store.write_instance(one.name, one.to_json())
    climb(pool, {one.name: one.problem for one in instances}, store, certify=not quick)
    if not quick:
        papers = {paper for one in instances if (paper := key_of_paper(one.name))}
        audits(pool, sorted(papers), store)


def _studies(pool: Engine, size: str, swarms: list[str], store: Store, *, resume: bool) -> None:
    """The studies beside the main comparison."""
    if size in PROOFS:
        calls = proofs.calls(*PROOFS[size])
        study.run(proofs.STUDY, calls, folder=store.folder, pool=pool, resume=resume)
        calls = zones.calls(CASES, ZONES)
        study.run(zones.STUDY, calls, folder=store.folder, pool=pool, resume=resume)
    if size in BIAS:
        functions, arms, repeats, evaluations = BIAS[size]
        calls = bias.calls(functions, arms, swarms, repeats, evaluations)
        study.run(bias.STUDY, calls, folder=store.folder, pool=pool, resume=resume)


def _announce(
    pool: Engine, planned: list[Run], store: Store, instances: Sequence[Instance], jobs: int
) -> None:
    """Say how long the runs will take, before they begin."""
    problems = {one.name: one.problem for one in instances}
    rows = measured(pool, part(planned), problems, store)
    hours = estimate(rows, planned, jobs) / 3600.0
    print(
        f"estimate: {len(planned)} runs take about {hours:.2g} hours with {jobs} workers"
        f" (from {len(rows)} of them)",
        file=sys.stderr,
        flush=True,
    )
