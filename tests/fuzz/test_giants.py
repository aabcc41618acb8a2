"""Files of 100 MB, and small files that unfold: refused in one line, at once.

python -m pytest -n 0 -s tests/fuzz/test_giants.py prints the seconds that each takes.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from giants import GIANTS, made
from readers import BESIDE, READERS, SEEDS
from test_readers import reader_quietly
from watch import accepted, guarded

QUICK = 5.0  # s of processor time; most take a tenth of one
_READERS = {reader.name: reader for reader in READERS}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("giants")
    for name in BESIDE:
        (folder / Path(name).name).write_bytes((SEEDS / name).read_bytes())
    for reader in READERS:  # what is loaded on first use is loaded now
        for seed in sorted((SEEDS / reader.name).glob("*")):
            reader_quietly(reader, seed)
    return folder


@pytest.mark.parametrize("name", GIANTS)
def test_giants_are_refused_at_once(folder: Path, name: str) -> None:
    reader, path = _READERS[GIANTS[name].reader], made(GIANTS[name], folder)
    try:
        with guarded():
            answer, seconds, line = accepted(
                reader.read,
                path,
                names_files=reader.names_files,
                places=reader.places,
                seconds=QUICK,
            )
    finally:
        size = path.stat().st_size
        path.unlink()
    print(f"\n{name}: {size / 1e6:.6g} MB, {seconds:.3f} s: {line}", end="")
    assert not answer
