"""The claim of a certificate, read from a file that may be wrong or hostile."""

from __future__ import annotations

from typing import Any

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import R, least, most
from compare.check_certificate.demands import ClaimedDemands, plain_demands, read_demands
from compare.check_certificate.reading import index, items, number

FORMAT = "timebound certificate 1"
LONGEST_NAME = 100  # characters
MOST_EVENTS, MOST_SEGMENTS, MOST_JOINTS = 3_000_000, 50, 50
MOST_SEGMENTS_OF_A_SUM = 5_000  # of a bound of every motion: the work grows with the rows alone
EVERY_MOTION = "every-motion"  # the family of bounds of every motion


class Claim:
    """The problem and the bound of a certificate, as exact numbers; None stands for no limit.

    names: of the joints, none or one each; w, d: waypoints and displacements [rad]; limits: of velocity,
    acceleration, jerk; L: the bound [s]; without: waypoints that the proof leaves out; events: the proof, not
    looked at yet.
    """

    def __init__(self, data: Any) -> None:
        if not isinstance(data, dict) or data.get("format") != FORMAT:
            raise BadInput(f"not a certificate: its format is not {FORMAT!r}")
        self.family = str(data.get("family"))
        every = self.family == EVERY_MOTION
        longest = MOST_SEGMENTS_OF_A_SUM if every else MOST_SEGMENTS
        rows = items(data.get("waypoints"), 2, longest + 1)
        self.dof = len(items(rows[0], 1, MOST_JOINTS))
        self.w = [[number(x) for x in items(row, self.dof, self.dof)] for row in rows]
        self.n = len(rows) - 1
        self.names = [str(name) for name in items(data.get("names", []), 0, self.dof)]
        if len(self.names) not in (0, self.dof) or not all(
            name.isprintable() and len(name) <= LONGEST_NAME for name in self.names
        ):
            raise BadInput(f"names: {self.names!r:.40} are no names of {self.dof} joints")
        limits = data.get("limits")
        if not isinstance(limits, dict):
            raise BadInput("limits: missing")
        keys = ("velocity", "acceleration", "jerk")
        self.limits = [
            [None if x is None else number(x) for x in items(limits.get(key), self.dof, self.dof)]
            for key in keys
        ]
        need(all(x is None or x > 0 for row in self.limits for x in row), "a limit is not positive")
        self.position = [
            [None if x is None else number(x) for x in items(pair, 2, 2)]
            for pair in items(limits.get("position"), self.dof, self.dof)
        ]
        self.slack, self.L = number(data.get("position_slack")), number(data.get("seconds"))
        need(self.slack >= 0, "position_slack is negative")
        need(self.L > 0, "the bound is not positive")
        self.short, self.horizon = data.get("short"), data.get("horizon")
        self.events = items(data.get("events"), 0, MOST_EVENTS)
        self.d = [
            [b - a for a, b in zip(*pair, strict=True)]
            for pair in zip(self.w, self.w[1:], strict=False)
        ]
        self.moving = [j for j in range(self.dof) if not all(row[j] == 0 for row in self.d)]
        asked = data.get("demands")
        if asked is None:
            need(self.moving, "nothing moves: any motion is as fast as it likes")
        elif not every:
            raise BadInput(f"demands: a bound of {self.family!r:.20} keeps none")
        self._asked = asked
        without = data.get("without")
        if without and asked is None:
            raise BadInput("without: only a bound under demands leaves out waypoints")
        self.without = frozenset(index(i, self.n) for i in items(without or [], 0, self.n))
        # the prover widens the limits by a thousandth more
        self.slack *= R(1001) / 1000

    def demands(self) -> ClaimedDemands:
        """Read what the motions have to keep.

        Returns
        -------
        ClaimedDemands
            Those of the file; of a plain problem where it has none.
        """
        return plain_demands(self) if self._asked is None else read_demands(self._asked, self)

    def joint_name(self, j: int) -> str:
        """Say which joint is meant: its name, or its number from 1 where it has none.

        Parameters
        ----------
        j : int
            The joint, from 0.

        Returns
        -------
        str
        """
        return self.names[j] if self.names else f"{j + 1}"

    def limit(self, order: int, j: int) -> Any:
        """Look up a limit that a row poses.

        Parameters
        ----------
        order : int
            1: velocity, 2: acceleration, 3: jerk.
        j : int
            The joint.

        Returns
        -------
        arb
            The limit. Refuses the certificate if there is none.
        """
        value = self.limits[order - 1][j]
        need(value is not None, f"a row poses a limit that joint {self.joint_name(j)} does not have")
        return value

    def room(self, k: int, j: int, sign: int) -> Any:
        """Measure the room from a waypoint to a position limit, widened by the slack.

        Parameters
        ----------
        k, j : int
            Waypoint and joint.
        sign : int
            1: the limit above, -1: below.

        Returns
        -------
        arb [rad]
            The room. Refuses the certificate if there is no such limit.
        """
        bound: Any = self.position[j][sign > 0]
        need(bound is not None, f"a row poses a limit that joint {self.joint_name(j)} does not have")
        far = most(sign * bound, *(sign * row[j] for row in self.w))
        return far - sign * self.w[k][j] + self.slack

    def acceleration(self, j: int, total: Any = None) -> Any:
        """Bound the acceleration of a joint, if it is zero at the start and at the end.

        Parameters
        ----------
        j : int
            The joint.
        total : arb [s], optional
            The time of the motion; by default the bound that is claimed.

        Returns
        -------
        arb [rad/s^2], or None
            Upper bound; None without limits on acceleration and jerk.
        """
        total = self.L if total is None else total
        _, acceleration, jerk = (row[j] for row in self.limits)
        if jerk is not None:
            rising = jerk * total / 2
            acceleration = rising if acceleration is None else least(acceleration, rising)
        return acceleration

    def speed(self, j: int, total: Any = None) -> Any:
        """Bound the speed of a joint in a motion from rest to rest.

        Parameters
        ----------
        j : int
            The joint.
        total : arb [s], optional
            The motion takes no longer; L by default.

        Returns
        -------
        arb [rad/s], or None
            Upper bound; None without any limit.
        """
        total = self.L if total is None else total
        velocity, acceleration = self.limits[0][j], self.acceleration(j, total)
        if acceleration is not None:
            rising = acceleration * total / 2
            velocity = rising if velocity is None else least(velocity, rising)
        return velocity

    def shortest(self, total: Any = None) -> list[Any]:
        """Lower bounds of the durations, displacement over speed, length n [s].

        Parameters
        ----------
        total : arb [s], optional
            The motion takes no longer; L by default.

        Returns
        -------
        list of arb [s]
        """
        speeds = {j: self.speed(j, total) for j in self.moving}
        need(all(speed is not None for speed in speeds.values()), "a moving joint has no limit")
        return [most(*(abs(row[j]) / speeds[j] for j in self.moving)) for row in self.d]

    def row(self, raw: Any, pieces: int | None = None) -> tuple[Any, ...]:
        """Read a row.

        Parameters
        ----------
        raw : object
            From the file.
        pieces : int, optional
            Number of pieces of the spline; that of the segments by default.

        Returns
        -------
        tuple
            Kind, multiplier > 0; then joint, segment and sign for jumps and pieces; order and place for pieces;
            first segment and the one after the last for parts.
        """
        raw = items(raw, 2, 7)
        kind, multiplier = raw[0], number(raw[-1])
        need(multiplier > 0, "a multiplier is not positive")
        if kind in ("t", "f", "l") and len(raw) == 2:
            return kind, multiplier
        if kind == "w" and len(raw) == 4:
            return kind, multiplier, index(raw[1], self.n), index(raw[2], self.n + 1)
        if (kind, len(raw)) not in (("p", 7), ("j", 5)):
            raise BadInput(f"unknown row {raw!r:.60}")
        j, k, sign = index(raw[1], self.dof), index(raw[2], pieces or self.n), raw[-2]
        if type(sign) is not int or sign not in (-1, 1):
            raise BadInput(f"a sign is {sign!r:.40}")
        need(j in self.moving, f"a row is about joint {j + 1}, which does not move")
        if kind == "j":
            return kind, multiplier, j, k, sign
        place = number(raw[4])
        need(0 <= place <= 1, "a row is posed outside its piece")
        return kind, multiplier, j, k, sign, index(raw[3], 4), place
