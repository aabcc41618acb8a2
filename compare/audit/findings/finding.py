"""One finding of an audit, and the kinds of finding in plain words."""

from __future__ import annotations

from dataclasses import dataclass, field

# kind -> what it means; in the order of the report
FAULTS: dict[str, str] = {
    "displacement": "faster than displacement over velocity limit",
    "minimum": "below the certified minimum of its spline",
    "limits": "breaks the limits it states",
    "other limits": "the result fits other limits than the stated ones",
    "tables": "too fast for the limits that another result of the same paper fits",
    "rule": "the longest time per segment breaks limits that each joint alone keeps",
    "ranking": "the order of the methods changes once their motions keep the limits",
    "sum": "the arithmetic does not add up",
    "point": "joint angles and Cartesian point disagree",
    "reach": "a point is out of the arm's reach",
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
    "slow": "compared with the best motion under the limits that it reaches itself",
    "offsets": "joint offsets are not printed",
}


@dataclass(frozen=True)
class Finding:
    """One verdict on a paper's numbers.

    Attributes
    ----------
    paper : str
        Name of the paper.
    kind : str
        A key of ``FAULTS`` or ``NOTES``.
    where, text : str
        The place in the paper; what was found there, with its numbers.
    proved : bool
        Whether it holds for every reading of the printed digits. Otherwise it is an inference.
    numbers : dict
        The numbers of the text, in SI units.
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
