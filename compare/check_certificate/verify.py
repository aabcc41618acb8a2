"""Verify a certificate, whatever its family."""

from __future__ import annotations

from typing import Any

from compare.check_certificate.answers import BadInput
from compare.check_certificate.claim import EVERY_MOTION, Claim
from compare.check_certificate.families.b_spline.tree import BSplineTree
from compare.check_certificate.families.every_motion.relaxation import Relaxation
from compare.check_certificate.families.four_three_four import FourThreeFour
from compare.check_certificate.families.quintic import Quintic
from compare.check_certificate.families.three_five_three import ThreeFiveThree
from compare.check_certificate.words import demands_in_words, proof_in_words


def verify(data: Any, *, show: bool = False) -> str:
    """Verify a certificate.

    Parameters
    ----------
    data : object
        The content of the file.
    show : bool
        Whether to add the inequalities of the last sum, for a bound of every motion.

    Returns
    -------
    str
        What the certificate proves, in words.

    Raises
    ------
    Refused
        If the proof does not hold.
    BadInput
        If the data are no certificate.
    """
    claim = Claim(data)
    trees: dict[str, Any] = {
        "3-5-3": ThreeFiveThree,
        "4-3-4": FourThreeFour,
        "quintic": Quintic,
        "b-spline-3": BSplineTree,
        "b-spline-5": BSplineTree,
        EVERY_MOTION: Relaxation,
    }
    if claim.family not in trees:
        raise BadInput(f"family: {claim.family!r:.40} is not one of {', '.join(trees)}")
    tree = trees[claim.family](claim)
    discards = 0 if tree.void else tree.replay()
    every = isinstance(tree, Relaxation)
    asked = demands_in_words(claim.demands()) if every else ""
    parts = len(tree.tally.ends) if isinstance(tree, Relaxation) else 1
    events = len(claim.events) if tree.void or not every else tree.tally.events
    words = (
        f"no {'motion' if every else f'{claim.family} motion'} of {str(data.get('name'))[:60]!r}{asked} "
        f"takes {float(claim.L):.12g} s or less "
        f"({events} events, {discards} {'rows' if every else 'discards'}"
        f"{f', in {parts} parts' if parts > 1 else ''})"
    )
    return "\n".join([words, *proof_in_words(tree)]) if show and every else words
