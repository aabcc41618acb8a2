"""Any DH table in a paper file: points are judged through it, and hints name the reading that fits."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from importlib.resources import files
from typing import Any

import numpy as np
import pytest
from arm_sheets import DEG, DH, Sheet, sound
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.audit import Audit, parse_papers, published_text
from compare.audit.findings.points import points_of
from compare.audit.hints import hints_of
from formulations import InputError


def wrong_points(found: Audit) -> list[str]:
    return sorted({f.where for f in found.faults if f.kind in ("point", "reach")})


@given(
    seed=st.integers(0, 10**6), form=st.sampled_from(["standard", "modified"]), digits=st.integers(0, 3)
)
@settings(max_examples=40, deadline=None)
def test_true_points_of_any_table_are_never_accused(seed: int, form: str, digits: int) -> None:
    rng = np.random.default_rng(seed)
    dh: dict[str, Any] = {
        "d": rng.uniform(-400.0, 400.0, 3), "a": rng.uniform(-400.0, 400.0, 3),
        "alpha": rng.uniform(-180.0, 180.0, 3), "offset": rng.uniform(-180.0, 180.0, 3), "form": form,
    }  # fmt: skip
    sheet = sound(dh)
    sheet.dh = dh
    sheet.points = [p.round(digits) for p in sheet.points]
    text = sheet.text()
    for point in sheet.points:  # as they are printed: to so many digits
        long, short = ("[" + ", ".join(f'"{x:.{n}f}"' for x in point) + "]" for n in (3, digits))
        text = text.replace(long, short)
    (paper,) = parse_papers(text, "p")
    assert points_of(paper) == []


@given(seed=st.integers(0, 10**6), digits=st.integers(0, 2))
@settings(max_examples=40, deadline=None)
def test_the_rounding_of_the_table_itself_is_allowed_for(seed: int, digits: int) -> None:
    rng = np.random.default_rng(seed)
    dh = {key: np.array(row) + rng.uniform(-0.5, 0.5, 3) for key, row in DH.items()}
    sheet = sound(dh)
    exact = parse_papers(sheet.text(), "p")[0]
    assert points_of(exact)  # as exact numbers the printed ones lead elsewhere
    text = sheet.text()
    for key, row in dh.items():
        quoted = "[" + ", ".join(f'"{x:.{digits}f}"' for x in row) + "]"
        text = text.replace(f"{key} = {list(map(float, DH[key]))}", f"{key} = {quoted}")
    assert points_of(parse_papers(text, "p")[0]) == []


@pytest.mark.parametrize("unit", [("mm", "deg"), ("m", "deg"), ("mm", "rad"), ("m", "rad")])
def test_units_of_the_table_are_read(unit: tuple[str, str]) -> None:
    sheet = sound()
    for key in ("d", "a"):
        sheet.dh[key] = np.array(DH[key]) * (1e-3 if unit[0] == "m" else 1.0)
    sheet.dh["alpha"] = np.array(DH["alpha"]) * (DEG if unit[1] == "rad" else 1.0)
    sheet.dh_units = unit
    assert points_of(sheet.paper()) == []


def test_a_point_out_of_reach_says_how_far() -> None:
    sheet = sound()
    sheet.points[3] = np.array([2000.0, 0.0, 320.0])
    (found,) = points_of(sheet.paper())
    assert found.kind == "reach"
    # a straight arm along x: 40 + hypot(300 + 250, 45) mm from the axis, 320 mm high
    assert found.numbers["distance"] == pytest.approx(2.0 - 0.04 - np.hypot(0.55, 0.045), abs=1e-3)


def form(s: Sheet) -> None:
    s.dh["form"] = "modified"


def lengths_in_m(s: Sheet) -> None:
    s.dh_units = ("m", "deg")


def angles_in_rad(s: Sheet) -> None:
    s.dh_units = ("mm", "rad")


def columns(s: Sheet) -> None:
    s.dh["a"], s.dh["d"] = s.dh["d"], s.dh["a"]


def base(s: Sheet) -> None:
    s.dh["d"][0] = 230.0


def twist(s: Sheet) -> None:
    s.dh["alpha"][0] = -90.0


def nothing(s: Sheet) -> None:
    """The points are made of another table."""


@pytest.mark.parametrize(
    ("plant", "true", "tried"),
    [
        (form, {}, "the standard form (stated: modified)"),
        (nothing, {"form": "modified"}, "the modified form (stated: standard)"),
        (lengths_in_m, {}, "lengths in mm (stated: m)"),
        (angles_in_rad, {}, "angles in deg (stated: rad)"),
        (columns, {}, "columns a and d swapped"),
        (base, {}, "d of joint 1 320 mm, the height of the base (printed: 230)"),
        (twist, {}, "the other sign of alpha of joint 1"),
        (nothing, {"offset": [0.0, 90.0, 0.0]}, "joint offsets theta2 + 90 deg"),
        (nothing, {"offset": [180.0, 0.0, -90.0]}, "joint offsets theta1 + 180 deg, theta3 - 90 deg"),
        (nothing, {"form": "modified", "offset": [0.0, -90.0, 0.0]},
         "the modified form (stated: standard) and joint offsets theta2 - 90 deg"),
        (nothing, {"a": [40.0, 300.0, 230.5]}, "a of joint 3 230.5 mm (printed: 250)"),
    ],
)  # fmt: skip
def test_the_reading_that_fits_is_named(
    plant: Callable[[Sheet], None], true: dict[str, Any], tried: str
) -> None:
    sheet = sound(DH | true)
    plant(sheet)
    found = sheet.audited()
    assert wrong_points(found) == ["P1", "P2", "P3", "P4"]
    (hint,) = [hint for hint in found.hints if hint.kind == "dh"]
    assert hint.tried == f"Table 2 read with {tried}"
    assert hint.removes == hint.of
    assert "the largest miss of a point falls from" in hint.text


def test_one_misprinted_point_does_not_hide_the_form() -> None:
    sheet = sound()
    sheet.dh["form"] = "modified"
    sheet.points[2][0] += 100.0
    (hint,) = [hint for hint in sheet.audited().hints if hint.kind == "dh"]
    assert hint.tried == "Table 2 read with the standard form (stated: modified)"
    assert hint.explains == ("P1", "P2", "P4")


def test_a_reading_that_comes_much_nearer_is_named_though_no_fault_goes() -> None:
    sheet = sound()
    sheet.dh["form"], sheet.dh["d"] = "modified", [320.0, 0.0, 50.0]
    (hint,) = [hint for hint in sheet.audited().hints if hint.kind == "dh"]
    assert hint.tried == "Table 2 read with the standard form (stated: modified)"
    assert hint.removes == 0
    assert "none of 4 faults goes" in hint.text
    assert hint.text.endswith(" mm to 5.001 mm")


def own_table(name: str, form: str) -> str:
    """A shipped paper with its printed DH table in place of the arm that was fitted to its points."""
    printed = tomllib.loads((files("formulations.arms") / f"{name}.toml").read_text("utf-8"))["printed"]
    head = f'[dh]\nwhere = "Table 1"\nform = "{form}"\nlength = "{printed["length"]}"\nangle = "deg"\n'
    rows = "".join(f"{key} = {printed[key]}\n" for key in ("d", "a", "alpha"))
    text = published_text(name).replace(f'arm = "{name}"\n', "")
    return text.replace("[waypoints]", f"{head}{rows}[waypoints]", 1)


@pytest.mark.parametrize("form", ["standard", "modified"])
@pytest.mark.parametrize(
    ("name", "tried", "remaining"),
    [
        # the offsets that were found by hand; the points of ur5 are out of its reach by up to 347 mm
        ("sr4c", "joint offsets theta2 + 90 deg, theta5 - 90 deg, theta6 + 90 deg", "0.07097 mm"),
        ("ur5", "joint offsets theta2 - 90 deg, theta4 - 90 deg", "348 mm"),
        ("bagging", "", "2.547 mm"),  # z of point A is a misprint
        ("cobot", None, ""),  # no reading of the printed table fits
    ],
)
def test_the_printed_tables_of_the_papers(
    name: str, tried: str | None, remaining: str, form: str
) -> None:
    paper = parse_papers(own_table(name, form), name)[0]
    found = [hint for hint in hints_of(paper, points_of(paper)) if hint.kind == "dh"]
    words = ["the standard form (stated: modified)"] if form == "modified" else []
    if tried is None or not (words or tried):
        assert found == []
        return
    (hint,) = found
    assert hint.tried == f"Table 1 read with {' and '.join([*words, *([tried] if tried else [])])}"
    assert hint.text.endswith(remaining)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('form = "standard"', 'form = "modifed"', "dh: form: 'modifed' is not one of standard, modified"),
        ('form = "standard"', "", "dh: form: missing"),
        ('length = "mm"\nangle', 'length = "inch"\nangle', "dh: length: 'inch' is not one of m, mm"),
        ('angle = "deg"\nd', 'angle = "degree"\nd', "dh: angle: 'degree' is not one of rad, deg"),
        ("a = [40.0, 300.0, 250.0]", "a = [40.0, 300.0]", "dh: a: 2 values where 3 are expected"),
        ("a = [40.0,", 'a = ["a1",', "dh: a: value 1: 'a1' is not a number"),
        ("a = [40.0,", "a = [4e8,", "dh: a: 400000 m is longer than 10000 m: a mistaken unit?"),
        ("alpha = [", "alhpa = [", "dh: unknown key 'alhpa'; did you mean 'alpha'?"),
        ("[dh]", '[dh]\njoints = ["revolute", "prismatic", "revolute"]',
         "dh: joints: joint 2 is 'prismatic'; the audit reads arms of revolute joints only"),
        ("[dh]", '[dh]\njoints = ["revolut", "revolute", "revolute"]',
         "dh: joints: 'revolut'; the nearest known one is 'revolute'"),
        ("[dh]", '[dh]\njoints = ["revolute"]', "dh: joints: 1 values where 3 are expected"),
        ("[dh]", "[dh]\nsign = [1, 2, 1]", "dh: sign: 2 is not 1 or -1"),
        ("[dh]", "[[dh]]", "dh: expected a table [dh]"),
        ('family = "3-5-3"', 'family = "3-5-3"\narm = "ur5"', "arm: given beside [dh]; keep one of them"),
    ],
)  # fmt: skip
def test_a_mistake_in_the_table_is_one_line(old: str, new: str, message: str) -> None:
    text = sound().text()
    assert old in text
    with pytest.raises(InputError) as caught:
        parse_papers(text.replace(old, new, 1), "p")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
