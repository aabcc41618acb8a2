"""Arithmetic of a paper that no reading of its digits makes true: totals, differences, means, percentages."""

from __future__ import annotations

from collections.abc import Sequence

from compare.audit.findings import Finding
from compare.audit.paper import ArithmeticClaim, Paper, PrintedTimes
from compare.audit.paper.digits import Printed

_DUST = 1e-9  # relative rounding of sums of decimal fractions


def claims_of(paper: Paper) -> list[Finding]:
    """Check every claim, every total and every longest time of a paper.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Returns
    -------
    list of Finding
        Only what does not hold for any reading of the digits.
    """
    found = [_judged(paper, claim) for claim in paper.claims]
    for row in paper.rows:
        if row.total is not None:
            says = "the total of its times" if not row.of else "the total of the longest times"
            found.append(
                _judged(paper, ArithmeticClaim(row.where, says, "sum", row.times, row.total), row.of)
            )
        for k in range(len(row.times) if row.of else 0):
            column = tuple(joint.times[k] for joint in row.of)
            low, high = max(t.low for t in column), max(t.high for t in column)
            if _apart(low, high, row.times[k]):
                text = f"segment {k + 1}: {row.times[k]} s is printed, the longest time is {high:.6g} s"
                found.append(Finding(paper.name, "sum", row.where, text))
    return [finding for finding in found if finding is not None]


def between(rule: str, of: Sequence[Printed]) -> tuple[float, float]:
    """Enclose the result of a rule over every reading of the digits.

    Parameters
    ----------
    rule : str
        sum, mean, difference or reduction (per cent).
    of : sequence of Printed
        The numbers that the rule is applied to.

    Returns
    -------
    tuple of float
        Least and greatest result.
    """
    low, high = sum(n.low for n in of), sum(n.high for n in of)
    if rule == "sum":
        return low, high
    if rule == "mean":
        return low / len(of), high / len(of)
    before, after = of
    if rule == "difference":
        return before.low - after.high, before.high - after.low
    return 100.0 * (1.0 - after.high / before.low), 100.0 * (1.0 - after.low / before.high)


def _judged(paper: Paper, claim: ArithmeticClaim, rows: Sequence[PrintedTimes] = ()) -> Finding | None:
    low, high = between(claim.rule, claim.of)
    if not _apart(low, high, claim.equals):
        return None
    right = f"{0.5 * (low + high):.{max(_decimals(n) for n in (*claim.of, claim.equals))}f}"
    text = f"{claim.says}: {claim.equals} is printed, the {claim.rule} is {right}"
    if claim.rule == "sum":
        text += _left_out(claim.of, claim.equals, rows)
    numbers = {"printed": claim.equals.value, "low": low, "high": high}
    return Finding(paper.name, "sum", claim.where, text, numbers=numbers)


def _decimals(number: Printed) -> int:
    return len(number.text.partition(".")[2])


def _left_out(of: Sequence[Printed], equals: Printed, rows: Sequence[PrintedTimes]) -> str:
    """Name the segment that was left out of the sum, or of the sum of another row, if that explains it."""
    for name, times in [("", of), *((f" of {row.where}", row.times) for row in rows)]:
        for k in range(len(times)):
            rest = [t for i, t in enumerate(times) if i != k]
            if not _apart(*between("sum", rest), equals):
                return f"; it is the sum{name} without segment {k + 1}"
    return ""


def _apart(low: float, high: float, number: Printed) -> bool:
    """Whether no reading of the digits makes a printed number fall into [low, high]."""
    dust = _DUST * max(abs(low), abs(high), abs(number.value))
    return low > number.high + dust or high < number.low - dust
