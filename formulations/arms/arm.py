"""An arm: the printed DH table beside the one that fits its paper's own numbers."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from formulations.arms.dh_table import DHTable
from formulations.arms.kinematics import Chain
from formulations.kinematics.link_chain import LinkChain
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError

ARMS: tuple[str, ...] = tuple(
    sorted(
        entry.name.removesuffix(".toml")
        for entry in files("formulations.arms").iterdir()
        if entry.name.endswith(".toml")
    )
)


@dataclass(frozen=True)
class Arm:
    """An arm with rotary joints.

    Attributes
    ----------
    name, title, source : str
    notes : str
        How the printed table was read, and how well the reading fits.
    chain : Chain
        The DH table as read.
    printed : Chain
        The DH table as the paper prints it.
    position : Array, shape (dof, 2)
        Joint limits [rad], infinite where none are known.
    """

    name: str
    title: str
    source: str
    notes: str
    chain: Chain
    printed: Chain
    position: Array

    @property
    def dof(self) -> int:
        """Number of joints."""
        return len(self.chain.d)

    @property
    def tool(self) -> LinkChain:
        """The chain from base to flange, as a problem takes it."""
        return self.chain.links


@cache
def load_arm(name: str) -> Arm:
    """Load a shipped arm.

    Parameters
    ----------
    name : str
        One of ``ARMS``: sr4c (Wang 2025), bagging (Li 2022), ur5 (Zhou 2025), z1 (Lu & Wang 2024), cobot
        (Zhang 2025).

    Returns
    -------
    Arm

    Raises
    ------
    InputError
        If there is no arm of that name; the message lists the names.
    """
    if name not in ARMS:
        raise InputError(f"arm: {name!r} is not known (known: {', '.join(ARMS)})")
    data = tomllib.loads((files("formulations.arms") / f"{name}.toml").read_text("utf-8"))
    resolved = data["resolved"]
    unlimited = [[-np.inf, np.inf]] * len(resolved["d"])
    return Arm(
        name=data["name"],
        title=data["title"],
        source=data["source"],
        notes=data["notes"].strip(),
        chain=_table(resolved).chain(),
        printed=_table(data["printed"]).chain(),
        position=np.deg2rad(np.array(resolved.get("position", unlimited), dtype=np.float64)),
    )


def _table(table: dict[str, Any]) -> DHTable:
    dof = len(table["d"])
    return DHTable(
        d=np.array(table["d"], dtype=np.float64),
        a=np.array(table["a"], dtype=np.float64),
        alpha=np.array(table["alpha"], dtype=np.float64),
        offset=np.array(table.get("offset", [0.0] * dof), dtype=np.float64),
        sign=np.array(table.get("sign", [1.0] * dof), dtype=np.float64),
        form=table.get("form", "standard"),
        length=table["length"],
        angle="deg",
    )
