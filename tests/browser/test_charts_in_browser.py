"""The charts of the report: what they draw is what the motions, the bounds and the rows say."""

from __future__ import annotations

import itertools
import re
from typing import Any

import numpy as np
import pytest
from report_in_browser import SEEDS, SWARM, Shown, SmallReport

from compare.report.motion_picture import arm_of, skeleton
from formulations import FAMILIES, Trajectory
from formulations.problem.arrays import Array

pytestmark = pytest.mark.long

UNITS = {"cobot": "deg", "planted": "rad"}  # as the problems' files say
POWERS = ("", "/s", "/s²", "/s³")
CODINGS = ("published", "shared", "stretched")


def spline(report: SmallReport, case: str) -> Trajectory:
    """The best spline, from its durations alone."""
    durations = np.array(report.ladders[case]["durations"]["family"])
    problem = report.problems[case]
    return FAMILIES[problem.family].trajectory(problem, durations)


def choose(shown: Shown, of: str, kind: str, **chosen: str) -> dict[str, Any]:
    """The chart after a choice in its controls."""
    figure = shown.figure(of, kind)
    for label, value in chosen.items():
        figure.locator("label", has_text=label).locator("select").select_option(value)
    return shown.drawn(of, kind)


def curve(chart: dict[str, Any], axis: str, kind: str) -> dict[str, Any]:
    """The one curve of a motion on an axis; thicker lines mark what is over a limit."""
    found = [
        trace
        for trace in chart["data"]
        if trace["mode"] == "lines" and trace["line"]["width"] == 2
        if (trace["yaxis"], trace["legendgroup"]) == (axis, kind)
    ]
    assert len(found) == 1
    return found[0]


@pytest.mark.parametrize(
    ("case", "joint"), [("cobot", 1), ("cobot", 4), ("planted", 0), ("planted", 1)]
)
def test_switching_joints_draws_that_joints_own_motion_limits_and_units(
    light: Shown, small_report: SmallReport, case: str, joint: int
) -> None:
    problem, motion, unit = small_report.problems[case], spline(small_report, case), UNITS[case]
    scale = np.degrees(1.0) if unit == "deg" else 1.0
    chart = choose(light, case, "motion", joint=str(joint))
    limits = [np.nan, *problem.limits.derivatives[:, joint]]
    for order, word in enumerate(("position", "velocity", "acceleration", "jerk")):
        axis = f"y{order + 1}" if order else "y"
        title = chart["layout"][axis.replace("y", "yaxis")]["title"]["text"]
        assert title == f"{word}<br>[{unit}{POWERS[order]}]"
        drawn = curve(chart, axis, "family")
        times = np.array(drawn["x"])
        assert times[0] == 0.0
        assert times[-1] == pytest.approx(motion.seconds, rel=1e-8)
        assert np.diff(times).max() <= motion.seconds / 499.0
        inside = np.ones(len(times), dtype=bool)
        for instant in motion.breaks:  # the jerk of a spline jumps there
            inside &= np.abs(times - instant) > 1e-7
        expected = scale * motion.at(times[inside], order)[:, joint]
        size = np.abs(expected).max()
        np.testing.assert_allclose(np.array(drawn["y"])[inside], expected, rtol=0.0, atol=1e-6 * size)
        lines = sorted(shape["y0"] for shape in chart["layout"]["shapes"] if shape["yref"] == axis)
        if order and np.isfinite(limits[order]):
            assert lines == pytest.approx([-scale * limits[order], scale * limits[order]], rel=1e-5)
    marks = [trace for trace in chart["data"] if trace["mode"] == "markers"]
    for trace in marks:
        assert trace["y"] == pytest.approx(list(scale * problem.waypoints[:, joint]), abs=1e-7)


def test_what_is_over_a_limit_is_drawn_thick_and_nothing_else(
    light: Shown, small_report: SmallReport
) -> None:
    """The published motion breaks limits of some joints; the two certified ones break none."""
    problem = small_report.problems["cobot"]
    thick: dict[str, float] = {}
    for joint in range(problem.dof):
        chart = choose(light, "cobot", "motion", joint=str(joint))
        for trace in chart["data"]:
            if trace["mode"] != "lines" or trace["line"]["width"] != 6:
                continue
            order = int(trace["yaxis"][1:] or 1) - 1
            assert trace["legendgroup"] == "published"
            limit = np.degrees(problem.limits.derivatives[order - 1, joint])
            over = np.array([y for y in trace["y"] if y is not None])
            assert (np.abs(over) > limit).all()
            thick[f"{joint} {order}"] = float(np.abs(over).max() / limit)
    published = [
        one
        for one in light.page.evaluate("() => data.cobot.motion.motions")
        if one["kind"] == "published"
    ]
    assert len(published) == 1
    assert bool(thick) == ("breaks" in published[0]["title"])


def test_the_arm_is_where_the_joints_put_it(light: Shown, small_report: SmallReport) -> None:
    """Plotly's own points at times of the slider, against forward kinematics."""
    motion, arm = spline(small_report, "cobot"), arm_of("cobot")
    assert arm is not None
    figure = light.figure("cobot", "arm")
    slider = figure.locator("input[type=range]")
    longest = float(slider.get_attribute("max") or "nan")
    for share in (0.0, 0.31, 0.77, 1.0):
        slider.evaluate("(s, time) => inPage.slideTo(s, time)", share * longest)
        time = float(slider.input_value())
        chart = light.drawn("cobot", "arm")
        moving = [trace for trace in chart["data"] if trace["mode"] == "lines+markers"]
        drawn = next(trace for trace in moving if trace["legendgroup"] == "family")
        points = np.array([drawn["x"], drawn["y"], drawn["z"]]).T
        expected = skeleton(arm, motion.at(min(time, motion.seconds)))
        # some points of the skeleton are always one; straight lines stand between 61 frames
        nearest = np.linalg.norm(expected[:, None] - points[None], axis=-1)
        bow = 2e-3 + sag(arm, motion)
        assert nearest.min(axis=1).max() < bow
        assert nearest.min(axis=0).max() < bow
        np.testing.assert_allclose(points[-1], expected[-1], atol=bow)
        assert figure.locator("output").inner_text().startswith(f"{time:.2f} s of")
    stops = next(trace for trace in chart["data"] if trace.get("name") == "waypoints")
    tool = skeleton(arm, small_report.problems["cobot"].waypoints)[:, -1]
    np.testing.assert_allclose(np.array([stops["x"], stops["y"], stops["z"]]).T, tool, atol=6e-4)


def sag(arm: Any, motion: Trajectory) -> float:
    """How far a straight line between 61 frames can lie from the path: h^2/8 times the acceleration [m]."""
    fine = np.linspace(0.0, motion.seconds, 6001)
    path: Array = skeleton(arm, motion.at(fine))
    bend = np.linalg.norm(np.diff(path, 2, axis=0), axis=-1).max() / (fine[1] - fine[0]) ** 2
    return float((motion.seconds / 60.0) ** 2 / 8.0 * bend)


def test_play_moves_the_arm_until_pause(light: Shown) -> None:
    figure = light.figure("cobot", "arm")
    slider, button = figure.locator("input[type=range]"), figure.locator(".controls button")
    slider.evaluate("(s) => inPage.slideTo(s, 0)")
    before = light.drawn("cobot", "arm")["data"][1]["x"]
    found = figure.evaluate("(f) => inPage.playAndPause(f)")
    assert found["words"] == ["Play", "Pause", "Play"]
    assert found["later"] == found["paused"] > 0.1
    step = 4.2 / 500.0  # to which the slider rounds
    assert float(found["clock"].split()[0]) == pytest.approx(found["paused"], abs=0.006 + step)
    assert light.drawn("cobot", "arm")["data"][1]["x"] != before
    # at its end it stops by itself, and begins anew
    slider.evaluate("(s) => inPage.slideTo(s, s.max - 0.05)")
    button.click()
    light.page.wait_for_function("(s) => s.value === s.max", arg=slider.element_handle())
    light.page.wait_for_function("(b) => b.textContent === 'Play'", arg=button.element_handle())


def test_the_arm_can_be_turned_and_stays_turned(light: Shown) -> None:
    light.draw_everything()  # a chart that is drawn later moves what stands below it
    canvas = light.figure("cobot", "arm").locator(".canvas")
    canvas.evaluate("(c) => c.scrollIntoView({block: 'center', behavior: 'instant'})")
    light.page.evaluate("() => new Promise(requestAnimationFrame)")
    eye = "(c) => JSON.stringify(c.layout.scene.camera.eye)"
    before = canvas.evaluate(eye)
    box = canvas.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    light.page.mouse.move(x, y)
    light.page.mouse.down()
    for step in range(1, 6):  # plotly turns the camera from frame to frame
        light.page.mouse.move(x + 24 * step, y + 6 * step)
        light.page.evaluate("() => new Promise(requestAnimationFrame)")
    light.page.mouse.up()
    light.page.wait_for_function(
        f"([c, before]) => ({eye})(c) !== before", arg=[canvas.element_handle(), before]
    )
    turned = canvas.evaluate(eye)
    light.page.locator("#theme").click()
    assert canvas.evaluate(eye) == turned
    light.page.locator("#theme").click()


def test_the_keyboard_plays_the_arm(light: Shown) -> None:
    figure = light.figure("cobot", "arm")
    slider = figure.locator("input[type=range]")
    slider.evaluate("(s) => inPage.slideTo(s, 0)")
    slider.focus()
    for _ in range(3):
        slider.press("ArrowRight")
    assert float(slider.input_value()) > 0.0
    assert not figure.locator("output").inner_text().startswith("0.00 s")


def test_progress_shows_the_coding_and_the_quantity_that_are_chosen(light: Shown) -> None:
    stored = light.page.evaluate("() => data.cobot.progress.curves")
    for coding, quantity in itertools.product(CODINGS, ("gap", "reached")):
        chart = choose(light, "cobot", "progress", coding=coding, show=quantity)
        mine = {one["swarm"]: one for one in stored if one["variant"] == coding}
        assert len(chart["data"]) == len(mine) == 3
        for trace in chart["data"]:
            name = trace["name"].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
            one = mine[name]
            if quantity == "reached":
                assert trace["y"] == pytest.approx([100.0 * share for share in one["reached"]])
                assert chart["layout"]["yaxis"]["range"] == [0, 102]
            else:
                assert trace["y"] == one["gap"][1]
                assert chart["layout"]["yaxis"]["type"] == "log"


@pytest.mark.parametrize("case", ["cobot", "planted"])
def test_every_stored_gap_is_a_mark_of_the_seeds(
    light: Shown, small_report: SmallReport, case: str
) -> None:
    chart = light.drawn(case, "seeds")
    best = small_report.ladders[case]["ladder"]["family"]["seconds"]
    for coding in CODINGS:
        trace = next(one for one in chart["data"] if one["name"] == coding)
        rows = [
            r
            for r in small_report.rows
            if (r.case, r.coding) == (case, coding) and r.seconds is not None
        ]
        assert sorted(trace["x"]) == pytest.approx(
            sorted(row.seconds / best - 1.0 for row in rows), rel=1e-6
        )
    unsolved = [note["text"] for note in chart["layout"].get("annotations", [])]
    assert unsolved == ([f"{len(SEEDS)} of {len(SEEDS)} without a motion"] if case == "cobot" else [])


@pytest.mark.parametrize("case", ["cobot", "planted"])
def test_the_ladder_shows_every_bound_at_its_time(
    light: Shown, small_report: SmallReport, case: str
) -> None:
    figure = light.figure(case, "ladder")
    box = figure.locator("input[type=checkbox]")
    few = sum(len(trace["x"]) for trace in light.drawn(case, "ladder")["data"])
    box.check()
    chart = light.drawn(case, "ladder")
    times = sorted(itertools.chain.from_iterable(trace["x"] for trace in chart["data"]))
    assert len(times) > few
    for key, rung in small_report.ladders[case]["ladder"].items():
        if rung["seconds"] is not None:
            assert min(abs(time - rung["seconds"]) for time in times) < 1e-6 * rung["seconds"], key
    zones = [shape for shape in chart["layout"]["shapes"] if shape["type"] == "rect"]
    ladder = small_report.ladders[case]["ladder"]
    assert max(zone["x1"] for zone in zones) == pytest.approx(ladder["family"]["seconds"], rel=1e-6)
    box.uncheck()
    assert sum(len(trace["x"]) for trace in light.drawn(case, "ladder")["data"]) == few


@pytest.mark.parametrize("case", ["cobot", "planted"])
def test_where_the_time_goes_ends_at_the_motion_of_the_swarm(
    light: Shown, small_report: SmallReport, case: str
) -> None:
    chart = light.drawn(case, "split")
    ladder = small_report.ladders[case]["ladder"]
    notes = {note["y"]: note for note in chart["layout"]["annotations"]}
    assert set(notes) == {f"pso, {coding}" for coding in CODINGS}
    for coding in CODINGS:
        times = [
            row.seconds
            for row in small_report.rows
            if (row.case, row.coding, row.swarm) == (case, coding, "pso")
        ]
        parts = [
            (x, y)
            for trace in chart["data"]
            for x, y in zip(trace["x"], trace["y"], strict=True)
            if x is not None
        ]
        end = max(x for x, y in parts if y == f"pso, {coding}")
        note = notes[f"pso, {coding}"]
        assert min(times) <= end <= max(times)
        assert note["x"] == end
        above = 100.0 * (end / ladder["free_form_lower"]["seconds"] - 1.0)
        said, share = re.findall(r"[\d.]+(?:e\+\d+)?", note["text"])
        assert float(said) == pytest.approx(end, abs=5e-4)
        assert float(share) == pytest.approx(above, rel=6e-3)
        assert chart["layout"]["xaxis"]["range"][1] > end


def test_a_hover_over_a_planted_swarm_shows_its_name_as_text(light: Shown) -> None:
    figure = light.figure("planted", "seeds")
    words = light.drawn("planted", "seeds")["data"][0]["hovertext"]
    point = next(k for k, one in enumerate(words) if "alert" in one)
    figure.evaluate("(f, k) => inPage.hover(f, 0, k)", point)
    shown = figure.locator(".hoverlayer .hovertext text")
    shown.wait_for(state="attached")  # plotly waits before it shows
    assert SWARM in (shown.text_content() or "")
    assert figure.locator(".hoverlayer script").count() == 0
