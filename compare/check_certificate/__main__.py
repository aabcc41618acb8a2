"""``python -m compare.check_certificate FILE``: the command ``check_certificate``."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from compare.__main__ import main as timebound
from compare.commands import BAD_INPUT, DONE, FAILED

CERTIFIED, REFUSED = DONE, FAILED  # exit codes, beside BAD_INPUT
__all__ = ["BAD_INPUT", "CERTIFIED", "REFUSED", "main"]


def main(argv: Sequence[str] | None = None) -> int:
    """Check one certificate.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments and options; those of the process if left out.

    Returns
    -------
    int
        CERTIFIED, REFUSED or BAD_INPUT.
    """
    return timebound(["check_certificate", *(sys.argv[1:] if argv is None else argv)])


if __name__ == "__main__":
    sys.exit(main())
