"""The examples in the manual pages of the public functions run and print what they say."""

from __future__ import annotations

import doctest
import importlib
import inspect

import pytest

import formulations

MODULES = (
    "formulations.optima.free_form.fastest",
    "formulations.proofs.every_motion.bound",
    "formulations.diagnosis",
)


@pytest.mark.parametrize("name", MODULES)
def test_examples_run(name: str) -> None:
    found = doctest.testmod(importlib.import_module(name))
    assert found.attempted >= 3
    assert found.failed == 0


@pytest.mark.parametrize("function", ["free_form", "free_form_bound"])
def test_a_manual_page_names_every_argument(function: str) -> None:
    called = getattr(formulations, function)
    page = inspect.getdoc(called) or ""
    for section in ("Parameters", "Returns", "Raises", "Notes", "References", "Examples"):
        assert f"\n{section}\n{'-' * len(section)}\n" in page
    for argument in inspect.signature(called).parameters:
        assert f"\n{argument} : " in page


@pytest.mark.parametrize("answer", ["FreeForm", "FreeFormBound", "Sensitivity"])
def test_a_manual_page_names_every_attribute(answer: str) -> None:
    kind = getattr(formulations, answer)
    page = inspect.getdoc(kind) or ""
    for attribute in kind.__dataclass_fields__:
        assert f"\n{attribute} : " in page
