"""The recipes "Add a paper to the audit" and "Add a table or figure of a paper", followed in a copy."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import compare

ROOT = Path(compare.__file__).parents[1]

CASE = """
name = "made-up"
title = "one joint, made up"
source = "made for a test"
unit = "deg"
family = "3-5-3"
waypoints = [[0], [20], [70], [90]]

[limits]
unit = "deg"
velocity = [60]
acceleration = [90]
"""
PRINTED = """
case = "made-up"
title = "Kim 2026: one joint, 3-5-3, PSO"
source = "made for a test"
family = "3-5-3"
limited = ["velocity", "acceleration"]

[waypoints]
where = "Table 1"
unit = "deg"
rows = [["0.0"], ["20.0"], ["70.0"], ["90.0"]]

[[limits]]
name = "Table 2"
unit = "deg"
velocity = [60]
acceleration = [90]

[[table]]
where = "Table 3"
by = "PSO"
limits = "Table 2"
joints = [1]
times = [["1.16", "0.70", "1.16"]]
totals = ["1.86"]

[settings.swarm]
where = "sec. 4"
population = 5
iterations = 3
"""
ITEM = '''
"""Kim 2026, Table 3: times of joint 1 by PSO."""

from __future__ import annotations

from typing import Any

from compare.audit.paper import load_papers, settings
from compare.audit.paper.digits import values
from compare.benchmark.protocol import Budget
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.measure import summary, trials
from compare.papers.verdicts import same_times
from compare.papers.words import seconds


def make_table_3(full: bool) -> dict[str, Any]:
    """Run PSO by the printed budget."""
    paper = load_papers("kim_2026")[0]
    swarm = settings("kim_2026")["swarm"]
    problem = paper.problem(0, "Table 2")
    found = trials(problem, "pso", Budget(swarm["population"], swarm["iterations"]), 2)
    return {"printed": float(values(paper.rows[0].times).sum()), "found": summary(found)}


def show_table_3(data: dict[str, Any]) -> Shown:
    """Show both totals."""
    found = data["found"]["median"]
    table = Table(["", "total [s]"], [["printed", seconds(data["printed"])], ["PSO", seconds(found)]])
    outcome = same_times([data["printed"]], [found or 0.0])
    remarks = [f"{outcome}: {seconds(data['printed'])} s against {seconds(found)} s."]
    return Shown([table], remarks, [ItemVerdict("the total", outcome)])


TABLE_3 = Item("Table 3", "times of joint 1", make_table_3, show_table_3, "Read as printed.")
'''


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The three packages in a folder of their own, with their compiled kernels, which stay valid."""
    folder = tmp_path_factory.mktemp("copy")
    for name in ("formulations", "metaheuristics", "compare"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("*.tmp.*"))
    return folder


def call(folder: Path, *words: str, code: int = 0) -> str:
    """What a command of the copy prints; a command that does not end as it should fails the test."""
    done = subprocess.run(
        [sys.executable, *words], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == code, done.stderr
    return done.stdout if code == 0 else done.stderr


@pytest.mark.long
def test_add_a_paper_then_a_table_of_it(copy: Path) -> None:
    # 1. add a paper: its case, and printed.toml in a folder named by author and year
    (copy / "formulations" / "problem" / "cases" / "made-up.toml").write_text(CASE)
    paper = copy / "compare" / "papers" / "kim_2026"
    paper.mkdir()
    (paper / "printed.toml").write_text(PRINTED)

    call(copy, "-c", "import formulations; formulations.load('made-up')")
    for name in ("kim_2026", "made-up"):  # by author and year, or by its case
        told = call(copy, "-m", "compare.audit", name, "--every")
        assert "Kim 2026: one joint" in told
        assert "WRONG: faster than displacement over velocity limit" in told
        assert "it is the sum without segment 1" in told
    (paper / "printed.toml").write_text(PRINTED.replace("totals =", "total_times ="))
    told = call(copy, "-m", "compare.audit", "kim_2026", code=2)
    assert "unknown key 'total_times'; did you mean 'totals'?" in told
    (paper / "printed.toml").write_text(PRINTED)

    # 2. add a table of it: an Item, and one line in each list
    (paper / "table_3.py").write_text(ITEM.lstrip())
    (paper / "__init__.py").write_text(
        '"""Kim 2026."""\n\nfrom compare.papers.kim_2026.table_3 import TABLE_3\n\nITEMS = (TABLE_3,)\n'
    )
    registry = copy / "compare" / "papers" / "__init__.py"
    text = registry.read_text("utf-8")
    text = text.replace("import li_2022, ", "import kim_2026, li_2022, ")
    text = text.replace('    "li_2022": ', '    "kim_2026": kim_2026.ITEMS,\n    "li_2022": ')
    registry.write_text(text)

    made = ("kim_2026", "--item", "Table 3", "--out", "report", "--jobs", "1")
    assert "made-up: Table 3: " in call(copy, "-m", "compare.papers", *made)
    stored = json.loads((copy / "report" / "papers" / "made-up" / "table-3.json").read_text())
    assert stored["status"] == "ok"
    assert stored["data"]["printed"] == pytest.approx(3.02)
    page = (copy / "report" / "papers" / "made-up.html").read_text("utf-8")
    assert "one joint, 3-5-3, PSO" in page
    assert "eproduced: 3.0200 s against" in page
    assert re.search(r"<h1>Kim 2026: [01] of 1 printed results are reproduced", page)
