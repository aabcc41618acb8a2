"""A DH table as it is printed: its form, its units, its numbers."""

from __future__ import annotations

from dataclasses import dataclass

from formulations.arms.kinematics import Chain
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.joint_words import METRES, UNITS

FORMS = ("standard", "modified")


@dataclass(frozen=True)
class DHTable:
    """A printed table of Denavit-Hartenberg parameters of revolute joints.

    Attributes
    ----------
    d, a : Array, shape (dof,)
        Link offsets and lengths, in the unit ``length``.
    alpha, offset : Array, shape (dof,)
        Link twists, and the DH angles at joint position 0, in the unit ``angle``.
    sign : Array, shape (dof,)
        +1 or -1, the sense of each joint.
    form : str
        standard: row i holds a_i and alpha_i; modified (Craig): row i holds a_{i-1} and alpha_{i-1}.
    length, angle : str
        m or mm; rad or deg.
    """

    d: Array
    a: Array
    alpha: Array
    offset: Array
    sign: Array
    form: str = "standard"
    length: str = "m"
    angle: str = "rad"

    def __post_init__(self) -> None:
        for key, value, known in (
            ("form", self.form, FORMS),
            ("length", self.length, tuple(METRES)),
            ("angle", self.angle, tuple(UNITS)),
        ):
            if value not in known:
                raise InputError(f"{key}: {value!r:.50} is not one of {', '.join(known)}")

    @property
    def dof(self) -> int:
        """Number of joints."""
        return len(self.d)

    def chain(self) -> Chain:
        """Read the table in its form and units.

        Returns
        -------
        Chain
        """
        metre, radian = METRES[self.length], UNITS[self.angle]
        make = Chain if self.form == "standard" else Chain.modified
        return make(
            self.d * metre, self.a * metre, self.alpha * radian, self.offset * radian, self.sign
        )
