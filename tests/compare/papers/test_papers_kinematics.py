"""Arms of the papers, by an oracle of their kinematics."""

from __future__ import annotations

import numpy as np
import pytest

from compare.audit.paper import load_papers
from compare.papers.inverse import make_inverse
from compare.papers.lu_2024.plan import drawn_waypoints
from compare.papers.zhang_2025.table_3 import make_angles
from compare.papers.zhou_2025.table_2 import approach
from formulations import load


def test_inverse_kinematics_finds_the_printed_angles_and_the_point_that_is_off() -> None:
    def outside(key: str) -> list[tuple[str, float]]:
        found = []
        for p in make_inverse(load_papers(key)[0])["points"]:
            apart = np.abs(np.subtract(p["found"], p["printed"]))
            if (apart > np.array(p["allowed"]) + 1e-9).any():
                found.append((p["where"], p["miss"]))
        return found

    assert outside("sr4c") == []
    assert outside("bagging") == [("Fig. 4, point A", pytest.approx(2.55e-3, abs=1e-5))]


def test_drawn_waypoints_are_those_of_the_case_for_its_seed_alone():
    case = load("z1").waypoints
    assert drawn_waypoints(2024) == pytest.approx(case, abs=1e-12)
    assert np.abs(drawn_waypoints(0) - case).max() > 0.1


def tool(rows, degrees):
    """Product of elementary motions; rows: theta offset [deg], d, a [mm], alpha [deg]."""
    pose = np.eye(4)
    for (offset, d, a, alpha), q in zip(rows, degrees, strict=True):
        for angle, (i, j), shift in ((q + offset, (0, 1), (0, 0, d)), (alpha, (1, 2), (a, 0, 0))):
            step, t = np.eye(4), np.radians(angle)
            step[[i, j], [i, j]] = np.cos(t)
            step[i, j], step[j, i] = -np.sin(t), np.sin(t)
            step[:3, 3] = shift
            pose = pose @ step
    return pose


UR5 = [(0, 89.2, 0, 90), (-90, 0, -425, 0), (0, 0, -392, 0),
       (-90, 109.3, 0, 90), (0, 94.75, 0, -90), (0, 82.5, 0, 0)]  # fmt: skip


COBOT = [(0, 121.5, 0, 90), (90, 0, 300, 0), (0, 0, 276, 0),
         (90, 110.5, 0, 90), (0, 90, 0, -90), (0, 82, 0, 0)]  # fmt: skip


def test_the_cobots_table_3_leads_to_its_table_2():
    data = make_angles(False)
    for point, there in zip(data["points"], data["tool"], strict=True):
        assert tool(COBOT, np.degrees(point["printed"]))[:3, 3] == pytest.approx(there, abs=1e-9)
    assert np.abs(np.subtract(data["tool"], data["table"])).max() < 0.04
    assert data["text_miss"] == pytest.approx(100.0, abs=0.01)


PUMA = [(0, 0, 0), (0, 0, -90), (149, 432, 0), (433, 0, -90), (0, 0, 90), (0, 0, -90)]  # d, a, alpha


def craig(degrees):
    """Tool of Table 1 in the modified form: a and alpha stand before the turn of their row."""
    rows = [(0, 0, PUMA[0][1], PUMA[0][2])]
    rows += [(0, d, *after) for (d, _, _), after in zip(PUMA, [p[1:] for p in PUMA[1:]], strict=False)]
    return tool([*rows, (0, PUMA[5][0], 0, 0)], [0, *degrees])[:3, 3]


def test_table_1_of_zhang_2025_misses_the_points_in_both_forms_with_any_offsets():
    data = make_angles(False)
    points, printed = np.array(data["table"]), np.degrees([p["printed"] for p in data["points"]])
    away = [np.linalg.norm(craig(q) - p) for q, p in zip(printed, points, strict=True)]
    assert data["forms"]["modified"] == pytest.approx(away, abs=1e-6)
    rows = [(0, d, a, alpha) for d, a, alpha in PUMA]
    away = [np.linalg.norm(tool(rows, q)[:3, 3] - p) for q, p in zip(printed, points, strict=True)]
    assert data["forms"]["standard"] == pytest.approx(away, abs=1e-6)
    rng = np.random.default_rng(14)
    for _ in range(300):
        turned = rng.choice([-1.0, 1.0], 6) * printed + rng.uniform(-180.0, 180.0, 6)
        for name, forward in (("standard", lambda q: tool(rows, q)[:3, 3]), ("modified", craig)):
            worst = max(np.linalg.norm(forward(q) - p) for q, p in zip(turned, points, strict=True))
            assert worst >= data["any_offset"][name] - 0.5  # grid of 0.1 deg


@pytest.mark.parametrize(
    ("point", "printed"),
    [
        ((-700, 200, 800), (-25.2188, 44.8152, -0.0197, 45.0923, 89.8880, -64.7841)),
        ((435, 785, 1025), (70.6249, -42.8564, -0.0439, -46.3651, -89.4308, 19.3823)),
    ],
)
def test_printed_angles_are_where_least_squares_stops_before_a_point_out_of_reach(point, printed):
    found = np.degrees(approach(np.array(point) / 1e3, 1.0))
    assert np.abs(found - printed).max() < 0.8

    def squares(degrees):
        pose = tool(UR5, degrees)
        turn = np.diag([-1.0, -1.0, 1.0]) @ pose[:3, :3].T
        angle = np.arccos(np.clip((np.trace(turn) - 1.0) / 2.0, -1.0, 1.0))
        return (np.linalg.norm(pose[:3, 3] - point) / 1e3) ** 2 + angle**2

    best = squares(found)
    assert np.sqrt(best) > 0.03  # out of reach
    for step in 0.5 * np.concatenate([np.eye(6), -np.eye(6)]):
        assert squares(found + step) > best
