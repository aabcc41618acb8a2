"""The motion picture: bones keep their lengths, frames are in true time, the file is one small SVG."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from compare.report.motion_picture import VIEWS, arm_of, draw_motion_picture, skeleton
from formulations import FAMILIES, InputError, load
from formulations.arms import ARMS, load_arm, random_joints

SVG = "{http://www.w3.org/2000/svg}"


@pytest.mark.parametrize("name", ARMS)
def test_bones_are_rigid_and_end_at_the_tool(name: str) -> None:
    arm = load_arm(name)
    joints = random_joints(arm, 40)
    points = skeleton(arm, joints)
    lengths = np.linalg.norm(np.diff(points, axis=1), axis=2)
    wanted = np.stack([np.abs(arm.chain.d), np.abs(arm.chain.a)], axis=1).ravel()
    np.testing.assert_allclose(lengths, np.broadcast_to(wanted, lengths.shape), atol=1e-12)
    np.testing.assert_allclose(points[:, -1], arm.chain.forward(joints)[:, :3, 3], atol=1e-12)


def test_views_are_seen_at_right_angles() -> None:
    for view in VIEWS:
        assert np.linalg.norm(view.right) == pytest.approx(1.0)
        assert np.linalg.norm(view.up) == pytest.approx(1.0)
        assert view.right @ view.up == pytest.approx(0.0, abs=1e-12)


def test_the_picture_shows_the_motion_in_true_time() -> None:
    problem, arm = load("sr4c"), load_arm("sr4c")
    trajectory = FAMILIES["3-5-3"].trajectory(problem, [1.5, 2.0, 1.4])
    text = draw_motion_picture(arm, trajectory, "a & b")
    assert len(text) < 150_000
    root = ElementTree.fromstring(text)
    assert root.find(f"{SVG}title").text == "a & b"
    bones = [p for p in root.iter(f"{SVG}polyline") if p.get("stroke-width") == "5"]
    arms = [p for p in bones if p.get("class") == "moving"]
    assert len(arms) == len(VIEWS)
    # who has asked for less motion sees the first frame instead
    assert "@media (prefers-reduced-motion: reduce){.moving{display:none}" in text
    assert all(e.get("class") == "moving" for e in root.iter() if e.find(f"{SVG}animate") is not None)
    still = [p.get("points") for p in bones if p.get("class") == "still"]
    assert still == [p.get("points") for p in arms]
    for drawn, view in zip(arms, VIEWS, strict=True):
        animation = drawn.find(f"{SVG}animate")
        total = float(animation.get("dur").removesuffix("s"))
        at = np.array([float(k) for k in animation.get("keyTimes").split(";")]) * total
        shown = [frame.replace(",", " ").split() for frame in animation.get("values").split(";")]
        frames = np.array(shown, dtype=float).reshape(len(shown), -1, 2)
        assert len(frames) == len(at)
        assert at[-2] == pytest.approx(trajectory.seconds, abs=1e-3)
        # the tool's way on paper is the projected motion, to a scale and a shift
        tool = arm.chain.forward(trajectory.at(np.minimum(at, trajectory.seconds)))[:, :3, 3]
        flat = view(tool)
        scale = np.ptp(frames[:, -1, 0]) / np.ptp(flat[:, 0])
        np.testing.assert_allclose(frames[:, -1] - frames[0, -1], scale * (flat - flat[0]), atol=0.5)
    numbers = [float(v) for v in re.findall(r"[\d.]+(?=,)", text)]
    assert max(numbers) < float(root.get("width"))


def test_what_has_no_arm_is_refused(tmp_path: Path) -> None:
    assert arm_of("ur5-corrected") is load_arm("ur5")
    assert arm_of("mine") is None
    trajectory = FAMILIES["3-5-3"].trajectory(load("sr4c").joint(0), [1.5, 2.0, 1.4])
    with pytest.raises(InputError, match="1 joints for 6 of sr4c"):
        draw_motion_picture(load_arm("sr4c"), trajectory, "one joint")
    call = [sys.executable, "-m", "compare", "motion_picture", "mine"]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "mine: no such file, and no case of that name" in done.stderr
