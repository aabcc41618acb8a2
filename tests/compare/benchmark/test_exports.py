"""What is exported is read by the programs that it is for: polars, iohinspector and cocopp."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare.__main__ import main
from compare.benchmark.grade import Trace
from compare.benchmark.plan import runs
from compare.benchmark.records.rows import COLUMNS, RunKey
from compare.benchmark.records.settings import Settings
from compare.benchmark.records.store import Store
from compare.benchmark.run import swarm
from formulations import load

pl = pytest.importorskip("polars")

CASES = ("sr4c", "cobot")
SWARMS = ("random", "pso")
SEEDS, BUDGET = 3, 120
OPTIMA = {"sr4c": 4.0, "cobot": 3.0}  # below what a swarm reaches
ALONE = {"sr4c": [2.0] * 6, "cobot": [1.5] * 5 + [None]}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A comparison, and all its exports in ``export``."""
    made = tmp_path_factory.mktemp("exported")
    store = Store(made)
    problems = {case: load(case) for case in CASES}
    for case in CASES:
        rung = {"seconds": OPTIMA[case], "kind": "upper", "status": "ok", "certified": False,
                "runtime": 0.1, "note": ""}  # fmt: skip
        rungs = {"family": rung, "family_lower": {**rung, "seconds": None}}
        ladder: Any = {
            "problem": case,
            "durations": {},
            "versions": {},
            "ladder": rungs,
            "alone": ALONE[case],
        }
        store.write_ladder(case, ladder)
    store.write_settings(Settings("default", CASES, tuple(range(SEEDS)), "120 evaluations"))
    planned = runs(problems, swarms=SWARMS, seeds=SEEDS, evaluations=BUDGET)
    with ThreadPoolExecutor(1) as pool:
        swarm(pool, planned, problems, store)
    store.close()
    assert main(["export", str(made), "--csv", "--parquet", "--ioh", "--coco"]) == 0
    return made


def curve_of(trace: Trace, case: str) -> dict[int, float]:
    """Evaluations -> best gap, where it fell: computed here, for comparison with what readers find."""
    optimum = OPTIMA[case] if trace.joint < 0 else ALONE[case][trace.joint]
    assert optimum is not None
    curve: dict[int, float] = {}
    best = np.inf
    for n, value in zip(trace.evaluations, trace.best, strict=True):
        if value < best:
            best, curve[n] = value, max(value / optimum - 1.0, 0.0)
    return curve


def curves(folder: Path, coding: str) -> dict[tuple[str, str, int], list[dict[int, float]]]:
    """By case, swarm and joint: the curves of all seeds in the track ``equal``, sorted."""
    found: dict[tuple[str, str, int], list[dict[int, float]]] = {}
    for key, traces in Store(folder).traces():
        for trace in traces:
            known = trace.joint < 0 or ALONE[key.case][trace.joint] is not None
            if key.coding == coding and key.track == "equal" and known:
                found.setdefault((key.case, key.swarm, trace.joint), []).append(
                    curve_of(trace, key.case)
                )
    return {
        name: sorted(group, key=lambda curve: sorted(curve.items())) for name, group in found.items()
    }


def test_polars_reads_the_rows(folder: Path) -> None:
    rows = Store(folder).rows()
    table = pl.read_parquet(folder / "export" / "rows.parquet")
    assert tuple(table.columns) == COLUMNS
    assert table.height == len(rows) == 2 * 2 * 4 * SEEDS
    for name in ("case", "seed", "status", "seconds", "gap", "keeps_limits", "versions", "track"):
        assert table[name].to_list() == [getattr(row, name) for row in rows]
    assert [tuple(t) for t in table["durations"].to_list()] == [row.durations for row in rows]
    text = pl.read_csv(folder / "export" / "rows.csv")
    assert text["seconds"].to_list() == [row.seconds for row in rows]
    assert text.columns == table.columns


def test_polars_reads_the_traces(folder: Path) -> None:
    table = pl.read_parquet(folder / "export" / "traces.parquet")
    expected = [
        (*key, trace.joint, n, best)
        for key, traces in Store(folder).traces()
        for trace in traces
        for n, best in zip(trace.evaluations, trace.best, strict=True)
    ]
    assert table.columns == [*RunKey._fields, "joint", "evaluations", "best"]
    assert table.rows() == expected


@pytest.mark.parametrize("coding", ["stretched", "published"])
@pytest.mark.filterwarnings("ignore")
def test_iohinspector_reads_the_runs(folder: Path, coding: str) -> None:
    inspector = pytest.importorskip("iohinspector")
    manager = inspector.DataManager()
    for name in SWARMS:
        manager.add_folder(str(folder / "export" / "ioh" / f"{name}-{coding}"))
    expected = curves(folder, coding)
    overview = manager.overview
    assert set(overview["algorithm_name"]) == {f"{name} {coding}" for name in SWARMS}
    assert overview.height == sum(len(group) for group in expected.values())
    assert set(overview["dimension"]) == {3}
    assert set(overview["budget"]) == {BUDGET}
    spent = {"stretched": {BUDGET}, "published": {BUDGET // 6}}[coding]
    assert set(overview["evals"]) <= spent
    data = manager.load(monotonic=True, include_meta_data=True)
    for (case, name, joint), group in expected.items():
        task = case if joint < 0 else f"{case} joint {joint + 1}"
        mine = data.filter(
            (pl.col("function_name") == task) & (pl.col("algorithm_name") == f"{name} {coding}")
        )
        runs_read = [
            {
                n: y
                for n, y in zip(run["evaluations"].to_list(), run["raw_y"].to_list(), strict=True)
                if np.isfinite(y)
            }
            for run in mine.partition_by("data_id")
        ]
        assert sorted(runs_read, key=lambda curve: sorted(curve.items())) == group


_COCO = """
import json, sys, warnings
warnings.simplefilter("ignore")
import cocopp
found = []
archive = cocopp.archiving.create(sys.argv[1])
for name in archive:
    for data in cocopp.load(archive.get(name)):
        found.append({
            "swarm": data.algId, "function": data.funcId, "dimension": data.dim,
            "evaluations": data.maxevals.tolist(), "final": sorted(data.finalfunvals.tolist()),
            "hit": [sorted(row) for row in data.detEvals([3.0, 1.0, 0.3, 0.1])],
        })
print("FOUND" + json.dumps({"list": list(map(str, archive)), "data": found}))
"""


@pytest.mark.slow
@pytest.mark.parametrize(("part", "coding"), [("whole", "stretched"), ("joints", "published")])
def test_cocopp_reads_the_archive(folder: Path, tmp_path: Path, part: str, coding: str) -> None:
    pytest.importorskip("cocopp")
    place = folder / "export" / "coco" / part
    done = subprocess.run(
        [sys.executable, "-c", _COCO, str(place)], capture_output=True, text=True, cwd=tmp_path,
        env={**os.environ, "HOME": str(tmp_path), "MPLBACKEND": "Agg"}, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    read = json.loads(done.stdout.partition("FOUND")[2].splitlines()[0])
    assert {f"{name}-{coding}.zip" for name in SWARMS} <= set(read["list"])
    names = dict(
        line.split(": ")[0].split(" ", 1) for line in (place / "tasks.txt").read_text().splitlines()
    )
    found = {
        (names[f"f{one['function']}"].split(" ", 1)[1], one["swarm"]): one
        for one in read["data"]
        if one["swarm"].endswith(f"-{coding}")
    }
    expected = curves(folder, coding)
    assert len(found) == len(expected)
    for (case, name, joint), group in expected.items():
        one = found[case if joint < 0 else f"{case} joint {joint + 1}", f"{name}-{coding}"]
        assert one["dimension"] == 3
        assert set(one["evaluations"]) == {BUDGET if joint < 0 else BUDGET // 6}
        final = sorted(min(curve.values(), default=1e9) for curve in group)
        assert one["final"] == pytest.approx(final, rel=1e-11)
        for target, hits in zip([3.0, 1.0, 0.3, 0.1], one["hit"], strict=True):
            # cocopp knows values at five targets a decade: a hit counts at the next of them
            first = [min((n for n, y in c.items() if y <= target), default=np.nan) for c in group]
            assert np.isfinite(hits).sum() <= np.isfinite(first).sum()
            exact = sorted(n for n in first if np.isfinite(n))
            assert all(
                hit >= n
                for hit, n in zip(sorted(h for h in hits if np.isfinite(h)), exact, strict=False)
            )


def test_an_export_names_what_it_needs(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(folder)]) == 2
    assert capsys.readouterr().err == "error: one of --parquet, --csv, --ioh, --coco must be given\n"
    assert main(["export", str(folder / "export"), "--csv"]) == 2
    assert "holds no comparison" in capsys.readouterr().err
