"""One row, one line: every column has a type, and what does not fit is named."""

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
from hypothesis import given
from hypothesis import strategies as st

from compare.benchmark.protocol import Coordinates, Track
from compare.benchmark.records.rows import (
    COLUMNS,
    TIMING_COLUMNS,
    BoundProof,
    Row,
    RowStatus,
    csv_text,
    read_csv,
)
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


@given(written=st.lists(rows, max_size=3))
def test_any_rows_come_back_as_they_were_written(
    written: list[Row], tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("rows") / "rows.csv"
    path.write_text(csv_text(written), "utf-8")
    assert read_csv(path) == written


@given(row=rows)
def test_a_row_is_plain_json(row: Row) -> None:
    again = json.loads(json.dumps(row.to_json(), allow_nan=False))
    assert list(again) == list(COLUMNS)
    assert again["status"] == row.status.value
    assert again["durations"] == list(row.durations)


@given(text=st.text(st.characters()))
def test_no_text_of_a_stranger_breaks_the_table(
    text: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("rows") / "rows.csv"
    row = graded_once()
    path.write_bytes(csv_text([replace(row, note=text), row]).encode("utf-8"))
    found = read_csv(path)
    assert found[1] == row
    assert replace(found[0], note="") == replace(row, note="")


@functools.cache
def graded_once() -> Row:
    return graded(load("sr4c"), 4.7, "shared", "random", 0, 30).row


def test_every_status_of_the_driver_is_one_of_a_row() -> None:
    assert {status.value for status in Status} <= {status.value for status in RowStatus}
    assert set(TIMING_COLUMNS) <= set(COLUMNS)


@pytest.mark.parametrize(
    ("column", "cell", "words"),
    [
        ("status", "fine", "'fine' is not a valid RowStatus"),
        ("proof", "proved", "'proved' is not a valid BoundProof"),
        ("seed", "1.5", "1.5"),
        ("seed", "", "''"),
        ("seconds", "fast", "fast"),
        ("seconds", "nan", "'nan' is not a finite number"),
        ("gap", "-inf", "'-inf' is not a finite number"),
        ("durations", "1.0 x", "x"),
        ("durations", "1.0 inf", "'inf' is not a finite number"),
        ("isolated", "", "'' is neither yes nor no"),
        ("keeps_limits", "maybe", "'maybe' is neither yes nor no"),
    ],
)
def test_a_cell_that_does_not_fit_is_named(column: str, cell: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "rows.csv"
    row = graded_once()
    cells = dict(zip(COLUMNS, row.to_cells(), strict=True)) | {column: cell}
    with path.open("w", newline="", encoding="utf-8") as file:
        file.write(csv_text([row, row]))
        csv.DictWriter(file, COLUMNS).writerow(cells)
    with pytest.raises(InputError) as caught:
        read_csv(path)
    assert f"{path}: line 4: {column}: " in str(caught.value)
    assert words in str(caught.value)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_none_is_not_written(value: float) -> None:
    row = graded_once()
    for changed in (replace(row, gap=value), replace(row, durations=(1.0, value))):
        with pytest.raises(ValueError, match="is not a finite number"):
            csv_text([changed])
