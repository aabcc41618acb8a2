"""Files of points: laws of the round trip, what other programs write, and what is refused."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pytest
import yaml
from conftest import Array
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import InputError, Trajectory, read_motion
from formulations.motion.files.csv_points import read_csv
from formulations.motion.files.decimals import decimals_of, read_records, write_records
from formulations.motion.files.formats import FORMATS
from formulations.motion.files.joint_trajectory import read_json, read_yaml
from formulations.motion.files.motion_file import decode_motion, encode_motion, read_points
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.files.pieces import read_pieces, write_pieces

SUFFIXES = [entry.suffixes[0] for entry in FORMATS]
NAMES = st.lists(
    st.text(st.characters(exclude_categories=["C", "Z"]), min_size=1, max_size=12),
    min_size=1, max_size=4, unique=True,
)  # fmt: skip


@st.composite
def motions(draw: st.DrawFn) -> MotionPoints:
    """Points of any size, on whole nanoseconds."""
    names = tuple(draw(NAMES))
    count = draw(st.integers(2, 6))
    numbers = st.floats(-1e9, 1e9)
    rows = st.lists(
        st.lists(numbers, min_size=len(names), max_size=len(names)), min_size=count, max_size=count
    )
    steps = draw(st.lists(st.integers(1, 10**12), min_size=count, max_size=count))
    stated = draw(st.integers(1, 3))
    values = [np.array(draw(rows)) if k < stated else None for k in range(3)]
    assert values[0] is not None
    return MotionPoints(np.cumsum(steps) / 1e9, values[0], values[1], values[2], names)


def points(text: str, name: str, folder: Path) -> MotionPoints:
    (folder / name).write_text(text)
    return read_points(folder / name)


def loss(before: Array | None, after: Array | None) -> float:
    """Largest error over the largest value of its column."""
    if before is None or after is None:
        assert before is after
        return 0.0
    largest = np.maximum(np.abs(before).max(axis=0), 1e-6)
    return float((np.abs(after - before) / largest).max())


@pytest.mark.parametrize("suffix", SUFFIXES)
@given(motion=motions())
@settings(deadline=None, max_examples=60)
def test_nothing_is_lost_beyond_the_seventeenth_digit(suffix: str, motion: MotionPoints) -> None:
    back = decode_motion(f"m{suffix}", encode_motion(f"m{suffix}", motion))
    assert isinstance(back, MotionPoints)
    counted = [tuple(f"{p}{j + 1}" for j in range(len(motion.names))) for p in ("", "joint_")]
    assert back.names == motion.names or (not back.names and motion.names in counted)
    assert np.array_equal(back.times, motion.times)  # whole nanoseconds: bit by bit
    for before, after in (
        (motion.positions, back.positions),
        (motion.velocities, back.velocities),
        (motion.accelerations, back.accelerations),
    ):
        assert loss(before, after) <= (0.0 if suffix == ".npz" else 2.3e-16)


@given(
    durations=st.lists(st.floats(1e-9, 1e9), min_size=1, max_size=4),
    numbers=st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=8),
)
@settings(deadline=None)
def test_pieces_come_back_bit_by_bit(durations: list[float], numbers: list[float]) -> None:
    coefficients = np.resize(np.array(numbers), (len(durations), 2, 4))
    motion = Trajectory(np.array(durations), coefficients, np.array([0.0, 0.1]))
    back, names = read_pieces(write_pieces(motion, ("a", "b")), "m.pieces.json")
    assert names == ("a", "b")
    assert back.passages is not None
    for before, after in (
        (motion.durations, back.durations),
        (motion.coefficients, back.coefficients),
        (np.array([0.0, 0.1]), back.passages),
    ):
        assert before.tobytes() == after.tobytes()


@given(st.lists(st.floats(-1e9, 1e9) | st.decimals(-1000, 1000, places=6).map(float), min_size=1))
@settings(deadline=None)
def test_written_numbers_are_those_of_python(numbers: list[float]) -> None:
    column = np.array(numbers)[:, None]
    text = write_records(column, decimals_of(column), [b"", b"\n"]).decode()
    assert "e" not in text  # YAML 1.1 takes 1e-05 for text
    assert all("." in line for line in text.splitlines())
    read = np.array([float(line) for line in text.splitlines()])
    assert np.abs(read - column[:, 0]).max() <= 2.3e-16 * np.abs(column).max() + 5.1e-23


@given(
    st.lists(
        st.from_regex(r"-?(0|[1-9]\d{0,20})(\.\d{1,25})?([eE][-+]?\d{1,2})?", fullmatch=True),
        min_size=1,
    )
)
@settings(deadline=None, max_examples=300)
def test_numbers_are_rounded_as_python_rounds_them(texts: list[str]) -> None:
    ascii_ = [text for text in texts if text.isascii()]
    data = "\n".join(ascii_).encode()
    values, end = read_records(data, 0, b"\0", b"\n", len(ascii_))
    assert end == len(data)
    assert values[:, 0].tolist() == [float(text) for text in ascii_]


@pytest.mark.parametrize("text", ["01", "+1", ".5", "5.", "1e", "nan", "--1", "1_0", ""])
def test_what_is_no_number_of_json_is_not_read_at_once(text: str) -> None:
    values, end = read_records(f"1\n{text}\n".encode(), 0, b"\0", b"\n", 5)
    assert len(values) < 2 or end < len(text) + 2


@given(motion=motions())
@settings(deadline=None, max_examples=40)
def test_reading_at_once_and_one_by_one_agree(motion: MotionPoints) -> None:
    for suffix, read in ((".csv", read_csv), (".json", read_json), (".yaml", read_yaml)):
        data = encode_motion(f"m{suffix}", motion)
        first, second = read(data, "m"), read(data, "m", records=False)
        assert first.names == second.names
        for one, other in (
            (first.times, second.times),
            (first.positions, second.positions),
            (first.velocities, second.velocities),
            (first.accelerations, second.accelerations),
        ):
            assert (one is None and other is None) or np.array_equal(one, other)  # type: ignore[arg-type]


def test_other_readers_read_what_is_written(tmp_path: Path) -> None:
    tiny = np.array([[1e-5, 2.0], [3e-7, -1e-12]])
    motion = MotionPoints(np.array([0.0, 0.008]), tiny, tiny, tiny, ("elbow", "wrist: 2"))
    for suffix in SUFFIXES:
        (tmp_path / f"m{suffix}").write_bytes(encode_motion(f"m{suffix}", motion))
    first, *rows = list(csv.reader(io.StringIO((tmp_path / "m.csv").read_text())))
    assert first[:3] == ["time", "position_elbow", "position_wrist: 2"]
    np.testing.assert_allclose([float(x) for x in rows[1]], [0.008, *[3e-7, -1e-12] * 3], rtol=1e-9)
    for data in (
        json.loads((tmp_path / "m.json").read_text()),
        yaml.safe_load((tmp_path / "m.yaml").read_text()),  # YAML 1.1, as ros2 topic pub reads it
    ):
        assert data["joint_names"] == ["elbow", "wrist: 2"]
        assert data["points"][1]["time_from_start"] == {"sec": 0, "nanosec": 8_000_000}
        np.testing.assert_allclose(data["points"][0]["velocities"], tiny[0], rtol=1e-9)
    with np.load(tmp_path / "m.npz", allow_pickle=False) as arrays:
        assert np.array_equal(arrays["acceleration"], tiny)
        assert arrays["joint_names"].tolist() == ["elbow", "wrist: 2"]


MESSAGE = """
joint_names: [b, a]
points:
- positions: [1, 2]
  velocities: [0, 0]
  accelerations: []
  effort: []
  time_from_start: {TIME0}
- positions: [3, 4.5]
  velocities: [0, 0]
  time_from_start: {TIME1}
"""


@pytest.mark.parametrize("wrap", ["", "joint_trajectory", "trajectory"])
@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("{sec: 0, nanosec: 0}", "{sec: 1, nanosec: 500000000}"),
        ("{secs: 0, nsecs: 0}", "{secs: 1, nsecs: 500000000}"),
        ("0", "1.5"),
        ("{nanosec: 0}", "{sec: 1, nanosec: 500000000}"),
    ],
)
def test_messages_of_ros_and_moveit(wrap: str, first: str, second: str, tmp_path: Path) -> None:
    text = MESSAGE.replace("{TIME0}", first).replace("{TIME1}", second)
    if wrap:
        text = f"{wrap}:\n" + "".join(f"  {line}\n" for line in text.splitlines() if line)
    for name, content in (("m.yaml", text), ("m.json", json.dumps(yaml.safe_load(text)))):
        found = points(content, name, tmp_path)
        assert found.names == ("b", "a")
        assert found.times.tolist() == [0.0, 1.5]
        assert found.positions.tolist() == [[1.0, 2.0], [3.0, 4.5]]
        assert found.velocities is not None
        assert found.accelerations is None
        cubic = read_motion(tmp_path / name)
        assert cubic.coefficients.shape == (1, 2, 4)
        assert cubic.at(0.75).tolist() == [2.0, 3.25]


def test_columns_by_name_in_any_order(tmp_path: Path) -> None:
    found = points(
        "position_b,time,velocity_a,position_a,velocity_b\n1,0,5,2,6\n3,1,7,4,8\n", "m.csv", tmp_path
    )
    assert found.names == ("b", "a")
    assert found.positions.tolist() == [[1, 2], [3, 4]]
    assert found.velocities is not None
    assert found.velocities.tolist() == [[6, 5], [8, 7]]
    only = points("time;position_1\n0;0,5\n1;1,5\n", "m.csv", tmp_path)
    assert only.positions.tolist() == [[0.5], [1.5]]
    assert read_motion(tmp_path / "m.csv").at(0.25).tolist() == [0.75]  # positions only: a line


def test_the_waypoints_are_found(tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_text("time,position_1\n0,0\n1,1\n3,0\n")
    motion = read_motion(tmp_path / "m.csv", waypoints=np.array([[0.0], [1.0], [0.5], [0.0]]))
    np.testing.assert_allclose(motion.passage_times, [0.0, 1.0, 2.0, 3.0], atol=1e-7)
    with pytest.raises(InputError, match="one of the two"):
        read_motion(tmp_path / "m.csv", waypoints=np.zeros((2, 1)), passages=np.zeros(2))


def _points(*rows: str) -> str:
    return '{"joint_names": ["a"], "points": [' + ", ".join(rows) + "]}"


A, B = (f'{{"positions": [1], "time_from_start": {k}}}' for k in range(2))
REFUSED = [
    ("m.json", _points('{"positions": [1], "velocities": [0], "time_from_start": 0}',
                       '{"positions": [2], "time_from_start": 1}'),
     "points[1]: no velocities, and points[0] has them"),
    ("m.json", _points(A, A),
     "point 2 is at 0 s, point 1 at 0 s"),
    ("m.json", _points(A.replace("[1]", "[NaN]"), B),
     "points[0].positions[0]: nan is not a finite number"),
    ("m.json", _points('{"positions": [1, 2], "time_from_start": 0}'), "2 positions for 1 joints (a)"),
    ("m.json", _points(A.replace("}", ', "velocites": [2]}')),
     "nearest known one is 'velocities'"),
    ("m.json", _points('{"positions": [1]}'), "time_from_start is missing"),
    ("m.json", _points(A.replace("0}", '{"sec": 0.5, "nanosec": 0}}')), "not a whole number"),
    ("m.json", _points('{"positions": [1], "accelerations": [0], "time_from_start": 0}',
                       '{"positions": [1], "accelerations": [0], "time_from_start": 1}'),
     "accelerations are given, but no velocities"),
    ("m.json", '{"pieces": [{"seconds": 0, "coefficients": [[1]]}]}', "0 is not positive"),
    ("m.json", '{"pieces": [{"seconds": 1, "coefficients": [[1], [2]]}, '
               '{"seconds": 1, "coefficients": [[1]]}]}',
     "1 joints where 2 are expected"),
    ("m.csv", "time,position_a,velocity_b\n0,1,2\n1,2,3\n", "no column position_b"),
    ("m.csv", "time,position_a,position_b,velocity_b\n0,1,2,3\n1,2,3,4\n", "no velocity column for joint 'a'"),
    ("m.csv", "time,position_a,postion_b\n0,1,2\n1,2,3\n", "unknown column 'postion_b'"),
    ("m.csv", "time,position_a,position_a\n0,1,2\n1,2,3\n", "given twice"),
    ("m.csv", "position_a\n1\n2\n", "column 'time' is missing"),
    ("m.csv", "0,1\n1,2\n", "the first row must name the columns"),
    ("m.csv", "time,position_a\n0,1\n1,1e300\n", "1e+300 is beyond 1e+09"),
    ("m.yaml", "a: &a [1]\nb: *a\n", "anchors are not read"),
    ("m.npz", "PK", "not an NPZ file"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "text", "message"), REFUSED)
def test_what_is_no_motion_is_refused_in_one_line(
    name: str, text: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError) as caught:
        points(text, name, tmp_path)
    assert message in str(caught.value)
    assert name in str(caught.value)
    assert "\n" not in str(caught.value)


def test_hostile_npz_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def npz(**members: bytes) -> Path:
        with zipfile.ZipFile(tmp_path / "m.npz", "w", zipfile.ZIP_DEFLATED) as archive:
            for key, data in members.items():
                archive.writestr(f"{key}.npy", data)
        return tmp_path / "m.npz"

    def npy(array: object, **more: bool) -> bytes:
        stream = io.BytesIO()
        np.save(stream, array, **more)  # type: ignore[arg-type]
        return stream.getvalue()

    pickled = npy(np.array([print], dtype=object), allow_pickle=True)
    huge = npy(np.zeros(2)).replace(b"(2,)", b"(9999999999999,)")
    for members, message in (
        ({"time": pickled}, "expected numbers or text"),
        ({"time": huge}, "time: "),
        ({"time": npy(np.zeros((2, 2))), "position": npy(np.zeros((2, 1)))}, "(n_points,)"),
        ({"tme": npy(np.zeros(2))}, "nearest known one is 'time'"),
        ({"time": npy(np.arange(2.0))}, "'position' is missing"),
    ):
        with pytest.raises(InputError) as caught:
            read_points(npz(**members))
        assert message in str(caught.value), message
    with zipfile.ZipFile(tmp_path / "m.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("time.npy", b"\0" * 1_100_000)
    monkeypatch.setattr("formulations.motion.files.npz._LARGEST", 1_000_000)
    with pytest.raises(InputError, match="unpacked"):
        read_points(tmp_path / "m.npz")


@given(st.data())
@settings(deadline=None, max_examples=300)
def test_a_broken_byte_is_one_line_or_a_motion(data: st.DataObject) -> None:
    line = np.linspace(0.0, 1.0, 3)[:, None]
    motion = MotionPoints(line[:, 0], line, line, line, ("a",))
    suffix = data.draw(st.sampled_from([*SUFFIXES, ".pieces.json", ""]))
    origin = data.draw(st.sampled_from(SUFFIXES))
    text = bytearray(
        write_pieces(motion.motion(), ("a",))
        if suffix == ".pieces.json"
        else encode_motion(f"m{origin}", motion)
    )
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text) - 1))
        text[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=4))
    with contextlib.suppress(InputError):  # one line by its constructor; anything else is a fault
        decode_motion(f"m{suffix}", bytes(text))
