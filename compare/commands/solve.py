"""``python -m compare.solve FILE``: every bound of one problem, on screen and as JSON."""

from __future__ import annotations

import sys
from dataclasses import asdict
from math import isfinite
from pathlib import Path
from typing import Any

from compare.commands import shared as commands
from formulations import RUNGS, InputError, Ladder, ladder, load
from formulations.diagnosis import diagnose
from formulations.motion.motion_file import write_motion
from formulations.proofs.certificate import write_certificate

_LINES = 8  # of what holds the motion up


def main() -> int:
    """Solve one problem file or shipped case."""
    parser = commands.parser(
        "solve",
        "The ladder of bounds of one problem: what no motion can beat, and the best known motions.",
        "python -m compare.solve sr4c --json sr4c.json",
    )
    parser.add_argument("file", metavar="FILE", help="a problem file (TOML) or a shipped case")
    parser.add_argument("--json", metavar="OUT", help="write the ladder as JSON too")
    parser.add_argument(
        "--certificate",
        metavar="FILE",
        help="write the proof of family_lower, for python -m compare.check_certificate",
    )
    parser.add_argument(
        "--motion-certificate", metavar="FILE", help="the same of free_form_lower: of every motion"
    )
    parser.add_argument(
        "--gap", type=float, default=1e-3, help="aimed at between free_form and free_form_lower"
    )
    parser.add_argument(
        "--export", metavar="FILE", help="write the fastest verified motion (.csv or .json)"
    )
    parser.add_argument(
        "--rate", type=float, help="points a second in that file; left out: where the pieces meet"
    )
    parser.add_argument("--seed", type=int, default=0, help="seed of the NLP's random starts")
    options = parser.parse_args()
    if not (isfinite(options.gap) and options.gap > 0.0):
        raise InputError(f"--gap: {options.gap:g} is not a positive number")

    problem = load(options.file)
    live = sys.stderr.isatty()

    def progress(key: str) -> None:
        if live:
            print(f"\r\033[K{key} ...", end="", file=sys.stderr, flush=True)

    answer = ladder(
        problem,
        seed=options.seed,
        certificate=bool(options.certificate or options.motion_certificate),
        gap=options.gap,
        progress=progress,
    )
    held = None
    if answer.free_form is not None:
        progress("what holds it up")
        held = diagnose(problem, answer.free_form)
    if live:
        print("\r\033[K", end="", file=sys.stderr)
    print(f"{problem.name}: {problem.title}")
    print(f"{problem.dof} joints, {problem.n_segments} segments, family {problem.family}\n")
    print(as_text(answer))
    if held is not None and held.holds:
        print("\nwhat holds the fastest motion up")
        print("\n".join(f"  {line}" for line in held.lines()[:_LINES]))
    if options.json:
        diagnosis = None if held is None else asdict(held)
        commands.write_json(Path(options.json), {**answer.to_json(), "diagnosis": diagnosis})
    if options.export:
        _export(options.export, answer, options.rate)
    wanted = {
        "family_lower": (options.certificate, answer.bound),
        "free_form_lower": (options.motion_certificate, answer.free_form_bound),
    }
    written = [
        _write_certificate(path, key, None if bound is None else bound.certificate, answer)
        for key, (path, bound) in wanted.items()
        if path
    ]
    return commands.DONE if all(written) else commands.FAILED


def _export(path: str, answer: Ladder, rate: float | None) -> None:
    """Write the fastest motion that passed the check."""
    verified = {key: answer.rungs[key].seconds or 0.0 for key in answer.trajectories}
    verified = {key: value for key, value in verified.items() if answer.rungs[key].kind == "upper"}
    if not verified:
        raise InputError("--export: there is no verified motion")
    key = min(verified, key=lambda key: verified[key])
    write_motion(path, answer.trajectories[key], rate=rate)
    print(f"\n{path}: {key}, {verified[key]:.9g} s")


def _write_certificate(path: str, key: str, certificate: dict[str, Any] | None, answer: Ladder) -> bool:
    """Write the proof of a rung, or say why there is none."""
    if certificate is None:
        reason = answer.rungs[key].note or "nothing was proved beyond the displacements"
        print(f"{key}: no certificate was written: {reason}", file=sys.stderr)
        return False
    write_certificate(path, certificate)
    print(f"\n{path}: proof of {float.fromhex(certificate['seconds']):.9g} s, {key}")
    return True


def as_text(answer: Ladder) -> str:
    """The ladder as a plain table, shortest time first; rungs without a number last, with reasons."""
    rungs = sorted(answer.rungs.values(), key=lambda r: (r.seconds is None, r.seconds or 0.0))
    rows = []
    for rung in rungs:
        proof = {"lower": "proved", "upper": "verified", "reference": "discretised"}[rung.kind]
        rows.append(
            [
                rung.key,
                "-" if rung.seconds is None else f"{rung.seconds:.6f} s",
                proof if rung.status == "ok" else rung.status,
                f"{rung.runtime:.2f} s",
                RUNGS[rung.key].meaning,
            ]
        )
    notes = [f"  {rung.key}: {rung.note}" for rung in rungs if rung.note]
    header = ["rung", "time", "status", "took", "what it is"]
    return "\n".join([commands.table(header, rows, right=(1, 3)), "", "notes", *notes])


if __name__ == "__main__":
    commands.run(main)
