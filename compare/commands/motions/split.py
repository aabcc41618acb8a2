"""``timebound split FILE``: where the time goes between a swarm's motion and the fastest one."""

from __future__ import annotations

import sys
from typing import Annotated

import matplotlib as mpl
import matplotlib.pyplot as plt
from cyclopts import Parameter

from compare.benchmark.objective import CODINGS
from compare.commands import DONE
from compare.commands.motions.problem_options import FileOrRobot, OwnRobotOptions, problem_of
from compare.commands.options import Budget, Codings, Json, Seed, Swarm, positive, writable
from compare.screen import show, stages
from compare.studies.time_split import as_json, as_text, run_and_split, split_figure
from formulations import InputError


def split(
    file: FileOrRobot = None,
    /,
    *,
    own: OwnRobotOptions = None,
    swarm: Swarm = "pso",
    codings: Codings = None,
    seed: Seed = 0,
    budget: Budget = 2550,
    population: Annotated[int, Parameter(validator=positive)] = 50,
    json: Json = None,
    figure: Annotated[str | None, Parameter(metavar="FILE", validator=writable)] = None,
) -> int:
    """Show where the time goes, from a swarm's motion down to the bound on every motion there is.

    What a motion loses to the swarm's search, to the papers' rule of the longest segment, to the
    spline's timing and to its path adds up to its whole distance from the bound.

    Parameters
    ----------
    population
        Vectors per population.
    figure
        Draw the shares (.svg, .png or .pdf).
    """
    problem = problem_of(file, own)
    wanted = list(codings or CODINGS)
    with stages(problem.name) as stage:
        splits, reasons = run_and_split(
            problem, swarm, wanted, seed=seed, budget=budget, population=population, progress=stage
        )
    for coding, reason in reasons.items():
        print(f"{coding}: no verified motion ({reason})", file=sys.stderr)
    if not splits:
        raise InputError(f"--swarm: {swarm} found no verified motion in {', '.join(wanted)}")
    text = [
        f"{problem.name}, {swarm}, {coding} coding: {CODINGS[coding]}\n{as_text(shares)}\n"
        for coding, shares in splits.items()
    ]
    show("\n".join(text), {"problem": problem.name, "swarm": swarm, "split": as_json(splits)}, json)
    if figure is not None:
        mpl.use("Agg")
        drawn = split_figure(f"{problem.name}: where the time of {swarm} goes", splits)
        try:
            drawn.savefig(figure, bbox_inches="tight")
        except (OSError, ValueError) as error:
            raise InputError(f"--figure: {figure}: {error}") from None
        plt.close(drawn)
    return DONE
