"""Other readings of a paper's text beside the default: what is said of them follows from the numbers."""

from __future__ import annotations

from typing import Any

from compare.papers.li_2022 import table_3 as li_table_3
from compare.papers.zhang_2025 import layers
from compare.papers.zhou_2025 import groups


def test_zhang_section_2_3() -> None:
    def readings(longest: list[float | None]) -> dict[str, Any]:
        by_seed = {"longest": longest, "all": [3.6] * 8, "slowed": [3.6] * 8, "afresh": [3.6] * 8,
                   "afresh, all evaluations": [3.5] * 8}  # fmt: skip
        found = {
            key: {"by_seed": times, "median": times[0], "evaluations": 10}
            for key, times in by_seed.items()
        }
        return {"readings": found, "starts": [{"keeps": False, "stretch": 1.01}] * 8}

    told = layers.layers_remarks(readings([3.55] * 8), 3.5)
    assert "lower on 8 of 8 seeds, more often" in told[0]
    assert "each joint's own it ends lower on 4 of 8 seeds, not more often beyond chance" in told[0]
    assert "keep the limit on 0 of 8 seeds" in told[1]
    assert "is infeasible" in told[1]
    assert told[2].endswith("on 8 of 8 seeds: more often.")
    told = layers.layers_remarks(readings([3.55, *[3.7] * 6, None]), 3.5)
    assert "lower on 1 of 8 seeds, less often" in told[0]
    told = layers.layers_remarks(
        readings([3.45] * 8) | {"starts": [{"keeps": True, "stretch": 0.99}] * 8}, 3.4
    )
    assert "infeasible" not in told[1]
    assert told[2].endswith("on 0 of 8 seeds: less often.")


def test_li_sec_3_step_1() -> None:
    def joint(six: list[float | None], longer: list[float | None]) -> dict[str, Any]:
        times = {"mpso": [2.0, 2.0, 2.0, None], "six": six, "six, all iterations": longer}
        return {"trials": {reading: {"by_seed": found} for reading, found in times.items()}}

    told = li_table_3._populations({"joints": [joint([1.0] * 4, [3.0, 3.0, None, None])] * 3})
    assert "as many evaluations in 12 of 12 pairs of runs, more often (12 of 12 found" in told
    assert "as many iterations in 1.5 of 12 pairs of runs, less often (6 of 12 found" in told


def test_zhou_sec_4_2_step_1() -> None:
    def told(two: list[float | None], median: float, impossible: bool) -> str:
        def reading(times: list[float | None], found: float) -> dict[str, Any]:
            arm = {"seconds": found}
            return {"found": [{"by_seed": times, "median": found}] * 6, "arm": arm}

        read = {"one": reading([3.0, 3.0, None], 3.0), "two": reading(two, median)}
        assert len(groups.groups_table(read, [2.9] * 7, [3.0] * 7).rows) == 7
        return groups.groups_remark(read, [3.0] * 7, [impossible] * 7)

    lower, higher = told([2.0, 2.0, 2.0], 3.0, False), told([4.0, None, None], 5.0, True)
    assert "lower than with one flock in 18 of 18 pairs of runs, more often" in lower
    assert lower.endswith("of Table 6 are reproduced.")
    assert "in 3 of 18 pairs of runs, less often" in higher
    assert higher.endswith("of Table 6 are not reproduced.")
