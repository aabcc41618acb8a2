"""Certificates under limits on the tool: claims that are proved, claims that are refused, and their words."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from tool_problems import two_links

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.certificate_file import compare_with
from compare.check_certificate.verify import verify
from formulations import Conditions, Problem, free_form, free_form_bound, load, save

FILE = """
arm = "ur5"
unit = "deg"
waypoints = [[0, -60, 60, 0, 30, 0], [35, -40, 35, 10, 5, 25], [65, -70, 75, -15, 10, 5]]
[limits]
velocity = 180
acceleration = 600
jerk = 6000
[conditions]
tool_speed = 0.3
[[conditions.waypoint]]
at = 1
tool_radius = 0.03
tolerance = 4
[[conditions.segment]]
from = 1
tool_speed = 0.15
"""


@cache
def proof() -> tuple[Problem, str]:
    """Two links with a ball of the tool, and the certificate of their bound as text."""
    problem = two_links(Conditions(tool_speed=0.3, segment_tool_speed={1: 0.2}, tool_zones={1: 0.02}))
    bound = free_form_bound(problem, upper=9.0, time_limit=5.0, record=True)
    assert bound.certificate is not None
    assert float.fromhex(bound.certificate["seconds"]) >= bound.seconds * (1.0 - 1e-9)
    return problem, json.dumps(bound.certificate)


def test_what_is_proved_is_certified_and_no_motion_is_faster() -> None:
    problem, text = proof()
    data = json.loads(text)
    said = verify(data, show=True)
    assert "a tool speed of at most 0.2 to 0.3 m/s, balls of the tool at 1 waypoint" in said
    assert "the tool on 2 turning joints and at (0.9, 0, 0) m when they are at 0" in said
    assert (
        "link 2: shifted by (0, 0, 0); turns about (0, 0, 1) by q2; then shifted by (0.4, 0, 0)" in said
    )
    seconds = float.fromhex(data["seconds"])
    assert seconds <= free_form(problem, tolerance=1e-1).seconds
    without = {key: value for key, value in data["demands"].items() if key != "tool"}
    for false in ({"demands": without}, {"seconds": (seconds * (1.0 + 1e-9)).hex()}):
        with pytest.raises(Refused):
            verify({**data, **false})


def scaled(where: str, by: float) -> Callable[[dict[str, Any]], None]:
    """Multiply the numbers of one key by a factor."""

    def change(tool: dict[str, Any]) -> None:
        tool[where] = [None if x is None else (by * float.fromhex(x)).hex() for x in tool[where]]

    return change


def longer(by: float) -> Callable[[dict[str, Any]], None]:
    """Lengthen the last link by a factor."""

    def change(tool: dict[str, Any]) -> None:
        entry = tool["chain"][-1]["after"][0]
        entry[3] = (by * float.fromhex(entry[3])).hex()

    return change


def less_turned(tool: dict[str, Any]) -> None:
    for link in tool["chain"]:
        link["factor"] = (0.9).hex()


def no_speed(tool: dict[str, Any]) -> None:
    tool["speed"] = [None, None]


@pytest.mark.parametrize(
    "fault",
    [
        scaled("speed", 1.001),
        scaled("radius", 1.01),
        longer(0.999),
        less_turned,
        no_speed,
    ],
    ids=["faster", "a larger ball", "shorter", "less turned", "without a speed"],
)
def test_a_proof_for_another_tool_is_refused(fault: Callable[[dict[str, Any]], None]) -> None:
    data = json.loads(proof()[1])
    fault(data["demands"]["tool"])
    with pytest.raises(Refused):
        verify(data)


def test_a_longer_link_is_certified_as_another_tool() -> None:
    """It has farther to go, so the bound holds for it too; the words say which tool it is about."""
    data = json.loads(proof()[1])
    longer(1.5)(data["demands"]["tool"])
    assert "at (1.1, 0, 0) m when they are at 0" in verify(data)


def test_wider_zones_leave_less_of_the_distance() -> None:
    data = json.loads(proof()[1])
    data["demands"]["tool"]["radius"] = [None, (5.0).hex(), None]  # now the box says how far
    with pytest.raises(Refused):
        verify(data)
    for pair in data["demands"]["waypoints"][1]:
        low, high = (float.fromhex(x) for x in pair)
        pair[:] = [(low + 0.09).hex(), (high - 0.09).hex()]
    verify(data)


def moved(link: dict[str, Any], key: str, value: Any) -> None:
    link[key] = value


SPOILT: dict[str, tuple[type[Exception], str, Callable[[dict[str, Any]], Any]]] = {
    "a place of no segment": (
        BadInput,
        "from 0 to 1",
        lambda t: t.update(passes=[[2, 0, [], []]]),
    ),
    "a key too many": (BadInput, "has the keys", lambda t: t.update(mass=1)),
    "no chain": (BadInput, "expected a list", lambda t: t.update(chain=[])),
    "a joint too many": (BadInput, "from 0 to 1", lambda t: moved(t["chain"][0], "joint", 2)),
    "a link without a key": (BadInput, "a step has the keys", lambda t: t["chain"][0].pop("axis")),
    "neither": (BadInput, "true or false", lambda t: moved(t["chain"][0], "prismatic", 1)),
    "a long axis": (
        Refused,
        "no unit vector",
        lambda t: moved(t["chain"][0], "axis", [(1.0).hex()] * 3),
    ),
    "a stretch": (
        Refused,
        "does not turn and shift only",
        lambda t: moved(t["chain"][0]["after"][0], 0, (1.1).hex()),  # type: ignore[arg-type]
    ),
    "infinite": (BadInput, "not finite", lambda t: moved(t["chain"][0], "offset", "inf")),
    "backwards": (Refused, "not positive", lambda t: moved(t, "speed", [(-1.0).hex(), None])),
    "nothing": (Refused, "none is given", lambda t: t.update(speed=[None] * 2, radius=[None] * 3)),
    "too short": (BadInput, "expected a list", lambda t: t.update(radius=[None])),
}


@pytest.mark.parametrize("name", SPOILT)
def test_a_spoilt_chain_is_refused(name: str) -> None:
    error, said, spoil = SPOILT[name]
    data = json.loads(proof()[1])
    spoil(data["demands"]["tool"])
    with pytest.raises(error, match=said):
        verify(data)


def test_the_certificate_is_about_the_tool_of_the_problem(tmp_path: Path) -> None:
    path = tmp_path / "slow.toml"
    path.write_text(FILE)
    problem = load(str(path))
    bound = free_form_bound(problem, upper=30.0, time_limit=3.0, record=True)
    data = json.loads(json.dumps(bound.certificate))
    assert "a tool speed of at most 0.15 to 0.3 m/s" in verify(data)
    compare_with(data, str(path))
    for text in (
        FILE.replace("tool_speed = 0.3", "tool_speed = 0.31"),
        FILE.replace("tool_speed = 0.15", "tool_speed = 0.3"),
        FILE.replace("tool_radius = 0.03", "tool_radius = 0.02"),
        FILE.replace('"ur5"', '"cobot"'),
    ):
        path.write_text(text)
        with pytest.raises(Refused, match=r"tool differs|differ from"):
            compare_with(data, str(path))
    path.write_text(FILE.split("[conditions]")[0])
    with pytest.raises(Refused):
        compare_with(data, str(path))
    # another place of the tool on the same arm
    assert problem.tool is not None
    longer_chain = problem.tool.extended([0.0, 0.0, 0.1])
    other = copy.deepcopy(data)
    end = [[float(x).hex() for x in row] for row in longer_chain.end[:3]]
    other["demands"]["tool"]["end"] = end
    path.write_text(FILE)
    with pytest.raises(Refused, match="the tool differs"):
        compare_with(other, str(path))
    save(problem, tmp_path / "again.toml")
    compare_with(data, str(tmp_path / "again.toml"))
