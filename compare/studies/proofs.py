"""What a certified bound costs, against segments and gap: the study behind ``timebound proofs``.

Random problems are stated and proved one by one: how many boxes, how much time, which gap is reached,
and how often a single local solve ends in the wrong basin.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.report.style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, styled
from compare.screen import table
from compare.studies.study import Call, Study
from formulations import FAMILIES, Limits, Problem, proved_optimum
from formulations.proofs.family import family_bound

GAPS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
LIMITED = ("V", "VA", "VAJ")
TIME_LIMIT = 60.0  # s per proof


@dataclass(frozen=True)
class ProofTask:
    """One random problem and the gaps asked for."""

    series: str
    segments: int
    joints: int
    limited: str
    seed: int
    gaps: tuple[float, ...]
    family: str = ""
    position: bool = False


@dataclass(frozen=True)
class ProofCost:
    """What a proof cost. wrong_basin: the first local solve alone ended over 1e-6 above the best."""

    series: str
    segments: int
    joints: int
    limited: str
    seed: int
    gap_asked: float
    gap_reached: float
    bound: float
    upper: float
    boxes: int
    seconds: float
    status: str
    wrong_basin: bool


def random_problem(task: ProofTask) -> Problem:
    """Draw a problem: displacements log-uniform in 1e-3 to 2 rad with random signs, limits near 1.

    Position limits, where the task has some, leave 0.02 rad to the spline of equal durations.

    Parameters
    ----------
    task : ProofTask
        Its size, its limits and its seed.

    Returns
    -------
    Problem
        The same for the same task.
    """
    rng = np.random.default_rng([task.seed, task.segments, task.joints])
    shape = (task.segments, task.joints)
    d = rng.choice([-1.0, 1.0], shape) * 10.0 ** rng.uniform(-3.0, np.log10(2.0), shape)
    waypoints = np.concatenate([np.zeros((1, task.joints)), np.cumsum(d, axis=0)])
    velocity, acceleration, jerk = np.exp(rng.uniform(-0.5, 0.5, (3, task.joints)))
    limits = Limits.of(
        velocity,
        2.0 * acceleration if "A" in task.limited else np.inf,
        8.0 * jerk if "J" in task.limited else np.inf,
        dof=task.joints,
    )
    problem = Problem.of(waypoints, limits, family=task.family or None, name=f"random-{task.seed}")
    if not task.position:
        return problem
    ends = np.stack([waypoints.min(axis=0), waypoints.max(axis=0)], axis=1)
    closed = replace(problem, limits=replace(limits, position=ends))
    equal = np.ones((1, task.segments))
    margin = float(FAMILIES[problem.family].position_excess(closed, equal)[0]) + 0.02
    return replace(problem, limits=replace(limits, position=ends + margin * np.array([-1.0, 1.0])))


def prove(task: ProofTask) -> list[ProofCost]:
    """Solve one problem, and prove its bound to every gap.

    Parameters
    ----------
    task : ProofTask
        The problem and the gaps.

    Returns
    -------
    list of ProofCost
        A row per gap.
    """
    problem = random_problem(task)
    optimum, _ = proved_optimum(problem)
    alone = optimum.starts[0].seconds
    costs = []
    for gap in task.gaps:
        bound = family_bound(problem, gap=gap, time_limit=TIME_LIMIT, optimum=optimum)
        costs.append(
            ProofCost(
                series=task.series,
                segments=task.segments,
                joints=task.joints,
                limited=task.limited,
                seed=task.seed,
                gap_asked=gap,
                gap_reached=bound.gap,
                bound=bound.seconds,
                upper=bound.upper,
                boxes=bound.boxes,
                seconds=bound.runtime,
                status=bound.outcome,
                wrong_basin=alone > bound.upper * (1.0 + 1e-6),
            )
        )
    return costs


def calls(count: int, most_segments: int, each_size: int) -> list[Call]:
    """List the calls of the study.

    Parameters
    ----------
    count : int
        Random 3-5-3 problems, of one to seven joints.
    most_segments : int
        Most segments of the problems with six joints; of B-splines at most six.
    each_size : int
        Problems per size, limits and gap.

    Returns
    -------
    list of tuples
        Arguments of ``prove``.
    """
    many = [
        ProofTask("random 3-5-3", 3, 1 + seed % 7, LIMITED[seed % 3], seed, (1e-5,))
        for seed in range(count)
    ]
    longer = [
        ProofTask("segments", segments, 6, limited, seed, (1e-4,))
        for segments in range(2, most_segments + 1)
        for limited in LIMITED
        for seed in range(each_size)
    ]
    finer = [
        ProofTask("digits", segments, 6, "VA", seed, GAPS)
        for segments in (3, 4, 5)
        for seed in range(each_size)
    ]
    splines = [
        ProofTask(family, segments, 6, limited, seed, (1e-3,), family, position)
        for family in ("b-spline-3", "b-spline-5")
        for segments in range(3, min(most_segments, 6) + 1)
        for limited, position in (("VA", False), ("VAJ", True))
        for seed in range(each_size)
    ]
    return [(task,) for task in (*many, *longer, *finer, *splines)]


@dataclass(frozen=True)
class ProofGroup:
    """All problems of one series, size, kind of limits and gap. Times in s."""

    series: str
    segments: int
    limited: str
    gap: float
    problems: int
    proved: int
    boxes: float
    most_boxes: int
    seconds: float
    most_seconds: float
    wrong_basin: int


def summarise(costs: list[ProofCost]) -> list[dict[str, Any]]:
    """Take medians and largest values by series, size, limits and gap.

    Parameters
    ----------
    costs : list of ProofCost
        All rows.

    Returns
    -------
    list of dict
        A ``ProofGroup`` each.
    """
    groups: dict[tuple[str, int, str, float], list[ProofCost]] = {}
    for cost in costs:
        groups.setdefault((cost.series, cost.segments, cost.limited, cost.gap_asked), []).append(cost)
    return [
        asdict(
            ProofGroup(
                *key,
                problems=len(group),
                proved=sum(cost.status == "proved" for cost in group),
                boxes=float(np.median([cost.boxes for cost in group])),
                most_boxes=max(cost.boxes for cost in group),
                seconds=float(np.median([cost.seconds for cost in group])),
                most_seconds=max(cost.seconds for cost in group),
                wrong_basin=sum(cost.wrong_basin for cost in group),
            )
        )
        for key, group in sorted(groups.items())
    ]


@styled
def cost_figure(costs: list[ProofCost], summary: list[dict[str, Any]]) -> Figure:
    """Draw boxes of the random 3-5-3 problems, time against segments, and time against the gap.

    Parameters
    ----------
    costs : list of ProofCost
        All rows.
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    Figure
        Three panels.
    """
    figure, (first, second, third) = plt.subplots(1, 3, figsize=(11.5, 3.6))
    many = [cost for cost in costs if cost.series == "random 3-5-3"]
    boxes = np.array([max(cost.boxes, 1) for cost in many])
    if len(boxes):
        bins = np.geomspace(boxes.min() * 0.99, boxes.max() * 1.01, 25)
        first.hist(boxes, bins=list(bins), color=BLUE, alpha=0.8)
    first.set_xscale("log")
    wrong = sum(cost.wrong_basin for cost in many)
    proved = sum(cost.status == "proved" for cost in many)
    first.set_title(f"{len(many)} random 3-5-3: {proved} proved to 1e-5", loc="left", fontsize=9)
    first.set_xlabel(f"boxes (one local solve alone is wrong in {wrong})")
    first.set_ylabel("problems")
    for limited, colour, marker in zip(LIMITED, (GREEN, ORANGE, PURPLE), "osD", strict=True):
        mine = [c for c in costs if c.series == "segments" and c.limited == limited]
        for done, face in ((True, colour), (False, "white")):
            shown = [c for c in mine if (c.status == "proved") == done]
            second.plot([c.segments for c in shown], [c.seconds for c in shown], marker, ls="",
                        color=colour, mfc=face, ms=5, label=limited if done else None)  # fmt: skip
    second.set_yscale("log")
    second.set_xlabel("segments, six joints (hollow: not proved in time)")
    second.set_ylabel("time of the proof [s]")
    second.set_title("to a gap of 1e-4", loc="left", fontsize=9)
    second.legend(frameon=False, fontsize=8)
    for segments, colour, marker in ((3, BLUE, "o"), (4, VERMILION, "s"), (5, GREY, "D")):
        mine = [c for c in costs if c.series == "digits" and c.segments == segments]
        gaps = sorted({c.gap_asked for c in mine}, reverse=True)
        medians = [float(np.median([c.seconds for c in mine if c.gap_asked == gap])) for gap in gaps]
        third.plot(gaps, medians, marker + "-", color=colour, ms=4, label=f"{segments} segments")
    third.set_xscale("log")
    third.set_yscale("log")
    third.invert_xaxis()
    third.set_xlabel("gap asked for [1]")
    third.set_ylabel("time of the proof [s], median")
    third.set_title("six joints, velocity and acceleration", loc="left", fontsize=9)
    third.legend(frameon=False, fontsize=8)
    return figure


def as_text(costs: list[ProofCost], summary: list[dict[str, Any]]) -> str:
    """Lay the groups out as a table.

    Parameters
    ----------
    costs : list of ProofCost
        All rows.
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    str
        A line per series, size, limits and gap.
    """
    rows = [
        [
            g.series, str(g.segments), g.limited, f"{g.gap:.0e}", f"{g.proved} of {g.problems}",
            f"{g.boxes:.0f}", f"{g.most_boxes}", f"{g.seconds:.3f}", f"{g.most_seconds:.3f}",
            str(g.wrong_basin),
        ]
        for g in (ProofGroup(**entry) for entry in summary)
    ]  # fmt: skip
    header = ["series", "segments", "limits", "gap", "proved"]
    header += ["boxes", "most", "time [s]", "longest [s]", "wrong basin"]
    return table(header, rows, right=(1, 3, 4, 5, 6, 7, 8, 9))


STUDY = Study(
    name="proofs",
    row=ProofCost,
    compute=prove,
    summarise=summarise,
    text=as_text,
    figure=cost_figure,
)
