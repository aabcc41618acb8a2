"""Verdicts on the pages of each paper follow from the numbers beside them."""

from __future__ import annotations

import copy
from typing import Any

import matplotlib.pyplot as plt
import pytest

from compare.papers.li_2022 import table_3 as li_table_3
from compare.papers.measure import judged
from compare.papers.wang_2025 import joint_1
from compare.papers.wang_2025.figures import figures_4_5
from compare.papers.wang_2025.tables import table_8
from compare.papers.zhang_2025 import figures_6_9, table_3, table_4
from compare.papers.zhou_2025 import figures_5_7, table_2, tables_4_6
from formulations import load

# --- Wang 2025 ------------------------------------------------------------------------------------


def test_wang_table_8() -> None:
    rows = [
        joint_1.JointOneRun(limit, swarm, seed, base + 0.001 * seed, "ok")
        for limit in joint_1.LIMITS
        for swarm, base in {s: 3.6 if s.startswith("pso") else 3.3 for s in joint_1.SWARMS}.items()
        for seed in range(10)
    ]
    data = {
        "runs": 10,
        "impossible": {"PSO": 0, "IPSO": 0, "MIPSO": 3},
        "rows": [],
        "summary": joint_1.summarise(rows),
        "accelerations": {"table 9": 59.98},
        "scatter": {limit: table_8._same_scatter(rows, limit) for limit in joint_1.LIMITS},
    }

    def remarks() -> str:
        return " ".join(table_8._remarks_8(data, {"PSO": 3.5640, "IPSO": 3.4010, "MIPSO": 3.2789}))

    assert "60 deg/s² was in force" in remarks()
    assert "3 of MIPSO" in remarks()
    assert remarks().count("The gain of MIPSO over PSO is reproduced") == 2
    assert remarks().count("(Brown-Forsythe test, p = 1), which shows no difference") == 2
    data["accelerations"] = {"table 9": 59.98, "table 10": 80.0}
    data["impossible"] = {"PSO": 0, "IPSO": 0, "MIPSO": 0}
    for limit in joint_1.LIMITS:
        data["summary"][limit]["swarms"]["pso"]["all"] |= {"mean": 3.30, "deviation": 0.1}
        data["scatter"][limit] = 0.001
    assert "was in force" not in remarks()
    assert "No printed run is proved impossible" in remarks()
    assert remarks().count("The gain of MIPSO over PSO is not reproduced") == 2
    assert remarks().count("0.1000 s (Brown-Forsythe test, p = 0.001), as the paper says") == 2


def test_wang_figures_4_and_5() -> None:
    data = figures_4_5.make_tent(False)
    told = " ".join(figures_4_5.show_tent(data).remarks)
    assert "decides nothing" in told
    assert "56 %, more often" in told
    other = copy.deepcopy(data)
    other["pairs"] = 0.51
    other["scatter"]["tent map, one orbit"][2] = 0.5 * other["scatter"]["random"][0]
    told = " ".join(figures_4_5.show_tent(other).remarks)
    assert "51 %, not more often beyond chance" in told
    assert "is enough to tell them apart" in told
    factors = figures_4_5.make_factors(False)
    assert "does not do what the text says" in figures_4_5.show_factors(factors).remarks[1]
    factors["w_printed"] = factors["w_resolved"]
    assert "does what the text says" in figures_4_5.show_factors(factors).remarks[1]
    factors["c1"] = factors["c2"]
    assert "as the figure shows: no" in figures_4_5.show_factors(factors).remarks[0]
    plt.close("all")


# --- Li 2022 --------------------------------------------------------------------------------------


def test_li_table_3() -> None:
    def joint(number: int, speed: float, ratio: float) -> dict[str, Any]:
        return {"joint": number, "speed": speed, "printed": {"seconds": ratio}, "own": {"optimum": 1.0}}

    data = {
        "limit": 3.1416,
        "runs": 1,
        "joints": [joint(1, 3.14, 3.0), joint(2, 11.0, 5.0)],
        "starred": {"times": ["3.0", "4.0005"], "total": "7.0005", "speed": 3.0, "keeps": True},
        "least": {"optimum": 2.0, "bound": 1.9},
        "first_plan": 12,
        "rule": {swarm: [None] for swarm in li_table_3.READINGS},
    }
    told = li_table_3._remarks_3(data)
    assert "No one limit fits them all" in told[0]
    assert told[1].startswith("0 of 2 printed vectors are at the certified optimum")
    assert "as the paper says" in told[2]
    data["joints"] = [joint(1, 3.14, 1.0), joint(2, 3.1, 5.0)]
    data["starred"]["total"] = "6.0005"
    told = li_table_3._remarks_3(data)
    assert "No one limit" not in told[0]
    assert told[1].startswith("1 of 2")
    assert "unlike what the paper says" in told[2]


# --- Zhou 2025 ------------------------------------------------------------------------------------


def zhou() -> dict[str, Any]:
    times = [["1.0", "1.0", "1.0"]] * 7
    swarm = {
        "where": "Table 6",
        "printed": times,
        "total": "3.0",
        "impossible": [True] * 7,
        "stretch": [2.0] * 7,
        "found": [{"median": 9.0}] * 6,
        "arm": {"seconds": 20.0},
    }
    swarms = {name: copy.deepcopy(swarm) for name in ("PSO", "SSA", "ISSA")}
    return {"swarms": swarms, "least": [9.0] * 7, "other_unit": 4.0, "other_sign": 8.0}


def test_zhou_tables_4_to_6() -> None:
    data = zhou()
    assert "ISSA: not reproduced" in tables_4_6._remark(data, "ISSA")
    assert "is not reproduced" in tables_4_6._gain(data)
    assert "does not explain" in tables_4_6._other_readings(data)
    issa = data["swarms"]["ISSA"]
    issa |= {"impossible": [False] * 7, "stretch": [1.0] * 7, "found": [{"median": 3.0}] * 6}
    issa["arm"] = {"seconds": 3.0}
    data["swarms"]["PSO"]["found"] = [{"median": 3.0 / (1.0 - 0.1567)}] * 6
    data["other_unit"] = 2.9
    told = tables_4_6._remark(data, "ISSA")
    assert "ISSA: reproduced" in told
    assert "keeps the limits" in told
    assert "is reproduced" in tables_4_6._gain(data)
    assert "explains the times" in tables_4_6._other_readings(data)


def test_zhou_table_2() -> None:
    data = table_2.make_angles(False)
    told = table_2.show_angles(data).remarks
    assert told[0].startswith("4 of 4 points are out of reach")
    assert told[1].startswith("Reproduced:")
    assert "The sign is lost in print." in told[2]
    for row in data["rows"]:
        row |= {"out_of_reach": 0.0, "tilt_as_printed": 0.1}
    told = table_2.show_angles(data | {"apart": 30.0}).remarks
    assert told[0].startswith("0 of 4 points")
    assert told[1].startswith("Not reproduced:")
    assert "lost in print" not in told[2]


def test_zhou_figures() -> None:
    def curve(end: float) -> dict[str, Any]:
        return {"iterations": [0.0, 1.0], "quartiles": [[2.0 * end, end]] * 3}

    data = {"descents": {name: curve(3.0) for name in ("PSO", "SSA", "ISSA")}, "bound": 5.0}
    told = figures_5_7.show_descents(data).remarks
    assert told[0].startswith("Not reproduced.")
    assert "is not reproduced at the end" in told[1]
    ends = {"PSO": 3.3, "SSA": 3.1, "ISSA": 2.9}
    data = {"descents": {name: curve(end) for name, end in ends.items()}, "bound": 2.8}
    told = figures_5_7.show_descents(data).remarks
    assert told[0].startswith("Reproduced.")
    assert "is reproduced at the end" in told[1]

    problem = load("ur5-corrected")
    slow = judged(problem, [40.0, 60.0, 40.0])
    fast = judged(problem, [2.94, 3.918, 1.195])
    plans = {"total": "8.053", "printed": fast, "reproduced": slow, "before": fast}
    told = figures_5_7.show_curves(plans).remarks
    assert "breaks the limits that it was planned for, against what is claimed" in told[0]
    assert "overshoots" in told[1]
    told = figures_5_7.show_curves(plans | {"printed": slow, "reproduced": fast}).remarks
    assert "keeps the limits that it was planned for, as claimed" in told[0]
    assert "does not keep the limits" in told[3]
    assert "breaks the limits until" in told[2]
    assert "keeps the limits." in figures_5_7.show_curves(plans | {"before": slow}).remarks[2]
    assert "not reproduced" in figures_5_7.show_path(plans | {"miss": [0.04] * 4}).remarks[0]
    assert "is reproduced" in figures_5_7.show_path(plans | {"miss": [0.0001] * 4}).remarks[0]
    plt.close("all")


# --- Zhang 2025 -----------------------------------------------------------------------------------


def test_zhang_table_3() -> None:
    data = table_3.make_angles(False)
    told = table_3.show_angles(data).remarks
    assert told[0].startswith("Reproduced by another arm than the printed one")
    assert "365 to 757 mm in the standard form and by 354 to 843 mm in the modified form" in told[0]
    assert told[1].endswith("no reading of Table 1 is this arm.")
    assert "a misprint" in told[3]
    for point in data["points"]:
        point |= {"miss": 0.3}
    told = table_3.show_angles(data | {"text_miss": 0.1}).remarks
    assert told[0].startswith("Not reproduced")
    assert "a misprint" not in told[3]
    data = table_3.make_angles(False)
    data["forms"]["modified"] = [0.1] * 4
    told = table_3.show_angles(data | {"any_offset": {"standard": 182.0, "modified": 0.1}}).remarks
    assert told[0].startswith("Reproduced by the arm as printed")
    assert told[1].endswith("the modified form may be the arm's.")


def test_zhang_table_4() -> None:
    data = {
        "printed": [["1.0", "1.1", "1.9"]] * 7,
        "total": "3.0",
        "least": [3.5] * 7,
        "arm": {"seconds": 4.0},
        "rule": {"keeps": True, "stretch": 1.0, "seconds": 4.0},
        "alone": [{"median": 3.5}] * 6,
        "whole": {"median": 3.5},
        "limit": 100.0,
        "speeds": [[90.0]] * 7,
    }
    told = table_4._remarks(data)
    assert "It leaves the first segment out" in told[0]
    assert "are not reproduced" in told[1]
    assert "keeps 100 deg/s: yes" in told[2]
    told = table_4._remarks(
        data | {"total": "4.0", "alone": [{"median": 4.0}] * 6, "speeds": [[110.0]] * 7}
    )
    assert "leaves the first segment out" not in told[0]
    assert "are reproduced" in told[1]
    assert "keeps 100 deg/s: no" in told[2]


@pytest.mark.parametrize(
    ("factor", "verdict"), [(1.0, "not reproduced"), (1.0 / 0.05, "reproduced in kind")]
)
def test_zhang_figure_6(factor: float, verdict: str) -> None:
    def swarm(end: float) -> dict[str, Any]:
        descent = {"iterations": [0.0, 1.0], "quartiles": [[2.0 * end, end]] * 3}
        return {"median": end, "seconds": [end], "descent": descent}

    found = {key: swarm(2.0 * (factor if key in ("PSO", "WOA") else 1.0)) for key in figures_6_9.SWARMS}
    data = {
        "joints": [{"found": found, "bound": 2.0}] * 6,
        "limit": 100.0,
        "crossing": [90.0] * 6,
        "runs": 1,
    }
    told = figures_6_9._remarks_6(data)
    assert f"The gain over the standard PSO is {verdict}." in told[0]
    assert "the two contradict each other" in told[1]


def test_zhang_figures_7_to_9() -> None:
    problem = load("cobot")
    motions = {
        name: judged(problem, times)
        for name, times in {"before": [2.0, 3.0, 2.0], "printed": [0.987, 1.1746, 1.9742],
                            "reproduced": [1.0, 1.2, 1.2]}.items()
    }  # fmt: skip
    data = {
        "motions": motions,
        "speeds": {name: [90.0] for name in (*motions, "before, 2, 3 and 2 s")},
        "total": "3.139",
        "bound": 3.35,
        "limit": 100.0,
    }
    told = figures_6_9._remarks_7(data)
    assert "(printed: 3.139 s), unlike what the paper says" in told[0]
    assert "cannot be done" in told[1]
    told = figures_6_9._remarks_7(data | {"total": "4.1358", "bound": 3.0})
    assert "(printed: 4.1358 s), as the paper says" in told[0]
    assert "cannot be done" not in told[1]
