"""The shipped papers, judged by hand from their digits."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest
from printed_papers import DEG

from compare.audit import Finding, Paper, audit, load_papers
from compare.audit.findings.claims import claims_of
from compare.audit.findings.other_limits import table_findings
from compare.audit.findings.together import ranking_findings, rule_findings
from compare.audit.findings.vectors import motion_faults
from compare.audit.motion.printed_motion import PrintedMotion


@cache
def shipped(name: str) -> tuple[Paper, tuple[PrintedMotion, ...]]:
    """A paper and its time vectors as motions."""
    paper = next(p for p in load_papers(name) if p.name == name)
    return paper, tuple(PrintedMotion.of(paper, row) for row in paper.rows)


def one(found: list[Finding], kind: str, where: str) -> Finding:
    """The one finding of a kind at a place."""
    (finding,) = [f for f in found if (f.kind, f.where) == (kind, where)]
    return finding


def test_sr4c_by_hand() -> None:
    # joint 1 leaves its start by the cube x0 + d1 (t/T1)^3: v = 3 d1/T1, a = 6 d1/T1^2 at its end.
    # Table 5: d1 = 0.5236 - 0.3927 = 0.1309, d3 = 1.5709 - 1.0472 = 0.5237 rad; Table 9: T1 = 0.8660,
    # T3 = 1.7331. 6 * 0.1309 / 0.8660^2 = 1.04727 rad/s^2 = 60.00 deg/s^2, not Table 6's 110
    start, end = 6.0 * 0.1309 / 0.8660**2 / DEG, 3.0 * 0.5237 / 1.7331 / DEG
    assert start == pytest.approx(60.0, abs=0.01)
    assert end == pytest.approx(51.94, abs=0.01)
    # and T1 would be sqrt(6 d1 / A) = 0.8660 if 60 was the limit
    assert np.sqrt(6.0 * 0.1309 / (60.0 * DEG)) == pytest.approx(0.8660, abs=5e-5)
    _, motions = shipped("sr4c")
    assert motions[0].peaks[0].printed[1] / DEG == pytest.approx(start, abs=1e-6)
    assert motions[0].peaks[0].printed[0] / DEG > end
    told = one(motion_faults(motions[0]), "other limits", "Table 9, joint 1").text
    assert "acceleration 60 deg/s^2 (in round numbers 60) where 110 is stated" in told
    # 54.73 deg/s is what the optimum under 60 deg/s^2 reaches: the velocity limit has no part in it
    assert "velocity" not in told
    assert motions[0].peaks[0].printed[0] / DEG == pytest.approx(54.73, abs=0.01)
    # joints 5 and 6: 6 * 0.1745 / 0.8944^2 and 6 * 0.6280 / 1.6971^2 rad/s^2 are 75 deg/s^2 too
    assert pytest.approx(75.0, abs=0.02) == 6.0 * 0.1745 / 0.8944**2 / DEG
    assert pytest.approx(75.0, abs=0.05) == 6.0 * 0.6280 / 1.6971**2 / DEG
    for joint, stated in ((5, 110), (6, 90)):
        told = one(motion_faults(motions[joint - 1]), "other limits", f"Table 9, joint {joint}").text
        assert f"(in round numbers 75) where {stated} is stated" in told
    # joints 2, 3 and 4 are at their stated 55, 60, 60: joint 4 by 6 * 0.5124 / 1.7134^2
    assert pytest.approx(60.0, abs=0.01) == 6.0 * 0.5124 / 1.7134**2 / DEG
    for joint in (2, 3, 4):
        assert motion_faults(motions[joint - 1]) == []


def test_sr4c_table_8_is_half_a_per_cent_too_fast() -> None:
    # under 60 deg/s^2: T1 = sqrt(6 d1/A) = 0.86603, and nothing is below 3.27863 s
    paper, motions = shipped("sr4c")
    (finding,) = table_findings(motions[:1], paper.totals)
    assert finding.where == "Table 8, MIPSO"
    assert finding.numbers["minimum"] == pytest.approx(3.278629, abs=2e-6)
    assert finding.numbers["gap"] == pytest.approx(3.2632 / 3.278629 - 1.0, abs=1e-6)
    assert "3 of 10 results" in finding.text
    assert "0.471 % below" in finding.text
    (rule,) = rule_findings(motions[6], motions[:6])
    assert rule.numbers["value"] / DEG == pytest.approx(97.39, abs=0.01)
    assert "(joints beyond theirs: 1, 5, 6)" in rule.text
    assert claims_of(paper) == []


def test_ur5_by_hand() -> None:
    # Table 6, joint 1: 113.5241 deg in 1.31 s is 86.7 deg/s on average, 100.0363 deg in 0.81 s 123.5;
    # the end cube has 3 d3/T3 = 370.5 deg/s where 25 is stated
    assert pytest.approx(86.66, abs=0.01) == (70.6249 + 42.8992) / 1.31
    assert pytest.approx(370.5, abs=0.1) == 3.0 * (70.6249 + 29.4114) / 0.81
    paper, motions = shipped("ur5")
    (motion,) = [m for m in motions if m.row.where == "Table 6, joint 1"]
    found = motion_faults(motion)
    assert {f.kind for f in found} == {"displacement", "minimum", "limits"}
    # the least mean speed of any reading: 100.0362 deg in 0.815 s
    mean = one(found, "displacement", "Table 6, joint 1")
    assert mean.numbers["mean"] / DEG == pytest.approx(100.0362 / 0.815, abs=1e-3)
    broken = one(found, "limits", "Table 6, joint 1")
    assert broken.numbers["value"] / DEG > 370.5
    assert broken.numbers["stretch"] == pytest.approx(broken.numbers["value"] / DEG / 25.0, rel=1e-9)
    assert broken.numbers["honest"] == pytest.approx(2.943 * broken.numbers["stretch"], rel=1e-9)
    # 0.885 + 1.198 + 0.812 = 2.895 s, and Fig. 6 has 3.1 s
    (wrong,) = claims_of(paper)
    assert "3.1 is printed, the sum is 2.895" in wrong.text
    (ranking,) = ranking_findings(motions)
    assert "PSO 55.24 s, SSA 72.54 s, ISSA 99.64 s" in ranking.text
    # joint 3 moves by hundredths of a degree and takes seconds: it keeps its limits
    keeping = [m.row.where for m in motions if not m.breaks]
    assert keeping == [f"Table {k}, joint 3" for k in (4, 5, 6)]


def test_cobot_by_hand() -> None:
    # 0.9870 + 1.1746 + 1.9644 = 4.1260 s a joint, 0.9870 + 1.1746 + 1.9742 = 4.1358 s together;
    # 3.139 = 1.1746 + 1.9644: the first segment is left out
    (paper,) = load_papers("cobot")
    found = audit(paper)
    total = one(found.faults, "sum", "abstract, sec. 3.2 and 4")
    assert "3.139 is printed, the sum is 4.1358" in total.text
    assert total.text.endswith("the sum of Table 4, joint 1 without segment 1")
    # (51.75 + 8.52 + 55.65 + 16.82 + 72.94 + 95.52) / 6 = 50.20
    assert "49.72 is printed, the mean is 50.20" in one(found.faults, "sum", "sec. 3.2").text
    # joint 6: 3 * 30 / 1.9644 = 45.8 deg/s at the start of the last segment
    peak = found.motions[5].peaks[0].printed[0] / DEG
    assert peak > 3.0 * 30.0 / 1.9644
    assert peak == pytest.approx(47.62, abs=0.01)
    assert {f.kind for f in found.faults} == {"sum", "point", "table"}
    json.dumps(found.to_json(), allow_nan=False)


def test_z1_can_only_be_in_degrees() -> None:
    (paper,) = load_papers("z1")
    found = [f for f in audit(paper).findings if f.kind == "other limits"]
    # the widest joint turns 320 deg: 2 sqrt(5.585 / 100) s at 100 rad/s^2, seven times
    assert 7 * 2 * np.sqrt(320 * DEG / 100.0) == pytest.approx(3.309, abs=0.001)
    assert all("3.31 s" in f.text and "read in deg" in f.text and not f.proved for f in found)
    assert len(found) == 2
