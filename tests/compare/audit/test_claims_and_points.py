"""Arithmetic and Cartesian points of a paper: what is wrong is found, what is rounded is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from printed_papers import synthetic, truth

from compare.audit import load_papers, parse_papers
from compare.audit.findings.claims import claims_of
from compare.audit.findings.points import points_of
from compare.audit.paper.digits import printed


@pytest.mark.parametrize(
    ("planted", "where"),
    [
        ({"SHARE": "31.41"}, "sec. 4"),
        ({"MEAN": "5.4321"}, "Table 3, theirs"),
        ({"TOTALS": '"3.1000", "4.2000"'}, "Table 2, joint 1"),
        ({"LONGEST": '"1.0000", "2.0000", "3.0000"'}, "Table 2, last row"),
    ],
)
def test_arithmetic_that_does_not_add_up_is_found(planted: dict[str, str], where: str) -> None:
    (paper,) = parse_papers(synthetic(**planted), "p")
    assert where in {finding.where for finding in claims_of(paper)}


def test_the_segment_that_was_left_out_is_named() -> None:
    _, times = truth()
    longest = np.max(times, axis=0)
    text = synthetic(TOTAL=f"{longest[1:].sum():.4f}", SHARE=f"{100 * (1 - longest[1:].sum() / 9):.2f}")
    (finding,) = claims_of(parse_papers(text, "p")[0])
    assert finding.text.endswith("it is the sum without segment 1")


@given(st.lists(st.floats(0.05, 20.0), min_size=2, max_size=6), st.integers(1, 4))
@settings(max_examples=200)
def test_true_arithmetic_rounded_is_never_accused(t: list[float], digits: int) -> None:
    of = ", ".join(f'"{x:.{digits}f}"' for x in t)
    pair = f'"{t[0]:.{digits}f}", "{t[1]:.{digits}f}"'
    claims = [
        ("sum", of, f"{sum(t):.{digits}f}"),
        ("mean", of, f"{sum(t) / len(t):.{digits}f}"),
        ("difference", pair, f"{t[0] - t[1]:.{digits}f}"),
        ("reduction", pair, f"{100.0 * (1.0 - t[1] / t[0]):.2f}"),
    ]
    text = 'family = "3-5-3"\n[waypoints]\nunit = "rad"\ncount = 4\n' + "".join(
        f'[[claim]]\nwhere = "s"\nsays = "c"\nrule = "{rule}"\nof = [{numbers}]\nequals = "{equals}"\n'
        for rule, numbers, equals in claims
    )
    if all(float(f"{x:.{digits}f}") > 0.5 * 10.0**-digits for x in t[:2]):
        assert claims_of(parse_papers(text, "p")[0]) == []


def test_points_are_held_against_forward_kinematics() -> None:
    (paper,) = load_papers("cobot")
    true = replace(paper, points=paper.points[1:2])
    assert [f.kind for f in points_of(true)] == ["table"]
    moved = replace(true.points[0], position=(printed("x", "508.001"), *true.points[0].position[1:]))
    kinds = [f.kind for f in points_of(replace(paper, points=(moved,)))]
    assert kinds == ["point", "table"]
    far = replace(true.points[0], position=tuple(printed("x", v) for v in ("900", "0", "500")))
    assert "reach" in [f.kind for f in points_of(replace(paper, points=(far,)))]


def test_rounded_poses_of_rounded_joints_are_never_accused() -> None:
    (paper,) = load_papers("sr4c")
    assert not [f for f in points_of(paper) if f.fault]
    turned = replace(
        paper.points[0],
        rpy=(printed("r", "1.8719"), *(paper.points[0].rpy or ())[1:]),
    )
    found = points_of(replace(paper, points=(turned,)))
    assert [f.kind for f in found if f.fault] == ["point"]
    assert "turned by" in found[0].text
