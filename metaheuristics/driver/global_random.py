"""The two global random generators: fixed for the time of a run, watched, and put back.

An algorithm that draws from them is repeatable all the same, cannot disturb the next run, and is
found out.  A generator of its own, seeded by nobody, would show as two unequal runs of one seed.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np


@contextmanager
def global_random(rng: np.random.Generator) -> Iterator[Callable[[], bool]]:
    """Fix ``numpy.random`` and ``random`` by rng's seed; tells whether anybody drew from them."""
    before = _states()
    sequence: Any = rng.bit_generator.seed_seq
    word = int(np.random.SeedSequence(sequence.entropy, spawn_key=sequence.spawn_key)
               .generate_state(1)[0])  # fmt: skip
    np.random.seed(word)
    random.seed(word)
    start = _states()
    end = start
    try:
        yield lambda: not _equal(start, end)
    finally:
        end = _states()
        np.random.set_state(before[0])
        random.setstate(before[1])


def _states() -> tuple[Any, Any]:
    return np.random.get_state(), random.getstate()


def _equal(one: tuple[Any, Any], other: tuple[Any, Any]) -> bool:
    numpys = all(np.array_equal(a, b) for a, b in zip(one[0], other[0], strict=True))
    return numpys and bool(one[1] == other[1])
