"""Wang 2025, Table 8: few runs, even one or none, give statistics that mean what they say."""

from __future__ import annotations

import json

import matplotlib.pyplot as plt
import numpy as np
import pytest

from compare.papers.wang_2025 import joint_1
from compare.papers.wang_2025.tables import table_8

MIPSO = np.array([3.2837, 3.2886, 3.2824, 3.2793, 3.2812, 3.2788, 3.2886, 3.2695, 3.2632, 3.2735])


def test_the_interval_of_ten_runs_is_students() -> None:
    low, high = joint_1.statistics(MIPSO)["interval"]
    # 97.5 % quantile of t with nine degrees of freedom, from a table: 2.262, not 1.96
    reach = 2.2621571628 * MIPSO.std(ddof=1) / np.sqrt(10)
    assert (low, high) == pytest.approx((MIPSO.mean() - reach, MIPSO.mean() + reach), rel=1e-9)


def test_the_interval_holds_the_mean_as_often_as_it_says() -> None:
    rng = np.random.default_rng(4)
    held = [
        low <= 1.0 <= high
        for low, high in (joint_1.statistics(rng.normal(1.0, 0.1, 10))["interval"] for _ in range(4000))
    ]
    # binomial: a standard deviation of 0.0034; 1.96 in place of t gives 0.918
    assert np.mean(held) == pytest.approx(0.95, abs=0.012)


@pytest.mark.parametrize(("solved", "unsolved"), [(0, 1), (1, 0), (1, 2), (2, 0)])
def test_few_runs_give_no_nan(solved: int, unsolved: int) -> None:
    rows = [
        joint_1.JointOneRun(limit, swarm, seed, 3.3 + 0.1 * seed if seed < solved else None, "ok")
        for limit in joint_1.LIMITS
        for swarm in joint_1.SWARMS
        for seed in range(solved + unsolved)
    ]
    summary = joint_1.summarise(rows)
    json.dumps(summary, allow_nan=False)
    entry = summary[joint_1.IN_FORCE]["swarms"]["mipso"]["all"]
    assert (entry["runs"], entry["unsolved"]) == (solved + unsolved, unsolved)
    assert (entry["interval"] is None) == (solved < 2)
    assert (entry["mean"] is None) == (solved == 0)
    text = table_8.as_text(summary)
    assert "nan" not in text.lower()
    figure = table_8.table8_figure(rows, summary)
    plt.close(figure)


def test_table_8_made_again_is_shown_with_few_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table_8, "RUNS", {False: 1, True: 2})
    data = json.loads(json.dumps(table_8.make_table_8(False), allow_nan=False))
    shown = table_8.show_table_8(data)
    assert not [r for r in shown.remarks if "nan" in r.lower()]
    plt.close("all")
