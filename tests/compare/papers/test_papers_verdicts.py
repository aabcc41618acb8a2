"""Verdicts on the pages follow from the numbers beside them: other numbers, another verdict."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

import compare.papers
from compare.papers.verdicts import (
    Reproduction,
    more_often,
    pairs_won,
    same_gain,
    same_gains,
    same_order,
    same_times,
)

# --- the rules ------------------------------------------------------------------------------------


def test_pairs_are_won_by_the_shorter_time_and_a_failed_run_is_longer_than_any() -> None:
    assert pairs_won([1.0, 2.0, 3.0, None, 1.0, None], [2.0, 2.0, 2.0, 1.0, None, None]) == 3.0
    assert pairs_won([], []) == 0.0


@given(st.floats(-0.9, 0.9), st.floats(-0.9, 0.9))
def test_a_gain_is_reproduced_near_it_in_kind_on_its_side_and_never_on_the_other(
    printed: float, found: float
) -> None:
    outcome = same_gain(printed, found)
    assert same_gain(printed, printed) is Reproduction.REPRODUCED
    if printed * found < 0.0:
        assert outcome is Reproduction.NOT
    if outcome is Reproduction.IN_KIND:
        assert printed * found > 0.0
    # moving what was found nearer to the print never makes the verdict worse
    order = (Reproduction.NOT, Reproduction.IN_KIND, Reproduction.REPRODUCED)
    nearer = same_gain(printed, 0.5 * (printed + found))
    if printed * found > 0.0 and abs(printed) > 0.01:
        assert order.index(nearer) >= order.index(outcome)


def test_times_orders_and_shares() -> None:
    assert same_times([1.0, 2.0], [1.005, 1.99]) is Reproduction.REPRODUCED
    assert same_times([1.0, 2.0], [1.02, 2.0]) is Reproduction.NOT
    assert same_times([1.0, 2.0], [1.0, 2.0], [False, True]) is Reproduction.NOT
    assert same_gains([0.2, 0.2], [0.2, 0.05]) is Reproduction.IN_KIND
    assert same_gains([0.2, 0.2], [0.05, -0.2]) is Reproduction.NOT
    assert same_order([1.0, 2.0, 3.0]) is Reproduction.REPRODUCED
    assert same_order([1.0, 1.0, 3.0]) is Reproduction.NOT
    assert [more_often(share, 1000) for share in (0.56, 0.52, 0.2)] == [
        "more often",
        "not more often beyond chance",
        "less often",
    ]
    assert more_often(0.56, 100) == "not more often beyond chance"


def test_no_verdict_is_typed_into_a_text() -> None:
    typed = re.compile(
        r"not reproduced|reproduced in kind|not as claimed|reproduced, but|(?<![.\d])00[0-4]\b", re.I
    )
    (folder,) = compare.papers.__path__
    for path in Path(folder).rglob("*.py"):
        if path.name == "verdicts.py":
            continue
        tree = ast.parse(path.read_text("utf-8"))
        # what a command says of itself is no text of a page
        tree.body = [node for node in tree.body if getattr(node, "name", "") != "main"]
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                text = re.sub(r"(pso|whale|mipso)-00\d", "", node.value)
                assert not typed.search(text), (path, node.lineno, node.value)
