"""What ``timebound grade`` and ``timebound versus`` share."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import Annotated

from cyclopts import Parameter

from compare.benchmark.below_bound import BelowBoundError
from compare.benchmark.records.store import Store
from compare.commands import DONE, FAILED
from compare.engines import start
from compare.files import output_folder
from compare.grading.names import swarm_name
from compare.grading.page import as_text, write_page
from compare.grading.protocol import GradingProtocol
from compare.grading.running import chosen_instances, run_and_grade
from compare.screen import show
from compare.statistics.needed import MissingStatisticsError, all_present
from formulations import InputError
from metaheuristics import MissingLibraryError, UnknownAlgorithmError

Instances = Annotated[
    str | None,
    Parameter(name="--cases", metavar="NAME,..",
              help="Instances: names of the benchmark or of shipped cases, or problem files; the held-out"
                   " ones of the benchmark if left out."),
]  # fmt: skip


def graded_page(
    swarm: str,
    against: str,
    page: str,
    others: tuple[str, ...],
    *,
    out: str,
    json: str | None,
    seeds: int,
    budget: int,
    cases: str | None,
    jobs: int,
    cluster: str | None,
    zero: bool,
) -> int:
    """Grade a swarm, write its page, and show the verdict.

    Parameters
    ----------
    swarm, against : str
        As typed.
    page : str
        Name of the page.
    others : tuple of str
        Further swarms of the standing.
    out, json, seeds, budget, cases, jobs, cluster : str, str or None, int, int, str or None, int, str or None
        The options of the command.
    zero : bool
        Whether to test if the swarm is drawn to zero.

    Returns
    -------
    int
        The exit code.
    """
    try:
        all_present()
        names = [swarm_name(typed) for typed in (swarm, against)]
    except (UnknownAlgorithmError, MissingLibraryError, MissingStatisticsError) as error:
        raise InputError(str(error)) from None
    if names[0] == names[1]:
        raise InputError(f"{against}: is the swarm itself; name another one to compare it with")
    protocol = GradingProtocol(names[0], names[1], others, seeds=seeds, budget=budget)
    if not zero:
        protocol = replace(protocol, zero_instances=0)
    instances, kind = chosen_instances(cases)
    store = Store(output_folder(out))
    try:
        with start(jobs, cluster) as pool:
            found = run_and_grade(pool, protocol, instances, store, called=(swarm, against), kind=kind)
    except BelowBoundError as error:
        print(f"error: {error}", file=sys.stderr)
        return FAILED
    written = write_page(found, store.folder, page)
    show(f"{as_text(found)}\n\npage: {written}", {**found.to_json(), "page": str(written)}, json)
    return DONE
