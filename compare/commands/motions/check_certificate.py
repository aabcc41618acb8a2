"""``timebound check_certificate FILE``: prove a certified bound again.

Nothing of the prover is loaded to check a certificate. Only ``--problem`` calls the project's own
loader, and ``--json FILE`` its writer of files, once the answer is known.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.certificate_file import compare_with, read
from compare.commands import BAD_INPUT, DONE, FAILED
from compare.commands.options import Json
from compare.screen import show

CERTIFIED, REFUSED = DONE, FAILED  # exit codes


def check_certificate(
    file: Annotated[str, Parameter(name="FILE")],
    /,
    *,
    problem: Annotated[str | None, Parameter(metavar="FILE_OR_CASE")] = None,
    show_sums: Annotated[bool, Parameter(name="--show")] = False,
    json: Json = None,
) -> int:
    """Prove a certified bound again, in arithmetic of its own and independently of the prover.

    Exit code 0: certified, 1: refused, 2: bad input.

    Parameters
    ----------
    file
        A certificate, from timebound solve --certificate or --motion-certificate.
    problem
        The problem that the certificate must be about.
    show_sums
        Show the inequalities that prove a bound of every motion.
    """
    try:
        import flint  # noqa: F401
    except ImportError:
        print("error: python-flint is missing: pip install 'timebound[certificate]'", file=sys.stderr)
        return BAD_INPUT
    from compare.check_certificate.verify import verify

    try:
        data = read(Path(file))
        words = verify(data, show=show_sums)
        if problem is not None:
            compare_with(data, problem)
    except Refused as reason:
        show(f"refused: {reason}", {"file": file, "certified": False, "words": str(reason)}, json)
        return REFUSED
    except BadInput as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    show(f"certified: {words}", {"file": file, "certified": True, "words": words}, json)
    return CERTIFIED
