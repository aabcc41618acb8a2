"""Files that were made to harm: one line and no more, within a second, without a byte written."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from robot_files import ROBOTS, planar

from formulations import InputError
from formulations.robot import Robot, robot_of, waypoints_of
from formulations.robot.joint_limits import parse_limits
from formulations.robot.urdf import parse_urdf

READERS = ("urdf", "srdf", "limits", "csv", "json", "yaml")
SECOND = 3.0  # of this process; 0.1 to 0.6 s on an idle machine


@pytest.fixture(scope="module")
def reader(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, Path], object]:
    """Reads a file as one of READERS, with good files beside it."""
    arm = tmp_path_factory.mktemp("good") / "arm.urdf"
    arm.write_text(planar(1.0, 1.0))
    robot = Robot.from_urdf(arm)  # imports what is imported late

    def read(kind: str, path: Path) -> object:
        if kind == "urdf":
            return robot_of(path)
        if kind == "srdf":
            return robot_of(arm, srdf=path, group="arm")
        if kind == "limits":
            return robot_of(arm, limits=path)
        named = path.with_name(f"{path.name}.{kind}")
        if not named.exists():
            os.symlink(path, named)
        return waypoints_of(named, robot)

    return read


def _refused(read: Callable[[str, Path], object], kind: str, path: Path) -> str:
    before = time.process_time()
    with pytest.raises(InputError) as caught:
        read(kind, path)
    assert time.process_time() - before < SECOND
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 500
    assert message.isprintable()
    return message


def _bomb(levels: int = 12) -> dict[str, str]:
    """Text of each kind that would grow to a million million values."""
    entities = "".join(f'<!ENTITY e{k} "{f"&e{k - 1};" * 10}">' for k in range(1, levels))
    xml = f'<?xml version="1.0"?><!DOCTYPE robot [<!ENTITY e0 "ha">{entities}]><robot name="&e{levels - 1};"/>'
    yaml = "a0: &a0 [ha, ha]\n" + "".join(
        f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 10)}]\n" for k in range(1, levels)
    )
    return {"urdf": xml, "srdf": xml, "limits": yaml, "yaml": yaml}


@pytest.mark.parametrize("kind", sorted(_bomb()))
def test_bombs(reader: Callable[[str, Path], object], tmp_path: Path, kind: str) -> None:
    path = tmp_path / "bomb"
    path.write_text(_bomb()[kind])
    message = _refused(reader, kind, path)
    assert "<!DOCTYPE is not read" in message or "anchors are not read" in message


@pytest.mark.parametrize("declared", ["UTF-7", "UTF-16", "latin-1", "no-such-code"])
def test_a_declared_encoding_hides_nothing(
    reader: Callable[[str, Path], object], tmp_path: Path, declared: str
) -> None:
    path = tmp_path / "x"
    path.write_text(f'<?xml version="1.0" encoding="{declared}"?>+ADwAIQ-DOCTYPE <robot/>')
    _refused(reader, "urdf", path)
    path.write_text(f'<?xml version="1.0" encoding="{declared}"?>' + planar(1.0))
    assert isinstance(reader("urdf", path), Robot)


def test_entities_of_other_files_are_not_read(
    reader: Callable[[str, Path], object], tmp_path: Path
) -> None:
    secret = tmp_path / "secret"
    secret.write_text("do not tell")
    for text in (
        f'<!DOCTYPE robot SYSTEM "file://{secret}"><robot name="x"/>',
        f'<!DOCTYPE robot [<!ENTITY s SYSTEM "file://{secret}">]><robot name="&s;"/>',
        f'<robot name="x" xmlns:xi="http://www.w3.org/2001/XInclude"><xi:include href="{secret}"/></robot>',
        '<robot name="&s;"/>',
    ):
        path = tmp_path / "x"
        path.write_text(text)
        assert "do not tell" not in _refused(reader, "urdf", path)


DEEP = {
    "urdf": "<robot>" + "<a>" * 100_000 + "</a>" * 100_000 + "</robot>",
    "srdf": "<robot>" + "<group name='arm'>" * 10_000,
    "limits": "[" * 1_000_000,
    "yaml": "points: " + "{a: " * 200_000,
    "json": "[" * 1_000_000,
    "csv": '"' * 1_000_001 + "\n",
}
WIDE = {
    "urdf": "<robot " + " ".join(f'a{k}="1"' for k in range(200_000)) + "/>",
    "limits": "joint_limits:\n" + "".join(f"  j{k}: {{max_velocity: 1}}\n" for k in range(20_000)),
    "yaml": "? " * 500_000,
    "json": json.dumps({f"k{k}": 1 for k in range(200_000)}),
    "csv": ",".join(["1"] * 500_000),
}


@pytest.mark.parametrize("kind", sorted(DEEP))
def test_deep_nesting(reader: Callable[[str, Path], object], tmp_path: Path, kind: str) -> None:
    path = tmp_path / "deep"
    path.write_text(DEEP[kind])
    _refused(reader, kind, path)


def test_the_depth_that_is_read(reader: Callable[[str, Path], object], tmp_path: Path) -> None:
    path = tmp_path / "deep"
    for kind in ("yaml", "json"):
        path.write_text('{"a": ' * 40 + "1" + "}" * 40)
        assert "more than 32 levels deep" in _refused(reader, kind, path)
        path.write_text('{"a": ' * 20 + "1" + "}" * 20)
        assert "neither poses nor a JointTrajectory" in _refused(reader, kind, path)


@pytest.mark.parametrize("kind", sorted(WIDE))
def test_wide_files(reader: Callable[[str, Path], object], tmp_path: Path, kind: str) -> None:
    path = tmp_path / "wide"
    path.write_text(WIDE[kind])
    _refused(reader, kind, path)


@pytest.mark.parametrize("kind", READERS)
def test_a_hundred_megabytes(reader: Callable[[str, Path], object], tmp_path: Path, kind: str) -> None:
    path = tmp_path / "large"
    with open(path, "wb") as stream:
        stream.truncate(100_000_000)
    assert "100000000 bytes; at most" in _refused(reader, kind, path)


BYTES = [
    (b"", "is empty"),
    (b"\xef\xbb\xbf", "is empty"),
    (b"\xff\xfer\0o\0", "is UTF-16; save it as UTF-8"),
    (b"\xff\xfe\0\0r\0\0\0", "is UTF-32; save it as UTF-8"),
    (b"a\nb\xe9c", "line 2: byte 0xe9 is not UTF-8"),
    (b"a\n\0b", "line 2: holds a null character"),
    (b"\x1b[31m\x07\x08", ""),
    (b"\xed\xa0\x80", "is not UTF-8"),
    (os.urandom(1000).replace(b"\xff", b"\xfe") + b"\xff", ""),
]


@pytest.mark.parametrize(("data", "reason"), BYTES)
@pytest.mark.parametrize("kind", READERS)
def test_bytes_that_are_no_text(
    reader: Callable[[str, Path], object], tmp_path: Path, kind: str, data: bytes, reason: str
) -> None:
    path = tmp_path / "bytes"
    path.write_bytes(data)
    assert reason in _refused(reader, kind, path)


@pytest.mark.parametrize("kind", ["urdf", "srdf", "limits"])
def test_what_is_no_file(reader: Callable[[str, Path], object], tmp_path: Path, kind: str) -> None:
    assert "is a folder, not a file" in _refused(reader, kind, tmp_path)
    assert "no such file" in _refused(reader, kind, tmp_path / "none")
    assert "not the name of a file" in _refused(reader, kind, Path("a\0b"))
    assert "5" in _refused(reader, kind, 5)  # would be an open file
    assert "is a device or a pipe" in _refused(reader, kind, Path("/dev/zero"))
    os.mkfifo(tmp_path / "pipe")
    assert "is a device or a pipe" in _refused(reader, kind, tmp_path / "pipe")
    os.symlink(tmp_path / "loop", tmp_path / "loop")
    _refused(reader, kind, tmp_path / "loop")
    with pytest.raises(InputError, match="File name too long"):
        reader(kind, tmp_path / ("x" * 5000))


def test_a_byte_order_mark_is_accepted(reader: Callable[[str, Path], object], tmp_path: Path) -> None:
    for kind, text in (
        ("urdf", planar(1.0)),
        ("srdf", '<robot><group name="arm"><joint name="joint1"/></group></robot>'),
        ("limits", "joint_limits: {joint1: {max_velocity: 1}}"),
        ("csv", "joint1,joint2\n0,0\n1,1"),
        (
            "json",
            '{"joint_names": ["joint1", "joint2"], "points": [{"positions": [0, 0]}, {"positions": [1, 1]}]}',
        ),
    ):
        path = tmp_path / f"marked-{kind}"
        path.write_bytes(b"\xef\xbb\xbf" + text.encode())
        reader(kind, path)


def test_nothing_is_written(
    reader: Callable[[str, Path], object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Robot.from_urdf(
        ROBOTS / "iiwa7.urdf",
        srdf=ROBOTS / "iiwa7.srdf",
        group="arm",
        limits=ROBOTS / "iiwa7_joint_limits.yaml",
    )
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("package", "kind", "text"),
    [
        ("yourdfpy", "urdf", planar(1.0)),
        ("lxml", "urdf", planar(1.0)),
        ("yaml", "limits", "joint_limits: {joint1: {max_velocity: 1}}"),
    ],
)
def test_a_package_that_is_not_installed_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, package: str, kind: str, text: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    path = tmp_path / "x"
    path.write_text(text)
    parse = parse_urdf if kind == "urdf" else parse_limits
    with pytest.raises(InputError, match=r"needs the package \w+: pip install 'timebound\[robot\]'"):
        parse(text, "x")
