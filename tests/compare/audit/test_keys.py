"""A key that nobody reads is refused, at every depth, with the nearest known one."""

from __future__ import annotations

import re

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from compare.audit import PAPERS, parse_papers
from compare.audit.paper import published_text
from formulations import InputError

SMALL = """
family = "3-5-3"
[waypoints]
unit = "rad"
rows = [["0.0"], ["0.4"], ["1.2"], ["1.5"]]
[[limits]]
name = "Table 1"
unit = "rad"
velocity = [9]
[[table]]
where = "Table 2"
limits = "Table 1"
joints = [1]
times = [["1.0", "1.0", "1.0"]]
totals = ["3.0"]
"""


def refusal(text: str) -> str:
    with pytest.raises(InputError) as caught:
        parse_papers(text, "mine")
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("totals =", "total_times =", "table: Table 2: unknown key 'total_times'; did you mean 'totals'?"),
        ("velocity =", "velocities =", "limits: Table 1: unknown key 'velocities'; did you mean 'velocity'?"),
        ('unit = "rad"\nrows', 'units = "rad"\nrows', "waypoints: unknown key 'units'; did you mean 'unit'?"),
        ("[[table]]", "[[tabel]]", "unknown key 'tabel'; did you mean 'table'?"),
        ("[waypoints]", "[[waypoints]]", "waypoints: expected a table [waypoints]"),
        ("[[table]]", "[table]", "table: expected tables [[table]]"),
        ('family = "3-5-3"', "family = 353", "family: expected text, got 353"),
        ('where = "Table 2"', "where = 2", "where: expected text, got 2"),
        ("joints = [1]", "joints = 1", "joints: expected a list, got 1"),
        ('family = "3-5-3"', 'family = "3-5-3"\n[settings.swarm]\npopulaton = 3',
         "settings: swarm: unknown key 'populaton'; did you mean 'population'?"),
    ],
)  # fmt: skip
def test_an_unknown_key_is_refused_with_the_nearest_known_one(old: str, new: str, message: str) -> None:
    assert old in SMALL
    assert message in refusal(SMALL.replace(old, new, 1))


KEY = re.compile(r"^(?:\[+(?:\w+\.)*)?(\w+)\]*(?: =|$)", re.M)


@given(paper=st.sampled_from(PAPERS), data=st.data())
def test_any_key_of_a_shipped_paper_misspelt_is_refused_by_name(
    paper: str, data: st.DataObject
) -> None:
    text = published_text(paper)
    start, end = data.draw(st.sampled_from([match.span(1) for match in KEY.finditer(text)]))
    key = text[start:end]
    at = data.draw(st.integers(0, len(key) - 1))
    wrong = data.draw(
        st.sampled_from(
            [
                key[:at] + key[at + 1 :],
                key[: at + 1] + key[at:],
                key[:at] + "x" + key[at + 1 :],
                key[:at] + key[at : at + 2][::-1] + key[at + 2 :],
            ]
        )
    )
    assume(
        wrong and wrong != key and wrong not in {text[slice(*m.span(1))] for m in KEY.finditer(text)}
    )
    assume(not wrong.isdigit())
    message = refusal(text[:start] + wrong + text[end:])
    assert repr(wrong) in message
    assert "did you mean" in message
