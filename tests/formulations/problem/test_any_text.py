"""Whatever is written: a problem, or one line."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import CASES, FAMILIES, InputError, parse

# --- whatever is written: a problem, or one line --------------------------------------------------


def problem_or_one_line(text: str) -> None:
    line = "FILE: "
    try:
        problem = parse(text, where="FILE")
    except InputError as error:
        line = str(error)
    assert len(line.splitlines()) == 1, repr(line)
    assert line.startswith("FILE: ")
    if line != "FILE: ":
        return
    assert problem.waypoints.shape == (problem.n_segments + 1, problem.dof)
    assert problem.n_segments >= 1
    assert np.isfinite(problem.waypoints).all()
    limits = problem.limits
    for values in (limits.velocity, limits.acceleration, limits.jerk):
        assert values.shape == (problem.dof,)
        assert (values > 0.0).all()
    assert (limits.position[:, 0] < limits.position[:, 1]).all()
    assert problem.family in FAMILIES


SCALARS = st.one_of(
    st.integers(-(10**6), 10**6).map(str),
    st.sampled_from([30, 400, 4400]).map(lambda n: "9" * n),
    st.sampled_from([30, 400, 4400]).map(lambda n: "0x" + "e" * n),
    st.floats().map(repr),
    st.sampled_from(
        ["true", '""', '"rad"', '"deg"', '"3-5-3"', '"4-3-4"', "''", "07:32:00", "1979-05-27"]
    ),
    st.text(max_size=8).map(
        lambda s: '"' + "".join(f"\\U{ord(c):08x}" for c in s if not 0xD800 <= ord(c) < 0xE000) + '"'
    ),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=5).map(lambda xs: "[" + ", ".join(xs) + "]"),
        inner.map(lambda x: "{ velocity = " + x + " }"),
    ),
    max_leaves=12,
)
LIMIT_KEYS = ["unit", "velocity", "acceleration", "jerk", "position", "jrek"]
KEYS = st.one_of(
    st.sampled_from(["name", "title", "source", "unit", "family", "waypoints", "limits", "nmae"]),
    st.sampled_from(LIMIT_KEYS).map("limits.{}".format),
    st.just('"a\\nb"'),
)
NUMBERS = st.floats(-2.0, 2.0, width=32).map(repr)


@st.composite
def nearly_right(draw: st.DrawFn) -> str:
    """Random keys with random values over a skeleton that is right."""
    rows, columns = draw(st.integers(1, 5)), draw(st.integers(1, 3))
    table = {
        "waypoints": "["
        + ", ".join("[" + ", ".join(draw(NUMBERS) for _ in range(columns)) + "]" for _ in range(rows))
        + "]",
        "limits.velocity": draw(st.sampled_from(["1", "0.5", "[1, 1]"])),
    }
    table |= draw(st.dictionaries(KEYS, VALUES, max_size=3))
    return "\n".join(f"{key} = {value}" for key, value in table.items())


@given(text=nearly_right())
@settings(max_examples=400)
def test_random_tables_give_a_problem_or_one_line(text: str) -> None:
    problem_or_one_line(text)


SHIPPED = [(files("formulations.problem.cases") / f"{case}.toml").read_text("utf-8") for case in CASES]
TOKENS = st.one_of(
    st.sampled_from(list("[]{}=,.\"'#\n\t -+_0123456789einfa\\\0\u2028")),
    st.sampled_from(["nan", "inf", "-1", "1e400", "[limits]", "true", "0x" + "f" * 4400, "9" * 4400]),
)


@given(data=st.data())
@settings(max_examples=400)
def test_mutated_shipped_cases_give_a_problem_or_one_line(data: st.DataObject) -> None:
    text = data.draw(st.sampled_from(SHIPPED))
    for _ in range(data.draw(st.integers(1, 4))):
        # numbers and keys are hit as often as the long prose
        spots = [match.start() for match in re.finditer(r"[-\w.\[\]]+", text)]
        at = data.draw(st.sampled_from(spots or [0]))
        length = data.draw(st.sampled_from([0, 1, 1, 2, 7, 40]))
        text = text[:at] + data.draw(TOKENS) + text[at + length :]
    problem_or_one_line(text)


@given(text=st.text(max_size=200))
def test_random_text_gives_a_problem_or_one_line(text: str) -> None:
    problem_or_one_line(text)


ROBOT = [str(Path(__file__).parents[2] / "data" / "fuzz" / name) for name in ("arm.urdf", "arm.srdf")]
ROBOT += ["moveit.limits.yaml", "plain.txt", "table.csv", ".", "", "\\u0000", "nowhere.toml"]
PATHS = st.sampled_from(ROBOT).map('"{}"'.format)
JOINTS = st.lists(st.sampled_from(["a", "b", "a b", "", "joint1", "joint2"]), max_size=3).map(
    lambda names: "[" + ", ".join(f'"{name}"' for name in names) + "]"
)
BY_JOINT = st.dictionaries(
    st.sampled_from(["a", "b", "joint1", "c"]), st.one_of(SCALARS, st.just("[-3, 3]")), max_size=3
).map(lambda table: "{" + ", ".join(f"{key} = {value}" for key, value in table.items()) + "}")
ROBOT_TABLE = {
    **dict.fromkeys(["robot", "srdf", "limits_file", "waypoints_file"], st.one_of(PATHS, VALUES)),
    **dict.fromkeys(["joints", "prismatic", "unlimited"], st.one_of(JOINTS, VALUES)),
    **dict.fromkeys(["group", "base", "tip", "length", "velocity_scaling", "jerk_scaling"], VALUES),
    **dict.fromkeys([f"limits.{key}" for key in LIMIT_KEYS[1:5]], st.one_of(BY_JOINT, VALUES)),
}


@given(data=st.data())
@settings(max_examples=600, deadline=None)
def test_random_keys_of_a_robot_give_a_problem_or_one_line(data: st.DataObject) -> None:
    keys = data.draw(st.lists(st.sampled_from(sorted(ROBOT_TABLE)), unique=True, max_size=5))
    table = {"waypoints": "[[0, 0], [1, 1]]", "limits.velocity": "1", "joints": '["a", "b"]'}
    table |= {key: data.draw(ROBOT_TABLE[key], label=key) for key in keys}
    for key in data.draw(st.lists(st.sampled_from(sorted(table)), max_size=2)):
        table.pop(key, None)
    problem_or_one_line("\n".join(f"{key} = {value}" for key, value in table.items()))
