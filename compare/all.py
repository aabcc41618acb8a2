"""``python -m compare.all``: every case, swarm and coding, the papers' audits, and the report."""

from __future__ import annotations

import os
import time

from compare.benchmark import suite
from compare.benchmark.known_times import key_of_paper
from compare.benchmark.objective import CODINGS
from compare.benchmark.run import audits, climb, swarm, tabulate_known_times, warm_up, workers
from compare.benchmark.store import Settings, Store
from compare.commands import shared as commands
from compare.report.page import render
from compare.studies import bias, proofs
from formulations import CASES, InputError, load
from metaheuristics import ALGORITHMS

# random 3-5-3 problems, most segments, problems per size: what a proof costs, in the report
PROOFS = {"default": (40, 5, 1), "full": (1000, 8, 2)}
# who is drawn to zero: functions, arms, seeds, evaluations
BIAS: dict[str, tuple[list[str], list[str], int, int]] = {
    "default": (["sphere"], ["sr4c"], 5, 2550),
    "full": (list(bias.FUNCTIONS), ["sr4c", "ur5", "cobot", "bagging"], 10, 5000),
}


def main() -> int:
    """Run a comparison and write its report."""
    parser = commands.parser(
        "all",
        "Run every swarm on every case in every coding against the family's optimum, audit the papers\n"
        "of the cases, and write the report: DIR/index.html, report.md, rows.csv and all figures.",
        "python -m compare.all --cases sr4c,ur5 --swarms pso,mipso --seeds 30 --out report",
    )
    size = parser.add_mutually_exclusive_group()
    size.add_argument(
        "--quick",
        action="store_true",
        help="2 seeds, 420 evaluations, few swarms, no proofs, no audits, no B-spline",
    )
    size.add_argument(
        "--full", action="store_true", help="30 seeds, the papers' own budgets, more controls"
    )
    parser.add_argument("--out", default="report", metavar="DIR", help="folder of the report")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="worker processes")
    parser.add_argument("--cases", help=f"some of {','.join(CASES)}")
    parser.add_argument(
        "--swarms",
        help=f"some of {','.join(ALGORITHMS)}; library:Name of mealpy, pymoo, nevergrad, minion; or"
        " your own, module:function",
    )
    parser.add_argument("--rivals", action="store_true", help=f"these too: {', '.join(suite.RIVALS)}")
    parser.add_argument(
        "--apart",
        type=float,
        metavar="SECONDS",
        help="every search in a process of its own, for at most so many seconds of the swarm's work",
    )
    parser.add_argument("--codings", help=f"some of {','.join(CODINGS)}")
    parser.add_argument("--seeds", type=int, help="number of seeds")
    parser.add_argument("--budget", type=int, help="evaluations per search, for all cases")
    parser.add_argument(
        "--resume", action="store_true", help="keep the finished rows of an interrupted run"
    )
    options = parser.parse_args()

    started = time.perf_counter()
    name = "quick" if options.quick else "full" if options.full else "default"
    cases = commands.chosen("--cases", options.cases, CASES)
    if options.quick and options.cases is None:
        cases = suite.quick_cases()
    for key in ("jobs", "seeds", "budget"):
        if getattr(options, key) is not None:
            commands.positive(f"--{key}", getattr(options, key))
    if options.apart is not None and not options.apart > 0:
        raise InputError(f"--apart: {options.apart:g} is not positive")
    swarms = commands.swarms("--swarms", options.swarms, suite.swarms_of(name))
    if options.rivals:
        swarms = commands.swarms("--rivals", ",".join([*swarms, *suite.RIVALS]), [])
    runs = suite.runs(
        size=name,
        cases=cases,
        swarms=swarms,
        codings=commands.chosen("--codings", options.codings, CODINGS),
        seeds=options.seeds,
        evaluations=options.budget,
        seconds=options.apart,
    )
    problems = {case: load(case) for case in cases}
    store = Store(commands.output_folder(options.out))
    if options.resume:
        store.mend()
    else:
        store.clear()
    budgets = sorted({run.budget for run in runs})
    settings = Settings(
        size=name,
        cases=tuple(cases),
        seeds=max(run.seed for run in runs) + 1,
        budget=" or ".join(str(budget) for budget in budgets) + " evaluations",
    )
    store.write_settings(settings)

    warm_up(problems)
    with workers(options.jobs) as pool:
        climb(pool, problems, store, certify=not options.quick)
        if not options.quick:
            audits(pool, sorted({paper for case in cases if (paper := key_of_paper(case))}), store)
        swarm(pool, runs, problems, store)
        tabulate_known_times(pool, problems, store)
        if name in PROOFS and options.cases is None:
            proofs.study(pool, proofs.tasks(*PROOFS[name]), store.folder)
        if name in BIAS and options.cases is None:
            functions, arms, seeds, budget = BIAS[name]
            bias.study(pool, store.folder, cases=arms, functions=functions, swarms=swarms,
                       seeds=seeds, budget=budget)  # fmt: skip
        page = render(pool, store.folder, problems, settings)
    print(f"report: {page} ({len(runs)} runs, {time.perf_counter() - started:.0f} s)")
    return commands.DONE


if __name__ == "__main__":
    commands.run(main)
