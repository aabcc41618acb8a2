"""Where the tests find robots: their own small files, and the URDFs of the package example-robot-data."""

from __future__ import annotations

import importlib.metadata
from pathlib import Path

import pytest

DATA = Path(__file__).parents[2] / "data"
ROBOTS = DATA / "robots"


def shared(ending: str) -> Path:
    """The file of example-robot-data whose path ends so."""
    return next(path for path in all_shared("") if path.as_posix().endswith(ending))


def all_shared(suffix: str) -> list[Path]:
    """All files of example-robot-data with a suffix."""
    try:
        files = importlib.metadata.files("example-robot-data") or []
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("example-robot-data is not installed (extra test)")
    return sorted(Path(str(file.locate())).resolve() for file in files if str(file).endswith(suffix))


def urdf(*parts: str, name: str = "arm") -> str:
    """A URDF of these elements."""
    return f'<robot name="{name}">' + "\n".join(parts) + "</robot>"


def joint(
    name: str,
    parent: str,
    child: str,
    *,
    kind: str = "revolute",
    xyz: str = "1 0 0",
    rpy: str = "0 0 0",
    axis: str = "0 0 1",
    limit: str = 'lower="-3" upper="3" velocity="2" effort="1"',
    more: str = "",
) -> str:
    """A joint with the link that it moves."""
    limits = f"<limit {limit}/>" if limit else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{limits}{more}</joint><link name="{child}"/>'
    )


def planar(*lengths: float, limit: str = 'lower="-3" upper="3" velocity="2" effort="1"') -> str:
    """An arm in the plane z = 0 with links of these lengths and a tip link at the end."""
    parts, xyz = ['<link name="base"/>'], "0 0 0"
    for k, length in enumerate(lengths):
        parent = "base" if k == 0 else f"link{k}"
        parts.append(joint(f"joint{k + 1}", parent, f"link{k + 1}", xyz=xyz, limit=limit))
        xyz = f"{length} 0 0"
    parts.append(joint("end", f"link{len(lengths)}", "tip", kind="fixed", xyz=xyz, limit=""))
    return urdf(*parts)


def written(folder: Path, name: str, text: str) -> Path:
    """A file with this text."""
    path = folder / name
    path.write_text(text, "utf-8")
    return path
