"""Spoilt files through every reader: an answer, or one line of a named error, and nothing else.

The seeds are in ``seeds``; what once broke a reader is kept there too. A few thousand inputs run by default.
For more, with the throughput of each reader:

    TIMEBOUND_FUZZ=1000000 python -m pytest -n 0 -s tests/fuzz/test_readers.py
    TIMEBOUND_FUZZ_SEED=N for others

An input that breaks a reader is left in pytest's folder, under the name that the message gives.
"""

from __future__ import annotations

import contextlib
import faulthandler
import os
import random
import time
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from mutations import Mutator
from readers import BESIDE, READERS, SEEDS, Reader
from watch import Fault, accepted, guarded
from zips import ZipMutator
from zips import seeds as zip_seeds

from formulations.arms import reach
from formulations.robot import assembly

COUNT = int(os.environ.get("TIMEBOUND_FUZZ", "10000"))
SEED = int(os.environ.get("TIMEBOUND_FUZZ_SEED", "20261126"))
LONG = COUNT > 100_000
HANG = 600.0  # s without an end in which no signal is answered: the process ends with its stack
KEPT = [
    pytest.param(reader, path, id=f"{reader.name}/{path.name}")
    for reader in READERS
    for path in reader.seeds
]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in BESIDE:
        (tmp_path / Path(name).name).write_bytes((SEEDS / name).read_bytes())
    # the robot beside an input is the same each time, and its URDF takes longer to read than all else
    monkeypatch.setattr(assembly, "parse_urdf", lru_cache(8)(assembly.parse_urdf))
    monkeypatch.setattr(
        reach, "_STARTS", 3
    )  # how near an arm gets to a pose out of reach: a search of seconds
    return tmp_path


def tried(reader: Reader, path: Path) -> tuple[bool, float, str]:
    return accepted(reader.read, path, names_files=reader.names_files, places=reader.places)


def contents(reader: Reader) -> list[tuple[str, bytes]]:
    """Names and bytes of the seeds."""
    if reader.name == "npz":
        return [(f"motion{k}.npz", data) for k, data in enumerate(zip_seeds())]
    return [(path.name, path.read_bytes()) for path in reader.seeds]


@pytest.mark.parametrize(("reader", "seed"), KEPT)
def test_seeds(folder: Path, reader: Reader, seed: Path) -> None:
    """What broke a reader once is refused; all else is read."""
    path = folder / f"input-{seed.name}"
    path.write_bytes(seed.read_bytes())
    reader_quietly(reader, path)  # what is loaded on first use is loaded now
    with guarded():
        answer, _, line = tried(reader, path)
    assert answer != seed.name.startswith("found"), line


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.name)
def test_spoilt_files_give_an_answer_or_one_line(folder: Path, reader: Reader) -> None:
    rng = random.Random(f"{SEED} {reader.name}")
    seeds = contents(reader)
    data = [content for _, content in seeds]
    mutator = ZipMutator(rng, data) if reader.name == "npz" else Mutator(rng, data)
    for name, content in seeds:  # what is loaded on first use is loaded now
        (folder / f"input-{name}").write_bytes(content)
        reader_quietly(reader, folder / f"input-{name}")
    count, answers, spent = COUNT * reader.share // 1000, 0, []
    started = time.perf_counter()
    with guarded():
        for k in range(count):
            if k % 1000 == 0:
                faulthandler.dump_traceback_later(HANG, exit=True)
                if LONG and k and k % 5000 == 0:
                    print(
                        f"{reader.name}: {k} of {count}, {k / (time.perf_counter() - started):.0f} per second",
                        flush=True,
                    )
            name, content = seeds[int(rng.random() * len(seeds))]
            path = folder / f"input-{name}"
            spoilt = mutator.mutated(content)
            written(path, spoilt)
            try:
                answer, seconds, _ = tried(reader, path)
            except Fault as fault:
                faulthandler.cancel_dump_traceback_later()
                kept = path.with_name(f"found-{name}")
                kept.write_bytes(spoilt)
                raise AssertionError(
                    f"{reader.name}, seed {SEED}, input {k}: {kept}: {fault}: {spoilt[:2000]!r}"
                ) from fault
            answers += answer
            spent.append(seconds)
    faulthandler.cancel_dump_traceback_later()
    if LONG:
        total = time.perf_counter() - started
        print(
            f"{reader.name}: {count} inputs, {answers} answers, {count / total:.0f} per second; reading takes "
            f"{1e6 * float(np.median(spent)):.0f} us in the median, {max(spent):.3f} s at most", flush=True
        )  # fmt: skip
    assert 0 < answers < count
    assert not any(name.endswith(".part") for name in os.listdir(folder))


def written(path: Path, data: bytes) -> None:
    """Overwrite a file in place: on some disks to shorten it first takes longer than all readers."""
    with path.open("r+b") as file:
        file.write(data)
        file.truncate()


def reader_quietly(reader: Reader, path: Path) -> None:
    with contextlib.suppress(Exception):  # it is judged when it is tried
        reader.read(path)
