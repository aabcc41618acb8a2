"""Zhou 2025: what its tables and figures share."""

from __future__ import annotations

from compare.audit.paper import Paper, load_papers
from compare.benchmark.protocol import PAPER_BUDGETS
from formulations import Problem, load

BUDGET = PAPER_BUDGETS["ur5"]
RUNS = {False: 5, True: 30}
SWARMS = {"PSO": "pso", "SSA": "sparrow", "ISSA": "issa"}  # as the paper calls them


def as_meant() -> tuple[Paper, Problem]:
    """The paper and its task, with the minus sign of joint 6 at P1 restored."""
    paper = next(p for p in load_papers("zhou_2025") if p.name == "ur5-corrected")
    return paper, load("ur5-corrected")


def printed_ends() -> dict[str, float]:
    """Where the curves of Fig. 6 end for joint 1, as sec. 5.2 says, by algorithm [s]."""
    claims = load_papers("zhou_2025")[0].claims
    return {c.says.split()[0]: c.equals.value for c in claims if c.where.endswith("Fig. 6")}
