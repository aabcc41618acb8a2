"""``timebound all``: every case, swarm and coding, the papers' audits, the studies, and the report."""

from __future__ import annotations

import time
from typing import Annotated

from cyclopts import Parameter

from compare.benchmark.known_times import key_of_paper
from compare.benchmark.objective import CODINGS
from compare.benchmark.plan import quick_cases, runs
from compare.benchmark.protocol import RIVALS, Coordinates, Track, swarms_of
from compare.benchmark.records.settings import Settings, budget_words
from compare.benchmark.records.store import Store
from compare.benchmark.run import audits, climb, swarm, tabulate_known_times, warm_up, workers
from compare.commands import DONE
from compare.commands.benchmark.seeds import SeedList
from compare.commands.options import (
    CORES,
    Cases,
    Codings,
    Jobs,
    Out,
    SeenIn,
    Swarms,
    Tracks,
    positive,
)
from compare.files import output_folder
from compare.report.page import render
from compare.studies import proofs, study
from compare.studies.drawn_to_zero import bias
from compare.studies.drawn_to_zero.centred_functions import FUNCTIONS
from formulations import CASES, InputError, load

# random 3-5-3 problems, most segments, problems per size: what a proof costs, in the report
PROOFS = {"default": (40, 5, 1), "full": (1000, 8, 2)}
# which swarms are drawn to zero: functions, arms, seeds, evaluations
BIAS: dict[str, tuple[list[str], list[str], int, int]] = {
    "default": (["sphere"], ["sr4c"], 5, 2550),
    "full": (list(FUNCTIONS), ["sr4c", "ur5", "cobot", "bagging"], 10, 5000),
}


def compare_all(
    *,
    quick: bool = False,
    full: bool = False,
    out: Out = "report",
    jobs: Jobs = CORES,
    cases: Cases = None,
    swarms: Swarms = None,
    rivals: Annotated[bool, Parameter(help=f"Run these too: {', '.join(RIVALS)}.")] = False,
    apart: Annotated[float | None, Parameter(metavar="SECONDS", validator=positive)] = None,
    codings: Codings = None,
    seeds: SeedList = None,
    budget: Annotated[int | None, Parameter(validator=positive)] = None,
    budget_factor: Annotated[int, Parameter(validator=positive)] = 1,
    tracks: Tracks = (Track.equal, Track.paper),
    coordinates: SeenIn = (Coordinates.printed,),
    resume: bool = False,
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
    apart
        Run every search in a process of its own, for at most so many seconds of the swarm's work.
    seeds
        Number of seeds, or which: 10-19, or 3,5,8; 5 if left out.
    budget
        Evaluations of a run over the whole motion, for all cases; 2550 if left out.
    budget_factor
        Multiply every budget by 10, say, or 100.
    resume
        Keep the rows that an interrupted run has finished.
    """
    started = time.perf_counter()
    if quick and full:
        raise InputError("--quick, --full: only one of them can be given")
    size = "quick" if quick else "full" if full else "default"
    chosen = list(cases or (quick_cases() if quick else CASES))
    wanted = list(swarms or swarms_of(size))
    if rivals:
        from compare.commands.options import found_swarms

        wanted = list(found_swarms(",".join([*wanted, *RIVALS])))
    problems = {case: load(case) for case in chosen}
    planned = runs(
        problems,
        size=size,
        swarms=wanted,
        codings=list(codings or CODINGS),
        tracks=tracks,
        coordinates=coordinates,
        seeds=seeds,
        evaluations=budget,
        factor=budget_factor,
        seconds=apart,
    )
    store = Store(output_folder(out))
    if not resume:
        store.clear()
    budgets = sorted({run.budget for run in planned})
    settings = Settings(
        size=size,
        cases=tuple(chosen),
        seeds=tuple(sorted({run.seed for run in planned})),
        budget=budget_words(budgets),
    )
    store.write_settings(settings)

    warm_up(problems)
    with workers(jobs) as pool:
        climb(pool, problems, store, certify=not quick)
        if not quick:
            audits(pool, sorted({paper for case in chosen if (paper := key_of_paper(case))}), store)
        swarm(pool, planned, problems, store)
        tabulate_known_times(pool, problems, store)
        if size in PROOFS and cases is None:
            calls = proofs.calls(*PROOFS[size])
            study.run(proofs.STUDY, calls, folder=store.folder, pool=pool, resume=resume)
        if size in BIAS and cases is None:
            functions, arms, repeats, evaluations = BIAS[size]
            calls = bias.calls(functions, arms, wanted, repeats, evaluations)
            study.run(bias.STUDY, calls, folder=store.folder, pool=pool, resume=resume)
        page = render(pool, store.folder, problems, settings)
    print(f"report: {page} ({len(planned)} runs, {time.perf_counter() - started:.0f} s)")
    return DONE
