"""A deadline ends the search with the best verified motion; without one nothing changes."""

from __future__ import annotations

import os
import signal
import threading
import time
from itertools import count

import numpy as np
import pytest
from free_form_helpers import UR5, motion

from formulations import Conditions, Limits, NotFoundInTime, Problem, check, free_form
from formulations.deadlines import Deadline
from formulations.problem.errors import InputError


def large(n: int) -> Problem:
    points = np.cumsum(np.random.default_rng(1).uniform(-0.6, 0.6, (n, 7)), axis=0)
    return Problem.of(points, Limits.of(2.0, 8.0, 60.0, dof=7))


LARGE = large(40)  # as many as the nonlinear program is asked for


@pytest.mark.parametrize("seconds", [0.0, 1.0, 3.0])
@pytest.mark.parametrize("solver", ["ipopt", "highs"])
def test_a_time_limit_is_kept(seconds: float, solver: str) -> None:
    begun = time.perf_counter()
    found = free_form(LARGE, time_limit=seconds, solver=solver)  # type: ignore[arg-type]
    assert time.perf_counter() - begun < seconds + 10.0  # far less than the whole search
    assert found.status == "time limit"
    assert check(LARGE, motion(found)).feasible


def test_more_time_is_never_worse_and_ends_where_no_limit_ends() -> None:
    free = free_form(UR5)
    assert free.status == "ok"
    assert free_form(UR5, time_limit=60.0).seconds == free.seconds
    least = free_form(UR5, time_limit=0.0)
    assert least.method.startswith("stop and go")
    assert least.status == "time limit"
    assert least.seconds > free.seconds


def test_whatever_the_moment_of_the_interrupt_the_motion_is_verified() -> None:
    """The request comes after the nth question, for every n until the search is done."""
    seconds = []
    for n in (0, 1, 2, 3, 5, 8, 13, 21, 10_000):
        questions = count()
        found = free_form(UR5, stop=lambda n=n, questions=questions: next(questions) >= n)
        assert check(UR5, motion(found)).feasible
        assert found.status == ("ok" if n == 10_000 else "interrupted")
        seconds.append(found.seconds)
    assert min(seconds) == seconds[-1]
    assert seconds[0] > seconds[-1]


def test_nothing_found_in_time_is_an_error_of_its_own() -> None:
    with pytest.raises(NotFoundInTime, match=r"time limit: no motion .* conditions\.total"):
        free_form(LARGE, conditions=Conditions(total=30.0), time_limit=0.0)


def test_ctrl_c_in_python_raises_between_two_iterations() -> None:
    # a test run in the background of a shell inherits that SIGINT is ignored
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(1.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    begun = time.perf_counter()
    try:
        with pytest.raises(KeyboardInterrupt):
            free_form(large(100), tolerance=1e-6)
        assert time.perf_counter() - begun < 15.0  # the whole search takes longer
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        timer.cancel()
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("seconds", [-1.0, float("nan")])
def test_a_time_limit_that_is_none_is_refused(seconds: float) -> None:
    with pytest.raises(InputError, match=r"time_limit: .* is not a time"):
        free_form(UR5, time_limit=seconds)


def test_a_part_of_a_computation_ends_with_the_whole() -> None:
    whole = Deadline(0.0)
    assert whole.within(10.0).over
    assert not Deadline(10.0).within(5.0).over
    assert Deadline(10.0).within(0.0).over
    assert Deadline(None, lambda: True).within(10.0).left == 0.0
