"""The user's Ctrl-C ends a run, whatever the algorithm does; a KeyboardInterrupt of its own is its fault."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from loops import HI, LO, Array, bowl

from metaheuristics import Result, Status, Task, minimise
from metaheuristics.driver.plug_in import search_of
from metaheuristics.driver.task import Moves, Search

pytestmark = pytest.mark.filterwarnings("error")


def run(search: Search, f: Any = bowl, *, budget: int = 100) -> Result:
    return minimise(search, f, LO, HI, budget=budget, seed=0)


@pytest.fixture(autouse=True)
def _sigint_as_on_a_terminal() -> Iterator[None]:
    """A test run in the background of a shell inherits that SIGINT is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def ctrl_c() -> None:
    """Do what a terminal does."""
    os.kill(os.getpid(), signal.SIGINT)


def interrupted(task: Task) -> Moves:
    """Be at work when the user interrupts."""
    yield task.sample(4)
    ctrl_c()
    time.sleep(5.0)


def swallower(task: Task) -> Moves:
    """Be at work when the user interrupts, and go on."""
    yield task.sample(4)
    try:
        ctrl_c()
        time.sleep(5.0)
    except BaseException:
        pass
    while True:
        yield task.sample(4)


def changer(task: Task) -> Moves:
    """Raise something else when the user interrupts."""
    yield task.sample(4)
    try:
        ctrl_c()
        time.sleep(5.0)
    except BaseException:
        raise ValueError("not now") from None


def returner(task: Task) -> Moves:
    """Return when the user interrupts."""
    yield task.sample(4)
    try:
        ctrl_c()
        time.sleep(5.0)
    except BaseException:
        return None


class Slow:
    """Points whose conversion to floats is interrupted by the user."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> Array:
        """Wait for the user."""
        ctrl_c()
        time.sleep(5.0)
        return np.empty(0)


def slow_points(task: Task) -> Any:
    """Yield `Slow` points."""
    yield Slow()


def called(f: Any, lo: Array, hi: Array, budget: int, rng: Any) -> None:
    """Be at work in a thread when the user interrupts."""
    f(lo)
    ctrl_c()
    time.sleep(0.2)
    while True:
        f(lo)


@pytest.mark.parametrize(
    "search", [interrupted, swallower, changer, returner, slow_points, search_of(called)]
)
def test_the_users_interrupt_ends_the_run(search: Search) -> None:
    before = signal.getsignal(signal.SIGINT)
    calls = 0

    def f(x: Array) -> Array:
        nonlocal calls
        calls += 1
        return bowl(x)

    with pytest.raises(KeyboardInterrupt):
        run(search, f)
    assert calls <= 2
    assert signal.getsignal(signal.SIGINT) is before


def test_the_users_interrupt_in_the_objective_ends_the_run() -> None:
    def f(x: Array) -> Array:
        ctrl_c()
        time.sleep(5.0)
        return bowl(x)

    with pytest.raises(KeyboardInterrupt):
        run(interrupted, f)


def test_a_handler_of_the_callers_own_is_asked() -> None:
    class StopError(Exception):
        """What the caller's handler raises."""

    def handler(number: int, frame: Any) -> None:
        raise StopError

    before = signal.signal(signal.SIGINT, handler)
    try:
        with pytest.raises(StopError):
            run(swallower)
        seen: list[int] = []
        signal.signal(signal.SIGINT, lambda number, frame: seen.append(number))
        assert run(patient).status is Status.ok
        assert seen == [signal.SIGINT]
    finally:
        signal.signal(signal.SIGINT, before)


def patient(task: Task) -> Moves:
    """Do not notice the interrupt."""
    yield task.sample(4)
    ctrl_c()
    while True:
        yield task.sample(4)


def raising(task: Task) -> Moves:
    """Raise a KeyboardInterrupt without a user."""
    yield task.sample(4)
    raise KeyboardInterrupt


def raising_called(f: Any, lo: Array, hi: Array, budget: int, rng: Any) -> None:
    """Raise a KeyboardInterrupt without a user, in a thread."""
    f(lo)
    raise KeyboardInterrupt


@pytest.mark.parametrize("search", [raising, search_of(raising_called)])
def test_a_keyboard_interrupt_without_a_user_is_a_fault(search: Search) -> None:
    result = run(search)
    assert (result.status, result.note) == (Status.raised, "KeyboardInterrupt")


def test_in_another_thread_no_interrupt_is_the_users() -> None:
    found: list[Result] = []
    thread = threading.Thread(target=lambda: found.append(run(raising)))
    thread.start()
    thread.join()
    assert found[0].status is Status.raised


def test_where_the_interrupt_is_ignored_it_stays_ignored() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assert run(patient).status is Status.ok
        assert run(raising).status is Status.raised
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
