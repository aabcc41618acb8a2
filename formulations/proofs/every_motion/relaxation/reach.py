"""How far and how fast one joint can get in one segment: inequalities that every motion satisfies.

Segment k takes T seconds, s = t / T in [0, 1]; dv/ds = W = T a, dW/ds = T^2 j, and the mean of v over
s is d / T. So v <= V, -A' T <= W <= A T and |dW/ds| <= J T^2; v0, W0, v1, W1 are the states at both ends.
Limits may differ between the directions: A' is that of the acceleration against the motion.

**Distance.** For any 0 <= s1 <= s2 <= s3 <= s4 <= s5 <= s6 <= 1, z = (s2 + s3) / 2, y = (s4 + s5) / 2:

    d / T  <=  z v0 + p W0 + (1 - y) v1 - q W1 + (y - z) V + (m A + m' A') T + g J T^2           (1)

    p = z s1 - s1^2 / 2,                       q = (1 - y) (1 - s6) - (1 - s6)^2 / 2
    m = (s2 - s1) (s3 - s1) / 2,               m' = (s6 - s5) (s6 - s4) / 2
    g = G(z, s1) + G(1 - y, 1 - s6) + (s3 - s2)^3 / 12 + (s5 - s4)^3 / 12
    G(z, s) = z s^2 / 2 - s^3 / 3

Proof. Let l(s) = z - s before s3, 0 between s3 and s4, y - s after s4. By parts, the mean of v is
z v0 + (1 - y) v1 + int l W ds + int v dM, where M has density 1 between s3 and s4 and the masses
(s3 - s2) / 2 at s3, (s5 - s4) / 2 at s4: all positive, y - z together, hence the term in V. In
int l W: l is positive on [s1, s2] and negative on [s5, s6]; the limits of W there give m and m'. On each
other piece an antiderivative of l that vanishes at s1 (on [0, s1]), at s2 and at s3 (on [s2, s3]: l has
the mean 0 there), at s4 and at s5, at s6 (on [s6, 1]) moves the derivative to W; the values at 0 and 1
are p and -q, and the integrals of its modulus add up to g.

It is tight for the motion that goes farthest: jerk J until s1, acceleration A until s2, jerk -J until
s3, top speed until s4, and the mirror image. Where that motion never reaches V, the two pieces of jerk
-J are one, [s2, s5]; then y = z = (s2 + s5) / 2, and (s5 - s2)^3 / 12 stands for the last two terms.

**Speed.** For any 0 <= s1 <= s2 <= 1, by the same argument one derivative higher,

    v1 - v0  <=  s1 W0 + (1 - s2) W1 + (s2 - s1) A T + (s1^2 + (1 - s2)^2) / 2 J T^2.            (2)

**Stop.** A joint must turn round before it has gone the distance r to its position limit: for any
0 <= s1 <= s2 <= 1,

    s2 v0 + p W0  <=  r / T + (s2 - s1)^2 / 2 A' T + g J T^2,                                    (3)
    p = s1 s2 - s1^2 / 2,   g = s1^2 s2 / 2 - s1^3 / 3.

Proof. r / T is at least the integral of v up to s2, s2 v0 + int (s2 - s) W ds; there W >= -A' T on
[s1, s2], and by parts as above on [0, s1]. It is tight for jerk -J until s1 and acceleration -A until
the joint rests at s2.

All three hold for the opposite direction of motion too, with the limits swapped, and (3) also for
reversed time. Without a jerk limit, s1 = 0, s3 = s2, s5 = s4, s6 = 1 in (1), s1 = 0, s2 = 1 in (2) and
s1 = 0 in (3) leave no term in W or J.

Every coefficient below is a sum of products of nonnegative differences. Its relative error is a few
roundings, since nothing cancels.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array


def distance_coefficients(switches: Array, cruises: bool) -> tuple[Array, ...]:
    """Compute the coefficients of (1).

    Parameters
    ----------
    switches : Array, shape (m, 6)
        Ascending in [0, 1].
    cruises : bool
        Whether there is a piece at top speed. If not, the third and the fourth switch are not used.

    Returns
    -------
    tuple of Array, shape (m,)
        Of v0, W0, v1, W1, V, A T (m + m', for limits that are the same in both directions) and J T^2.
    """
    s1, s2, s3, s4, s5, s6 = switches.T
    if cruises:
        top, turn = 0.5 * ((s4 - s3) + (s5 - s2)), ((s3 - s2) ** 3 + (s5 - s4) ** 3) / 12.0
    else:  # one piece of jerk -J from s2 to s5, whose halves stand for both
        s3, s4 = s5, s2
        top, turn = np.zeros_like(s1), (s5 - s2) ** 3 / 12.0
    e4, e5, e6 = 1.0 - s4, 1.0 - s5, 1.0 - s6
    rising, falling = arc_coefficients(switches, cruises)
    first = s1 * (0.5 * ((s2 - s1) + s3))
    last = e6 * (0.5 * ((s6 - s5) + e4))
    rise = s1**2 * (((s2 - s1) + (s3 - s1)) / 4.0 + s1 / 6.0)
    fall = e6**2 * (((s6 - s5) + (s6 - s4)) / 4.0 + e6 / 6.0)
    return 0.5 * (s2 + s3), first, 0.5 * (e4 + e5), -last, top, rising + falling, rise + fall + turn


def arc_coefficients(switches: Array, cruises: bool) -> tuple[Array, Array]:
    """Compute the coefficients m and m' of (1), of the acceleration with the motion and against it.

    Parameters
    ----------
    switches : Array, shape (m, 6)
        Ascending in [0, 1].
    cruises : bool
        As of ``distance_coefficients``.

    Returns
    -------
    tuple of Array, shape (m,)
    """
    s1, s2, s3, s4, s5, s6 = switches.T
    if not cruises:
        s3, s4 = s5, s2
    return 0.5 * (s2 - s1) * (s3 - s1), 0.5 * (s6 - s5) * (s6 - s4)


def speed_coefficients(switches: Array) -> tuple[Array, ...]:
    """Compute the coefficients of (2).

    Parameters
    ----------
    switches : Array, shape (m, 2)
        Ascending in [0, 1].

    Returns
    -------
    tuple of Array, shape (m,)
        Of W0, W1, A T and J T^2.
    """
    s1, s2 = switches.T
    e2 = 1.0 - s2
    return s1, e2, s2 - s1, 0.5 * (s1**2 + e2**2)


def stop_coefficients(switches: Array) -> tuple[Array, ...]:
    """Compute the coefficients of (3).

    Parameters
    ----------
    switches : Array, shape (m, 2)
        Ascending in [0, 1].

    Returns
    -------
    tuple of Array, shape (m,)
        Of v0, W0, A T and J T^2.
    """
    s1, s2 = switches.T
    rest = s2 - s1
    return s2, 0.5 * s1 * (rest + s2), 0.5 * rest**2, s1**2 * (0.5 * rest + s1 / 6.0)
