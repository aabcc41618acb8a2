"""Mutated files through every reader: an answer or one line of InputError, and nothing else.

The seeds are kept in tests/data/fuzz; what once broke a reader is kept there too. A few thousand inputs run by
default. For more: TIMEBOUND_FUZZ=1000000 python -m pytest -n 0 tests/formulations/robot/test_fuzz.py, with
TIMEBOUND_FUZZ_SEED=N for others.
"""

from __future__ import annotations

import os
import random
import time
from pathlib import Path

import numpy as np
import pytest
from robot_files import DATA

from formulations import InputError
from formulations.robot import Robot, robot_of
from formulations.robot.waypoints.poses import Poses
from formulations.robot.waypoints.reader import parse_waypoints, positions_or_poses

COUNT = int(os.environ.get("TIMEBOUND_FUZZ", "3000"))
SEED = int(os.environ.get("TIMEBOUND_FUZZ_SEED", "20261125"))
SEEDS = sorted(path for path in (DATA / "fuzz").iterdir() if path.is_file())
SOLVED = 100  # one in so many files of poses is solved too: it takes a tenth of a second
FREE = ("acceleration", "jerk", "position")
SLOWEST = 5.0  # s of this process for one file

TOKENS = [
    b"nan",
    b".nan",
    b"inf",
    b"-.inf",
    b"1e300",
    b"-1e300",
    b"1e-300",
    b"9" * 400,
    b"0x10",
    b"1_000",
    b"-0",
    b"1e999",
    b"true",
    b"null",
    b"~",
    b"[]",
    b"{}",
    b"[[[[[[",
    b"{a: ",
    b"&a ",
    b"*a",
    b"<<: ",
    b"!!python/object:os.system ",
    b"!degrees ",
    b"!!binary ",
    b"? ",
    b"- ",
    b"---\n",
    b"...\n",
    b"|\n",
    b">\n",
    b"%YAML 1.1\n",
    b"#",
    b"'",
    b'"',
    b"\t",
    b"\0",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\xc3",
    b"\xed\xa0\x80",
    b"\xe2\x80\xa8",
    b"\x1b[2J",
    b"\r",
    b"\n\n",
    b",",
    b";",
    b":",
    b"<",
    b">",
    b"/>",
    b"<!DOCTYPE a>",
    b"<!ENTITY a 'b'>",
    b"&amp;",
    b"&lt;",
    b"&x;",
    b"<![CDATA[",
    b"]]>",
    b"<?x?>",
    b"<!--",
    b"<joint name='j1'/>",
    b"<link name='z'/>",
    b"<mimic joint='j2'/>",
    b"<limit/>",
    b"<axis xyz='0 0 0'/>",
    b"xacro:",
    b"${x}",
    b"j1",
    b"j2",
    b"f",
    b"base",
    b"tip",
    b"positions",
    b"poses",
    b"points",
    b"joint_names",
    b"joint_limits",
    b"max_velocity",
    b"has_jerk_limits",
    b"ros__parameters",
    b"revolute",
    b"floating",
    b"fixed",
    b"position_",
    b"qw",
    b"roll",
    b"../../etc/passwd",
    b"file:///etc/passwd",
    b"\xf0\x9f\xa4\x96",
    "\u0661".encode(),
    "\u2028".encode(),
    "\u00a0".encode(),
]


def mutated(rng: random.Random, data: bytes, others: list[bytes]) -> bytes:
    """The data with a few faults of the kinds that people and machines make."""
    for _ in range(1 + int(rng.expovariate(0.5))):
        at = rng.randrange(len(data) + 1)
        end = min(len(data), at + int(rng.expovariate(0.1)))
        kind = rng.randrange(9)
        if kind == 0:
            data = data[:at] + rng.choice(TOKENS) + data[end:]
        elif kind == 1:
            data = data[:at] + rng.choice(TOKENS) + data[at:]
        elif kind == 2:
            data = data[:at] + data[end:]
        elif kind == 3:
            data = data[:at] + data[at:end] * rng.randrange(2, 5) + data[end:]
        elif kind == 4:
            data = data[:at] + bytes([rng.randrange(256)]) + data[at + 1 :]
        elif kind == 5:
            lines = data.split(b"\n")
            rng.shuffle(lines) if rng.random() < 0.1 else lines.insert(
                rng.randrange(len(lines) + 1), rng.choice(lines)
            )
            data = b"\n".join(lines)
        elif kind == 6:
            lines = data.split(b"\n")
            del lines[rng.randrange(len(lines))]
            data = b"\n".join(lines)
        elif kind == 7:
            other = rng.choice(others)
            start = rng.randrange(len(other) + 1)
            data = data[:at] + other[start : start + rng.randrange(200)] + data[end:]
        else:
            words = data.split(b" ")
            words[rng.randrange(len(words))] = rng.choice(TOKENS)
            data = b" ".join(words)
    return data


class Readers:
    """Every reader, on a file of this name and these bytes."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.arm = folder / "arm.urdf"
        self.arm.write_bytes((DATA / "fuzz" / "arm.urdf").read_bytes())
        self.robot = Robot.from_urdf(self.arm, tip="tip", unlimited=("acceleration", "jerk"))
        self.count = 0

    def read(self, name: str, data: bytes) -> None:
        """Read; raises InputError, or AssertionError for an answer that is none."""
        self.count += 1
        path = self.folder / f"input.{name.split('.', 1)[1]}"
        if name.endswith((".urdf", ".srdf", ".limits.yaml")):
            path.write_bytes(data)
        if name.endswith(".urdf"):
            self._check(robot_of(path, unlimited=FREE))
        elif name.endswith(".srdf"):
            self._check(
                robot_of(
                    self.arm, srdf=path, group=("chain", "some", "rest")[self.count % 3], unlimited=FREE
                )
            )
        elif name.endswith(".limits.yaml"):
            self._check(robot_of(self.arm, limits=path, unlimited=FREE))
        else:
            found = positions_or_poses(data, name, self.robot)
            if isinstance(found, Poses):
                assert np.isfinite(found.poses).all()
                turns = found.poses[:, :3, :3]
                np.testing.assert_allclose(
                    turns @ turns.swapaxes(1, 2), np.tile(np.eye(3), (len(turns), 1, 1)), atol=1e-9
                )
                if self.count % SOLVED:
                    return
            assert np.isfinite(parse_waypoints(data, name, self.robot)).all()

    def _check(self, robot: Robot) -> None:
        assert robot.dof >= 1
        assert np.isfinite(robot.forward(np.zeros(robot.dof))).all()
        limits = robot.limits
        assert (limits.derivatives > 0.0).all()
        assert (limits.position[:, 0] < limits.position[:, 1]).all()


@pytest.fixture
def readers(tmp_path: Path) -> Readers:
    return Readers(tmp_path)


def _tried(readers: Readers, name: str, data: bytes) -> bool:
    """Whether the input is an answer; fails on anything but an answer or one line."""
    before = time.process_time()
    try:
        readers.read(name, data)
    except InputError as error:
        message = str(error)
        assert len(message) < 1000, (name, data)
        assert message.isprintable(), (name, data, message)
        return False
    except BaseException as error:
        raise AssertionError(f"{name}: {type(error).__name__}: {error}: {data!r}") from error
    finally:
        assert time.process_time() - before < SLOWEST, (name, data)
    return True


@pytest.mark.parametrize("path", SEEDS, ids=lambda path: path.name)
def test_seeds(readers: Readers, path: Path) -> None:
    """What was broken once is refused; all else is read."""
    readers.count = 3 * SOLVED - 1  # the first group, and poses are solved
    assert _tried(readers, path.name, path.read_bytes()) != path.name.startswith("found")


def test_mutated_files_give_an_answer_or_one_line(readers: Readers) -> None:
    rng = random.Random(SEED)
    contents = [path.read_bytes() for path in SEEDS]
    answers = 0
    for _ in range(COUNT):
        k = rng.randrange(len(SEEDS))
        answers += _tried(readers, SEEDS[k].name, mutated(rng, contents[k], contents))
    assert 0 < answers < COUNT
    names = {path.name for path in readers.folder.iterdir()}
    assert names <= {"arm.urdf", "input.urdf", "input.srdf", "input.limits.yaml"}
