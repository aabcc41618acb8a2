"""Every item's verdicts: as listed here, in the words of its remarks, and turned by other numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import matplotlib.pyplot as plt
import pytest
from stored_items import stored

from compare.papers import ITEMS
from compare.papers.item import Item, ItemVerdict, Shown
from compare.papers.li_2022.figures_4_6 import RULE as LI_RULE
from compare.papers.verdicts import Reproduction, counted, held, seen_in_pairs
from compare.papers.wang_2025.motions import PLAN, RULE
from compare.papers.words import result

CODES = {
    "R": Reproduction.REPRODUCED,
    "K": Reproduction.IN_KIND,
    "N": Reproduction.NOT,
    "U": Reproduction.UNDECIDED,
}
EXPECTED = {  # of the stored numbers, default size; empty: nothing is printed that could be judged
    "sr4c": {
        "Eqs 5-7": "RN", "Fig 4": "K", "Fig 5": "RNR", "Table 3": "UUUU", "Table 5": "R", "Figs 7-9": "R",
        "Table 8": "RRNNNNNNNKN", "Fig 10": "N", "Table 9": "RRNN", "Fig 11": "R", "Table 10": "NRNRNR",
        "Figs 12-14": "RRR", "Figs 17-19": "RRNR",
    },
    "bagging": {"Table 2": "N", "Fig 4": "N", "Fig 5": "NN", "Table 3": "RNNRNN", "Fig 6": "R"},
    "ur5": {"Table 2": "RN", "Tables 4-6": "NNNNN", "Fig 5": "N", "Fig 6": "NN", "Fig 7": "RN"},
    "z1": {"Eqs 4, 5": "", "Eqs 17, 22": "", "Fig 1": "N", "Fig 4": "", "Fig 5": "RR", "Figs 6-8": "KKKR"},
    "cobot": {"Table 3": "RNN", "Table 4": "NN", "Fig 6": "NKN", "Figs 7-9": "RNN"},
}  # fmt: skip


@pytest.fixture(autouse=True)
def no_figures() -> Iterator[None]:
    yield
    plt.close("all")


def item(paper: str, label: str) -> Item:
    return next(one for one in ITEMS[paper] if one.label == label)


def show(paper: str, label: str, change: Callable[[dict[str, Any]], object] = lambda _: None) -> Shown:
    data = stored(paper, item(paper, label).key)
    change(data)
    return item(paper, label).show(data)


def test_every_item_is_listed() -> None:
    assert {paper: [one.label for one in items] for paper, items in ITEMS.items()} == {
        paper: list(labels) for paper, labels in EXPECTED.items()
    }


# --- planted changes: item, verdict, what is changed, its outcomes, and the remark before and after ---


def spread(data: dict[str, Any]) -> None:
    data["rule"]["mpso"] = [{**data["rule"]["mpso-times-ten"][0], "seconds": s} for s in (0.1, 99.0)]


def gain_of_zhou(data: dict[str, Any]) -> None:
    for mine, other in zip(*(data["swarms"][name]["found"] for name in ("ISSA", "PSO")), strict=True):
        other["median"] = mine["median"] / (1.0 - 0.1567)


def set_ends(data: dict[str, Any]) -> None:
    for end, name in enumerate(("ISSA", "SSA", "PSO"), start=8):
        data["descents"][name]["quartiles"][1][-1] = float(end)


def li_ends(data: dict[str, Any]) -> None:
    for j in data["joints"]:
        j["descents"]["mpso"]["quartiles"][1][-1] = sum(j["printed"])


def wang_gain(data: dict[str, Any]) -> None:
    for facts in data["summary"].values():
        facts["swarms"]["pso"]["all"]["mean"] = facts["swarms"]["mipso"]["all"]["mean"] / 0.92


def by_rule(data: dict[str, Any]) -> None:
    (exact,) = data["rules"]["Table 6"]["motions"]["exact"]
    exact["seconds"] = data["printed"]["seconds"]


def late(data: dict[str, Any]) -> None:
    descent = data["found"]["whale-lu-2024"]["descent"]
    descent["iterations"] = [3.0 * k for k in descent["iterations"]]
    descent["quartiles"][1][-1] *= 0.5


def alone(data: dict[str, Any]) -> None:
    for found, times in zip(data["alone"], data["printed"], strict=False):
        found["median"] = sum(map(float, times))


def no_gain(data: dict[str, Any]) -> None:
    for joint in data["joints"]:
        joint["found"]["WOA"]["median"] = joint["found"]["improved"]["median"]


def put(*path: Any, to: Any) -> Callable[[dict[str, Any]], None]:
    """Change one place of the data."""

    def change(data: Any) -> None:
        for step in path[:-1]:
            data = data[step]
        data[path[-1]] = to

    return change


PLANTED: list[tuple[str, str, int, Callable[[dict[str, Any]], None], str, str, str]] = [
    ("sr4c", "Eqs 5-7", 1, lambda d: [r["ranks"].update({"as printed": 14}) for r in d["rows"]],
     "NR", "is singular", "is regular"),
    ("sr4c", "Fig 4", 0, put("pairs", to=0.3), "KN", "Reproduced in kind: of", "Not reproduced: of"),
    ("sr4c", "Fig 4", 0, put("pairs", to=0.51), "KU", "more often than", "Not decided by these runs: of"),
    ("sr4c", "Fig 5", 1, lambda d: d.update(w_printed=d["w_resolved"]), "NR",
     "printed does not do what the text says", "printed does what the text says"),
    ("sr4c", "Table 3", 0, put("summary", "overall", "mipso-pso1", "verdict", to="helps"), "UR",
     "(that it helps is not decided by these runs;", "(that it helps is reproduced;"),
    ("sr4c", "Table 5", 0, put("points", 1, "allowed", to=[0.0] * 6), "RN",
     "Reproduced within", "Not reproduced within"),
    ("sr4c", "Figs 7-9", 0, put("motions", PLAN, "jumps", 0, to=1.0), "RN",
     "as the paper says", "unlike what the paper says"),
    ("sr4c", "Table 8", 2, put("impossible", "MIPSO", to=0), "NR", "of MIPSO", "No printed run is proved"),
    ("sr4c", "Table 8", 3, wang_gain, "NR",
     "over PSO is not reproduced under 60", "over PSO is reproduced under 60"),
    ("sr4c", "Fig 10", 0, put("descents", "pso", "quartiles", 1, -1, to=9.0), "NR",
     "below PSO is not reproduced", "below PSO is reproduced"),
    ("sr4c", "Table 9", 3, by_rule, "NR",
     "Not reproduced under Table 6", "Reproduced under Table 6"),
    ("sr4c", "Fig 11", 0, put("misses", "resolved", 0, to=1.0), "RN",
     "Table 4 is reproduced", "Table 4 is not reproduced"),
    ("sr4c", "Table 10", 1, put("rows", 0, "limits", 1, "trials", "median", to=9.0), "RN",
     "it is reproduced under 60", "it is not reproduced under 60"),
    ("sr4c", "Figs 12-14", 0, put("rows", 0, "keeps", to="no"), "RN", "the limits: ", "the limits: no."),
    ("sr4c", "Figs 17-19", 1, put("motions", RULE, "digits", to="no"), "RN",
     "as the paper says", "limits of Table 6: no"),
    ("bagging", "Table 2", 0, lambda d: [p.update(allowed=[1.0] * 6) for p in d["points"]], "NR",
     "Not reproduced within", "Reproduced within"),
    ("bagging", "Fig 4", 0, put("apart", to=[[0.0] * 3] * 7), "NR",
     "printed points is not reproduced", "printed points is reproduced"),
    ("bagging", "Fig 5", 0, li_ends, "NR",
     "are not reproduced with factors as printed", "are reproduced with factors as printed"),
    ("bagging", "Table 3", 1, spread, "NR",
     "With factors as printed the starred total is not", "With factors as printed the starred total is rep"),
    ("bagging", "Fig 6", 0, put("motions", LI_RULE, "jumps", 0, to=1.0), "RN",
     "as the paper says", "unlike what the paper says"),
    ("ur5", "Table 2", 0, put("apart", to=30.0), "RN", "Reproduced: a least", "Not reproduced: a least"),
    ("ur5", "Tables 4-6", 4, gain_of_zhou, "NR", "over PSO is not reproduced", "over PSO is reproduced"),
    ("ur5", "Fig 5", 0, put("miss", to=[0.0] * 4), "NR", "P4 is not reproduced", "P4 is reproduced"),
    ("ur5", "Fig 6", 1, set_ends, "NR", "is not reproduced at the end", "is reproduced at the end"),
    ("ur5", "Fig 7", 1, put("printed", "keeps", to=True), "NR", "against what is claimed", "as claimed"),
    ("z1", "Fig 1", 0, put("found", "an orbit per coordinate, beta 0.5", "discrepancy", to=[0.0] * 3),
     "NR", "random one is not reproduced", "random one is reproduced"),
    ("z1", "Fig 5", 0, late, "RN", "as the paper says", "unlike what the paper says"),
    ("z1", "Figs 6-8", 0, lambda d: d["found"]["b-spline-5"].update(seconds=[99.0] * 11), "KN",
     "Reproduced in kind: by the medians", "Not reproduced: by the medians"),
    ("cobot", "Table 3", 1, put("forms", "modified", to=[0.1] * 4), "NR",
     "by another arm", "by the arm as printed"),
    ("cobot", "Table 4", 1, alone, "NR", "rows are not reproduced", "rows are reproduced"),
    ("cobot", "Fig 6", 1, no_gain, "KN", "the whales is reproduced in kind", "the whales is not reproduced"),
    ("cobot", "Figs 7-9", 1, put("total", to="4.1358"), "NR",
     "unlike what the paper says", "4.1358 s), as the paper says"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("paper", "label"), [(paper, label) for paper, labels in EXPECTED.items() for label in labels]
)
def test_verdicts_agree_with_the_remarks_and_turn_with_the_numbers(paper: str, label: str) -> None:
    before = show(paper, label)
    assert [v.outcome for v in before.verdicts] == [CODES[code] for code in EXPECTED[paper][label]]
    assert len({v.what for v in before.verdicts}) == len(before.verdicts)
    told = " ".join(before.remarks)
    planted = [line for line in PLANTED if line[:2] == (paper, label)]
    assert bool(planted) == bool(before.verdicts)
    for _, _, index, change, (first, then), said, says in planted:
        after = show(paper, label, change)
        assert before.verdicts[index].outcome is CODES[first]
        assert after.verdicts[index].outcome is CODES[then]
        assert after.verdicts[index].what == before.verdicts[index].what
        assert said in told
        assert says in " ".join(after.remarks)
        assert says not in told


# --- what is said of several verdicts ---------------------------------------------------------------


def test_outcomes_are_counted() -> None:
    yes, kind, no, open_ = CODES.values()
    assert counted([]) == "nothing to judge"
    assert counted([kind]) == "reproduced in kind"
    assert counted([no, yes, no]) == "1 of 3 reproduced, 2 of 3 not reproduced"
    assert [held(True), held(False)] == [yes, no]
    assert seen_in_pairs(0.9, 100, clear=True) is yes
    assert seen_in_pairs(0.52, 100, clear=True) is open_

    def found(*outcomes: Reproduction) -> list[ItemVerdict]:
        return [ItemVerdict("a result", outcome) for outcome in outcomes]

    assert result({"Table 1": []}) == "No printed result is judged yet"
    told = result({"Table 1": found(yes, no, no), "Fig 1": found(open_, kind)})
    assert told == "1 of 5 printed results are reproduced, 1 in kind, 2 not, 1 not decided"
    assert result({"Table 1": found(yes)}) == "1 of 1 printed results are reproduced"
