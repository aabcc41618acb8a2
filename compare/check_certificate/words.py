"""A proof written for people: the inequalities that add up to it, each with its multiplier.

Segments, joints and waypoints count from 1. T2 is the duration of segment 2; v5(2) and a5(2) are the
velocity and the acceleration of joint 5 at waypoint 2, or v[elbow](2) and a[elbow](2) where joints have names.
"""

from __future__ import annotations

from compare.check_certificate.balls import R
from compare.check_certificate.claim import Claim, number
from compare.check_certificate.families.relaxation import Inequality, Relaxation, Variable

KINDS = {
    "h": "the time assumed",
    "s": "1/T between its bounds",
    "t": "1/T is convex",
    "c": "T^2 beside T and 1/T",
    "w": "T a between bounds",
    "v": "speed while the acceleration fades",
    "a": "speed that can be gained",
    "r": "room to stop",
    "d": "distance, with a piece at top speed",
    "k": "distance",
}


def proof_in_words(checker: Relaxation) -> list[str]:
    """Write the last sum of a proof, in SI units.

    Parameters
    ----------
    checker : Relaxation
        After its replay.

    Returns
    -------
    list of str
        A line per inequality.
    """
    lines = []
    for raw in checker.sum:
        of = KINDS[str(raw[0])]
        if str(raw[0]) in "wvardk":
            of += f", joint {checker.claim.joint_name(raw[1])}"
        lines.append(
            f"  {float(number(raw[-1])):.6g} x ({_inequality(checker.row(raw), checker.claim)})  [{of}]"
        )
    return lines


def _inequality(row: Inequality, claim: Claim) -> str:
    """One inequality: its terms that are not zero, and its right-hand side."""
    terms = [(float(x), _name(key, claim)) for key, x in row[0].items() if not bool(x == R(0))]
    text = " ".join(f"{'-' if x < 0 else '+'} {abs(x):.6g} {what}" for x, what in terms)
    return f"{text.removeprefix('+ ')} <= {float(row[1]):.6g}"


def _name(key: Variable, claim: Claim) -> str:
    """A variable as the module's docstring names it."""
    kind, k = key[0], key[1] + 1
    if kind in ("T", "u", "q"):
        return {"T": f"T{k}", "u": f"(1/T{k})", "q": f"T{k}^2"}[kind]
    j = claim.joint_name(key[2])
    if claim.names:
        j = f"[{j}]"
    if kind == "W":
        return f"T{k} a{j}({k + key[3]})"
    return f"{kind}{j}({k})"
