"""The DH table that a paper prints, with what its rounded digits leave open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.audit.paper.digits import halves, row, values
from formulations import InputError
from formulations.arms import Arm, DHTable
from formulations.problem.joint_words import METRES, UNITS
from formulations.robot.text.files import known_names

_PARTS = ("d", "a", "alpha", "offset", "sign")
_JOINTS = ("revolute", "prismatic")
_LONGEST = 1e4  # m: a link beyond is a mistaken unit


@dataclass(frozen=True)
class PrintedDH:
    """A printed DH table.

    Attributes
    ----------
    where : str
        The place in the paper.
    table : DHTable
        At the printed digits.
    length_half, angle_half : float
        Sum of the half units of all lengths and of all angles, in the units of the table.
    """

    where: str
    table: DHTable
    length_half: float
    angle_half: float

    def arm(self, name: str) -> Arm:
        """Make the arm of the table, with joints that turn without limits.

        Parameters
        ----------
        name : str
            Of the paper.

        Returns
        -------
        Arm
        """
        chain = self.table.chain()
        everywhere = np.tile([-np.inf, np.inf], (self.table.dof, 1))
        return Arm(name, name, self.where, "", chain, chain, everywhere)

    @property
    def blur(self) -> tuple[float, float]:
        """Bounds on how far the rounding of the table moves [m] and turns [rad] the tool.

        A length moves all that follows by no more than its half unit. An angle turns it by no more than its
        half unit, about an axis that is at most the whole arm away from the tool.
        """
        chain = self.table.chain()
        turn = self.angle_half * UNITS[self.table.angle]
        whole = float(np.abs(chain.d).sum() + np.abs(chain.a).sum() + np.linalg.norm(chain.base[:3, 3]))
        return self.length_half * METRES[self.table.length] + turn * whole, turn


def read_dh(table: dict[str, Any], dof: int | None) -> PrintedDH:
    """Read the table [dh] of a file.

    Parameters
    ----------
    table : dict
        Its keys are checked.
    dof : int or None
        Joints of the waypoints, if they are printed.

    Returns
    -------
    PrintedDH

    Raises
    ------
    InputError
        One line that names the key.
    """
    for number, joint in enumerate(table.get("joints", []), start=1):
        if joint not in _JOINTS:
            raise InputError(f"dh: joints: {joint!r:.50}; {known_names(str(joint), _JOINTS)}")
        if joint == "prismatic":
            raise InputError(
                f"dh: joints: joint {number} is 'prismatic'; the audit reads arms of revolute joints only: "
                f"leave out [dh] and the points"
            )
    width = len(table["d"]) if dof is None else dof
    parts = {key: row(f"dh: {key}", table[key], width) for key in _PARTS if key in table}
    if "joints" in table and len(table["joints"]) != width:
        raise InputError(f"dh: joints: {len(table['joints'])} values where {width} are expected")
    numbers = {key: values(part) for key, part in parts.items()}
    sign = numbers.get("sign", np.ones(width))
    if not (np.abs(sign) == 1.0).all():
        raise InputError(f"dh: sign: {sign[np.abs(sign) != 1.0][0]:g} is not 1 or -1")
    try:
        dh = DHTable(
            numbers["d"], numbers["a"], numbers["alpha"], numbers.get("offset", np.zeros(width)), sign,
            form=table["form"], length=table["length"], angle=table["angle"],
        )  # fmt: skip
    except InputError as error:
        raise InputError(f"dh: {error}") from None
    for key in ("d", "a"):
        longest = float(np.abs(numbers[key]).max()) * METRES[dh.length]
        if longest > _LONGEST:
            raise InputError(
                f"dh: {key}: {longest:g} m is longer than {_LONGEST:g} m: a mistaken unit?"
            )
    length, angle = (
        float(sum(halves(parts[key]).sum() for key in keys if key in parts))
        for keys in (("d", "a"), ("alpha", "offset"))
    )
    return PrintedDH(table.get("where", "DH table"), dh, length, angle)
