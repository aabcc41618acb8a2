"""The errors that timebound raises on purpose. Each message is one line that names the key and the value."""

from __future__ import annotations

_LONGEST = 1000  # characters of a message; the rest of a longer one is left out


class InputError(ValueError):
    """What a person typed or wrote into a file cannot be used; commands exit with code 2.

    The message is one short line that a terminal can show, whatever names and files contain.
    """

    def __init__(self, message: str) -> None:
        line = " ".join(message.split())
        if not line.isprintable():
            line = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in line)
        if len(line) > _LONGEST:
            line = f"{line[: _LONGEST // 2]} ... {line[5 - _LONGEST // 2 :]}"
        super().__init__(line)


class UnsupportedProblem(InputError):  # noqa: N818  # a refusal, not a failure
    """The problem is legal, but this family or reference has no meaning for it."""


class NoFeasibleMotion(RuntimeError):  # noqa: N818  # the answer, in a word
    """No motion was found that keeps the position limits and the conditions asked for."""


class NotFoundInTime(NoFeasibleMotion):
    """The time was over before a motion was found that keeps the conditions."""


class OutOfReach(InputError):  # noqa: N818  # a refusal, not a failure
    """No joint positions within the limits reach a pose.

    Attributes
    ----------
    distance : float
        How far the tool stays away from the pose's position [m].
    """

    def __init__(self, message: str, distance: float) -> None:
        super().__init__(message)
        self.distance = distance
