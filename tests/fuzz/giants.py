"""Files of 100 MB that look valid at first, and small ones that mean much: what an attacker would send."""

from __future__ import annotations

import io
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

SIZE = 100_000_000  # bytes


class Giant(NamedTuple):
    """A reader, the suffix of the file, and its bytes."""

    reader: str
    suffix: str
    make: Callable[[], bytes]


def large(head: bytes, piece: bytes, tail: bytes = b"", size: int = SIZE) -> Callable[[], bytes]:
    """A head, a piece again and again up to a size, a tail."""
    return lambda: head + piece * ((size - len(head) - len(tail)) // len(piece)) + tail


def nested(
    opening: bytes, closing: bytes = b"", head: bytes = b"", depth: int = 100_000
) -> Callable[[], bytes]:
    """Values in values."""
    return lambda: head + opening * depth + b"1" + closing * depth


def laughs(head: bytes = b"") -> bytes:
    """Aliases of aliases: 9 ** 9 words."""
    lines = [b"a0: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol]"]
    lines += [b"a%d: &a%d [%s]" % (k, k, b", ".join([b"*a%d" % (k - 1)] * 9)) for k in range(1, 9)]
    return head + b"\n".join(lines) + b"\n"


def entities(root: bytes) -> bytes:
    """XML entities of entities."""
    lines = [b'<!ENTITY a0 "lol">'] + [
        b'<!ENTITY a%d "%s">' % (k, b"&a%d;" % (k - 1) * 10) for k in range(1, 10)
    ]
    return b"<!DOCTYPE robot [\n" + b"\n".join(lines) + b"]>\n<" + root + b">&a9;</" + root + b">"


def npz(
    shape: str,
    body: bytes = b"",
    *,
    name: str = "time.npy",
    descr: str = "<f8",
    method: int = 0,
    times: int = 1,
) -> bytes:
    """An archive whose members claim a shape."""
    header = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    member = b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header + body
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method or zipfile.ZIP_STORED) as archive:
        for k in range(times):
            archive.writestr(
                zipfile.ZipInfo(f"{k}{name}" if k else name), member, method or zipfile.ZIP_STORED
            )
    return stream.getvalue()


def claimed(data: bytes, size: int) -> bytes:
    """The archive with another unpacked size in its directory."""
    at = data.rfind(b"PK\1\2") + 24
    return data[:at] + struct.pack("<I", size) + data[at + 4 :]


_CSV = b"time,position_a\n0.0,0.0\n0.5,1.0\n"
_POINT = b'{"positions": [0.5], "time_from_start": {"sec": 1, "nanosec": 0}},\n'
_URDF = b'<robot name="a">\n'

GIANTS: dict[str, Giant] = {
    "URDF, many links": Giant("urdf", "urdf", large(_URDF, b'<link name="a"/>\n', b"</robot>")),
    "URDF of 10 MB, many links": Giant(
        "urdf", "urdf", large(_URDF, b'<link name="a"/>\n', b"</robot>", 9_990_000)
    ),
    "URDF of 10 MB, one long name": Giant(
        "urdf", "urdf", large(_URDF + b'<link name="', b"a", b'"/></robot>', 9_990_000)
    ),
    "URDF of 10 MB, many attributes": Giant(
        "urdf",
        "urdf",
        lambda: _URDF + b"<link " + b" ".join(b'a%d="1"' % k for k in range(600_000)) + b"/></robot>",
    ),
    "URDF, deep": Giant("urdf", "urdf", nested(b"<a>", b"</a>", _URDF)),
    "URDF, entities of entities": Giant("urdf", "urdf", lambda: entities(b"robot")),
    "URDF, one long line of digits": Giant(
        "urdf",
        "urdf",
        large(
            _URDF + b'<link name="a"/><joint name="j" type="fixed"><origin xyz="',
            b"9",
            b'x 0 0"/></joint>',
            9_000_000,
        ),
    ),
    "SRDF, many groups": Giant(
        "srdf", "srdf", large(b'<robot name="arm">', b'<group name="g"/>\n', b"</robot>")
    ),
    "SRDF of 10 MB, many groups": Giant(
        "srdf", "srdf", large(b'<robot name="arm">', b'<group name="g"/>\n', b"</robot>", 9_990_000)
    ),
    "limits, many joints": Giant(
        "limits", "yaml", large(b"joint_limits:\n", b"  j1: {max_velocity: 1}\n")
    ),
    "limits of 2 MB, many joints": Giant(
        "limits",
        "yaml",
        lambda: b"joint_limits:\n" + b"".join(b"  j%d: {max_velocity: 1}\n" % k for k in range(80_000)),
    ),
    "limits, aliases of aliases": Giant("limits", "yaml", lambda: laughs(b"joint_limits: {}\n")),
    "limits, deep flow": Giant("limits", "yaml", nested(b"[", b"]", b"joint_limits: ")),
    "limits, deep mappings": Giant("limits", "yaml", nested(b"{a: ", b"}")),
    "limits, deep block": Giant("limits", "yaml", nested(b"- ", b"", b"joint_limits:\n  ")),
    "limits, wide flow": Giant("limits", "yaml", large(b"joint_limits: [", b"1, ", b"1]", 1_990_000)),
    "limits, many documents": Giant("limits", "yaml", large(b"", b"---\n", b"", 1_990_000)),
    "waypoints, CSV": Giant("waypoints", "csv", large(b"j1,j2,j3,j4\n", b"0.1,0.2,0.05,1\n")),
    "waypoints of 20 MB, CSV": Giant(
        "waypoints", "csv", large(b"j1,j2,j3,j4\n", b"0.1,0.2,0.05,1\n", b"x", 19_900_000)
    ),
    "waypoints of 20 MB, empty lines": Giant(
        "waypoints", "csv", large(b"j1,j2,j3,j4\n", b"\n", b"x", 19_900_000)
    ),
    "waypoints of 20 MB, comments": Giant(
        "waypoints", "csv", large(b"j1,j2,j3,j4\n", b"#\n", b"x", 19_900_000)
    ),
    "waypoints of 20 MB, commas": Giant("waypoints", "csv", large(b"", b",", b"", 19_900_000)),
    "waypoints of 20 MB, spaces": Giant("waypoints", "txt", large(b"1", b" 1", b"x", 19_900_000)),
    "waypoints of 20 MB, quotes": Giant("waypoints", "csv", large(b"j1,", b'"', b"", 19_900_001)),
    "waypoints of 20 MB, digits": Giant("waypoints", "txt", large(b"1 2 3 ", b"9", b"x", 19_900_000)),
    "waypoints, JSON, deep": Giant("waypoints", "json", nested(b"[", b"]")),
    "waypoints, JSON, deep mappings": Giant("waypoints", "json", nested(b'{"a": ', b"}")),
    "waypoints of 20 MB, JSON, wide": Giant(
        "waypoints", "json", large(b'{"poses": [', b"0,", b"0]}", 19_900_000)
    ),
    "waypoints of 20 MB, JSON, lists": Giant(
        "waypoints", "json", large(b'{"poses": [', b"[],", b"0]}", 19_900_000)
    ),
    "waypoints, JSON, many points": Giant(
        "waypoints", "json", large(b'{"joint_names": ["a"], "points": [', _POINT, b"]}")
    ),
    "waypoints, YAML, aliases of aliases": Giant(
        "waypoints", "yaml", lambda: laughs(b"joint_names: [j1]\n")
    ),
    "waypoints, YAML, deep flow": Giant("waypoints", "yaml", nested(b"[", b"]", b"points: ")),
    "waypoints of 20 MB, YAML, wide flow": Giant(
        "waypoints", "yaml", large(b"points: [", b"0,", b"0]", 19_900_000)
    ),
    "waypoints of 20 MB, YAML, wide block": Giant(
        "waypoints", "yaml", large(b"points:\n", b"- 0\n", b"- 1\n", 19_900_000)
    ),
    "waypoints of 20 MB, YAML, documents": Giant(
        "waypoints", "yaml", large(b"", b"---\n", b"", 19_900_000)
    ),
    "waypoints of 20 MB, YAML, a long word": Giant(
        "waypoints", "yaml", large(b"points: ", b"9", b"x", 19_900_000)
    ),
    "waypoints of 20 MB, YAML, comments": Giant(
        "waypoints", "yaml", large(b"", b"#\n", b"x", 19_900_000)
    ),
    "problem": Giant("problem", "toml", large(b"waypoints = [\n", b"[0.0, 1.0],\n", b"]\n")),
    "problem of 2 MB": Giant(
        "problem", "toml", large(b"waypoints = [\n", b"[0.0, 1.0],\n", b"]\n", 1_990_000)
    ),
    "problem, deep arrays": Giant("problem", "toml", nested(b"[", b"]", b"waypoints = ")),
    "problem, deep tables": Giant("problem", "toml", nested(b"{a = ", b"}", b"limits = ")),
    "problem, a key of many parts": Giant("problem", "toml", lambda: b"a." * 100_000 + b"a = 1\n"),
    "problem, quoted parts": Giant("problem", "toml", lambda: b"'a' . " * 100_000 + b"a = 1\n"),
    "problem, a table of many parts": Giant(
        "problem", "toml", lambda: b"[" + b"a." * 100_000 + b"a]\n"
    ),
    "problem, a long number": Giant("problem", "toml", large(b"waypoints = ", b"9", b"\n", 1_990_000)),
    "problem, many tables": Giant(
        "problem", "toml", lambda: b"".join(b"[a%d]\n" % k for k in range(200_000))
    ),
    "problem, comments": Giant("problem", "toml", large(b"", b"#\n", b"x", 1_990_000)),
    "problem, a device": Giant(
        "problem", "toml", lambda: b'robot = "/dev/zero"\nwaypoints = [[0], [1]]\n'
    ),
    "paper": Giant("paper", "toml", large(b'family = "3-5-3"\n', b"# a comment\n", b"x")),
    "paper, a key of many parts": Giant("paper", "toml", lambda: b"a." * 100_000 + b"a = 1\n"),
    "motion, CSV, broken at the end": Giant("motion", "csv", large(_CSV, b"1.0,0.5\n", b"x\n")),
    "motion, CSV, another form": Giant("motion", "csv", large(_CSV, b"1.0, 0.5,\n")),
    "motion, CSV, times that stand": Giant("motion", "csv", large(_CSV, b"0.5,1.0\n")),
    "motion, CSV, one line": Giant("motion", "csv", large(b"time,", b"position_a,", b"\n")),
    "motion, CSV, a line of spaces": Giant(
        "motion", "csv", lambda: _CSV[:16] + b"0.0" + b" " * 200_000 + b",1.0\n" * 9
    ),
    "motion, CSV, a line of tabs": Giant(
        "motion", "csv", lambda: _CSV[:16] + b"0.0,0.5" + b"\t" * 200_000 + b"\n" * 9
    ),
    "motion, CSV, empty lines": Giant("motion", "csv", large(_CSV, b"\n")),
    "motion, CSV, zeros": Giant("motion", "csv", large(_CSV, b"\0")),
    "motion, CSV, digits": Giant("motion", "csv", large(_CSV + b"1.0,", b"9")),
    "motion, JSON, broken at the end": Giant("motion", "json", large(b'{"points": [', _POINT, b"x]}")),
    "motion, JSON, times that stand": Giant(
        "motion", "json", large(b'{"points": [', _POINT, _POINT[:-2] + b"]}")
    ),
    "motion, JSON, deep": Giant("motion", "json", nested(b"[", b"]", b'{"points": ')),
    "motion, JSON, wide": Giant("motion", "json", large(b'{"points": [', b"0,", b"0]}")),
    "motion of 10 MB, JSON, wide": Giant(
        "motion", "json", large(b'{"points": [', b"0,", b"0]}", 9_990_000)
    ),
    "motion of 10 MB, JSON, spaces": Giant(
        "motion", "json", large(b'{"points": [{"positions": [0.5', b" ", b"]}]}", 9_990_000)
    ),
    "motion, JSON, a string": Giant("motion", "json", large(b'{"points": [{"a": "', b"a", b'"}]}')),
    "motion, YAML, broken at the end": Giant(
        "motion", "yaml", large(b"points:\n", b"- positions: [0.5]\n  time_from_start: 1.0\n", b"x")
    ),
    "motion, YAML, aliases of aliases": Giant("motion", "yaml", lambda: laughs(b"points: []\n")),
    "motion of 10 MB, YAML, wide flow": Giant(
        "motion", "yaml", large(b"points: [", b"0,", b"0]", 9_990_000)
    ),
    "motion, YAML, deep": Giant("motion", "yaml", nested(b"[", b"]", b"points: ")),
    "pieces": Giant("motion", "pieces.json", large(b'{"pieces": [', b"0,", b"0]}")),
    "pieces of 50 MB, wide": Giant(
        "motion", "pieces.json", large(b'{"pieces": [', b"0,", b"0]}", 49_900_000)
    ),
    "pieces of 50 MB, one joint of numbers": Giant(
        "motion",
        "pieces.json",
        large(b'{"pieces": [{"seconds": 1, "coefficients": [[', b"0,", b"0]]}]}", 49_900_000),
    ),
    "pieces, deep": Giant("motion", "pieces.json", nested(b"[", b"]", b'{"pieces": ')),
    "NPZ, a claimed size of 1e12": Giant("npz", "npz", lambda: npz("(1000000000000,)")),
    "NPZ, a claimed size of 1e12 and columns": Giant(
        "npz", "npz", lambda: npz("(1000000000000, 7)", b"0" * 800)
    ),
    "NPZ, unpacked 4 GB by the directory": Giant(
        "npz", "npz", lambda: claimed(npz("(3,)", b"0" * 24), 4_000_000_000)
    ),
    "NPZ, objects": Giant("npz", "npz", lambda: npz("(1,)", b"cos\nsystem\n(S'id'\ntR.", descr="|O")),
    "NPZ, a bomb of 900 MB": Giant(
        "npz", "npz", lambda: npz("(3,)", bytes(900_000_000), method=zipfile.ZIP_DEFLATED)
    ),
    "NPZ, 100 MB of another shape": Giant("npz", "npz", lambda: npz("(3,)", bytes(SIZE))),
    "NPZ, 100 MB of zeros": Giant("npz", "npz", large(b"PK\3\4", b"\0")),
    "NPZ, many members": Giant("npz", "npz", lambda: npz("(3,)", b"0" * 24, times=60_000)),
    "NPZ, a long header": Giant("npz", "npz", lambda: npz("(" + "1," * 30_000 + ")")),
    "NPZ, a deep header": Giant("npz", "npz", lambda: npz("(" * 30_000 + ")" * 30_000)),
    "NPZ, a name of 100 MB": Giant(
        "npz", "npz", lambda: npz("(1,)", bytes(SIZE), name="joint_names.npy", descr=f"<U{SIZE // 4}")
    ),
    "certificate, another JSON": Giant("certificate", "json", large(b'{"a": [', b"0,", b"0]}")),
    "certificate, many events": Giant(
        "certificate",
        "json",
        large(b'{"format": "timebound certificate 1", "events": [', b'["T"],', b'["T"]]}'),
    ),
    "certificate, deep": Giant(
        "certificate", "json", nested(b"[", b"]", b'{"format": "timebound certificate 1", "events": ')
    ),
    "a store of zeros": Giant("store", "results.sqlite", large(b"SQLite format 3\0", b"\0")),
    "rows of a study": Giant("store", "study.jsonl", large(b"", b'{"call": 0}\n')),
    "rows of a study, deep": Giant("store", "study.jsonl", nested(b"[", b"]\n")),
    "settings": Giant("store", "settings.json", large(b'{"cases": [', b"0,", b"0]}")),
    "a ladder of 50 MB": Giant(
        "store", "ladder.json", large(b'{"ladder": [', b"0,", b"0]}", 49_900_000)
    ),
    "an audit, deep": Giant("store", "audit.json", nested(b"[", b"]", b'{"audits": ')),
}


def made(giant: Giant, folder: Path) -> Path:
    """The file of a giant."""
    path = folder / (f"input-{giant.suffix}" if giant.reader == "store" else f"input.{giant.suffix}")
    path.write_bytes(giant.make())
    return path
