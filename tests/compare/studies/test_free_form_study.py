"""The commands of the free-form study and of the rivals."""

from __future__ import annotations

import pytest

from compare.__main__ import main
from compare.studies import free_form_study, planners
from formulations import Trajectory, free_form, load

SR4C = load("sr4c")


def test_the_study_verifies_every_answer(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(free_form_study, "cases", lambda: iter([SR4C]))
    monkeypatch.setattr(free_form_study, "extremes", lambda: iter(()))
    assert main(["free_form_study", "--count", "2"]) == 0
    shown = capsys.readouterr().out
    assert "2 random problems: 2 verified, 0 above stop and go, 0 below their bound" in shown


def test_a_rival_that_is_not_installed_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert main(["rivals"]) == 1
    assert "drake: not installed (pip install drake)" in capsys.readouterr().err
    assert main(["rivals", "--rivals", "pilz"]) == 2
    assert "--rivals: 'pilz' is not known" in capsys.readouterr().err


def test_a_rivals_motion_is_slowed_down_or_refused() -> None:
    own = free_form(SR4C).trajectory
    assert own is not None
    hasty = planners.judged(SR4C, "hasty", own.stretched(0.99), 0.0)
    assert hasty.seconds == pytest.approx(own.seconds, rel=1e-6)
    assert "slowed down by 1.0e-02" in hasty.note
    lazy = planners.judged(SR4C, "lazy", Trajectory(own.durations[:-1], own.coefficients[:-1]), 0.0)
    assert lazy.note.startswith("refused: ")
