"""The rigid-body dynamics of an arm from its URDF, by Pinocchio (Carpentier et al. 2019).

References
----------
Carpentier et al. 2019, "The Pinocchio C++ library: a fast and flexible implementation of rigid body dynamics
algorithms and their analytical derivatives", IEEE/SICE International Symposium on System Integration.
Featherstone 2008, "Rigid Body Dynamics Algorithms", chapter 5, Springer.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.torque import Payload, TorqueLimits


@dataclass(frozen=True)
class Body:
    """All that a joint moves rigidly, in the joint's frame, and the joint itself.

    Attributes
    ----------
    parent : int
        The joint before it, counted as in ``ArmDynamics.bodies``; -1 for the base.
    joint : int
        Its place in the order of the problem.
    rotation, offset : Array, shape (3, 3) and (3,)
        Pose of the joint's frame in the one before it [m].
    axis : Array, shape (3,)
        Unit vector.
    prismatic : bool
    mass : float
        [kg].
    com : Array, shape (3,)
        [m].
    inertia : Array, shape (3, 3)
        About the centre of mass [kg m^2].
    """

    parent: int
    joint: int
    rotation: Array
    offset: Array
    axis: Array
    prismatic: bool
    mass: float
    com: Array
    inertia: Array


@dataclass(frozen=True, eq=False)
class ArmDynamics:
    """Inverse dynamics of the joints of a problem.

    Attributes
    ----------
    bodies : tuple of Body
        From the base outward.
    limits : Array, shape (dof,)
        Limits on the torques that were given, or the URDF's [N m, or N].
    friction : Array, shape (dof,)
        Dry friction, which is subtracted from the limits [N m].
    damping : Array, shape (dof,)
        Viscous damping [N m s].
    gravity : Array, shape (3,)
        [m/s^2].
    """

    bodies: tuple[Body, ...]
    limits: Array
    friction: Array
    damping: Array
    gravity: Array
    _order: Array = field(repr=False)  # place of each joint of the problem among Pinocchio's velocities
    _angles: Array = field(repr=False)  # joints of the problem whose positions are (cos, sin) there
    _model: Any = field(repr=False)
    _pool: Any = field(repr=False)

    @property
    def available(self) -> Array:
        """Limits less dry friction, (dof,) [N m]."""
        return self.limits - self.friction

    @property
    def dof(self) -> int:
        """Number of joints."""
        return len(self.limits)

    def torques(self, q: Array, v: Array, a: Array) -> Array:
        """Compute the torques M(q) a + C(q, v) v + g(q) + D v of samples.

        Parameters
        ----------
        q, v, a : Array, shape (..., dof)
            Positions [rad], velocities and accelerations.

        Returns
        -------
        Array, shape (..., dof)
            [N m, or N].
        """
        import pinocchio

        flat = [np.reshape(one, (-1, self.dof)) for one in (q, v, a)]
        positions = self._configurations(flat[0])
        rates = np.zeros((2, self.dof, len(flat[0])))
        rates[:, self._order] = np.swapaxes(flat[1:], 1, 2)
        found = pinocchio.rneaInParallel(1, self._pool, positions, rates[0], rates[1])
        moved = np.reshape(found, (self.dof, -1))[self._order].T + self.damping * flat[1]
        return np.asarray(moved.reshape(np.shape(q)))

    def holding(self, q: Array) -> Array:
        """Compute the torques that hold the arm still.

        Parameters
        ----------
        q : Array, shape (..., dof)
            [rad].

        Returns
        -------
        Array, shape (..., dof)
            [N m, or N].
        """
        still = np.zeros_like(q)
        return self.torques(q, still, still)

    def _configurations(self, q: Array) -> Array:
        """Positions (n, dof) as Pinocchio takes them, (nq, n)."""
        found = np.empty((self._model.nq, len(q)))
        for joint, (body, values) in enumerate(zip(self._order, q.T, strict=True)):
            place = self._model.idx_qs[int(body) + 1]
            if self._angles[joint]:
                found[place], found[place + 1] = np.cos(values), np.sin(values)
            else:
                found[place] = values
        return found


@lru_cache(maxsize=16)
def dynamics_of(torque: TorqueLimits) -> ArmDynamics:
    """Make the dynamics of an arm, once.

    Parameters
    ----------
    torque : TorqueLimits

    Returns
    -------
    ArmDynamics

    Raises
    ------
    InputError
        The package ``pin`` is missing, or the URDF does not describe the dynamics of these joints.
    """
    try:
        import pinocchio
    except ImportError:
        raise InputError(
            "conditions.torque: torque limits need the package pin: pip install 'timebound[dynamics]'"
        ) from None
    whole = _whole(torque, pinocchio)
    others = [name for name in list(whole.names)[1:] if name not in torque.joints]
    locked = [whole.getJointId(name) for name in others]
    model = pinocchio.buildReducedModel(whole, locked, pinocchio.neutral(whole))
    model.gravity.linear = np.array(torque.gravity)
    if torque.payload is not None:
        _load(torque, torque.payload, model, pinocchio)
    order = np.array([model.idx_vs[model.getJointId(name)] for name in torque.joints])
    bodies = tuple(_bodies(model, order, pinocchio))
    if not any(body.mass > 0.0 for body in bodies):
        raise InputError(f"{torque.file}: no link that moves has a mass (<inertial>)")
    efforts = np.asarray(model.upperEffortLimit)[order]
    return ArmDynamics(
        bodies,
        _limits(torque, efforts, np.asarray(model.upperDryFrictionLimit)[order]),
        np.asarray(model.upperDryFrictionLimit)[order],
        np.asarray(model.damping)[order],
        np.array(torque.gravity),
        order,
        np.array([model.nqs[model.getJointId(name)] == 2 for name in torque.joints]),
        model,
        pinocchio.ModelPool(model, 1),
    )


def _whole(torque: TorqueLimits, pinocchio: Any) -> Any:
    """The model of the whole URDF; its joints are there, and none is coupled to another."""
    from formulations.robot.urdf import parse_urdf

    tree = parse_urdf(torque.urdf, torque.file)  # refuses what Pinocchio cannot read, in one line
    known = tree.named()
    for name in torque.joints:
        if name not in known or known[name].joint is None:
            from formulations.robot.text.files import known_names, shown

            moving = [joint.name for joint in tree.joints if joint.joint is not None]
            raise InputError(
                f"{torque.file}: no joint {shown(name)} that moves; {known_names(name, moving)}"
            )
    for joint in tree.joints:
        if joint.mimic and (joint.name in torque.joints or joint.mimic[0] in torque.joints):
            raise InputError(
                f"{torque.file}: joint {joint.name} follows joint {joint.mimic[0]}: "
                "the dynamics of joints that follow others are not known"
            )
    try:
        return pinocchio.buildModelFromXML(torque.urdf)
    except (ValueError, RuntimeError) as error:
        raise InputError(f"{torque.file}: Pinocchio refuses it: {error}") from None


def _load(torque: TorqueLimits, payload: Payload, model: Any, pinocchio: Any) -> None:
    """Fix the payload to its link."""
    joint, pose = model.getJointId(torque.joints[-1]), pinocchio.SE3.Identity()
    if payload.link is not None:
        if not model.existBodyName(payload.link):
            links = [frame.name for frame in model.frames if frame.type == pinocchio.FrameType.BODY]
            from formulations.robot.text.files import known_names, shown

            raise InputError(
                f"payload: no link {shown(payload.link)} in {torque.file}; "
                f"{known_names(payload.link, links)}"
            )
        frame = model.frames[model.getBodyId(payload.link)]
        joint, pose = frame.parentJoint, frame.placement
        if not joint:
            raise InputError(f"payload: link {payload.link} is not moved by any joint")
    point = pinocchio.Inertia(payload.mass, np.array(payload.com), np.zeros((3, 3)))
    model.appendBodyToJoint(joint, point, pose)


def _bodies(model: Any, order: Array, pinocchio: Any) -> Any:
    data = model.createData()
    pinocchio.computeJointJacobians(model, data, pinocchio.neutral(model))
    joint_of = {int(place): joint for joint, place in enumerate(order)}
    for body in range(1, model.njoints):
        place = model.idx_vs[body]
        jacobian = pinocchio.getJointJacobian(model, data, body, pinocchio.LOCAL)
        motion = np.reshape(jacobian, (6, -1))[:, place]  # one column comes as a vector
        prismatic = not np.abs(motion[3:]).max() > 0.5
        pose, inertia = model.jointPlacements[body], model.inertias[body]
        yield Body(
            parent=int(model.parents[body]) - 1,
            joint=joint_of[int(place)],
            rotation=np.array(pose.rotation),
            offset=np.array(pose.translation),
            axis=np.array(motion[:3] if prismatic else motion[3:]),
            prismatic=bool(prismatic),
            mass=float(inertia.mass),
            com=np.array(inertia.lever),
            inertia=np.array(inertia.inertia),
        )


def _limits(torque: TorqueLimits, efforts: Array, friction: Array) -> Array:
    found = np.array(efforts if torque.limits is None else torque.limits)
    for name, limit, lost in zip(torque.joints, found, friction, strict=True):
        if not limit > 0.0:
            raise InputError(f"{torque.file}: joint {name}: effort {limit:g} is no limit on its torque")
        if not limit > lost:
            raise InputError(
                f"{torque.file}: joint {name}: friction {lost:g} N m leaves nothing of the limit "
                f"{limit:g} N m"
            )
    return found
