"""The options that ask more of a motion than its problem does: stops, times, velocities at the ends.

A command has the parameter ``asked: ConditionOptions = None`` and calls ``conditions_of(asked, problem)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING, Annotated

from cyclopts import Group, Parameter

if TYPE_CHECKING:
    from formulations import Conditions, Problem
    from formulations.problem.arrays import Array

_CONDITIONS = Group(
    "Conditions", help="Waypoints count from 0, the start; the last one is the end.", sort_key=11
)
Velocities = Annotated[str | None, Parameter(metavar="V,V,..", allow_leading_hyphen=True)]


@Parameter(name="*", group=_CONDITIONS)
@dataclass(frozen=True)
class AskedConditions:
    """The options as they were typed."""

    stop: Annotated[
        tuple[int, ...],
        Parameter(
            metavar="K",
            n_tokens=1,
            consume_multiple=False,
            show_default=False,
            help="Stand still at waypoint K; several times if needed.",
        ),
    ] = ()
    passage: Annotated[
        tuple[str, ...],
        Parameter(
            name="--pass",
            metavar="K=T",
            n_tokens=1,
            consume_multiple=False,
            show_default=False,
            help="Pass waypoint K at T seconds; several times if needed.",
        ),
    ] = ()
    total: Annotated[
        float | None,
        Parameter(metavar="T", help="The motion takes T seconds, and is as smooth as it can be."),
    ] = None
    start_velocity: Annotated[
        Velocities,
        Parameter(
            help="Velocity at the start, a number per joint, in the unit of the file (deg/s where it has "
            "degrees)."
        ),
    ] = None
    end_velocity: Annotated[Velocities, Parameter(help="Velocity at the end, in the same way.")] = None


ConditionOptions = Annotated[AskedConditions | None, Parameter(name="*")]


def conditions_of(asked: AskedConditions | None, problem: Problem) -> Conditions:
    """Read what is asked for.

    Parameters
    ----------
    asked : AskedConditions or None
        The options; None where none was given.
    problem : Problem
        Whose joints move, and in whose unit velocities are typed.

    Returns
    -------
    Conditions

    Raises
    ------
    InputError
        In one line that names the option and what was typed, or the condition that does not fit.
    """
    from formulations import Conditions

    given = asked or AskedConditions()
    found = Conditions(
        passage=_passages(given.passage),
        total=given.total,
        stops=frozenset(given.stop),
        start_velocity=_velocity("--start-velocity", given.start_velocity, problem),
        end_velocity=_velocity("--end-velocity", given.end_velocity, problem),
    )
    found.validate(problem)
    return found


def _passages(texts: tuple[str, ...]) -> dict[int, float]:
    """Passage times [s] by waypoint."""
    from formulations import InputError

    passages: dict[int, float] = {}
    for text in texts:
        waypoint, separator, time = text.partition("=")
        try:
            passages[int(waypoint)] = float(time)
        except ValueError:
            separator = ""
        if not separator:
            raise InputError(f"--pass: {text!r} is not of the form K=T, such as 2=1.5")
    return passages


def _velocity(key: str, text: str | None, problem: Problem) -> Array | None:
    """Velocities of the joints, (dof,) [rad/s], from numbers in the unit of the file."""
    import numpy as np

    from formulations import InputError
    from formulations.problem.joint_words import factors

    if text is None:
        return None
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"{key}: {text!r} is not a list of numbers") from None
    if len(values) != problem.dof or not all(isfinite(value) for value in values):
        raise InputError(f"{key}: expected {problem.dof} finite numbers, got {text!r}")
    return np.array(values) * factors(problem.units, problem.display_unit)
