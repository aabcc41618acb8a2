"""The points of a motion as a file states them, whatever its format."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.motion.interpolation import joined
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError


@dataclass(frozen=True)
class MotionPoints:
    """Points of a motion.

    Attributes
    ----------
    times : Array, shape (n_points,) [s]
        Increasing.
    positions : Array, shape (n_points, dof) [rad]
        Positions of the joints (m for a prismatic joint).
    velocities, accelerations : Array, shape (n_points, dof), or None [rad/s, rad/s^2]
        None where the file states none.
    names : tuple of str
        Names of the joints, in the order of the columns; empty where the file has none.
    """

    times: Array
    positions: Array
    velocities: Array | None = None
    accelerations: Array | None = None
    names: tuple[str, ...] = ()

    def motion(self, interpolation: str = "auto", passages: Array | None = None) -> Trajectory:
        """Join the points as a controller does.

        Parameters
        ----------
        interpolation : {"auto", "linear", "cubic", "quintic"}
            Degree of the pieces between two points.
        passages : Array, shape (n_waypoints,) [s], optional
            Times at which waypoints are passed.

        Returns
        -------
        Trajectory
            It starts at time 0.
        """
        return joined(
            self.times,
            self.positions,
            self.velocities,
            self.accelerations,
            interpolation=interpolation,
            passages=passages,
        )

    def in_order(self, names: tuple[str, ...]) -> MotionPoints:
        """Reorder the joints.

        Parameters
        ----------
        names : tuple of str
            The same names in the order that is wanted.

        Returns
        -------
        MotionPoints
            With columns in this order.
        """
        order = np.array([self.names.index(name) for name in names])
        return MotionPoints(
            self.times,
            self.positions[:, order],
            None if self.velocities is None else self.velocities[:, order],
            None if self.accelerations is None else self.accelerations[:, order],
            names,
        )


def order_of_joints(wanted: tuple[str, ...], names: tuple[str, ...]) -> list[int] | None:
    """Find the order in which joints of a motion have to be taken.

    Parameters
    ----------
    wanted, names : tuple of str
        Names of the joints of a problem and of a motion; empty where they have none.

    Returns
    -------
    list of int, or None
        The place of each wanted joint; None where the order is right or there are no names to go by.

    Raises
    ------
    InputError
        They have other names.
    """
    if not wanted or not names or wanted == names:
        return None
    if set(wanted) != set(names):
        raise InputError(f"motion: joints {', '.join(names)}, the problem has {', '.join(wanted)}")
    return [names.index(name) for name in wanted]
