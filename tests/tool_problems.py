"""Problems with a tool for tests: a hinge, a slider, two links in a plane, and the UR5."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from formulations import Conditions, Problem
from formulations.arms import load_arm
from formulations.kinematics.link_chain import LinkChain, Step

LIMITS = {"velocity": 2.0, "acceleration": 5.0, "jerk": 40.0}


def shifted(x: float) -> np.ndarray:
    """A pose shifted along x."""
    pose = np.eye(4)
    pose[0, 3] = x
    return pose


def planar(lengths: list[float]) -> LinkChain:
    """Hinges about z, with links of these lengths along x."""
    steps = tuple(
        Step(np.eye(4), shifted(length), np.array([0.0, 0.0, 1.0]), False, j, 1.0, 0.0)
        for j, length in enumerate(lengths)
    )
    return LinkChain(tuple(f"joint {j + 1}" for j in range(len(lengths))), steps, np.eye(4))


def slider(factor: float = 1.0) -> LinkChain:
    """One joint that slides along an axis across the coordinates."""
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    return LinkChain(("joint 1",), (Step(np.eye(4), np.eye(4), axis, True, 0, factor, 0.0),), np.eye(4))


def hinge(lever: float, conditions: Conditions, points: object = ((0.0,), (1.0,), (0.3,))) -> Problem:
    """One joint with a tool at a lever."""
    return Problem(points, LIMITS, tool=planar([lever]), conditions=conditions)


def two_links(conditions: Conditions) -> Problem:
    """Two links in a plane through three waypoints."""
    return Problem(
        [[0.0, 0.3], [0.8, 1.0], [1.5, 0.2]], LIMITS, tool=planar([0.5, 0.4]), conditions=conditions
    )


def ur5(conditions: Conditions) -> Problem:
    """The UR5 of Zhou 2025 through three waypoints."""
    points = np.array([[0.0, -1.0, 1.0, 0.0, 0.5, 0.0], [0.6, -0.7, 0.6, 0.2, 0.1, 0.4]])
    points = np.vstack([points, [1.1, -1.2, 1.3, -0.3, 0.2, 0.1]])
    limits = {"velocity": 3.14, "acceleration": 10.0, "jerk": 100.0}
    return Problem(points, limits, tool=load_arm("ur5").tool, conditions=conditions)


def random_chain(rng: np.random.Generator, joints: int, links: int, slides: float = 0.3) -> LinkChain:
    """Links that turn or slide about any axes; some follow the joint of another one by a factor."""

    def pose() -> np.ndarray:
        found = np.eye(4)
        found[:3, :3] = Rotation.random(rng=rng).as_matrix()
        found[:3, 3] = rng.normal(scale=0.3, size=3)
        return found

    def step(j: int) -> Step:
        axis = rng.normal(size=3)
        factor, offset = (1.0, 0.0) if j < joints else (float(rng.normal()), float(rng.normal()))
        return Step(
            pose(),
            pose(),
            axis / np.linalg.norm(axis),
            bool(rng.random() < slides),
            j % joints,
            factor,
            offset,
        )

    names = tuple(f"joint {j + 1}" for j in range(joints))
    return LinkChain(names, tuple(step(j) for j in range(links)), pose())
