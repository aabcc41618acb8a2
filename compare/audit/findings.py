"""What an audit can find, in plain words, each with the number that proves it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from compare.audit.paper import Paper

# kind -> what it means; in the order of the report
FAULTS: dict[str, str] = {
    "displacement": "faster than displacement over velocity limit",
    "minimum": "below the certified minimum of its spline",
    "limits": "breaks the limits it states",
    "other limits": "other limits than the stated ones fit",
    "tables": "too fast for the limits that another result of the same paper fits",
    "rule": "the longest time per segment does not keep what each joint alone keeps",
    "ranking": "made feasible, the order of the methods changes",
    "sum": "the arithmetic does not add up",
    "point": "joint angles and Cartesian point disagree",
    "reach": "a point out of the arm's reach",
    "table": "the printed arm does not lead to the printed points",
}
IN_SHORT: dict[str, str] = {
    "displacement": "faster than its top speed allows",
    "minimum": "below the certified minimum",
    "limits": "breaks its own limits",
    "other limits": "other limits fit",
    "tables": "tables contradict each other",
    "rule": "longest-segment rule breaks the limits",
    "ranking": "order of the methods changes",
    "sum": "sums that are wrong",
    "point": "angles and points disagree",
    "reach": "points out of reach",
    "table": "printed arm does not fit",
}
NOTES: dict[str, str] = {
    "missing": "cannot be judged",
    "keeps": "keeps its limits",
    "rounding": "keeps its limits as far as the printed digits tell",
    "slow": "beside the best motion under the limits that it reaches itself",
    "offsets": "joint offsets are not printed",
}


@dataclass(frozen=True)
class Finding:
    """One verdict.

    kind: a key of FAULTS or NOTES. proved: it follows from the numbers for every reading of the printed
    digits; otherwise the numbers speak for it, no more. numbers: those of the text, SI.
    """

    paper: str
    kind: str
    where: str
    text: str
    proved: bool = True
    numbers: dict[str, float] = field(default_factory=dict)

    @property
    def fault(self) -> bool:
        """Whether something is wrong."""
        return self.kind in FAULTS


def amount(paper: Paper, value: float, order: int) -> str:
    """A derivative of a joint for people: 418.7 deg/s."""
    power = {1: "/s", 2: "/s^2", 3: "/s^3"}.get(order, "")
    return f"{number(value / paper.angle)} {paper.unit}{power}"


def number(value: float) -> str:
    """Four digits, six beyond a thousand; no exponent for what people measure."""
    if not np.isfinite(value):
        return "unlimited"
    return f"{value:.4g}" if abs(value) < 1000.0 else f"{value:.0f}"


def percent(ratio: float) -> str:
    """0.47 %, 35.5 %."""
    return f"{100.0 * ratio:.3g} %"
