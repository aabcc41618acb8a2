"""Limits on the torques of the motors, and all that the dynamics of the arm need to be known for."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from formulations.problem.errors import InputError
from formulations.problem.limits import numbers

if TYPE_CHECKING:
    from formulations.problem.problem import Problem

EARTH = (0.0, 0.0, -9.81)  # m/s^2 in the frame of the robot's base


@dataclass(frozen=True)
class Payload:
    """A body that the arm carries.

    Parameters
    ----------
    mass : float
        [kg], positive.
    com : tuple of float
        Centre of mass in the frame of the link [m].
    link : str, optional
        The link that it is fixed to; left out, the one that the last joint moves.
    """

    mass: float
    com: tuple[float, float, float] = (0.0, 0.0, 0.0)
    link: str | None = None

    def __post_init__(self) -> None:
        if not (np.isfinite(self.mass) and self.mass > 0.0):
            raise InputError(f"payload: mass {self.mass:g} kg is not positive")
        object.__setattr__(self, "com", _triple("payload.com", self.com))


@dataclass(frozen=True)
class TorqueLimits:
    """Limits on joint torques, with the arm whose rigid-body dynamics say what torques a motion takes.

    Make them with ``TorqueLimits.from_urdf``. The torques are M(q) q'' + C(q, q') q' + g(q) + D q', with the
    viscous damping D of the URDF. Its dry friction is subtracted from the limit, whichever way a joint moves.
    Rotor inertia, elasticity and the drives' curves of torque over speed are not in the model.

    Parameters
    ----------
    urdf : str
        The text of the URDF, with ``<inertial>`` of the links. Meshes are not read.
    joints : tuple of str
        The joints of the problem, in its order. All other joints are locked at 0.
    limits : tuple of float, optional
        Greatest modulus per joint [N m; N for a prismatic joint]; left out, the URDF's ``effort``.
    payload : Payload, optional
        What the arm carries.
    gravity : tuple of float
        In the frame of the robot's base [m/s^2].
    file : str
        Name of the URDF, for messages.
    """

    urdf: str
    joints: tuple[str, ...]
    limits: tuple[float, ...] | None = None
    payload: Payload | None = None
    gravity: tuple[float, float, float] = EARTH
    file: str = field(default="URDF", compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", tuple(self.joints))
        object.__setattr__(self, "gravity", _triple("gravity", self.gravity))
        if self.limits is not None:
            object.__setattr__(self, "limits", _limits(self.limits, self.joints))

    @staticmethod
    def from_urdf(
        path: str | Path,
        joints: Iterable[str],
        *,
        limits: ArrayLike | None = None,
        payload: Payload | None = None,
        gravity: Sequence[float] = EARTH,
    ) -> TorqueLimits:
        """Read the arm from a URDF.

        Parameters
        ----------
        path : str or Path
            The URDF.
        joints : iterable of str
            The joints that move, in the order of the problem.
        limits : array_like, shape () or (dof,), optional
            Greatest modulus [N m; N for a prismatic joint]; left out, the URDF's ``effort``.
        payload : Payload, optional
        gravity : sequence of float, shape (3,)
            In the frame of the robot's base [m/s^2].

        Returns
        -------
        TorqueLimits

        Raises
        ------
        InputError
            In one line with key and value.
        """
        from formulations.robot.text.files import decode, read_bytes
        from formulations.robot.urdf import LARGEST_URDF

        names = tuple(joints)
        given = None if limits is None else np.broadcast_to(numbers("torque", limits), len(names))
        return TorqueLimits(
            decode(read_bytes(path, largest=LARGEST_URDF), str(path)),
            names,
            None if given is None else tuple(given.tolist()),
            payload,
            tuple(gravity),  # type: ignore[arg-type]  # checked above
            str(path),
        )

    def scaled(self, factor: float, limits: ArrayLike) -> TorqueLimits:
        """Return the same arm with limits that are a multiple of given ones.

        Parameters
        ----------
        factor : float
        limits : array_like, shape (dof,)
            [N m], such as ``ArmDynamics.limits``.

        Returns
        -------
        TorqueLimits
        """
        return replace(self, limits=tuple((factor * np.asarray(limits)).tolist()))

    def require_fitting(self, problem: Problem) -> None:
        """Refuse limits of another arm.

        Parameters
        ----------
        problem : Problem

        Raises
        ------
        InputError
            The joints are not those of the problem.
        """
        if len(self.joints) != problem.dof:
            raise InputError(
                f"conditions.torque: {len(self.joints)} joints, the problem has {problem.dof}"
            )
        if problem.names and problem.names != self.joints:
            raise InputError(
                f"conditions.torque: joints {', '.join(self.joints)}, the problem has "
                f"{', '.join(problem.names)}"
            )


def _triple(key: str, given: Iterable[float]) -> tuple[float, float, float]:
    found = numbers(key, list(given))
    if found.shape != (3,) or not np.isfinite(found).all():
        raise InputError(f"{key}: expected three numbers, got {given!r:.50}")
    return (float(found[0]), float(found[1]), float(found[2]))


def _limits(given: Iterable[float], joints: tuple[str, ...]) -> tuple[float, ...]:
    found = numbers("torque", list(given))
    if found.shape != (len(joints),):
        raise InputError(f"torque: expected {len(joints)} limits, one per joint, got {found.shape}")
    for name, value in zip(joints, found, strict=True):
        if not value > 0.0:  # also for NaN
            raise InputError(f"torque: joint {name}: {value:g} N m is not positive")
    return tuple(found.tolist())
