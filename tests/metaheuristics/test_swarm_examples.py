"""The examples in the docstrings of the public names run, and show what they say."""

from __future__ import annotations

import doctest
import importlib

import pytest

MODULES = {
    "metaheuristics.driver.judge": {"minimise"},
    "metaheuristics.driver.isolation": {"apart"},
    "metaheuristics.driver.archive": {"Result"},
    "metaheuristics.driver.task": {"Status", "Task"},
    "metaheuristics.entry": {"Algorithm"},
    "metaheuristics.by_name": {"algorithm"},
}


@pytest.mark.parametrize("name", MODULES)
def test_the_examples_of_a_module_run(name: str) -> None:
    module = importlib.import_module(name)
    tests = [test for test in doctest.DocTestFinder().find(module) if test.examples]
    assert {test.name.removeprefix(f"{name}.") for test in tests} >= MODULES[name]
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    for test in tests:
        assert runner.run(test).failed == 0
