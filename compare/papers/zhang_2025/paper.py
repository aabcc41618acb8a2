"""Zhang 2025: what its tables and figures share. Numbers that a claim of the text repeats are taken from it."""

from __future__ import annotations

from compare.audit.paper import ArithmeticClaim, Paper, load_papers
from compare.benchmark.protocol import PAPER_BUDGETS

BUDGET = PAPER_BUDGETS["cobot"]
RUNS = {False: 15, True: 100}


def paper() -> Paper:
    """The numbers that the paper prints."""
    return load_papers("zhang_2025")[0]


def _claim(words: str) -> ArithmeticClaim:
    return next(claim for claim in paper().claims if words in claim.says)


def reductions() -> dict[str, list[str]]:
    """How much lower the improved PSO ends than each rival, joints 1 to 6 [%] (sec. 3.2, below Fig. 6)."""
    words = {"PSO": "on average, against standard PSO", "WOA": "on average, against WOA"}
    return {rival: [number.text for number in _claim(says).of] for rival, says in words.items()}


def ends() -> dict[str, str]:
    """Where the curves of joint 1 end [s] (sec. 3.2, Fig. 6)."""
    found = {total.by: str(total.value) for total in paper().totals}
    return {"PSO": found["standard PSO"], "improved": found["improved PSO"]}


def first_plan() -> float:
    """Time of the motion before [s] (sec. 3.2, Figs 7-9 a)."""
    return _claim("the time shrinks").of[0].value
