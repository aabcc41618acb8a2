"""Every motion through the waypoints, B-splines among them: one sum from velocities, accelerations."""

from __future__ import annotations

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import R
from compare.check_certificate.claim import Claim, index, items, number

MOST_CELLS = 1_000_000


class VelocityAccelerationSum:
    """A bound that holds for every motion from rest to rest, whatever its family.

    For m linear on each segment, mu_0 .. mu_n at the waypoints, and p linear on N cells of each,
    sum (mu_{k-1} - mu_k) d_k / T_k = int m q'' = int p q'' + int (p - m)' q'
                                    <= A sum T_k mean |p| + V sum |steps of p - m|.
    Summed over the joints, a_k / T_k <= w_k T_k + const; so the total time is no less than
    sum T_k + a_k / T_k - w_k T_k - const >= sum 2 sqrt(a_k (1 - w_k)) - const. An event per joint.
    """

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        self.void = sum(claim.shortest(), R(0)) > claim.L

    def replay(self) -> int:
        """Verify the sum; returns the number of joints in it."""
        n, joints = self.claim.n, set()
        a, w, const = [R(0)] * n, [R(0)] * n, R(0)
        for raw in self.claim.events:
            letter, joint, mu, p = items(raw, 4, 4)
            if letter != "M":
                raise BadInput(f"unknown event {letter!r:.20}")
            j = index(joint, self.claim.dof)
            need(j not in joints, f"joint {j + 1} counts twice")
            joints.add(j)
            mu = [number(x) for x in items(mu, n + 1, n + 1)]
            p = [number(x) for x in items(p, n + 1, MOST_CELLS)]
            cells = (len(p) - 1) // n
            need(len(p) == cells * n + 1, "the cells of a segment are not equal in number")
            for k in range(n):
                a[k] += (mu[k] - mu[k + 1]) * self.claim.d[k][j]
                for i in range(k * cells, (k + 1) * cells):
                    if not (p[i] == 0 and p[i + 1] == 0):
                        w[k] += self.claim.limit(2, j) * (abs(p[i]) + abs(p[i + 1])) / (2 * cells)
                    turn = p[i + 1] - p[i] - (mu[k + 1] - mu[k]) / cells
                    const += self.claim.limit(1, j) * abs(turn)
        need(all(x >= 0 for x in a), "a segment gains from taking no time")
        need(all(x <= 1 for x in w), "a segment gains from taking long")
        total = sum((2 * (x * (1 - y)).sqrt() for x, y in zip(a, w, strict=True)), R(0)) - const
        need(total > self.claim.L, "the sum is not above the bound")
        return len(joints)
