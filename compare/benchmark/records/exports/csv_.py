"""``rows.csv``: the rows of a store as a table, written line by line, whole or not at all."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable
from pathlib import Path

from compare.benchmark.records.rows import COLUMNS, Row
from formulations import InputError


def write_rows(rows: Iterable[Row], path: Path) -> None:
    """Write rows as a CSV table.

    Parameters
    ----------
    rows : iterable of Row
        They are taken one by one, so that a million of them need no memory.
    path : Path
        The file; it is replaced in one step if it is there.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    temporary = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        with temporary.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            writer.writerows(row.to_cells() for row in rows)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
