"""The formats of ``timebound export`` by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from compare.benchmark.records.exports.coco import write_coco
from compare.benchmark.records.exports.csv_ import write_rows
from compare.benchmark.records.exports.ioh import write_ioh
from compare.benchmark.records.exports.parquet import write_parquet
from compare.benchmark.records.store import Store


def _csv(store: Store, folder: Path) -> Iterable[Path]:
    write_rows(store.iterate_rows(), folder / "rows.csv")
    return [folder / "rows.csv"]


FORMATS: dict[str, Callable[[Store, Path], Iterable[Path]]] = {
    "csv": _csv,
    "parquet": write_parquet,
    "ioh": write_ioh,
    "coco": write_coco,
}
