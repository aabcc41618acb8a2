"""The command of the free-form study."""

from __future__ import annotations

import pytest

from compare.__main__ import main
from compare.studies import free_form_study
from formulations import load

SR4C = load("sr4c")


def test_the_study_verifies_every_answer(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(free_form_study, "cases", lambda: iter([SR4C]))
    monkeypatch.setattr(free_form_study, "extremes", lambda: iter(()))
    assert main(["free_form_study", "--count", "2"]) == 0
    shown = capsys.readouterr().out
    assert "2 random problems: 2 verified, 0 above stop and go, 0 below their bound" in shown
