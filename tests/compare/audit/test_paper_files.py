"""Files of papers: they agree with the cases, and a mistake is one line."""

from __future__ import annotations

import numpy as np
import pytest
from printed_papers import synthetic

from compare.audit import PAPERS, load_papers, parse_papers
from formulations import CASES, InputError, load


@pytest.mark.parametrize("name", PAPERS)
def test_published_waypoints_and_limits_are_those_of_the_cases(name: str) -> None:
    for paper in load_papers(name):
        if paper.waypoints is None:
            continue
        case = load(paper.name)
        assert paper.name in CASES
        np.testing.assert_allclose(paper.waypoints, case.waypoints, atol=1e-12)
        assert paper.family == case.family
        if paper.stated:
            first = next(iter(paper.stated.values()))
            np.testing.assert_allclose(first.derivatives, case.limits.derivatives, rtol=1e-12)
            np.testing.assert_allclose(first.position, case.limits.position, rtol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('family = "3-5-3"', 'family = "3-5"', "family: '3-5' is not one of"),
        ('limits = "Table 1"', 'limits = "Table 9"', "limits: no [[limits]] has the name 'Table 9'; the near"),
        ("joints = [1, 2]", "joints = [1, 3]", "table: Table 2: joints: 3 is not one of 1 to 2"),
        ('rows = [', 'rows = [["0.5", "0.5"],', "3 values where 4 are expected (waypoints: rows: 5)"),
        ("joints = [1, 2]", "joints = [1]", "joints, times and totals differ in length"),
        ('rule = "reduction"', 'rule = "ratio"', "rule: 'ratio' is not one of"),
        ('of = [9,', 'of = [9, 1,', "of: 3 values where 2 are expected"),
        ('"0.5000", "-0.2000"', '"0.5000", "-0,2"', "waypoints: rows: row 2: value 2: '-0,2' is no"),
        ("velocity = [60, 80]", "velocity = [60, 0]", "velocity: 0 is not positive"),
        ('limited = [', 'limit = [', "unknown key 'limit'"),
        ('unit = "deg"', 'unit = "gon"', "unit: 'gon' is not one of rad, deg"),
        ('name = "Table 1"', "", "name: missing"),
        ('[[claim]]', '[claim]', "claim: expected tables [[claim]]"),
    ],
)  # fmt: skip
def test_a_mistake_in_a_paper_is_one_line(old: str, new: str, message: str) -> None:
    text = synthetic()
    assert old in text
    with pytest.raises(InputError) as caught:
        parse_papers(text.replace(old, new, 1), "p")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
