"""Papers 002 to 004 made again: oracles of what their items rest on."""

import json
import re

import numpy as np
import pytest
from compare.papers.descent import descent

from compare.audit.paper import settings
from compare.benchmark.grade import Trace
from compare.benchmark.suite import Budget
from compare.papers import ITEMS
from compare.papers.lu_2024.figure_1 import one_orbit, orbit
from compare.papers.lu_2024.plan import drawn_waypoints
from compare.papers.measure import judged, least, listed, percent, summary, trials
from compare.papers.zhang_2025.table_3 import make_angles
from compare.papers.zhou_2025.table_2 import approach
from formulations import load

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
    assert sorted(made) == sorted(NAMED[paper])


@pytest.mark.parametrize("paper", NAMED)
def test_every_printed_table_says_where_it_stands(paper):
    for table in settings(paper).values():
        assert re.search(r"sec\.|Table|Fig", table["where"])


@pytest.mark.parametrize(("paper", "label"), [("z1", "Fig 4"), ("cobot", "Table 3")])
def test_an_item_is_the_same_twice_and_shows_what_is_stored(paper, label):
    made = item(paper, label)
    data = made.make(False)
    assert json.dumps(data, allow_nan=False) == json.dumps(made.make(False), allow_nan=False)
    shown = made.show(json.loads(json.dumps(data)))
    assert shown.parts
    assert all(re.search(r"\d", remark) for remark in shown.remarks)


# --- 003 ---


def test_the_chaotic_map_follows_its_closed_form_and_dies_at_one_half():
    start = np.random.default_rng(3).random(50)
    found = orbit(start, 60, 0.5)
    for n in range(1, 21):  # x_n = arccos(cos(2^n pi x_0)) / pi; the cosine loses half the digits
        expected = np.arccos(np.cos(2.0**n * np.pi * start)) / np.pi
        assert found[n - 1] == pytest.approx(expected, abs=2.0**n * 1e-15 + 1e-7)
    assert not found[54:].any()
    assert orbit(start, 500, 0.499).all()


def test_one_orbit_through_all_numbers_lies_on_the_graph_of_the_map():
    x, y = one_orbit(np.random.default_rng(0), 20, 2, 0.5).T
    assert y == pytest.approx(1.0 - np.abs(1.0 - 2.0 * x), abs=1e-15)


def test_drawn_waypoints_are_those_of_the_case_for_its_seed_alone():
    case = load("z1").waypoints
    assert drawn_waypoints(2024) == pytest.approx(case, abs=1e-12)
    assert np.abs(drawn_waypoints(0) - case).max() > 0.1


# --- 002 and 004: kinematics by an oracle of its own ---


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


def test_printed_times_of_002_break_even_the_first_segments_closed_form():
    problem = load("ur5-corrected")
    printed = judged(problem, [2.94, 3.918, 1.195])
    # a cube from rest ends at 3 d / T
    speed = 3.0 * np.abs(problem.displacements[2]) / 1.195
    assert not printed["keeps"]
    assert printed["stretch"] >= (speed / problem.limits.velocity).max() > 1.0
    assert printed["seconds"] == pytest.approx(8.053)


def test_the_least_time_is_proved_and_reached():
    joint = load("cobot").joint(2)
    found = least(joint)
    assert found["bound"] <= found["optimum"] <= found["bound"] * (1.0 + 1e-6)
    again = judged(joint, found["durations"])
    assert again["keeps"]
    assert again["seconds"] == pytest.approx(found["optimum"], rel=1e-9)
    runs = trials(joint, "pso-004", Budget(20, 20), 4)
    seconds = summary(runs)
    assert seconds["median"] == sorted(g.row["seconds"] for g in runs)[1]
    assert sum(seconds["durations"]) == pytest.approx(seconds["median"])
    assert seconds["seconds"][0] >= found["bound"]


# --- words and curves ---


def test_descents_are_quartiles_of_the_best_so_far_and_none_before():
    # five runs, two evaluations an iteration; improvements at evaluation 3 and 5
    traces = [Trace(-1, [3, 5, 8], [10.0 + r, 5.0 + r, 5.0 + r]) for r in range(5)]
    found = descent(traces, 2, 3)
    assert found["iterations"] == [0, 1, 2, 3]
    assert found["quartiles"] == [
        [None, 11.0, 6.0, 6.0],
        [None, 12.0, 7.0, 7.0],
        [None, 13.0, 8.0, 8.0],
    ]


def test_words():
    assert listed([1]) == "1"
    assert listed([1, 2, 5]) == "1, 2 and 5"
    assert percent(0.1567, 2) == "15.67\u00a0%"
