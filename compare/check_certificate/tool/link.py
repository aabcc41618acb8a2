"""One link of the chain to the tool that a claim states: two fixed poses, and a joint between them.

A joint that slides adds (f q + o) k to a point. One that turns maps x to

    R x = x + sin(f q + o) (k x x) + (1 - cos(f q + o)) (k x (k x x)).

The file's floats are no exact rotations, so no bound takes them for such. A pose A x = L x + l lengthens a
vector by at most |L|, where |L|^2 <= the largest row sum of |L^T L|. The matrix of the cross product with k has
the eigenvalues 0 and +- i |k|, so that |R|^2 <= 1 + 4 |k|^2 max(|k|^2 - 1, 0).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from flint import arb_mat

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import R, most
from compare.check_certificate.reading import index, items, number

STEP_KEYS = ("before", "axis", "prismatic", "joint", "factor", "offset", "after")
_TOLERANCE = 1e-9  # of what a file may call a rotation or a unit vector


@dataclass
class Pose:
    """A fixed affine map; size: bound on the factor by which it lengthens a vector."""

    linear: Any
    shift: Any
    size: Any

    @staticmethod
    def read(raw: Any) -> Pose:
        """Read three rows of four numbers. Refuses what is no rotation with a shift.

        Parameters
        ----------
        raw : object
            From the file.

        Returns
        -------
        Pose
        """
        rows = [[number(x) for x in items(row, 4, 4)] for row in items(raw, 3, 3)]
        linear, shift = arb_mat([row[:3] for row in rows]), arb_mat([row[3:] for row in rows])
        square = (linear.transpose() * linear).tolist()
        need(
            all(
                abs(x - (i == j)) < _TOLERANCE
                for i, row in enumerate(square)
                for j, x in enumerate(row)
            ),
            "a pose of the tool's chain does not turn and shift only",
        )
        return Pose(linear, shift, most(*(sum(map(abs, row), R(0)) for row in square)).sqrt())

    def on(self, columns: Any) -> Any:
        """Apply it to a point and to its slopes.

        Parameters
        ----------
        columns : arb_mat, shape (3, 1 + dof)
            The point [m], then its derivative by each joint.

        Returns
        -------
        arb_mat
            The same, moved.
        """
        moved = self.linear * columns
        add_to(moved, 0, self.shift)
        return moved


@dataclass
class Link:
    """One joint with the fixed poses around it; its angle or way is factor q[joint] + offset."""

    before: Pose
    after: Pose
    axis: Any
    prismatic: bool
    joint: int
    factor: Any
    offset: Any

    @staticmethod
    def read(raw: Any, dof: int) -> Link:
        """Read one joint of a chain.

        Parameters
        ----------
        raw : object
            From the file.
        dof : int
            Number of joints of the claim.

        Returns
        -------
        Link
        """
        if not isinstance(raw, dict) or set(raw) != set(STEP_KEYS):
            raise BadInput(f"demands.tool.chain: a step has the keys {', '.join(STEP_KEYS)}")
        if not isinstance(raw["prismatic"], bool):
            raise BadInput("demands.tool.chain: prismatic is true or false")
        axis = arb_mat([[number(x)] for x in items(raw["axis"], 3, 3)])
        need(abs(length(axis) - 1) < _TOLERANCE, "an axis of the tool's chain is no unit vector")
        return Link(
            Pose.read(raw["before"]),
            Pose.read(raw["after"]),
            axis,
            raw["prismatic"],
            index(raw["joint"], dof),
            number(raw["factor"]),
            number(raw["offset"]),
        )

    @cached_property
    def cross(self) -> Any:
        """The matrix of the cross product with the axis."""
        x, y, z = self.axis.entries()
        return arb_mat([[0, -z, y], [z, 0, -x], [-y, x, 0]])

    @cached_property
    def lengthens(self) -> Any:
        """Bound on the factor by which a turn lengthens a vector."""
        k = length(self.axis)
        return (1 + 4 * k * k * most(k * k - 1, R(0))).sqrt()

    def on(self, columns: Any, q: list[Any]) -> Any:
        """Apply its motion to a point and to its slopes.

        Parameters
        ----------
        columns : arb_mat, shape (3, 1 + dof)
            The point [m], then its derivative by each joint.
        q : list of arb
            Joint positions [rad or m].

        Returns
        -------
        arb_mat
            The same, moved.
        """
        own, by = self.factor * q[self.joint] + self.offset, 1 + self.joint
        if self.prismatic:
            moved = arb_mat(columns)
            add_to(moved, 0, own * self.axis)
            add_to(moved, by, self.factor * self.axis)
            return moved
        sine, cosine = own.sin_cos()
        across = self.cross * columns
        inward = self.cross * across
        moved = columns + sine * across + (1 - cosine) * inward
        slope = cosine * across + sine * inward
        add_to(moved, by, self.factor * arb_mat([[slope[i, 0]] for i in range(3)]))
        return moved


def length(vector: Any) -> Any:
    """Measure a vector.

    Parameters
    ----------
    vector : arb_mat, shape (n, 1)
        The vector.

    Returns
    -------
    arb
        Its Euclidean length.
    """
    square = sum((x * x for x in vector.entries()), R(0))
    if square > 0:
        return square.sqrt()
    return R(0).union(square.upper().sqrt())  # a ball about 0 may reach below it


def add_to(columns: Any, at: int, vector: Any) -> None:
    """Add a vector to one column.

    Parameters
    ----------
    columns : arb_mat, shape (3, n)
        Changed.
    at : int
        The column.
    vector : arb_mat, shape (3, 1)
        What is added.
    """
    for i in range(3):
        columns[i, at] = columns[i, at] + vector[i, 0]
