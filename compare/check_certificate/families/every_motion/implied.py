"""Limits on speed and acceleration that follow from the others, from the ends and from the times.

V, A and J are the largest moduli of a joint over all segments; the motion takes from L to H seconds. The
proofs stand in docs/methods/every_motion.md.

    at rest at both ends                      |v| <= A H / 2,  and with a = 0 there too:
                                              |v| <= J H^2 / 16,   |a| <= J H / 4
    a = 0 at both ends, or a cycle            |a| <= sqrt(2 J V)
    any ends                                  |a| <= 4 V / l + J l / 4     for every 0 < l <= L
"""

from __future__ import annotations

from typing import Any

from compare.check_certificate.balls import least
from compare.check_certificate.demands import ClaimedDemands
from compare.check_certificate.families.every_motion.course import loosest, moduli, most_of


class ImpliedLimits:
    """Per joint; None stands for no limit.

    jerk: J. top, steep: of speed and of acceleration, all that holds. limited: whether there is a limit of
    acceleration. largest: (down, up), the largest velocity limits. fades: for the start and the end, whether
    the acceleration is 0 there, or the motion is a cycle and goes on.
    """

    def __init__(self, demands: ClaimedDemands, H: Any, L: Any) -> None:
        self.limited, self.largest, self.fades, self.top, self.steep = [], [], [], [], []
        self.jerk = [most_of(x) for x in zip(*demands.jerk, strict=True)]
        for j, J in enumerate(self.jerk):
            self.largest.append(moduli(loosest(row[j] for row in demands.velocity)))
            V = most_of(self.largest[j])
            A = most_of(moduli(loosest(row[j] for row in demands.acceleration)))
            self.limited.append(A is not None)
            still = [demands.stops[0], demands.stops[-1]]
            v, a = (
                [
                    stop or (end[j][0] == 0 and end[j][1] == 0)
                    for stop, end in zip(still, ends, strict=True)
                ]
                for ends in (demands.end_velocity, demands.end_acceleration)
            )
            self.fades.append((True, True) if demands.cyclic else (a[0], a[1]))
            tops = [] if V is None else [V]
            steep = [] if A is None else [A]
            if A is not None and all(v):
                tops.append(A * H / 2)
            if J is not None:
                if all(v) and all(a):
                    tops.append(J * H * H / 16)
                    steep.append(J * H / 4)
                if V is not None and all(self.fades[j]):
                    steep.append((2 * J * V).sqrt())
                elif V is not None and L > 0:
                    span = least(L, 4 * (V / J).sqrt())
                    steep.append(4 * V / span + J * span / 4)
            self.top.append(least(*tops) if tops else None)
            self.steep.append(least(*steep) if steep else None)
