"""The papers in the report: audits in the store, the table of all of them, the moving arms."""

from __future__ import annotations

from pathlib import Path

import pytest

from compare.audit import FAULTS
from compare.audit.findings import IN_SHORT
from compare.benchmark.known_times import key_of_paper, table_of_known_times
from compare.benchmark.records.store import Store
from compare.benchmark.run import audits
from compare.engines import ThisProcess
from compare.report.frame import environment
from compare.report.page import papers_context
from compare.report.papers_at_a_glance import papers_at_a_glance
from formulations import CASES, InputError, load


def ladder_of(case: str, family: float, free_form: float) -> dict[str, object]:
    def rung(seconds: float, kind: str) -> dict[str, object]:
        return {"seconds": seconds, "kind": kind, "note": ""}

    return {
        "ladder": {
            "family": rung(family, "upper"),
            "family_lower": rung(family * (1.0 - 1e-7), "lower"),
            "free_form": rung(free_form, "upper"),
        }
    }


def audit_of(paper: str, by: str, feasible: str, *kinds: str) -> dict[str, object]:
    findings = [{"kind": kind, "fault": kind in FAULTS, "proved": True} for kind in kinds]
    motions = [{"where": "T", "joint": None, "by": by, "feasible": feasible}]
    return {"paper": paper, "title": f"{paper}!", "motions": motions, "findings": findings}


def test_every_case_comes_from_a_paper() -> None:
    assert {key_of_paper(case) for case in CASES} == {"sr4c", "bagging", "ur5", "cobot", "z1"}
    assert key_of_paper("ur5-corrected") == "ur5"
    assert key_of_paper("mine") is None
    assert list(IN_SHORT) == list(FAULTS)


def test_a_row_says_what_is_left_of_a_paper() -> None:
    known = {"ur5-corrected": (42.5705, 12.97), "cobot": (3.3496, 1.2), "z1": (15.5, 12.8)}
    ladders = {case: ladder_of(case, *times) for case, times in known.items()}
    times = {case: table_of_known_times(load(case), ladders[case], []) for case in known}
    stored = {
        "ur5": [audit_of("ur5-corrected", "ISSA", "no", "limits", "limits", "sum", "keeps")],
        "cobot": [audit_of("cobot", "improved PSO", "no limits")],
        "z1": [audit_of("z1", "B-spline with WOA", "no", "missing")],
    }
    rows = papers_at_a_glance({key: {"audits": data} for key, data in stored.items()}, times, ladders)
    assert [row.case for row in rows] == ["cobot", "ur5-corrected", "z1"]
    cobot, ur5, z1 = rows
    # of PSO, SSA and ISSA the shortest; Table 6's longest times are 12.37 times too short
    assert (ur5.key, ur5.published, ur5.by, ur5.keeps) == ("ur5", 8.053, "ISSA", "no")
    assert ur5.stretch == pytest.approx(12.3729, abs=1e-4)
    assert ur5.slowed == pytest.approx(8.053 * 12.3729, abs=1e-3)
    assert (ur5.optimum, ur5.proved, ur5.fastest) == (42.5705, True, 12.97)
    assert ur5.faults == ((IN_SHORT["limits"], 2, True), (IN_SHORT["sum"], 1, True))
    assert (cobot.keeps, cobot.stretch, cobot.faults) == ("prints none; keeps those assumed", None, ())
    # Lu 2024 prints no waypoints: nothing of the made ones may stand beside its total
    assert (z1.published, z1.keeps) == (11.71, "cannot be judged")
    assert z1.optimum is z1.fastest is z1.slowed is None


def test_what_leaves_the_position_limits_has_no_slowed_total() -> None:
    # as printed, joint 6 of ur5 turns beyond 360 deg with ISSA's times
    lines = table_of_known_times(load("ur5"), {"ladder": {}}, [])
    found = papers_at_a_glance(
        {"ur5": {"audits": [audit_of("ur5", "ISSA", "no")]}},
        {"ur5": lines},
        {"ur5": ladder_of("ur5", 43.8, 14.8)},
    )
    assert (found[0].leaves_position_limits, found[0].slowed) == (True, None)


def test_audits_are_stored_kept_and_made_again(tmp_path: Path) -> None:
    store = Store(tmp_path)
    pool = ThisProcess()
    audits(pool, ["z1"], store)
    data = store.audits()["z1"]
    assert [one["paper"] for one in data["audits"]] == ["z1"]
    assert {"digest", "versions", "machine"} <= set(data)

    made_of = {key: value for key, value in data.items() if key != "audits"}
    kept = [data["audits"][0] | {"title": "kept"}]
    store.write_audit("z1", made_of, kept)
    audits(pool, ["z1"], store)
    assert store.audits()["z1"]["audits"][0]["title"] == "kept"
    # of another text of the paper, it is made again
    store.write_audit("z1", made_of | {"digest": "another"}, kept)
    audits(pool, ["z1"], store)
    assert store.audits()["z1"]["audits"][0]["paper"] == "z1"
    # a paper that has a page of its own is linked to it
    assert papers_context(store, tmp_path, ["z1"])["pages"] == {}
    (tmp_path / "papers").mkdir()
    (tmp_path / "papers" / "z1.html").write_text("003")
    context = papers_context(store, tmp_path, ["z1"])
    page = environment(tmp_path).get_template("papers.html.j2").render(context)
    assert 'href="papers/z1.html"' in page
    assert ">Lu 2024</a>" in page
    assert "Unitree Z1" in page
    assert context["authors"] == {"z1": "Lu 2024"}
    store.write_audit("z1", made_of, [{"paper": "z1"}])
    with pytest.raises(InputError, match=r"results\.sqlite: audit z1: audits\[0\]\.title: missing"):
        store.audits()
    store.clear()
    assert store.audits() == {}
