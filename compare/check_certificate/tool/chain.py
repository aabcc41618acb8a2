"""The chain from base to tool that a claim states: where the tool is, and how the joints move it.

The tool point is p(q) = B_1 M_1(q) A_1 B_2 M_2(q) A_2 ... e, with fixed poses A and B and joints M (``link``).
Both derivatives of a turn R by its angle are at most |k| max(|k|, 1), as the matrix of the cross product with
its axis k has the eigenvalues 0 and +- i |k|.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flint import arb_mat

from compare.check_certificate.answers import need
from compare.check_certificate.balls import Interval, R, least, most
from compare.check_certificate.reading import items
from compare.check_certificate.tool.link import Link, Pose, add_to, length

MOST_STEPS = 200


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
        add_to(columns, 0, self.end.shift)
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
