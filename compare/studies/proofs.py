"""``python -m compare.proofs``: what a certified bound costs, against segments and against the gap.

Random problems, posed and proved one by one: boxes, time and gap reached, and how often one local solve
alone ends in the wrong basin. Rows go to DIR/proofs.csv as they end; the pictures are drawn from there.
"""

from __future__ import annotations

import csv
import os
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark.run import each, machine, workers
from compare.commands import shared as commands
from compare.report.style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, styled
from formulations import Limits, Problem, family_optimum
from formulations.proofs.family import family_bound

GAPS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
LIMITED = ("V", "VA", "VAJ")
TIME_LIMIT = 60.0  # s per proof


@dataclass(frozen=True)
class Task:
    """One random problem and the gaps asked for."""

    series: str
    segments: int
    joints: int
    limited: str
    seed: int
    gaps: tuple[float, ...]


@dataclass(frozen=True)
class Cost:
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


def random_problem(task: Task) -> Problem:
    """Displacements log-uniform in 1e-3 to 2 rad with random signs; limits near 1."""
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
    return Problem.of(waypoints, limits, name=f"random-{task.seed}")


def prove(task: Task) -> list[Cost]:
    """Pose one problem and prove it to every gap."""
    problem = random_problem(task)
    optimum = family_optimum(problem)
    alone = optimum.starts[0].seconds
    costs = []
    for gap in task.gaps:
        bound = family_bound(problem, gap=gap, time_limit=TIME_LIMIT, optimum=optimum)
        costs.append(
            Cost(
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


def tasks(count: int, most_segments: int, each_size: int) -> list[Task]:
    """``count`` random 3-5-3 problems of 1 to 7 joints; six joints with more segments and digits."""
    many = [
        Task("random 3-5-3", 3, 1 + seed % 7, LIMITED[seed % 3], seed, (1e-5,)) for seed in range(count)
    ]
    longer = [
        Task("segments", segments, 6, limited, seed, (1e-4,))
        for segments in range(2, most_segments + 1)
        for limited in LIMITED
        for seed in range(each_size)
    ]
    finer = [
        Task("digits", segments, 6, "VA", seed, GAPS)
        for segments in (3, 4, 5)
        for seed in range(each_size)
    ]
    return [*many, *longer, *finer]


@styled
def cost_figure(costs: list[Cost]) -> Figure:
    """Histogram of the random 3-5-3 problems; time against segments; time against the gap."""
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


def draw(costs: list[Cost], folder: Path) -> None:
    """Write the picture as SVG and PNG."""
    mpl.use("Agg")
    figure = cost_figure(costs)
    (folder / "figures").mkdir(exist_ok=True)
    figure.savefig(folder / "figures" / "proofs.svg", metadata={"Date": None})
    figure.savefig(folder / "figures" / "proofs.png")
    plt.close(figure)


def study(pool: ProcessPoolExecutor, wanted: list[Task], folder: Path) -> list[Cost]:
    """Prove them all, a row in DIR/proofs.csv as each ends, and draw what it cost."""
    costs: list[Cost] = []
    with (folder / "proofs.csv").open("w", newline="", encoding="utf-8") as lines:
        writer = csv.DictWriter(lines, list(Cost.__annotations__))
        writer.writeheader()
        for found in each(pool, "proofs", prove, [(task,) for task in wanted]):
            writer.writerows(asdict(cost) for cost in found)
            lines.flush()
            costs += found
    costs.sort(key=lambda cost: (cost.series, cost.segments, cost.limited, cost.seed, cost.gap_asked))
    draw(costs, folder)
    return costs


def main() -> int:
    """Prove random problems and draw what it cost."""
    parser = commands.parser(
        "proofs",
        "What a certified bound costs: boxes and time on random problems.",
        "python -m compare.proofs --count 1000 --segments 10 --out report",
    )
    parser.add_argument("--count", type=int, default=100, help="random 3-5-3 problems")
    parser.add_argument("--segments", type=int, default=6, help="most segments of six-joint problems")
    parser.add_argument("--each", type=int, default=2, help="problems per size, limits and gap")
    parser.add_argument("--out", default="report", metavar="DIR", help="folder of the report")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="worker processes")
    options = parser.parse_args()
    for key in ("count", "segments", "each", "jobs"):
        commands.positive(f"--{key}", getattr(options, key))
    folder = commands.output_folder(options.out)
    with workers(options.jobs) as pool:
        costs = study(pool, tasks(options.count, options.segments, options.each), folder)
    print(as_text(costs))
    print(machine())
    return commands.DONE


def as_text(costs: list[Cost]) -> str:
    """A line per series, size and limits."""
    rows = []
    groups: dict[tuple[str, int, str, float], list[Cost]] = {}
    for cost in costs:
        groups.setdefault((cost.series, cost.segments, cost.limited, cost.gap_asked), []).append(cost)
    for (series, segments, limited, gap), group in groups.items():
        boxes = [cost.boxes for cost in group]
        seconds = [cost.seconds for cost in group]
        proved = sum(cost.status == "proved" for cost in group)
        rows.append(
            [
                series, str(segments), limited, f"{gap:.0e}", f"{proved} of {len(group)}",
                f"{np.median(boxes):.0f}", f"{max(boxes)}", f"{np.median(seconds):.3f}",
                f"{max(seconds):.3f}", str(sum(cost.wrong_basin for cost in group)),
            ]
        )  # fmt: skip
    header = [
        "series",
        "segments",
        "limits",
        "gap",
        "proved",
        "boxes",
        "most",
        "s",
        "most",
        "wrong basin",
    ]
    return commands.table(header, rows, right=(1, 3, 4, 5, 6, 7, 8, 9))


if __name__ == "__main__":
    commands.run(main)
