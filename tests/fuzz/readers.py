"""Every way by which a user's file enters the project: one entry per reader, each with its seeds.

A seed is a file in ``seeds/NAME``. One whose name begins with ``found`` once broke its reader and is refused;
all others are read. The reader is called on a file with the seed's suffix, in a folder that holds the files
of ``BESIDE``, which problem files name.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from compare.audit import chapter
from compare.audit.paper import load_papers
from compare.benchmark.known_times import KnownTime
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.database.connection import Database
from compare.benchmark.records.facts import AuditRecord, require_judged
from compare.benchmark.records.settings import Settings
from compare.benchmark.records.store import Store
from compare.benchmark.tuning.constants import read_constants
from compare.check_certificate import certificate_file
from compare.check_certificate.verify import verify
from compare.plain_data import read_json
from compare.studies.study import Study, _finished
from formulations import FAMILIES, InputError, Trajectory, load, read_motion
from formulations.motion.files.motion_file import read_points
from formulations.retiming.path import Path as RetimedPath
from formulations.robot import Robot, robot_of, waypoints_of
from formulations.robot.text.files import read_bytes
from formulations.robot.waypoints.poses import Poses
from formulations.robot.waypoints.reader import LARGEST_WAYPOINTS, positions_or_poses

SEEDS = Path(__file__).parent / "seeds"
BESIDE = (
    "urdf/arm.urdf",
    "srdf/arm.srdf",
    "limits/moveit.yaml",
    "limits/ros.yaml",
    "waypoints/table.csv",
)
FREE = ("acceleration", "jerk", "position")
SOLVED = 50  # one in so many files of poses is solved: it takes a tenth of a second

_robots: dict[Path, Robot] = {}


@dataclass(frozen=True)
class Reader:
    """A reader.

    ``share``: how many of a thousand inputs it gets. ``names_files``: whether a file may name others, which
    are then read. ``places``: beginnings of refusals that name something else than the file.
    """

    name: str
    read: Callable[[Path], None]
    share: int
    names_files: bool = False
    places: tuple[str, ...] = ()

    @property
    def seeds(self) -> list[Path]:
        """The files in ``seeds/NAME``."""
        return sorted((SEEDS / self.name).iterdir())


def read_urdf(path: Path) -> None:
    _is_robot(robot_of(path, unlimited=FREE))


def read_srdf(path: Path) -> None:
    group = ("chain", "some", "rest")[path.stat().st_size % 3]
    _is_robot(robot_of(path.parent / "arm.urdf", srdf=path, group=group, unlimited=FREE))


def read_limits(path: Path) -> None:
    _is_robot(robot_of(path.parent / "arm.urdf", limits=path, unlimited=FREE))


def read_waypoints(path: Path) -> None:
    robot = _arm(path.parent)
    found = positions_or_poses(read_bytes(path, largest=LARGEST_WAYPOINTS), str(path), robot)
    if isinstance(found, Poses):
        assert np.isfinite(found.poses).all()
        turns = found.poses[:, :3, :3]
        np.testing.assert_allclose(
            turns @ turns.swapaxes(1, 2), np.tile(np.eye(3), (len(turns), 1, 1)), atol=1e-9
        )
        if path.stat().st_size % SOLVED:
            return
    waypoints = waypoints_of(path, robot)
    assert np.isfinite(waypoints).all()
    assert len(waypoints) >= 2


def read_problem(path: Path) -> None:
    problem = load(path)
    assert problem.waypoints.shape == (problem.n_segments + 1, problem.dof)
    assert problem.n_segments >= 1
    assert np.isfinite(problem.waypoints).all()
    limits = problem.limits
    for values in (limits.velocity, limits.acceleration, limits.jerk):
        assert values.shape == (problem.dof,)
        assert (values > 0.0).all()
    assert (limits.position[:, 0] < limits.position[:, 1]).all()
    assert problem.family in FAMILIES


def read_paper(path: Path) -> None:
    for paper in load_papers(str(path)):
        assert paper.family in FAMILIES
        assert paper.waypoints is None or np.isfinite(paper.waypoints).all()
        for stated in paper.stated.values():
            assert (stated.derivatives > 0.0).all()


def read_any_motion(path: Path) -> None:
    motion = read_motion(path)
    assert isinstance(motion, Trajectory)
    assert motion.seconds > 0.0
    assert np.isfinite(motion.coefficients).all()
    try:
        points = read_points(path)
    except InputError:
        return  # pieces
    assert (np.diff(points.times) > 0.0).all()
    if np.ptp(points.positions, axis=0).max() > 0.0:
        RetimedPath.of(points)


def read_certificate(path: Path) -> None:
    assert "no " in verify(certificate_file.read(path), show=True)


def read_tuned(path: Path) -> None:
    for constants in read_constants(path).values():
        assert np.isfinite(np.array(list(constants.values()), dtype=np.float64)).all()


def read_store(path: Path) -> None:
    """A file of a folder of results, which ``--resume`` and ``report`` read."""
    _STORED[path.name.removeprefix("input-").removeprefix("found-").split(".")[0].split("-")[0]](path)


@dataclasses.dataclass(frozen=True)
class Counted:
    """A row of a study."""

    name: str
    count: int
    ratio: float | None


def _of_study(path: Path) -> None:
    study: Any = Study("planted", Counted, lambda: [], lambda rows: None, lambda rows, summary: "")
    assert all(
        isinstance(row, Counted) for rows in _finished(study, path, {"a", "b"}).values() for row in rows
    )


def _database(path: Path) -> None:
    store = Store(path.parent)
    store.file, store.database = path, Database(path)
    try:
        assert all(row.case for row in store.rows(every=True))
        for _, traces in store.traces():
            assert all(len(trace.evaluations) == len(trace.best) for trace in traces)
        for facts in (store.ladders, store.known_times, store.audits, store.instances, store.problems):
            facts()
        store.settings()
    finally:
        store.close()


def _audit(path: Path) -> None:
    record = _document(AuditRecord)(path)
    require_judged(record, str(path))
    chapter(record["audits"])


def _document(kind: Any) -> Callable[[Path], Any]:
    return lambda path: read_json(path, kind, "a document of a store")


_STORED: dict[str, Callable[[Path], Any]] = {
    "results": _database,
    "settings": _document(Settings),
    "ladder": _document(LadderRecord),
    "known": _document(list[KnownTime]),
    "audit": _audit,
    "study": _of_study,
}


def _arm(folder: Path) -> Robot:
    if folder not in _robots:
        _robots[folder] = Robot.from_urdf(
            folder / "arm.urdf", tip="tip", unlimited=("acceleration", "jerk")
        )
    return _robots[folder]


def _is_robot(robot: Robot) -> None:
    assert robot.dof >= 1
    assert np.isfinite(robot.forward(np.zeros(robot.dof))).all()
    limits = robot.limits
    assert (limits.derivatives > 0.0).all()
    assert (limits.position[:, 0] < limits.position[:, 1]).all()


READERS = (
    Reader("urdf", read_urdf, 130, places=("robot ", "names: ")),
    Reader("srdf", read_srdf, 60, places=("robot ",)),
    Reader("limits", read_limits, 110, places=("robot ",)),
    Reader("waypoints", read_waypoints, 150),
    Reader("problem", read_problem, 150, names_files=True),
    Reader("poses", read_problem, 5, names_files=True),
    Reader("paper", read_paper, 80),
    Reader("motion", read_any_motion, 150),
    Reader("npz", read_any_motion, 50),
    Reader("certificate", read_certificate, 50, places=("",)),
    Reader("store", read_store, 50),
    Reader("constants", read_tuned, 20),
)
