"""Durations in closed form: in proportion to the distances between waypoints, scaled to the limits.

Lu & Wang 2024 pass the waypoints at parameters in proportion to chord lengths (eq. 4, 5) before they search for
better ones. Lee 1989 takes the square roots of the lengths: a spline overshoots less where a long segment meets
a short one.

References
----------
Lee E. T. Y. (1989). Choosing nodes in parametric curve interpolation. Computer-Aided Design 21(6), 363-370.
"""

from __future__ import annotations

import numpy as np

from formulations.families import FAMILIES
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem


def chord_lengths(problem: Problem, *, power: float = 1.0) -> Array:
    """Choose durations in proportion to the chord lengths, as short as the derivative limits allow.

    Position limits are not looked at: they depend on the ratios of the durations alone, so no scaling mends
    them. ``check`` judges the motion.

    Parameters
    ----------
    problem : Problem
        Waypoints, limits and family.
    power : float, default 1
        Of the chord lengths: 1 is chord-length parameterisation (eq. 4, 5), 1/2 the centripetal one, 0 makes
        all durations equal.

    Returns
    -------
    Array, shape (n_segments,) [s]

    Raises
    ------
    UnsupportedProblem
        If the family has no spline for this problem.
    InputError
        If the power is not a number, or two neighbouring waypoints are the same: a chord of no length leaves no
        time.

    Examples
    --------
    >>> import formulations as f
    >>> problem = f.load("z1")
    >>> motion = f.FAMILIES["b-spline-5"].trajectory(problem, chord_lengths(problem))
    >>> round(motion.seconds, 3), f.check(problem, motion).feasible
    (18.646, False)
    >>> round(float(chord_lengths(problem, power=0.5).sum()), 3)
    17.768
    """
    if not np.isfinite(power):
        raise InputError(f"chord_lengths: power: {power!r} is not a number")
    family = FAMILIES[problem.family]
    family.require(problem)
    chords = np.linalg.norm(np.diff(problem.waypoints, axis=0), axis=1)  # eq. 4
    if power != 0.0 and not chords.all():
        k = int(chords.argmin())
        raise InputError(
            f"chord_lengths: waypoints {k + 1} and {k + 2} are the same; a chord of no length leaves no time"
        )
    with np.errstate(all="ignore"):  # what leaves the range of floats is refused below
        shape = (chords / chords.max() if power != 0.0 else np.ones(len(chords))) ** power  # eq. 5
    if not (np.isfinite(shape) & (shape > 0.0)).all():
        raise InputError(f"chord_lengths: power {power:g} of these chords leaves the range of floats")
    return np.asarray(shape * family.stretch(problem, shape[None])[0])
