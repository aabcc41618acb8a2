"""The arm of a case, or a robot of a URDF, as a moving stick figure in one small SVG.

Two views show the same motion in true time, with the tool's path and the waypoints; shadows show the arm
at each waypoint. The animation is SMIL, which browsers run without a script. Other programs, and browsers
whose reader has asked for less motion, show the arm at its first waypoint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from compare.report.style import BLUE, GREEN, GREY, VERMILION
from formulations import FAMILIES, InputError, Problem, Trajectory
from formulations.arms import ARMS, Arm, load_arm
from formulations.problem.arrays import Array

if TYPE_CHECKING:
    from formulations.robot import Robot

_RATE = 25.0  # frames a second, of true time
_FEWEST, _MOST = 24, 180  # frames
_PANEL, _MARGIN, _TITLE, _FOOT = 360.0, 26.0, 50.0, 44.0  # px
_PAUSE = 1.0  # s that the last frame stays
# SMIL cannot ask whether the reader prefers less motion: a style hides the moving arm then
_CALM = (
    "<style>.still{display:none}@media (prefers-reduced-motion: reduce){.moving{display:none}"
    ".still{display:inline}}</style>"
)


@dataclass(frozen=True)
class View:
    """An orthographic view, given by the unit vectors that point to the right and up on paper."""

    name: str
    right: Array
    up: Array

    def __call__(self, points: Array) -> Array:
        """Project points (..., 3) [m] to the paper, (..., 2) [m]; the second coordinate points down."""
        return np.stack([points @ self.right, -(points @ self.up)], axis=-1)


def _slanted(azimuth: float, elevation: float) -> View:
    """The view of somebody who looks at the origin from this direction; angles in degrees."""
    a, e = np.deg2rad([azimuth, elevation])
    toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return View("from the side", right, np.cross(toward, right))


VIEWS = (_slanted(-55.0, 18.0), View("from above", np.array([1.0, 0, 0]), np.array([0, 1.0, 0])))


def arm_of(case: str) -> Arm | None:
    """Return the arm of a case or of one of its variants.

    Parameters
    ----------
    case : str

    Returns
    -------
    Arm or None
        None if no arm is known.
    """
    name = case.removesuffix("-corrected")
    return load_arm(name) if name in ARMS else None


def skeleton(arm: Arm | Robot, joints: Array) -> Array:
    """Return the arm as a chain of points: each Denavit-Hartenberg link goes along d first, then along a.

    Parameters
    ----------
    arm : Arm or Robot
    joints : Array, shape (..., dof) [rad or m]

    Returns
    -------
    Array, shape (..., n_points, 3) [m]
        2 dof + 1 points of an arm; base, joints and tip of a robot.
    """
    if not isinstance(arm, Arm):
        return arm.chain.points(joints)
    frames = arm.chain.frames(joints)
    origin, axis = frames[..., :3, 3], frames[..., :3, 2]
    elbow = origin[..., :-1, :] + arm.chain.d[:, None] * axis[..., :-1, :]
    points = np.stack([elbow, origin[..., 1:, :]], axis=-2)
    return np.concatenate([origin[..., :1, :], points.reshape(*points.shape[:-3], -1, 3)], axis=-2)


def fastest_spline(case: str, problem: Problem, durations: Array) -> str | None:
    """Draw the optimum of a case's spline family as an animated SVG.

    Parameters
    ----------
    case : str
    problem : Problem
        The problem of the case.
    durations : Array, shape (n_segments,) [s]
        Durations of the optimum.

    Returns
    -------
    str or None
        The text of the SVG; None if no arm is known for the case.
    """
    arm = arm_of(case)
    if arm is None:
        return None
    trajectory = FAMILIES[problem.family].trajectory(problem, durations)
    title = f"{arm.title}: fastest {problem.family} spline, {trajectory.seconds:.4f} s"
    return draw_motion_picture(arm, trajectory, title)


def draw_motion_picture(arm: Arm | Robot, trajectory: Trajectory, title: str) -> str:
    """Draw a motion of an arm as an animated SVG.

    Parameters
    ----------
    arm : Arm or Robot
    trajectory : Trajectory
        The motion of all its joints [rad or m].
    title : str
        The line above the picture.

    Returns
    -------
    str
        The text of the SVG.

    Raises
    ------
    InputError
        If the motion has another number of joints than the arm.
    """
    if trajectory.dof != arm.dof:
        raise InputError(f"motion picture: {trajectory.dof} joints for {arm.dof} of {arm.name}")
    count = int(np.clip(np.ceil(_RATE * trajectory.seconds), _FEWEST, _MOST)) + 1
    times = np.linspace(0.0, trajectory.seconds, count)
    joints = trajectory.at(times)
    bones = skeleton(arm, joints)
    stops = skeleton(arm, trajectory.at(trajectory.passage_times))
    pose = arm.chain.forward(joints)
    size = float(np.abs(bones).max())
    tips = pose[:, None, :3, 3] + 0.08 * size * np.swapaxes(pose[:, :3, :3], 1, 2)
    tool = np.stack([np.broadcast_to(pose[:, None, :3, 3], tips.shape), tips], axis=2)
    path = arm.chain.forward(trajectory.at(np.linspace(0.0, trajectory.seconds, 240)))[:, :3, 3]
    flat = bones * [1.0, 1.0, 0.0]

    scale, corners = _fit([bones, tool, flat])
    total = trajectory.seconds + _PAUSE
    run = f'dur="{total:.3f}s" repeatCount="indefinite" calcMode="linear"'
    keys = ";".join(f"{t / total:.4f}" for t in [*times, total])
    parts = []
    for index, view in enumerate(VIEWS):
        shift = np.array([_MARGIN + index * (_PANEL + _MARGIN), _TITLE]) - corners[index] * scale

        def place(points: Array, view: View = view, shift: Array = shift) -> Array:
            return view(points) * scale + shift

        def moving(points: Array, style: str) -> str:
            frames = [_points(p) for p in place(points)]
            values = ";".join([*frames, frames[-1]])
            return (
                f'<polyline class="moving" points="{frames[0]}" {style}><animate attributeName="points" '
                f'values="{values}" keyTimes="{keys}" {run}/></polyline>'
                f'<polyline class="still" points="{frames[0]}" {style}/>'
            )

        parts.append(
            f'<text x="{shift[0] + corners[index][0] * scale:.1f}" y="{_TITLE - 8:.1f}" '
            f'fill="{GREY}">{view.name}</text>'
        )
        if index == 0:
            parts.append(moving(flat, f'stroke="{GREY}" stroke-width="4" opacity=".25"'))
        shadow = f'stroke="{GREY}" stroke-width="1.5" opacity=".45"'
        parts.extend(_still(place(stop), shadow) for stop in stops)
        parts.append(_still(place(path), f'stroke="{VERMILION}" stroke-width="1.5"'))
        for number, stop in enumerate(stops):
            x, y = place(stop[-1])
            parts.append(
                f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{VERMILION}"/>'
                f'<text x="{x + 6:.1f}" y="{y - 5:.1f}" fill="{VERMILION}">{number + 1}</text>'
            )
        parts.append(moving(bones, f'stroke="{BLUE}" stroke-width="5"'))
        for axis, colour in enumerate((VERMILION, GREEN, BLUE)):
            parts.append(moving(tool[:, axis], f'stroke="{colour}" stroke-width="2"'))
        x, y = place(np.zeros(3))
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" fill="{BLUE}"/>')
    width = 2 * _PANEL + 3 * _MARGIN
    parts.append(_clock(trajectory, width, total, scale))
    body = "\n".join(parts)
    height = _TITLE + _PANEL + _FOOT
    look = 'font-family="sans-serif" font-size="12" fill="none" stroke-linecap="round"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" height="{height:.0f}" {look} stroke-linejoin="round">\n'
        f"<title>{escape(title)}</title>\n{_CALM}\n"
        f'<rect width="100%" height="100%" fill="#fff"/>\n'
        f'<text x="{_MARGIN}" y="20" fill="#000" font-size="13">{escape(title)}</text>\n'
        f"{body}\n</svg>\n"
    )


def _fit(parts: Sequence[Array]) -> tuple[float, list[Array]]:
    """The scale [px/m] at which every view fits its panel, and the corner of each centred view [m]."""
    boxes = []
    for view in VIEWS:
        seen = np.concatenate([view(part).reshape(-1, 2) for part in parts])
        boxes.append((seen.min(axis=0), seen.max(axis=0)))
    scale = min(float((_PANEL / np.maximum(high - low, 1e-9)).min()) for low, high in boxes)
    return scale, [0.5 * (low + high) - 0.5 * _PANEL / scale for low, high in boxes]


def _clock(trajectory: Trajectory, width: float, total: float, scale: float) -> str:
    """A bar that fills as time passes, with the times of the waypoints, and the length of some 0.1 m."""
    y, left = _TITLE + _PANEL + 16.0, _MARGIN
    long = width - 2 * _MARGIN - 120.0
    end = trajectory.seconds
    parts = [
        f'<rect x="{left}" y="{y}" width="{long:.1f}" height="4" fill="#e3e6ea"/>',
        f'<rect class="moving" x="{left}" y="{y}" width="0" height="4" fill="{BLUE}">'
        f'<animate attributeName="width" values="0;{long:.1f};{long:.1f}" '
        f'keyTimes="0;{end / total:.4f};1" dur="{total:.3f}s" repeatCount="indefinite"/></rect>',
    ]
    room = left
    for time in trajectory.passage_times:
        x = left + long * float(time) / end
        parts.append(f'<path d="M{x:.1f} {y - 3}v10" stroke="{VERMILION}" stroke-width="1.5"/>')
        # the times of both ends are written, and the others where there is room
        last = time == trajectory.passage_times[-1]
        if last or room <= x <= left + long - 50.0:
            words = f'fill="{GREY}" text-anchor="middle"'
            parts.append(f'<text x="{x:.1f}" y="{y + 20}" {words}>{time:.2f} s</text>')
            room = x + 50.0
    metres = 0.5 if 0.5 * scale <= 100.0 else 0.2 if 0.2 * scale <= 100.0 else 0.1
    x = width - _MARGIN - metres * scale
    parts.append(
        f'<path d="M{x:.1f} {y + 2}h{metres * scale:.1f}" stroke="{GREY}" stroke-width="2"/>'
        f'<text x="{width - _MARGIN}" y="{y + 20}" fill="{GREY}" text-anchor="end">{metres:g} m</text>'
    )
    return "\n".join(parts)


def _points(points: Array) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)


def _still(points: Array, style: str) -> str:
    return f'<polyline points="{_points(points)}" {style}/>'
