"""The watch itself: planted readers that do what no reader may, each of which it must see."""

from __future__ import annotations

import ast
import os
import pickle
import shutil
import socket
import subprocess
import time
from collections.abc import Callable
from itertools import count
from pathlib import Path

import pytest
from watch import MEMORY, Fault, accepted, guarded

from formulations import InputError

ROOT = Path(__file__).parents[2]

# every module that turns bytes or text of a file into data, and the reader of ``READERS`` that reaches it
DOORS = {
    "formulations/robot/assembly.py": "urdf, srdf, limits",
    "formulations/robot/waypoints/reader.py": "waypoints",
    "formulations/robot/text/trees.py": "limits, waypoints, motion",
    "formulations/robot/text/xml_tree.py": "urdf, srdf",
    "formulations/robot/urdf.py": "urdf",
    "formulations/problem/toml_file/problem_file.py": "problem",
    "formulations/problem/torque.py": "urdf",
    "compare/rivals/isolated.py": "answer of a rival's process",
    "compare/rivals/child.py": "question to a rival's process",
    "formulations/problem/toml_file/toml_text.py": "problem, paper",
    "formulations/motion/files/motion_file.py": "motion, npz",
    "formulations/motion/files/records.py": "motion",
    "compare/audit/paper/shipped.py": "paper",
    "compare/check_certificate/certificate_file.py": "certificate",
    "compare/plain_data.py": "store",
    "compare/benchmark/records/database/documents.py": "store",
    "compare/benchmark/suite/arms.py": "shipped files only",
    "formulations/arms/arm.py": "shipped files only",
    "compare/report/page.py": "a cell of a row",
    "compare/report/frame.py": "shipped scripts, and pictures",
    "compare/benchmark/tuning/constants.py": "shipped files only",
    "compare/citations/bibliography.py": "shipped files only",
    "compare/grading/names.py": "the source of a swarm, which runs afterwards",
    "compare/sources.py": "the source",
    "compare/studies/scale.py": "what the system says of this process",
    "compare/benchmark/records/proof_cache.py": "the source",
    "compare/benchmark/records/provenance.py": "the source",
    "metaheuristics/driver/channel.py": "messages of a process of its own",
    "metaheuristics/libraries/pymoo_.py": "the source of a library",
}
_READING = {"read_text", "read_bytes", "load", "loads", "raw_decode", "fromstring", "parse"}
_OF = {"json", "tomllib", "yaml", "pickle", "etree", "np", "ElementTree", "URDF", "JSONDecoder", "ast"}


def _told(message: str) -> Callable[[Path], None]:
    def read(path: Path) -> None:
        raise InputError(message.format(path=path))

    return read


def _raises(path: Path) -> None:
    raise KeyError("joints")


def _hides(path: Path) -> None:
    try:
        (path.parent / "written").write_text("x")
    except BaseException:
        raise InputError(f"{path}: cannot be read") from None


PLANTED: dict[str, tuple[Callable[[Path], object], str]] = {
    "a traceback": (_raises, "KeyError"),
    "writes": (lambda path: path.with_name("b").write_text("x"), "to write"),
    "writes, and hides it": (_hides, "to write"),
    "appends": (lambda path: path.open("ab").close(), "to write"),
    "makes a folder": (lambda path: path.with_name("d").mkdir(), "os.mkdir"),
    "removes": (lambda path: path.unlink(), "os.remove"),
    "renames": (lambda path: path.rename(path.with_name("c")), "os.rename"),
    "copies": (lambda path: shutil.copy(path, path.with_name("c")), "shutil"),
    "starts a process": (lambda path: subprocess.run(["true"], check=False), "subprocess.Popen"),
    "asks the shell": (lambda path: os.system("true"), "os.system"),
    "connects": (lambda path: socket.socket().connect(("127.0.0.1", 9)), "socket"),
    "reads what is elsewhere": (lambda path: Path("/etc/hostname").read_text(), "reads"),
    "unpickles": (lambda path: pickle.loads(b"cos\nsystem\n."), "pickle.find_class"),
    "waits": (lambda path: time.sleep(60.0), "Slow"),
    "computes": (lambda path: all(True for _ in count()), "Slow"),
    "takes memory": (lambda path: bytearray(2 * MEMORY), "MemoryError"),
    "says nothing": (lambda path: _told("")(path), "not one short line"),
    "names nothing": (lambda path: _told("wrong")(path), "neither file nor key"),
}


@pytest.mark.parametrize("what", PLANTED)
def test_what_no_reader_may_do_is_seen(what: str, tmp_path: Path) -> None:
    read, fault = PLANTED[what]
    path = tmp_path / "input.txt"
    path.write_text("x")
    with guarded(), pytest.raises(Fault, match=fault):
        accepted(read, path, seconds=0.1)
    assert path.read_text() == "x"
    assert os.listdir(tmp_path) == ["input.txt"]


def test_an_answer_and_a_line_are_no_faults(tmp_path: Path) -> None:
    path = tmp_path / "input.txt"
    path.write_text("x")
    with guarded():
        assert accepted(lambda path: path.read_text(), path)[0]
        answer, _, line = accepted(_told("{path}: \x1b[2J two\nlines " + "x" * 5000), path)
    assert not answer
    assert line.isprintable()
    assert len(line) <= 1000


def test_every_door_is_known() -> None:
    """A module that reads files in a new place needs a reader here."""
    found = set()
    for folder in ("formulations", "metaheuristics", "compare"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                if isinstance(node, ast.Call) and _reads(node.func):
                    found.add(path.relative_to(ROOT).as_posix())
    assert found == set(DOORS)


def _reads(call: ast.expr) -> bool:
    if isinstance(call, ast.Name):
        return call.id == "read_bytes"
    if not isinstance(call, ast.Attribute) or call.attr not in _READING:
        return False
    owner = call.value.func if isinstance(call.value, ast.Call) else call.value
    name = owner.attr if isinstance(owner, ast.Attribute) else getattr(owner, "id", "")
    return call.attr in ("read_text", "read_bytes") or name in _OF
