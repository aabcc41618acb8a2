"""The examples in the docstrings of the public names run, and the public names have docstrings."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pkgutil

import pytest

import formulations

MODULES = [
    info.name
    for info in pkgutil.walk_packages(formulations.__path__, "formulations.")
    if not info.ispkg
]
FINDER = doctest.DocTestFinder(exclude_empty=True)


@pytest.mark.parametrize("name", MODULES)
def test_the_examples_of_a_module_run(name: str) -> None:
    module = importlib.import_module(name)
    assert doctest.testmod(module).failed == 0


@pytest.mark.parametrize(
    "name", [n for n in formulations.__all__ if callable(getattr(formulations, n))]
)
def test_every_public_function_and_class_has_a_docstring_of_its_own(name: str) -> None:
    thing = getattr(formulations, name)
    text = inspect.getdoc(thing) or ""
    assert len(text.splitlines()[0]) > 10
    assert not text.startswith(f"{name}(")  # what a dataclass gets without one


@pytest.mark.parametrize(
    "name", ["load", "parse", "check", "ladder", "Problem", "Limits", "Conditions"]
)
def test_the_first_names_that_a_reader_meets_show_an_example(name: str) -> None:
    examples = FINDER.find(getattr(formulations, name), name)
    assert sum(len(found.examples) for found in examples) > 0
