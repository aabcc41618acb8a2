"""The keys of ``[conditions]`` about torques, read and written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from formulations.problem.errors import InputError
from formulations.problem.joint_words import joint_label
from formulations.problem.toml_file.joint_values import by_joint
from formulations.problem.toml_file.toml_values import known_keys, read_number, read_text, shown
from formulations.problem.torque import EARTH, Payload, TorqueLimits

TORQUE_KEYS = ("torque", "payload", "gravity", "urdf")
_PAYLOAD_KEYS = ("mass", "com", "link")


def torque_of_table(
    table: Mapping[str, Any], names: Sequence[str], dof: int, urdf: Path | None
) -> TorqueLimits | None:
    """Read torque limits.

    Parameters
    ----------
    table : mapping
        The table ``[conditions]``.
    names : sequence of str
        Of the joints.
    dof : int
        Number of joints.
    urdf : Path or None
        The URDF of the problem's robot.

    Returns
    -------
    TorqueLimits or None
        None where there are none.

    Raises
    ------
    InputError
        In one line that names the key and the value.
    """
    value = table.get("torque")
    if value is None or value is False:
        for key in TORQUE_KEYS[1:]:
            if key in table:
                raise InputError(f"conditions.{key}: has no meaning without torque")
        return None
    limits = None
    if value is not True:
        read = by_joint("conditions.torque", value, names, dof, read_number)
        for joint in range(dof):
            if joint not in read:
                raise InputError(f"conditions.torque: {joint_label(names, joint)}: missing")
        limits = tuple(read[joint] for joint in range(dof))
    payload = _payload(table["payload"]) if "payload" in table else None
    gravity = _three("conditions.gravity", table["gravity"]) if "gravity" in table else EARTH
    if "urdf" in table:
        text = read_text("conditions.urdf", table["urdf"])
        return TorqueLimits(text, tuple(names), limits, payload, gravity, "conditions.urdf")
    if urdf is None:
        raise InputError('conditions.torque: needs a robot (key robot = "FILE.urdf")')
    return TorqueLimits.from_urdf(urdf, names, limits=limits, payload=payload, gravity=gravity)


def table_of_torque(torque: TorqueLimits | None) -> dict[str, Any]:
    """Return torque limits as ``torque_of_table`` reads them, the URDF as text.

    Parameters
    ----------
    torque : TorqueLimits or None

    Returns
    -------
    dict
        Plain data; empty for None.
    """
    if torque is None:
        return {}
    found: dict[str, Any] = {
        "torque": True if torque.limits is None else list(torque.limits),
        "gravity": list(torque.gravity),
        "urdf": torque.urdf,
    }
    if torque.payload is not None:
        link = {} if torque.payload.link is None else {"link": torque.payload.link}
        found["payload"] = {"mass": torque.payload.mass, "com": list(torque.payload.com), **link}
    return found


def _payload(value: Any) -> Payload:
    key = "conditions.payload"
    if not isinstance(value, dict):
        return Payload(read_number(key, value))
    known_keys(key, value, _PAYLOAD_KEYS)
    if "mass" not in value:
        raise InputError(f"{key}.mass: missing")
    com = _three(f"{key}.com", value["com"]) if "com" in value else (0.0, 0.0, 0.0)
    link = read_text(f"{key}.link", value["link"]) if "link" in value else None
    return Payload(read_number(f"{key}.mass", value["mass"]), com, link)


def _three(key: str, value: Any) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3:
        raise InputError(f"{key}: expected three numbers, got {shown(value)}")
    x, y, z = np.array([read_number(key, one) for one in value]).tolist()
    return (x, y, z)
