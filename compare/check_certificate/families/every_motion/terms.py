"""The terms of an inequality about one joint on one leg, as it stands or times the duration T.

As it stands, positions are over T: u = 1 / T and p = e / T have to exist. Times T there is no quotient, so
the inequality holds for T = 0 too:

    position   speed   acceleration   limits of velocity, acceleration, jerk
    c u + p      v        W = T a        1     T     T^2
    c + e      g = T v    X = T^2 a      T    T^2    T^3
"""

from __future__ import annotations

from typing import Any

from compare.check_certificate.answers import need
from compare.check_certificate.balls import R
from compare.check_certificate.families.every_motion.setting import LegName, Setting, Variable

_ONE: Variable = ("1",)
Inequality = tuple[dict[Variable, Any], Any]


class LegTerms:
    """A sum of terms that is at most 0.

    whole: whether it is times T.
    """

    def __init__(self, setting: Setting, j: int, k: LegName, *, whole: bool) -> None:
        self.setting, self.j, self.k, self.whole = setting, j, k, whole
        self._row: dict[Variable, Any] = {_ONE: R(0)}

    def add(self, key: Variable, x: Any) -> None:
        """Add a term; a variable may occur twice, where a cycle has one leg.

        Parameters
        ----------
        key : tuple
            The variable.
        x : arb
            Its coefficient.
        """
        self._row[key] = self._row.get(key, R(0)) + x

    def constant(self, x: Any) -> None:
        """Add x that is a position.

        Parameters
        ----------
        x : arb [rad]
        """
        self.add(_ONE if self.whole else ("u", self.k), x)

    def offset(self, end: int, x: int) -> None:
        """Add x e, where there is a zone.

        Parameters
        ----------
        end : int
            0 where the leg starts, 1 where it ends.
        x : int
        """
        e = self.setting.at_end("e", self.k, self.j, end)
        if e in self.setting.boxes:
            self.add(e if self.whole else ("p", self.k, self.j, end), R(x))

    def speed(self, end: int, x: Any) -> None:
        """Add x v.

        Parameters
        ----------
        end : int
            0 where the leg starts, 1 where it ends.
        x : arb
        """
        whole = "g", self.k, self.j, end
        self.add(whole if self.whole else self.setting.at_end("v", self.k, self.j, end), x)

    def turn(self, end: int, x: Any) -> None:
        """Add x W.

        Parameters
        ----------
        end : int
            0 where the leg starts, 1 where it ends.
        x : arb
        """
        self.add(("X" if self.whole else "W", self.k, self.j, end), x)

    def less(self, order: int, x: Any, limit: Any) -> None:
        """Subtract x times a limit, which may be missing where x is 0.

        Parameters
        ----------
        order : int
            1: of velocity, 2: of acceleration, 3: of jerk.
        x, limit : arb
        """
        need(limit is not None or x == 0, f"a row needs a limit that joint {self.j + 1} does not have")
        if limit is not None:
            power = (None, "T", "q", "r")[order - 1 + self.whole]
            self.add((power, self.k) if power else _ONE, -x * limit)

    def inequality(self) -> Inequality:
        """Bring what is constant to the right.

        Returns
        -------
        Inequality
            Coefficients by variable, and the right-hand side.
        """
        return self._row, -self._row.pop(_ONE)
