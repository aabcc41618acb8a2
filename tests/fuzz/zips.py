"""NPZ files: seeds from code, and faults inside their members, whose checksums stay right."""

from __future__ import annotations

import io
import random
import warnings
import zipfile
from typing import Any

import numpy as np
from mutations import Mutator

_NAMES = (
    "time.npy",
    "position.npy",
    "velocity.npy",
    "acceleration.npy",
    "joint_names.npy",
    "time",
    "x.npy",
    "../x.npy",
    "/etc/x.npy",
    "",
    "a/b.npy",
)
_TYPES = (
    "<f8",
    "<f4",
    ">f8",
    "<i4",
    "<u8",
    "|b1",
    "<c16",
    "<U3",
    "|S3",
    "<M8[s]",
    "|O",
    "<f2",
    "<f16",
    "|V8",
    "|V0",
    "<U0",
    "i,f",
    "<U99999999",
)
_SHAPES = (
    "()",
    "(3,)",
    "(3, 2)",
    "(2, 3)",
    "(3, 1)",
    "(0,)",
    "(3, 0)",
    "(-1,)",
    "(3, 2, 1)",
    "(1000000000000,)",
    "(3, 99999999999)",
    "(1e3,)",
    "(3,",
    "3",
    "(True,)",
    "(2**70,)",
    "[3]",
    "None",
    "('a',)",
)


def seeds() -> list[bytes]:
    """States of two joints with names, and positions of one joint without."""
    t = np.arange(3) / 4.0
    q = np.stack([t, 1.0 - t], axis=1)
    states = {
        "time": t,
        "position": q,
        "velocity": 0.0 * q,
        "acceleration": 0.0 * q,
        "joint_names": np.array(["a", "b"]),
    }
    return [
        _packed([(f"{key}.npy", _npy(value)) for key, value in arrays.items()])
        for arrays in (states, {"time": t, "position": q[:, :1]})
    ]


def _npy(array: Any) -> bytes:
    stream = io.BytesIO()
    np.lib.format.write_array(stream, array, version=(1, 0))
    return stream.getvalue()


def _packed(members: list[tuple[str, bytes]], method: int = zipfile.ZIP_STORED) -> bytes:
    stream = io.BytesIO()
    with warnings.catch_warnings(action="ignore"), zipfile.ZipFile(stream, "w", method) as archive:
        for name, data in members:
            info = zipfile.ZipInfo(name)  # no date: the same bytes every time
            info.compress_type = method
            archive.writestr(info, data)
    return stream.getvalue()


class ZipMutator:
    """Spoils NPZ files: the bytes of the archive, of a member, or what the header of a member says."""

    def __init__(self, rng: random.Random, seeds: list[bytes]) -> None:
        self.rng = rng
        self.text = Mutator(rng, seeds)

    def mutated(self, data: bytes) -> bytes:
        """The archive with a fault or a few."""
        rng = self.rng
        if rng.random() < 0.3:
            return self.text.mutated(data)
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = [(name, archive.read(name)) for name in archive.namelist()]
        for _ in range(rng.randrange(1, 3)):
            k = rng.randrange(len(members))
            name, body = members[k]
            way = rng.randrange(5)
            if way == 0:
                members[k] = rng.choice(_NAMES), body
            elif way == 1:
                members[k] = name, self._with_header(body)
            elif way == 2:
                members[k] = name, self.text.mutated(body)
            elif way == 3:
                members.insert(k, (name, members[rng.randrange(len(members))][1]))
            elif len(members) > 1:
                del members[k]
        return _packed(
            members, rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))
        )

    def _with_header(self, body: bytes) -> bytes:
        """The member with another header of the right length."""
        rng = self.rng
        kind, shape = rng.choice(_TYPES), rng.choice(_SHAPES)
        header = f"{{'descr': {kind!r}, 'fortran_order': {rng.random() < 0.3}, 'shape': {shape}, }}"
        if rng.random() < 0.3:
            header = self.text.mutated(header.encode()).decode("latin-1")
        text = header.encode("latin-1") + b"\n"
        version = rng.choice((b"\1\0", b"\1\0", b"\2\0", b"\3\0", b"\0\0"))
        size = (
            len(text).to_bytes(2 if version == b"\1\0" else 4, "little")
            if len(text) < 60_000
            else b"\xff\xff"
        )
        return b"\x93NUMPY" + version + size + text + body[80:] * rng.randrange(3)
