"""A robot: the joints that are moved, their limits in force, and its kinematics.

robot = Robot.from_urdf("panda.urdf", srdf="panda.srdf", group="arm", limits="joint_limits.yaml")
problem = Problem(waypoints_of("path.csv", robot), robot.limits, names=robot.names)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from formulations.kinematics.link_chain import LinkChain
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Limits
from formulations.robot.inverse import joints_of_poses
from formulations.robot.joints import QUANTITIES, Joint, Mimic, missing_limits
from formulations.robot.kinematics import chain_between
from formulations.robot.text.files import known_names, shown
from formulations.robot.urdf import Urdf


@dataclass(frozen=True)
class Robot:
    """The joints of an arm with the limits in force, and its kinematics.

    Attributes
    ----------
    name : str
        Name in the URDF.
    joints : tuple of Joint
        The joints that are moved, with limits that are scaled and that include those of their followers.
    mimics : tuple of Mimic
        The joints that follow one of them.
    base, tip : str
        The links that a Cartesian pose is measured from and given for.
    urdf : Urdf or None
        The whole tree; None for joints alone, which have no kinematics.
    """

    name: str
    joints: tuple[Joint, ...]
    mimics: tuple[Mimic, ...] = ()
    base: str = ""
    tip: str = ""
    urdf: Urdf | None = field(default=None, repr=False, compare=False)

    @staticmethod
    def from_urdf(
        path: str | Path,
        *,
        joints: Sequence[str] | None = None,
        group: str | None = None,
        srdf: str | Path | None = None,
        limits: str | Path | Iterable[str | Path] | None = None,
        velocity_scaling: float | None = None,
        acceleration_scaling: float | None = None,
        jerk_scaling: float | None = None,
        unlimited: str | Iterable[str] = (),
        base: str | None = None,
        tip: str | None = None,
    ) -> Robot:
        """Read a robot from a URDF and the files beside it; ``robot_of`` says more.

        Parameters
        ----------
        path : str or Path
            The URDF.
        joints : sequence of str, optional
            The joints to move, in this order.
        group, srdf : optional
            A group of an SRDF in place of ``joints``.
        limits : str, Path or iterable of them, optional
            joint_limits.yaml files.
        velocity_scaling, acceleration_scaling, jerk_scaling : float, optional
            Factors on the limits of all joints.
        unlimited : str or iterable of str, optional
            Quantities that a joint may have no limit of.
        base, tip : str, optional
            Links that Cartesian poses are measured from and given for.

        Returns
        -------
        Robot
            Its ``limits`` raises InputError where one is still missing.
        """
        from formulations.robot.assembly import robot_of  # it makes robots

        return robot_of(
            path,
            joints=joints,
            group=group,
            srdf=srdf,
            limits=limits,
            velocity_scaling=velocity_scaling,
            acceleration_scaling=acceleration_scaling,
            jerk_scaling=jerk_scaling,
            unlimited=unlimited,
            base=base,
            tip=tip,
        )

    @property
    def dof(self) -> int:
        """Number of joints that are moved."""
        return len(self.joints)

    @property
    def names(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(joint.name for joint in self.joints)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Their kinds: ``revolute``, ``continuous`` or ``prismatic``."""
        return tuple(str(joint.kind) for joint in self.joints)

    @property
    def units(self) -> tuple[str, ...]:
        """Units of their positions: ``rad`` or ``m``."""
        return tuple(joint.unit for joint in self.joints)

    @property
    def limits(self) -> Limits:
        """The limits of a problem, (dof,) each [rad or m, s].

        Raises InputError that names every limit of every joint that is missing, and how to give it.
        """
        message = missing_limits(self.joints)
        if message is not None:
            whose = "" if self.urdf is None else f"robot {shown(self.name)}: "
            raise InputError(f"{whose}{message}")
        rows = [[getattr(joint, name) for joint in self.joints] for name in QUANTITIES]
        return Limits.of(*rows, dof=self.dof, units=self.units, names=self.names)

    def with_limits(
        self,
        *,
        velocity: float | Mapping[str, float] | None = None,
        acceleration: float | Mapping[str, float] | None = None,
        jerk: float | Mapping[str, float] | None = None,
        position: tuple[float, float] | Mapping[str, tuple[float, float]] | None = None,
    ) -> Robot:
        """The robot with limits replaced.

        Parameters
        ----------
        velocity, acceleration, jerk : float or mapping of str to float, optional
            One limit for all joints, or one for each joint named [rad or m, s]. They are in force as given:
            neither scaled nor narrowed by followers.
        position : (float, float) or mapping of str to (float, float), optional
            Lowest and highest position [rad or m].

        Returns
        -------
        Robot
            A new one.

        Raises
        ------
        InputError
            A joint is unknown, or a limit is not positive.
        """
        given = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk, "position": position}
        joints = {joint.name: joint for joint in self.joints}
        for quantity, values in given.items():
            if values is None:
                continue
            by_name = values if isinstance(values, Mapping) else dict.fromkeys(self.names, values)
            for name, value in by_name.items():
                if name not in joints:
                    raise InputError(
                        f"with_limits: {quantity}: no joint {shown(name)}; {known_names(str(name), joints)}"
                    )
                joints[name] = replace(joints[name], **{quantity: _limit(quantity, name, value)})
        return replace(self, joints=tuple(joints.values()))

    @cached_property
    def chain(self) -> LinkChain:
        """The joints between ``base`` and ``tip``; raises InputError where another one moves between."""
        if self.urdf is None:
            raise InputError(f"robot {shown(self.name)}: has no URDF, hence no kinematics")
        return chain_between(self.urdf, self.names, self.base, self.tip)

    def forward(self, joints: ArrayLike) -> Array:
        """Pose of the tip link in the base link.

        Parameters
        ----------
        joints : array_like, shape (..., dof)
            Joint positions [rad or m].

        Returns
        -------
        Array, shape (..., 4, 4)
            [m].
        """
        return self.chain.forward(joints)

    def inverse(self, poses: ArrayLike, *, near: ArrayLike | None = None) -> Array:
        """Joint positions that put the tip link at poses, each nearest to the last.

        Parameters
        ----------
        poses : array_like, shape (n, 4, 4)
            Poses of the tip link in the base link [m].
        near : array_like, shape (dof,), optional
            Joint positions that the first shall be nearest to; the middle of the position limits if left out.

        Returns
        -------
        Array, shape (n, dof)
            Joint positions within the position limits [rad or m].

        Raises
        ------
        OutOfReach
            A pose cannot be reached; the message says by how much.
        """
        start = None if near is None else np.asarray(near, dtype=np.float64)
        return joints_of_poses(self.chain, self.joints, np.asarray(poses, dtype=np.float64), start)

    def __str__(self) -> str:
        """One line: name, joints, tip."""
        return f"{self.name}: {self.dof} joints ({', '.join(self.names)}), {self.base} to {self.tip}"


def _limit(quantity: str, name: str, value: Any) -> Any:
    """A limit that a caller gives, checked."""
    where = f"with_limits: {quantity} of joint {shown(name)}"
    if quantity == "position":
        try:
            low, high = (float(end) for end in value)
        except (TypeError, ValueError):
            raise InputError(f"{where}: expected (lowest, highest), got {shown(value)}") from None
        if not low < high:
            raise InputError(f"{where}: lowest {low:g} is not below highest {high:g}")
        return low, high
    if isinstance(value, bool) or not isinstance(value, int | float) or not value > 0.0:
        raise InputError(f"{where}: {shown(value)} is not a positive number")
    if quantity == "velocity" and not np.isfinite(value):
        raise InputError(f"{where}: {shown(value)} is not finite")
    return float(value)
