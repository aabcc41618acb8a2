"""The plan of a comparison: every run that it consists of, in a fixed order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from compare.benchmark.grade import Run
from compare.benchmark.objective import CODINGS
from compare.benchmark.protocol import (
    DEFAULT_BUDGET,
    PAPER_BUDGETS,
    QUICK_BUDGET,
    SEEDS,
    Coordinates,
    Track,
    shares,
    swarms_of,
)
from formulations import CASES, Problem, load


def quick_cases() -> list[str]:
    """Names of all cases but the B-splines, whose optimum takes longer than a quick run may."""
    return [case for case in CASES if not load(case).family.startswith("b-spline")]


def runs(
    problems: Mapping[str, Problem],
    *,
    size: str = "default",
    swarms: Sequence[str] | None = None,
    codings: Sequence[str] | None = None,
    tracks: Sequence[Track] = (Track.equal, Track.paper),
    coordinates: Sequence[Coordinates] = (Coordinates.printed,),
    seeds: int | Sequence[int] | None = None,
    evaluations: int | None = None,
    factor: int = 1,
    seconds: float | None = None,
    constants: Mapping[str, Mapping[str, float | int]] | None = None,
) -> list[Run]:
    """List the runs of one comparison, in a fixed order.

    Parameters
    ----------
    problems : mapping of str to Problem
        By case.
    size : str
        A key of ``SEEDS``; it decides whatever is None below.
    swarms, codings : sequence of str, optional
        Names; all codings, and the swarms of the size if left out.
    tracks : sequence of Track
        The track ``paper`` differs from ``equal`` in the published coding alone, and has runs of that
        coding alone. It gives each joint the budget that ``equal`` gives the whole motion.
    coordinates : sequence of Coordinates
    seeds : int or sequence of int, optional
        Number of seeds, or the seeds themselves.
    evaluations : int, optional
        Budget of each run, over the whole motion.
    factor : int
        Multiplies every budget.
    seconds : float, optional [s]
        Time limit of a search in a process of its own, for every swarm.
    constants : mapping of str to mapping, optional
        Tuned constants by swarm, for the track ``tuned``; of every swarm, if there is that track.

    Returns
    -------
    list of Run

    Raises
    ------
    InputError
        If a budget is less than one evaluation for each joint that moves.
    """
    number = SEEDS[size] if seeds is None else seeds
    chosen = range(number) if isinstance(number, int) else number
    listed = []
    for case, problem in problems.items():
        budget = DEFAULT_BUDGET
        if size == "quick":
            budget = QUICK_BUDGET
        elif size == "full":
            budget = PAPER_BUDGETS.get(case, DEFAULT_BUDGET)
        total = (evaluations or budget.evaluations) * factor
        joints = len(problem.moving_joints)
        shares(total, joints)  # refused here, before anything is computed
        listed += [
            Run(
                case,
                coding,
                swarm,
                seed,
                total * joints if track is Track.paper and joints else total,
                budget.population,
                seconds,
                track,
                seen,
                tuple((constants or {})[swarm].items()) if track is Track.tuned else (),
            )
            for coding in (codings if codings is not None else CODINGS)
            for track in tracks
            if track is not Track.paper or coding == "published"
            for seen in coordinates
            for swarm in (swarms if swarms is not None else swarms_of(size))
            for seed in chosen
        ]
    return listed
