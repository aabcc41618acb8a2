"""``python -m compare.check_certificate FILE``: re-prove a certified bound."""

from __future__ import annotations

import argparse
import json
import sys
from math import inf
from pathlib import Path
from typing import Any

from compare.check_certificate.answers import BadInput, Refused, need

CERTIFIED, REFUSED, BAD_INPUT = 0, 1, 2
LARGEST_FILE = 400_000_000


def compare_with(data: Any, file_or_case: str) -> None:
    """Refuse a certificate that is about another problem.

    This is the one place that uses the project's own loader.

    Parameters
    ----------
    data : dict
        A certificate that was verified.
    file_or_case : str
        The problem it must be about.
    """
    from formulations import InputError, load

    try:
        problem = load(file_or_case)
    except InputError as error:
        raise BadInput(str(error)) from None

    def same(key: str, ours: Any, theirs: Any) -> None:
        ours = [[float(x) for x in row] for row in ours]
        theirs = [[-inf if x is None else float.fromhex(x) for x in row] for row in theirs]
        ours = [[-inf if abs(x) == inf else x for x in row] for row in ours]
        need(ours == theirs, f"{key} differ from those of {file_or_case}")

    limits, claimed = problem.limits, data["limits"]
    need(
        data["family"] in (problem.family, "every-motion"),
        f"family differs from that of {file_or_case}",
    )
    same("waypoints", problem.waypoints, data["waypoints"])
    for key in ("velocity", "acceleration", "jerk"):
        same(f"limits.{key}", [getattr(limits, key)], [claimed[key]])
    same("limits.position", limits.position, claimed["position"])
    slack = float.fromhex(data["position_slack"])
    need(slack >= problem.position_slack, "position_slack is less than the check allows")


def read(path: Path) -> Any:
    """Read the data in a file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    object
        The data; raises BadInput if it is no JSON.
    """

    def no_constant(name: str) -> Any:
        raise BadInput(f"{path}: {name} in the file")

    try:
        if path.stat().st_size > LARGEST_FILE:
            raise BadInput(f"{path}: larger than {LARGEST_FILE} bytes")
        return json.loads(path.read_text("utf-8"), parse_constant=no_constant)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise BadInput(f"{path}: not valid JSON: {str(error)[:100]}") from None


def main(arguments: list[str] | None = None) -> int:
    """Check one certificate; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m compare.check_certificate",
        description="Re-prove a certified bound in ball arithmetic, independently of the prover. "
        "Exit code 0: certified, 1: refused, 2: bad input.",
        epilog="example:\n  python -m compare.check_certificate sr4c.json --problem sr4c",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "file", metavar="FILE", help="a certificate, from compare.commands.solve --certificate"
    )
    parser.add_argument("--problem", metavar="FILE_OR_CASE", help="the problem it must be about")
    parser.add_argument(
        "--show", action="store_true", help="the inequalities that prove a bound of every motion"
    )
    options = parser.parse_args(arguments)
    try:
        import flint  # noqa: F401
    except ImportError:
        print("error: python-flint is missing: pip install 'timebound[certificate]'", file=sys.stderr)
        return BAD_INPUT
    from compare.check_certificate.verify import verify

    try:
        data = read(Path(options.file))
        words = verify(data, show=options.show)
        if options.problem:
            compare_with(data, options.problem)
    except Refused as reason:
        print(f"refused: {reason}")
        return REFUSED
    except BadInput as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    print(f"certified: {words}")
    return CERTIFIED


if __name__ == "__main__":
    sys.exit(main())
