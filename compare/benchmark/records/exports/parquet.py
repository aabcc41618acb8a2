"""Rows and traces as Parquet files, for polars, pandas, DuckDB and R."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from enum import StrEnum
from itertools import chain, islice
from pathlib import Path
from typing import Any

from compare.benchmark.records.database.schema import KINDS
from compare.benchmark.records.rows import COLUMNS, RunKey
from compare.benchmark.records.store import Store
from formulations import InputError

_CHUNK = 10_000  # runs in memory at a time


def write_parquet(store: Store, folder: Path) -> Iterable[Path]:
    """Write the rows and the traces of a comparison.

    Parameters
    ----------
    store : Store
    folder : Path

    Returns
    -------
    iterable of Path
        rows.parquet, a line per run; traces.parquet, a line per improvement of a search.

    Raises
    ------
    InputError
        If pyarrow is not installed, or a file cannot be written.
    """
    try:
        import pyarrow as pa
    except ImportError:
        raise InputError("--parquet: pyarrow is missing: pip install 'timebound[export]'") from None
    texts = pa.dictionary(pa.int32(), pa.string())  # few texts, many lines
    types: dict[Any, Any] = {
        str: texts, int: pa.int64(), bool: pa.bool_(), bool | None: pa.bool_(),
        float: pa.float64(), float | None: pa.float64(), tuple[float, ...]: pa.list_(pa.float64()),
    }  # fmt: skip

    def type_of(kind: Any) -> Any:
        return texts if isinstance(kind, type) and issubclass(kind, StrEnum) else types[kind]

    rows = pa.schema([(name, type_of(KINDS[name])) for name in COLUMNS])
    searches = pa.schema(
        [(name, type_of(KINDS[name])) for name in RunKey._fields]
        + [("joint", pa.int64()), ("evaluations", pa.int64()), ("best", pa.float64())]
    )
    lines = ([getattr(row, name) for name in COLUMNS] for row in store.iterate_rows())
    points = (
        [(*key, trace.joint, *point) for point in zip(trace.evaluations, trace.best, strict=True)]
        for key, traces in store.traces()
        for trace in traces
    )
    return [
        _write(rows, _chunks(lines), folder / "rows.parquet"),
        _write(searches, (list(chain(*some)) for some in _chunks(points)), folder / "traces.parquet"),
    ]


def _write(schema: Any, chunks: Iterable[list[Any]], path: Path) -> Path:
    import pyarrow as pa
    import pyarrow.parquet as pq

    temporary = path.with_name(path.name + ".part")
    try:
        with pq.ParquetWriter(temporary, schema, compression="zstd") as file:
            for chunk in chunks:
                columns = zip(*chunk, strict=True) if chunk else ([] for _ in schema)
                arrays = [pa.array(list(c), type=f.type) for c, f in zip(columns, schema, strict=True)]
                file.write_table(pa.Table.from_arrays(arrays, schema=schema))
        temporary.replace(path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    return path


def _chunks(lines: Iterator[Any]) -> Iterator[list[Any]]:
    while chunk := list(islice(lines, _CHUNK)):
        yield chunk
