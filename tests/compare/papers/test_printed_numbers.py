"""Numbers that the papers print are the ones that the code uses."""

from __future__ import annotations

from compare.audit.paper import load_papers, settings
from compare.audit.paper.digits import values
from compare.benchmark.protocol import PAPER_BUDGETS
from compare.papers.li_2022.paper import budget as li_budget
from compare.papers.measure import judged_row
from compare.papers.wang_2025 import ablation, joint_1
from compare.papers.wang_2025.paper import budget as wang_budget
from metaheuristics import ALGORITHMS


def test_numbers_that_stand_in_two_files_are_the_same() -> None:
    paper = load_papers("sr4c")[0]
    for swarm, times in joint_1.PRINTED.items():
        assert times == [t.value.value for t in paper.totals if t.by == swarm]
    protocol, swarm = settings("sr4c")["ablation"], settings("sr4c")["swarm"]
    full = ablation.FULL
    assert [full.population, full.dim, full.iterations, full.runs] == [
        protocol[name] for name in ("population", "dimensions", "iterations", "runs")
    ]
    mipso = ALGORITHMS["mipso"].parameters
    assert swarm["alpha"] == settings("sr4c")["tent"]["alpha"] == mipso["lam"]
    assert swarm["inertia"] == [mipso["w_max"], mipso["w_min"]]
    assert swarm["mutation"] == [mipso["pm1"], mipso["pm2"]]
    assert wang_budget() == PAPER_BUDGETS["sr4c"]

    # the plans that the claimed savings start from
    for key in ("sr4c", "bagging"):
        claims = [c for c in load_papers(key)[0].claims if "first plan" in c.says]
        assert [c.of[0].value for c in claims] == [sum(settings(key)["first_plan"]["times"])]
    mpso, swarm = ALGORITHMS["mpso"].parameters, settings("bagging")["swarm"]
    assert swarm["factors"] == [mpso["c_start"], mpso["c_end"]]
    assert swarm["inertia"] == [mpso["w_max"], mpso["w_min"]]
    assert li_budget() == PAPER_BUDGETS["bagging"]
    single = [row for row in load_papers("bagging")[0].rows if row.joint is not None]
    assert settings("bagging")["box"]["seconds"][0] == min(values(row.times).min() for row in single)
    for key, names in (("ur5", "population"), ("cobot", "population"), ("z1", "population")):
        swarm = settings(key)["swarm"]
        assert (swarm[names], swarm["iterations"]) == (
            PAPER_BUDGETS[key].population,
            PAPER_BUDGETS[key].iterations,
        )


def test_printed_vectors_are_judged_with_their_rounding() -> None:
    paper = load_papers("sr4c")[0]
    found = {(row.where, row.joint): judged_row(paper, row) for row in paper.rows}
    assert found["Table 9, joint 1", 0]["keeps"] == "yes"
    assert found["Table 9, joint 1", 0]["most"].startswith("acceleration of joint 1, 54.5 %")
    whole = found["sec. 4.2.2", None]
    assert whole["stretch"] > 1.0  # by its digits it breaks a limit, by 16 millionths
    assert whole["keeps"] == "within rounding"
