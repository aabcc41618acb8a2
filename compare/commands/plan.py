"""``python -m compare.plan FILE``: the fastest motion alone, under further conditions."""

from __future__ import annotations

import argparse
import sys
from math import isfinite
from pathlib import Path

import numpy as np

from compare.commands import shared as commands
from formulations import Conditions, FreeForm, InputError, NoFeasibleMotion, free_form, load
from formulations.motion.motion_file import write_motion
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem


def main() -> int:
    """Plan one motion."""
    parser = commands.parser(
        "plan",
        "The fastest motion through the waypoints of a problem, or the smoothest in a given time.\n"
        "Waypoints count from 0, the start.",
        "python -m compare.plan ur5 --stop 1 --pass 2=12.5 --export ur5.csv --rate 125",
    )
    parser.add_argument("file", metavar="FILE", help="a problem file (TOML) or a shipped case")
    parser.add_argument(
        "--stop", type=int, action="append", default=[], metavar="K", help="stand still at waypoint K"
    )
    parser.add_argument(
        "--pass", dest="passage", action="append", default=[], metavar="K=T",
        help="pass waypoint K at T seconds",
    )  # fmt: skip
    parser.add_argument(
        "--total", type=float, metavar="T", help="take T seconds, as smoothly as can be"
    )
    for end in ("start", "end"):
        parser.add_argument(
            f"--{end}-velocity", metavar="V,V,..", help="velocity there, one per joint [rad/s]"
        )
    parser.add_argument("--gap", type=float, default=1e-3, help="relative tolerance aimed at")
    parser.add_argument("--export", metavar="FILE", help="write the motion (.csv or .json)")
    parser.add_argument(
        "--rate", type=float, help="points a second in that file; left out: where the pieces meet"
    )
    parser.add_argument("--json", metavar="OUT", help="write times and judged peaks as JSON")
    options = parser.parse_args()
    problem = load(options.file)
    live = sys.stderr.isatty()

    def progress(stage: str, seconds: float) -> None:
        if live:
            print(f"\r\033[K{stage}: {seconds:.6g} s", end="", file=sys.stderr, flush=True)

    try:
        found = free_form(
            problem, conditions=_conditions(options, problem), tolerance=options.gap, progress=progress
        )
    except NoFeasibleMotion as none:
        raise InputError(str(none)) from None
    finally:
        if live:
            print("\r\033[K", end="", file=sys.stderr)
    print(as_text(problem, found))
    if options.export and found.trajectory is None:
        raise InputError("--export: nothing moves")
    if options.export and found.trajectory is not None:
        write_motion(options.export, found.trajectory, rate=options.rate)
        print(f"\n{options.export}: written")
    if options.json:
        commands.write_json(Path(options.json), _as_json(problem, found))
    return commands.DONE


def _conditions(options: argparse.Namespace, problem: Problem) -> Conditions:
    passage = {}
    for text in options.passage:
        waypoint, separator, time = text.partition("=")
        try:
            passage[int(waypoint)] = float(time)
        except ValueError:
            separator = ""
        if not separator:
            raise InputError(f"--pass: {text!r} is not of the form K=T, such as 2=1.5")
    return Conditions(
        passage=passage,
        total=options.total,
        stops=frozenset(options.stop),
        start_velocity=_velocity("--start-velocity", options.start_velocity, problem),
        end_velocity=_velocity("--end-velocity", options.end_velocity, problem),
    )


def _velocity(key: str, text: str | None, problem: Problem) -> Array | None:
    if text is None:
        return None
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"{key}: {text!r} is not a list of numbers") from None
    if len(values) != problem.dof or not all(isfinite(value) for value in values):
        raise InputError(f"{key}: expected {problem.dof} finite numbers, got {text!r}")
    return np.array(values)


def as_text(problem: Problem, found: FreeForm) -> str:
    """Total, passage times, and the limits used most, as judged."""
    lines = [f"{problem.name}: {found.seconds:.9g} s ({found.method}, {found.status})"]
    if found.trajectory is None or found.verdict is None:
        return lines[0]
    passed = ", ".join(f"{time:.6g}" for time in found.trajectory.passage_times)
    lines.append(f"waypoints passed at {passed} s")
    lines.append("verified: keeps every limit; used most:")
    used = [peak for peak in found.verdict.peaks if peak.quantity != "position"]
    lines += [f"  {peak}" for peak in used[:3]]
    return "\n".join([*lines, *found.notes])


def _as_json(problem: Problem, found: FreeForm) -> dict[str, object]:
    passed = [] if found.trajectory is None else found.trajectory.passage_times.tolist()
    return {
        "problem": problem.name,
        "seconds": found.seconds,
        "passage_times": passed,
        "method": found.method,
        "status": found.status,
        "notes": list(found.notes),
        "peaks": [
            {key: value for key, value in vars(peak).items() if key != "stretch"}
            for peak in (() if found.verdict is None else found.verdict.peaks)
        ],
        "runtime": found.runtime,
    }


if __name__ == "__main__":
    commands.run(main)
