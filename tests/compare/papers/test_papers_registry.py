"""Every table and figure that can be made again is there, once, and is the same when made twice."""

from __future__ import annotations

import json
import re

import matplotlib.pyplot as plt
import pytest

from compare.audit.paper import settings
from compare.papers import ITEMS
from compare.papers.item import Table

ASKED = {
    "sr4c": "Tables 3, 5, 8-10; Figs 4, 5, 7-14, 17-19",
    "bagging": "Tables 2, 3; Figs 4-6",
    "ur5": "Tables 2, 4-6; Figs 5-7",
    "z1": "Figs 1, 4-8",
    "cobot": "Tables 3, 4; Figs 6-9",
}


def numbered(labels: str) -> set[str]:
    """What a list like "Tables 2, 4-6; Fig 5" names, one by one."""
    found = set()
    for kind, numbers in re.findall(r"(Table|Fig)s? ([\d, -]+)", labels):
        for first, last in re.findall(r"(\d+)(?:-(\d+))?", numbers):
            found |= {f"{kind} {n}" for n in range(int(first), int(last or first) + 1)}
    return found


def test_every_table_and_figure_that_was_asked_for_is_there() -> None:
    assert [paper for paper in ITEMS if paper in ASKED] == list(ASKED)
    for paper, asked in ASKED.items():
        assert numbered("; ".join(item.label for item in ITEMS[paper])) >= numbered(asked), paper
        assert len({item.key for item in ITEMS[paper]}) == len(ITEMS[paper])
        assert all(item.title and item.reading for item in ITEMS[paper])


NAMED = {  # what the issue of this chapter names
    "ur5": ["Table 2", "Table 4", "Table 5", "Table 6", "Fig 5", "Fig 6", "Fig 7"],
    "z1": ["Fig 1", "Fig 4", "Fig 5", "Fig 6", "Fig 7", "Fig 8"],
    "cobot": ["Table 3", "Table 4", "Fig 6", "Fig 7", "Fig 8", "Fig 9"],
}


def item(paper, label):
    return next(i for i in ITEMS[paper] if i.label == label)


def shown_in(label):
    """Fig 7, Fig 8 and Fig 9 of "Figs 7-9"."""
    kind, first, last = re.fullmatch(r"(Table|Fig)s? (\d+)(?:-(\d+))?", label).groups()
    return [f"{kind} {n}" for n in range(int(first), int(last or first) + 1)]


@pytest.mark.parametrize("paper", NAMED)
def test_every_table_and_figure_is_made_again_once(paper):
    made = [one for i in ITEMS[paper] for one in shown_in(i.label)]
    assert len(made) == len(set(made))
    assert set(made) >= set(NAMED[paper])


@pytest.mark.parametrize("paper", NAMED)
def test_every_printed_table_says_where_it_stands(paper):
    for table in settings(paper).values():
        assert re.search(r"sec\.|Table|Fig", table["where"])


CHEAP = {("sr4c", "Fig 4"), ("sr4c", "Fig 5"), ("sr4c", "Table 5"), ("bagging", "Table 2")}


@pytest.mark.parametrize(("paper", "label"), sorted(CHEAP))
def test_an_item_is_the_same_when_made_again_and_can_be_shown(paper: str, label: str) -> None:
    (item,) = (item for item in ITEMS[paper] if item.label == label)
    first, second = (json.dumps(item.make(False), allow_nan=False) for _ in range(2))
    assert first == second
    shown = item.show(json.loads(first))
    assert shown.parts
    assert shown.remarks
    for part in shown.parts:
        if isinstance(part, Table):
            assert all(len(row) == len(part.header) for row in part.rows)
    plt.close("all")


@pytest.mark.parametrize(("paper", "label"), [("z1", "Fig 4"), ("cobot", "Table 3")])
def test_an_item_is_the_same_twice_and_shows_what_is_stored(paper, label):
    made = item(paper, label)
    data = made.make(False)
    assert json.dumps(data, allow_nan=False) == json.dumps(made.make(False), allow_nan=False)
    shown = made.show(json.loads(json.dumps(data)))
    assert shown.parts
    assert all(re.search(r"\d", remark) for remark in shown.remarks)
