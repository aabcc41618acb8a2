"""The chain from base to tool that a claim states: where the tool is, and how the joints move it.

The tool point is p(q) = B_1 M_1(q) A_1 B_2 M_2(q) A_2 ... e, with fixed affine maps A x = L x + l as
the file states them. A joint that slides adds (f q + o) k to a point. One that turns maps x to

    R x = x + sin(f q + o) (k x x) + (1 - cos(f q + o)) (k x (k x x)).

The file's floats are no exact rotations, so no bound takes them for such. L is bounded by
|L|^2 <= the largest row sum of |L^T L|. The matrix of the cross product with k has the eigenvalues 0 and
+- i |k|, so that |R|^2 <= 1 + 4 |k|^2 max(|k|^2 - 1, 0), and both derivatives of R by its angle are at most
|k| max(|k|, 1).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from flint import arb_mat

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import Interval, R, least, most
from compare.check_certificate.reading import index, items, number

MOST_STEPS = 200
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
        _add(moved, 0, self.shift)
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
            _add(moved, 0, own * self.axis)
            _add(moved, by, self.factor * self.axis)
            return moved
        sine, cosine = own.sin_cos()
        across = self.cross * columns
        inward = self.cross * across
        moved = columns + sine * across + (1 - cosine) * inward
        slope = cosine * across + sine * inward
        _add(moved, by, self.factor * arb_mat([[slope[i, 0]] for i in range(3)]))
        return moved


@dataclass
class ClaimedChain:
    """The links from base to tool, and the tool's place behind the last one."""

    links: list[Link]
    end: Pose
    dof: int

    @staticmethod
    def read(raw_links: Any, raw_end: Any, dof: int) -> ClaimedChain:
        """Read a chain.

        Parameters
        ----------
        raw_links, raw_end : object
            From the file.
        dof : int
            Number of joints of the claim.

        Returns
        -------
        ClaimedChain
        """
        links = [Link.read(x, dof) for x in items(raw_links, 1, MOST_STEPS)]
        return ClaimedChain(links, Pose.read(raw_end), dof)

    @property
    def turning(self) -> int:
        """Number of links that turn."""
        return sum(not link.prismatic for link in self.links)

    @property
    def sliding(self) -> int:
        """Number of links that slide."""
        return len(self.links) - self.turning

    def point_and_slopes(self, q: list[Any]) -> Any:
        """Compute the tool point and its derivative by each joint.

        Parameters
        ----------
        q : list of arb
            Joint positions [rad or m].

        Returns
        -------
        arb_mat, shape (3, 1 + dof)
            In the base's frame [m, m/rad or 1].
        """
        columns = arb_mat(3, 1 + self.dof)
        _add(columns, 0, self.end.shift)
        for link in reversed(self.links):
            columns = link.before.on(link.on(link.after.on(columns), q))
        return columns

    def bends(self, reach: list[Any]) -> list[list[Any]]:
        """Bound the second derivatives of the tool point by the joints.

        From tip to base, the length of the point and of its first and second derivatives is bounded by the
        product rule.

        Parameters
        ----------
        reach : list of arb
            Bounds on the moduli of the joint positions; only those of sliding joints count.

        Returns
        -------
        list of list of arb, [dof][dof]
            Symmetric.
        """
        joints = range(self.dof)
        size, slopes = length(self.end.shift), [R(0)] * self.dof
        bends = [[R(0)] * self.dof for _ in joints]

        def stretched(by: Any) -> None:
            nonlocal size, slopes, bends
            size, slopes = by * size, [by * x for x in slopes]
            bends = [[by * x for x in row] for row in bends]

        for link in reversed(self.links):
            stretched(link.after.size)
            size = size + length(link.after.shift)
            k, f, v = length(link.axis), abs(link.factor), link.joint
            if link.prismatic:
                size = size + (f * reach[v] + abs(link.offset)) * k
                slopes[v] = slopes[v] + f * k
            else:
                turned = f * k * most(k, R(1))
                of_point, of_slopes = f * turned * size, [turned * x for x in slopes]
                added = turned * size
                stretched(link.lengthens)
                slopes[v] = slopes[v] + added
                for j in joints:
                    bends[v][j] = bends[v][j] + of_slopes[j]
                    bends[j][v] = bends[j][v] + of_slopes[j]
                bends[v][v] = bends[v][v] + of_point
            stretched(link.before.size)
            size = size + length(link.before.shift)
        return bends

    def least_along(self, g: Any, joint: int, value: Any, limits: list[Interval], slack: Any) -> Any:
        """Bound g x from below over all tool points x that are reached with one joint at a value.

        From the base to the tool, poses and known joints are applied to g. A joint that turns by an unknown
        angle about k keeps the part of g along k, since k R = k; the rest takes off its length times that of
        R x across k.

        Parameters
        ----------
        g : arb_mat, shape (1, 3)
            In the base's frame.
        joint : int
            That is at the value; all others are anywhere.
        value : arb
            [rad or m].
        limits : list of Interval
            Of the positions; only those of sliding joints count.
        slack : arb
            By how much they may be left.

        Returns
        -------
        arb
            [m] times the unit of g. Refuses a sliding joint without limits.
        """
        total, across = R(0), self._across(limits, slack)
        for link, far in zip(self.links, across, strict=True):
            total, g = total + (g * link.before.shift)[0, 0], g * link.before.linear
            along = (g * link.axis)[0, 0]
            if link.prismatic:
                known = link.joint == joint
                ends = (value, value) if known else _within(limits[link.joint], slack)
                total += least(*(along * (link.factor * x + link.offset) for x in ends))
            elif link.joint == joint:
                sine, cosine = (link.factor * value + link.offset).sin_cos()
                turned = g * link.cross
                g = g + sine * turned + (1 - cosine) * (turned * link.cross)
            else:
                kept = (along / length(link.axis) ** 2) * link.axis.transpose()
                total -= length((g - kept).transpose()) * far
                g = kept
            total, g = total + (g * link.after.shift)[0, 0], g * link.after.linear
        return total + (g * self.end.shift)[0, 0]

    def _across(self, limits: list[Interval], slack: Any) -> list[Any]:
        """Bound, for each link, how far the tool is from its axis once it has turned."""
        size, found = length(self.end.shift), []
        for link in reversed(self.links):
            shift, k = link.after.shift, link.axis
            beside = shift - ((shift.transpose() * k)[0, 0] / length(k) ** 2) * k
            found.append(link.lengthens * (length(beside) + link.after.size * size))
            size = length(shift) + link.after.size * size
            if link.prismatic:
                ends = _within(limits[link.joint], slack)
                size += most(*(abs(link.factor * x + link.offset) for x in ends)) * length(k)
            else:
                size = link.lengthens * size
            size = length(link.before.shift) + link.before.size * size
        return found[::-1]


def _within(limits: Interval, slack: Any) -> Interval:
    """The positions that a joint may have."""
    lo, hi = limits
    need(
        lo is not None and hi is not None, "a joint that slides has no limits: the tool may be anywhere"
    )
    return lo - slack, hi + slack


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


def _add(columns: Any, at: int, vector: Any) -> None:
    """Add a vector to one column."""
    for i in range(3):
        columns[i, at] = columns[i, at] + vector[i, 0]
