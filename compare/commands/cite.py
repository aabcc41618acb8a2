"""``timebound cite CASE...``: BibTeX of the methods and papers that a run has used."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.citations.bibliography import bibtex, reasons
from compare.citations.used import used_by, used_swarms
from compare.commands import DONE
from compare.commands.options import Json, Swarms
from compare.screen import show


def cite(
    *sources: Annotated[
        str,
        Parameter(
            name="CASE",
            help="Cases or problem files, answers of timebound solve (.json), or folders of timebound all,"
            " grade or versus.",
            required=True,
        ),
    ],
    swarms: Swarms = None,
    json: Json = None,
) -> int:
    """Print BibTeX for exactly the methods and papers that a run has used.

    Of a case or a problem file these are what timebound solve uses for it; of an answer of timebound solve
    and of a folder of timebound all, grade or versus, what gave a number there, and the statistics of a
    verdict.
    """
    used = [one for source in sources for one in used_by(source)]
    used += used_swarms(swarms or ())
    show(bibtex(used), reasons(used), json)
    return DONE
