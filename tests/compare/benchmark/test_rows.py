"""One row: every column has a type, and comes back from the store and from ``rows.csv`` as it was."""

from __future__ import annotations

import csv
import functools
import json
import math
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest
from graded_runs import graded
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.benchmark.protocol import Coordinates, Track
from compare.benchmark.records.rows import (
    COLUMNS,
    TIMING_COLUMNS,
    BoundProof,
    Row,
    RowStatus,
)
from compare.benchmark.records.store import Store
from formulations import InputError, load
from metaheuristics import Status

numbers = st.floats(allow_nan=False, allow_infinity=False)
# no file holds half a character; a row keeps its text on one line
texts = st.text(st.characters(exclude_categories=("Cs",))).map(lambda text: " ".join(text.splitlines()))
counts = st.integers(0, 10**9)
by_type: dict[str, st.SearchStrategy[Any]] = {
    "str": texts,
    "int": counts,
    "float": numbers,
    "float | None": st.none() | numbers,
    "bool": st.booleans(),
    "bool | None": st.none() | st.booleans(),
    "tuple[float, ...]": st.lists(numbers).map(tuple),
    "RowStatus": st.sampled_from(RowStatus),
    "BoundProof": st.sampled_from(BoundProof),
    "Track": st.sampled_from(Track),
    "Coordinates": st.sampled_from(Coordinates),
}
rows = st.fixed_dictionaries({f.name: by_type[str(f.type)] for f in fields(Row)}).map(
    lambda columns: Row(**columns)
)


@given(row=rows, seeds=st.sets(counts, min_size=1, max_size=3))
@settings(max_examples=60)
def test_any_rows_come_back_as_they_were_written(
    row: Row, seeds: set[int], tmp_path_factory: pytest.TempPathFactory
) -> None:
    written = [replace(row, seed=seed) for seed in seeds]
    store = Store(tmp_path_factory.mktemp("rows"))
    store.add_all((one, []) for one in written)
    assert store.rows() == written
    assert [type(value) for value in store.rows()[0].to_json().values()] == [
        type(value) for value in row.to_json().values()
    ]
    store.write_csv()
    with store.rows_file.open(encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file, strict=True))
    assert [list(line.values()) for line in lines] == [one.to_cells() for one in written]
    numbered = [f.name for f in fields(Row) if "float" in str(f.type) and "tuple" not in str(f.type)]
    for line, one in zip(lines, written, strict=True):
        assert [float(line[name]) if line[name] else None for name in numbered] == [
            getattr(one, name) for name in numbered
        ]
    store.close()


@given(row=rows)
def test_a_row_is_plain_json(row: Row) -> None:
    again = json.loads(json.dumps(row.to_json(), allow_nan=False))
    assert list(again) == list(COLUMNS)
    assert again["status"] == row.status.value
    assert again["durations"] == list(row.durations)


@given(text=st.text(st.characters()))
@settings(max_examples=60)
def test_no_text_of_a_stranger_breaks_the_table(
    text: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    row = graded_once()
    store = Store(tmp_path_factory.mktemp("rows"))
    store.add_all([(replace(row, note=text, seed=7), []), (row, [])])
    found = store.rows()
    assert found[1] == row
    assert replace(found[0], note="", seed=row.seed) == replace(row, note="")
    store.write_csv()
    with store.rows_file.open(encoding="utf-8", newline="") as file:
        lines = list(csv.reader(file, strict=True))
    assert lines[2] == row.to_cells()
    store.close()


@functools.cache
def graded_once() -> Row:
    return graded(load("sr4c"), 4.7, "shared", "random", 0, 30).row


def test_every_status_of_the_driver_is_one_of_a_row() -> None:
    assert {status.value for status in Status} <= {status.value for status in RowStatus}
    assert set(TIMING_COLUMNS) <= set(COLUMNS)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_none_is_not_written(value: float, tmp_path: Path) -> None:
    row = graded_once()
    store = Store(tmp_path)
    for changed in (replace(row, gap=value), replace(row, durations=(1.0, value))):
        with pytest.raises(InputError, match="is not a finite number"):
            store.add_all([(changed, [])])
        with pytest.raises(ValueError, match="is not a finite number"):
            changed.to_cells()
    assert store.rows() == []
