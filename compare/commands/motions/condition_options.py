"""The options that ask more of a motion than its problem does: zones, times, stops, states at the ends.

A command has the parameter ``asked: ConditionOptions = None`` and calls ``problem_of(file, own, asked)``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeVar

from cyclopts import Group, Parameter

if TYPE_CHECKING:
    from formulations import Conditions, Problem
    from formulations.problem.arrays import Array
    from formulations.problem.condition_values import EndState
    from formulations.problem.torque import TorqueLimits

_CONDITIONS = Group(
    "Conditions",
    help="Waypoints count from 0, the start; the last one is the end. These options lie over the conditions "
    "of FILE: what they do not name stays as it says.",
    sort_key=11,
)
_ZONE = (
    "Pass all inner waypoints, or waypoint K, at a distance of up to R in each joint, in the unit of the "
    "file; R,R,.. gives each joint its own. Several times if needed."
)
Read = TypeVar("Read")


def _several(metavar: str, text: str, *, name: str | tuple[str, ...] | None = None) -> Parameter:
    """An option that may be given several times, each time with one value."""
    return Parameter(
        name=name, metavar=metavar, n_tokens=1, consume_multiple=False, show_default=False, help=text
    )


def _state(text: str) -> Parameter:
    """An option for the state at an end."""
    return Parameter(metavar="V,V,..", allow_leading_hyphen=True, help=text)


@Parameter(name="*", group=_CONDITIONS)
@dataclass(frozen=True)
class AskedConditions:
    """The options as they were typed."""

    zones: ClassVar[str] = "--zone"  # what the option for zones is called in messages
    stop: Annotated[
        tuple[int, ...], _several("K", "Stand still at waypoint K; several times if needed.")
    ] = ()
    passage: Annotated[
        tuple[str, ...],
        _several("K=T", "Pass waypoint K at T seconds; several times if needed.", name="--pass"),
    ] = ()
    total: Annotated[
        float | None,
        Parameter(metavar="T", help="The motion takes T seconds, and is as smooth as it can be."),
    ] = None
    zone: Annotated[tuple[str, ...], _several("R or K=R", _ZONE)] = ()
    window: Annotated[
        tuple[str, ...],
        _several("K=A:B", "Pass waypoint K between A and B seconds; without B, not before A."),
    ] = ()
    least: Annotated[
        tuple[str, ...],
        _several("K=T", "Take at least T seconds from waypoint K to the next one."),
    ] = ()
    wait: Annotated[
        tuple[str, ...],
        _several("K=S", "Stand still for S seconds at waypoint K, after arriving there."),
    ] = ()
    tool_speed: Annotated[
        float | None,
        Parameter(
            metavar="S", help="The tool moves at most at S m/s; the file names a robot or an arm."
        ),
    ] = None
    tool_zone: Annotated[
        tuple[str, ...],
        _several("K=R", "The tool passes waypoint K within R metres of its place there."),
    ] = ()
    cyclic: Annotated[
        bool,
        Parameter(
            negative="",
            show_default=False,
            help="One turn of a cycle: end with the velocity and the acceleration of the start.",
        ),
    ] = False
    torque: Annotated[
        str | None,
        Parameter(
            metavar="T,T,..",
            help="Limits on the torques of the motors [N m], one for all joints or one for each, or urdf for "
            "its efforts; needs a robot with inertias, and the extra dynamics.",
        ),
    ] = None
    payload: Annotated[
        float | None,
        Parameter(
            metavar="KG", help="A mass at the end of the arm, for --torque; the file can say where."
        ),
    ] = None
    start_velocity: Annotated[
        str | None,
        _state(
            "Velocity at the start, a number per joint, in the unit of the file (deg/s where it has "
            "degrees), or free."
        ),
    ] = None
    end_velocity: Annotated[str | None, _state("Velocity at the end, in the same way.")] = None
    start_acceleration: Annotated[
        str | None, _state("Acceleration at the start, a number per joint, or free.")
    ] = None
    end_acceleration: Annotated[str | None, _state("Acceleration at the end, in the same way.")] = None


@Parameter(name="*", group=_CONDITIONS)
@dataclass(frozen=True)
class ZonedByTolerance(AskedConditions):
    """The same where ``--tolerance`` has no other meaning: it gives zones."""

    zones: ClassVar[str] = "--tolerance"
    zone: Annotated[tuple[str, ...], _several("R or K=R", _ZONE, name=("--tolerance", "--zone"))] = ()


ConditionOptions = Annotated[AskedConditions | None, Parameter(name="*")]
PlanConditionOptions = Annotated[ZonedByTolerance | None, Parameter(name="*")]


def conditions_of(
    asked: AskedConditions | None, problem: Problem, urdf: Path | None = None
) -> Conditions:
    """Lay what is asked for by options over the conditions of a problem.

    Parameters
    ----------
    asked : AskedConditions or None
        The options; None where none was given.
    problem : Problem
        Whose joints move, in whose unit values are typed, and whose conditions stay where no option is given.
    urdf : Path, optional
        The URDF of its robot, which torque limits are about.

    Returns
    -------
    Conditions

    Raises
    ------
    InputError
        In one line that names the option and what was typed, or the condition that does not fit.
    """
    own = problem.conditions
    if asked is None or asked == type(asked)():
        return own
    states: dict[str, Any] = {}
    for key in ("start_velocity", "end_velocity", "start_acceleration", "end_acceleration"):
        if (text := getattr(asked, key)) is not None:
            states[key] = _end_state(f"--{key.replace('_', '-')}", text, problem)
    least = _numbered("--least", asked.least, "K=T, such as 0=1.5", float)
    found = replace(
        own,
        tolerance={**own.tolerance, **_zones(asked, problem)},
        passage={**own.passage, **_numbered("--pass", asked.passage, "K=T, such as 2=1.5", float)},
        windows={**own.windows, **_numbered("--window", asked.window, "K=A:B, such as 2=1:3", _window)},
        segment_times={
            **own.segment_times,
            **{k: (time, own.segment_times.get(k, (0.0, inf))[1]) for k, time in least.items()},
        },
        waits={**own.waits, **_numbered("--wait", asked.wait, "K=S, such as 2=0.5", float)},
        stops=own.stops | set(asked.stop),
        total=own.total if asked.total is None else asked.total,
        cyclic=own.cyclic or asked.cyclic,
        tool_speed=own.tool_speed if asked.tool_speed is None else asked.tool_speed,
        tool_zones={
            **own.tool_zones,
            **_numbered("--tool-zone", asked.tool_zone, "K=R, such as 2=0.01", float),
        },
        torque=_torque(asked, problem, urdf),
        **states,
    )
    found.validate(problem)
    return found


def _torque(asked: AskedConditions, problem: Problem, urdf: Path | None) -> TorqueLimits | None:
    """Torque limits of the options, laid over those of the problem."""
    from formulations import InputError
    from formulations.problem.torque import Payload, TorqueLimits

    found = problem.conditions.torque
    if asked.torque is not None:
        if found is None and urdf is None:
            raise InputError("--torque: needs a robot: --robot URDF, or the key robot in FILE")
        limits: tuple[float, ...] | None = None
        if asked.torque.strip() != "urdf":
            limits = tuple(_values("--torque", asked.torque, problem.dof).tolist())
        if found is None and urdf is not None:
            found = TorqueLimits.from_urdf(urdf, problem.names)
        found = None if found is None else replace(found, limits=limits)
    if asked.payload is not None:
        if found is None:
            raise InputError("--payload: has no meaning without --torque")
        found = replace(found, payload=Payload(asked.payload))
    return found


def _numbered(
    option: str, texts: tuple[str, ...], form: str, read: Callable[[str], Read]
) -> dict[int, Read]:
    """Values by waypoint or segment, of texts of the form K=VALUE."""
    from formulations import InputError

    found: dict[int, Read] = {}
    for text in texts:
        number, separator, value = text.partition("=")
        try:
            index, one = int(number), read(value)
        except ValueError:
            separator = ""
        if not separator:
            raise InputError(f"{option}: {text!r} is not of the form {form}")
        if index in found:
            raise InputError(f"{option}: {text!r}: {index} is given twice")
        found[index] = one
    return found


def _window(text: str) -> tuple[float, float]:
    early, separator, late = text.partition(":")
    if not separator:
        raise ValueError(text)
    return float(early), float(late) if late.strip() else inf


def _zones(asked: AskedConditions, problem: Problem) -> dict[int, Array]:
    """Zones (dof,) [rad or m] by waypoint."""
    from formulations import InputError

    found: dict[int, Array] = {}
    option, texts = asked.zones, asked.zone
    for_all = [text for text in texts if "=" not in text]
    if len(for_all) > 1:
        raise InputError(f"{option}: {for_all[1]!r}: all inner waypoints are given twice")
    for text in for_all:
        found = dict.fromkeys(range(1, problem.n_segments), _amounts(option, text, problem))
    single = [text for text in texts if "=" in text]
    typed: dict[int, str] = _numbered(option, tuple(single), "K=R, such as 2=0.01", str)
    return {**found, **{k: _amounts(option, text, problem) for k, text in typed.items()}}


def _end_state(option: str, text: str, problem: Problem) -> EndState:
    return "free" if text.strip() == "free" else _amounts(option, text, problem, alone=False)


def _amounts(option: str, text: str, problem: Problem, *, alone: bool = True) -> Array:
    """Values of the joints, (dof,) [rad or m], from numbers in the unit of the file; alone: one is for all."""
    from formulations.problem.joint_words import factors

    return _values(option, text, problem.dof, alone) * factors(problem.units, problem.display_unit)


def _values(option: str, text: str, dof: int, alone: bool = True) -> Array:
    """Numbers of the joints, (dof,); alone: one is for all."""
    import numpy as np

    from formulations import InputError

    try:
        values: list[Any] = [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"{option}: {text!r} is not a list of numbers") from None
    if alone and len(values) == 1:
        values *= dof
    if len(values) != dof or not all(isfinite(value) for value in values):
        raise InputError(f"{option}: expected {dof} finite numbers, got {text!r}")
    return np.array(values)
