"""Where the time goes: shares that add up to the whole, each against its rung."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from compare.__main__ import main
from compare.studies.time_split import as_text, path_timing, split, split_figure
from formulations import InputError, Limits, Problem

LADDER = {
    "free_form_lower": 2.9,
    "free_form": 2.91,
    "family": 4.7,
    "family_longest_segment": 5.04,
    "toppra_family_path": 3.14,
    "copp_family_path": None,
}
WITHOUT_JERK = Problem.of([[0.0], [1.0], [0.5], [2.0]], Limits.of(1.0, 2.0, dof=1))
WITH_JERK = Problem.of([[0.0], [1.0], [0.5], [2.0]], Limits.of(1.0, 2.0, 9.0, dof=1))


def rungs(**changes: float | None) -> dict[str, Any]:
    found = {key: {"seconds": value, "note": ""} for key, value in {**LADDER, **changes}.items()}
    if found["copp_family_path"]["seconds"] is None:
        found["copp_family_path"]["note"] = "whatever the reason is called"
    return found


TIMES = st.floats(0.01, 100.0)


@given(
    values=st.tuples(TIMES, TIMES, TIMES, TIMES, TIMES, st.none() | TIMES),
    seconds=TIMES,
    coding=st.sampled_from(["published", "shared", "stretched"]),
    problem=st.sampled_from([WITHOUT_JERK, WITH_JERK]),
)
def test_the_shares_add_up(
    values: tuple[Any, ...], seconds: float, coding: str, problem: Problem
) -> None:
    shares = split(problem, rungs(**dict(zip(LADDER, values, strict=True))), seconds, coding)
    assert shares[0].low == values[0]
    assert shares[-1].high == seconds
    assert values[0] + sum(s.seconds for s in shares) == pytest.approx(seconds, abs=1e-9)
    assert ("synchronisation" in {s.name for s in shares}) == (coding == "published")


def test_each_share_is_the_difference_of_its_rungs() -> None:
    shares = {s.name: s.seconds for s in split(WITHOUT_JERK, rungs(), 5.1, "published")}
    assert shares == pytest.approx(
        {
            "proof": 2.91 - 2.9,
            "path": 3.14 - 2.91,
            "timing": 4.7 - 3.14,
            "synchronisation": 5.04 - 4.7,
            "optimiser": 5.1 - 5.04,
        }
    )


def test_the_path_is_timed_under_every_limit_or_not_at_all() -> None:
    """TOPP-RA knows no jerk limit; which of the two holds follows from the problem, not from a note."""
    assert path_timing(WITH_JERK, rungs(copp_family_path=3.3)) == "copp_family_path"
    assert path_timing(WITHOUT_JERK, rungs()) == "toppra_family_path"
    assert path_timing(WITHOUT_JERK, rungs(toppra_family_path=None)) is None
    assert path_timing(WITH_JERK, rungs()) is None
    shares = split(WITH_JERK, rungs(), 5.0, "shared")
    assert [s.name for s in shares] == ["proof", "family", "optimiser"]


def test_a_ladder_without_a_free_form_motion_is_refused() -> None:
    with pytest.raises(InputError, match="no free_form"):
        split(WITHOUT_JERK, rungs(free_form=None), 5.0, "shared")


def test_the_picture_shows_every_share_and_survives_negative_ones() -> None:
    splits = {c: split(WITHOUT_JERK, rungs(family=3.1), 5.1, c) for c in ("published", "stretched")}
    figure = split_figure("title", splits)
    names = {text.get_text() for text in figure.axes[0].get_legend().get_texts()}
    assert names == {"no motion is faster (certified)", *(s.name for s in splits["published"])}
    assert "timing" in as_text(splits["published"])
    split_figure("nothing", {})


def test_the_command_splits_a_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, picture = tmp_path / "split.json", tmp_path / "split.svg"
    options = ["--budget", "100", "--json", str(out), "--figure", str(picture)]
    assert main(["split", "sr4c", *options]) == 0
    data = json.loads(out.read_text())
    assert set(data["split"]) == {"published", "shared", "stretched"}
    for shares in data["split"].values():
        total = shares[0]["low"] + sum(share["seconds"] for share in shares)
        assert total == pytest.approx(shares[-1]["high"], rel=1e-12)
    assert "<svg" in picture.read_text()
    assert "no motion is faster" in capsys.readouterr().out
