"""What a certificate proves, in words."""

from __future__ import annotations

from typing import Any

from compare.check_certificate.answers import BadInput
from compare.check_certificate.claim import Claim
from compare.check_certificate.every_motion import EveryMotion
from compare.check_certificate.four_three_four import FourThreeFour
from compare.check_certificate.quintic import Quintic
from compare.check_certificate.relaxation import Relaxation
from compare.check_certificate.three_five_three import ThreeFiveThree
from compare.check_certificate.words import proof_in_words


def verify(data: Any, *, show: bool = False) -> str:
    """What a certificate proves, in words; show: its last sum too, if it is one of inequalities.

    Raises Refused or BadInput.
    """
    claim = Claim(data)
    trees: dict[str, Any] = {
        "3-5-3": ThreeFiveThree,
        "4-3-4": FourThreeFour,
        "quintic": Quintic,
        "b-spline-3": EveryMotion,
        "b-spline-5": EveryMotion,
        "every-motion": Relaxation,
    }
    if claim.family not in trees:
        raise BadInput(f"family: {claim.family:.40} is not one of {', '.join(trees)}")
    tree = trees[claim.family](claim)
    discards = 0 if tree.void else tree.replay()
    every = isinstance(tree, Relaxation)
    words = (
        f"no {'motion' if every else f'{claim.family} motion'} of {str(data.get('name'))[:60]!r} "
        f"takes {float(claim.L):.12g} s or less "
        f"({len(claim.events)} events, {discards} {'rows' if every else 'discards'})"
    )
    return "\n".join([words, *proof_in_words(tree)]) if show and every else words
