"""Options that several commands share: each is defined once, with its help and its validation.

A value that cannot be used raises ValueError here; ``compare.__main__`` turns it into one line that
names the option. Names of cases, swarms and codings are looked up when they are needed, so that this
module loads at once.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter, Token

from compare.commands.names import found_swarms, several

CORES = os.cpu_count() or 1


def positive(kind: Any, value: float | None) -> None:
    """Refuse a number that is not positive and finite (a validator of cyclopts).

    Parameters
    ----------
    kind : type
        The type of the option.
    value : float or None
        Its value; None if it was left out.

    Raises
    ------
    ValueError
        It is not positive.
    """
    if value is not None and not (isfinite(value) and value > 0):
        raise ValueError(f"{value:g} is not positive" if isfinite(value) else f"{value} is not finite")


def not_negative(kind: Any, value: float) -> None:
    """Refuse a negative number (a validator of cyclopts).

    Parameters
    ----------
    kind : type
        The type of the option.
    value : float
        Its value.

    Raises
    ------
    ValueError
        It is negative, infinite or no number.
    """
    if value < 0:
        raise ValueError(f"{value} is negative")
    if not math.isfinite(value):
        raise ValueError(f"{value} is not finite")


def writable(kind: Any, value: str | None) -> None:
    """Refuse a file that cannot be written, before anything is computed (a validator of cyclopts).

    Parameters
    ----------
    kind : type
        The type of the option.
    value : str or None
        The file; ``-`` stands for standard output.

    Raises
    ------
    ValueError
        Its folder is none.
    """
    if value is None or value == "-":
        return
    if value.startswith("-"):
        raise ValueError(f"a file is missing before {value}")
    path = Path(value)
    if path.is_dir() or not path.parent.is_dir():
        reason = "it is a folder" if path.is_dir() else f"{path.parent} is no folder"
        raise ValueError(f"{value}: cannot be written: {reason}")


def _cases() -> Iterable[str]:
    from formulations import CASES

    return CASES


def _codings() -> Iterable[str]:
    from compare.benchmark.objective import CODINGS

    return CODINGS


def _rungs() -> Iterable[str]:
    from formulations import RUNGS

    return RUNGS


def _choice(names: Callable[[], Iterable[str]]) -> Callable[[Any, Sequence[Token]], tuple[str, ...]]:
    return lambda kind, tokens: several(tokens[0].value, names())


def _joined(value: Any) -> str | None:
    return ",".join(value) if value else None


def listed(names: Callable[[], Iterable[str]], words: str, name: str) -> Parameter:
    """Make the parameter of an option that is a comma-separated list of known names.

    Parameters
    ----------
    names : Callable
        Gives the names there are.
    words : str
        The help.
    name : str
        The option, ``--name``.

    Returns
    -------
    Parameter
        For an ``Annotated`` tuple of str.
    """
    return Parameter(
        name=name,
        help=words,
        converter=_choice(names),
        n_tokens=1,
        metavar="NAME,..",
        show_default=_joined,
    )


def _words_of(enum: str, name: str, words: str) -> Parameter:
    """The parameter of an option that is a comma-separated list of members of an enum of the protocol."""

    def read(kind: Any, tokens: Sequence[Token]) -> tuple[Any, ...]:
        from compare.benchmark import protocol

        members = getattr(protocol, enum)
        return tuple(members(value) for value in several(tokens[0].value, [str(m) for m in members]))

    return Parameter(
        name=name, help=words, converter=read, n_tokens=1, metavar="NAME,..", show_default=_joined
    )


def _read_swarms(kind: Any, tokens: Sequence[Token]) -> tuple[str, ...]:
    return found_swarms(tokens[0].value)


def _read_swarm(kind: Any, tokens: Sequence[Token]) -> str:
    return found_swarms(tokens[0].value)[0]


_OWN = (
    "a name of docs/reference/algorithms.md; library:Name of mealpy, pymoo, nevergrad, minion; or your own,"
    " module:function or FILE.py:function"
)


def _read_cases(kind: Any, tokens: Sequence[Token]) -> tuple[str, ...]:
    text = tokens[0].value
    files = [name.strip() for name in text.split(",") if _is_file(name.strip())]
    return several(text, [*_cases(), *files])


def _is_file(name: str) -> bool:
    return name.endswith(".toml") or Path(name).is_file()


Cases = Annotated[tuple[str, ...] | None, listed(_cases, "Shipped cases; all if left out.", "--cases")]
CasesOrFiles = Annotated[
    tuple[str, ...] | None,
    Parameter(name="--cases", help="Shipped cases, and problem files of your own (mine.toml); all cases if left"
              " out.", converter=_read_cases, n_tokens=1, metavar="NAME,..", show_default=_joined),
]  # fmt: skip
Codings = Annotated[
    tuple[str, ...] | None,
    listed(_codings, "How a swarm's vector becomes a motion: published, shared, stretched; all if left out.",
           "--codings"),
]  # fmt: skip
Tracks = Annotated[
    tuple[Any, ...] | None,
    _words_of("Track", "--tracks", "Rules: equal (the joints of the published coding share the budget),"
              " paper (the papers' own: each of them has all of it), tuned (constants tuned on open"
              " instances)."),
]  # fmt: skip
SeenIn = Annotated[
    tuple[Any, ...],
    _words_of("Coordinates", "--coordinates", "How swarms see the durations: printed, mirrored,"
              " offset (far away from zero)."),
]  # fmt: skip
Swarms = Annotated[
    tuple[str, ...] | None,
    Parameter(name="--swarms", help=f"Algorithms, each {_OWN}.", converter=_read_swarms, n_tokens=1,
              metavar="NAME,..", show_default=_joined),
]  # fmt: skip
Swarm = Annotated[
    str, Parameter(name="--swarm", help=f"An algorithm: {_OWN}.", converter=_read_swarm, n_tokens=1)
]
Interpolation = Literal["auto", "linear", "cubic", "quintic"]
Tolerance = Annotated[float, Parameter(name="--tolerance", metavar="RAD", validator=positive)]
ProblemFile = Annotated[
    str, Parameter(name="FILE", help="A problem file (TOML), or the name of a shipped case.")
]
Out = Annotated[str, Parameter(name="--out", metavar="DIR", help="Folder of the report.")]
Jobs = Annotated[int, Parameter(name="--jobs", validator=positive, help="Worker processes.")]
OnCluster = Annotated[
    str | None,
    Parameter(name="--cluster", metavar="ADDRESS",
              help="Run on the workers of this Dask scheduler, tcp://HOST:PORT, in place of --jobs."),
]  # fmt: skip
Seeds = Annotated[int, Parameter(name="--seeds", validator=positive, help="Number of seeds.")]
Seed = Annotated[
    int, Parameter(name="--seed", validator=not_negative, help="Seed of the random numbers.")
]
Starts = Annotated[
    int | None,
    Parameter(name="--starts", validator=positive,
              help="Starts of the family's optimiser; if left out, one start and a proof that none is faster."),
]  # fmt: skip
Budget = Annotated[
    int, Parameter(name="--budget", validator=positive, help="Evaluations of the objective per run.")
]
Resume = Annotated[bool, Parameter(name="--resume", help="Keep what an interrupted run has finished.")]
Json = Annotated[
    str | None,
    Parameter(
        name="--json", metavar="FILE", validator=writable, allow_leading_hyphen=True,
        help="Write the answer as JSON too; - writes it to standard output, and nothing else.",
    ),
]  # fmt: skip
Export = Annotated[
    str | None,
    Parameter(name="--export", metavar="FILE", validator=writable,
              help="Write the fastest verified motion: .csv, .json or .yaml (a ROS JointTrajectory), .npz,"
                   " or .pieces.json (exact polynomials). The file itself is judged before it is written."),
]  # fmt: skip
Rate = Annotated[
    float | None,
    Parameter(name="--rate", metavar="HZ", validator=positive,
              help="Points per second in that file; where the jerk switches if left out."),
]  # fmt: skip
Rungs = Annotated[
    tuple[str, ...] | None,
    listed(_rungs, "The bounds to find, and those they need; all if left out, but those of the family only up"
           " to 30 segments.", "--rungs"),
]  # fmt: skip
Without = Annotated[
    tuple[str, ...] | None,
    listed(_rungs, "Bounds to leave out, with all that need them.", "--without"),
]  # fmt: skip
TimeLimit = Annotated[
    float | None,
    Parameter(name="--time-limit", metavar="SECONDS", validator=positive,
              help="End after this time, with the best that was verified and proved until then; a part of it is"
                   " kept for the bound."),
]  # fmt: skip
Gap = Annotated[
    float,
    Parameter(name="--gap", validator=positive,
              help="Gap to be reached: the time of the motion over the proved bound, minus 1."),
]  # fmt: skip
