"""Where the time goes: shares that add up to the whole, each against its rung."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from compare.commands import split as module
from compare.commands.split import as_text, path_timing, split, split_figure
from formulations import InputError

LADDER = {
    "free_form_lower": 2.9,
    "free_form": 2.91,
    "family": 4.7,
    "family_longest_segment": 5.04,
    "toppra_family_path": 3.14,
    "copp_family_path": None,
}


def rungs(**changes: float | None) -> dict[str, Any]:
    return {key: {"seconds": value, "note": ""} for key, value in {**LADDER, **changes}.items()}


TIMES = st.floats(0.01, 100.0)


@given(
    values=st.tuples(TIMES, TIMES, TIMES, TIMES, TIMES, st.none() | TIMES),
    seconds=TIMES,
    coding=st.sampled_from(["published", "shared", "stretched"]),
)
def test_the_shares_add_up(values: tuple[Any, ...], seconds: float, coding: str) -> None:
    shares = split(rungs(**dict(zip(LADDER, values, strict=True))), seconds, coding, has_jerk=False)
    assert shares[0].low == values[0]
    assert shares[-1].high == seconds
    assert values[0] + sum(s.seconds for s in shares) == pytest.approx(seconds, abs=1e-9)
    assert ("synchronisation" in {s.name for s in shares}) == (coding == "published")


def test_each_share_is_the_difference_of_its_rungs() -> None:
    shares = {s.name: s.seconds for s in split(rungs(), 5.1, "published", has_jerk=False)}
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
    assert path_timing(rungs(copp_family_path=3.3), has_jerk=True) == "copp_family_path"
    assert path_timing(rungs(), has_jerk=False) == "toppra_family_path"
    # whatever the reason is that COPP gave no number, TOPP-RA's lacks the jerk limits
    assert path_timing(rungs(), has_jerk=True) is None
    shares = split(rungs(), 5.0, "shared", has_jerk=True)
    assert [s.name for s in shares] == ["proof", "family", "optimiser"]


def test_a_ladder_without_a_free_form_motion_is_refused() -> None:
    with pytest.raises(InputError, match="no free_form"):
        split(rungs(free_form=None), 5.0, "shared", has_jerk=False)


def test_the_picture_shows_every_share_and_survives_negative_ones() -> None:
    splits = {c: split(rungs(family=3.1), 5.1, c, has_jerk=False) for c in ("published", "stretched")}
    figure = split_figure("title", splits)
    names = {text.get_text() for text in figure.axes[0].get_legend().get_texts()}
    assert names == {"no motion is faster (certified)", *(s.name for s in splits["published"])}
    assert "timing" in as_text(splits["published"])
    split_figure("nothing", {})


def test_the_command_splits_a_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out, picture = tmp_path / "split.json", tmp_path / "split.svg"
    monkeypatch.setattr(
        sys,
        "argv",
        ["split", "sr4c", "--budget", "100", "--json", str(out), "--figure", str(picture)],
    )
    assert module.main() == 0
    data = json.loads(out.read_text())
    assert set(data["split"]) == {"published", "shared", "stretched"}
    for shares in data["split"].values():
        total = shares[0]["low"] + sum(share["seconds"] for share in shares)
        assert total == pytest.approx(shares[-1]["high"], rel=1e-12)
    assert "<svg" in picture.read_text()
    assert "no motion is faster" in capsys.readouterr().out
