"""Limits of real arms, from their data sheets: ``arms.toml``."""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

DECIMALS = 4  # of rad and m: no number of an instance depends on how a machine rounds its last bit


@dataclass(frozen=True)
class ArmSheet:
    """What a maker publishes of an arm, in rad, m and s, rounded to ``DECIMALS``.

    Attributes
    ----------
    name, title : str
    source, assumed : str
        Where the numbers come from; which of them are assumptions.
    units : tuple of str
        "rad" or "m" per joint.
    velocity, acceleration, jerk : tuple of float
    position : tuple of (float, float)
    """

    name: str
    title: str
    source: str
    assumed: str
    units: tuple[str, ...]
    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    jerk: tuple[float, ...]
    position: tuple[tuple[float, float], ...]


@cache
def arm_sheets() -> dict[str, ArmSheet]:
    """Read the data sheets.

    Returns
    -------
    dict of str to ArmSheet
        By name, in the order of the file.
    """
    text = (files("compare.benchmark.suite") / "arms.toml").read_text("utf-8")
    found = {}
    for name, data in tomllib.loads(text).items():
        dof = len(data["velocity"])
        sliding = {joint - 1 for joint in data.get("sliding", ())}
        units = tuple("m" if j in sliding else "rad" for j in range(dof))
        scale = [math.pi / 180 if (unit, data["unit"]) == ("rad", "deg") else 1.0 for unit in units]
        velocity, acceleration, jerk = (
            tuple(round(v * s, DECIMALS) for v, s in zip(data[key], scale, strict=True))
            for key in ("velocity", "acceleration", "jerk")
        )
        position = tuple(
            (round(low * s, DECIMALS), round(high * s, DECIMALS))
            for (low, high), s in zip(data["position"], scale, strict=True)
        )
        found[name] = ArmSheet(
            name,
            data["title"],
            data["source"],
            data["assumed"],
            units,
            velocity,
            acceleration,
            jerk,
            position,
        )
    return found
