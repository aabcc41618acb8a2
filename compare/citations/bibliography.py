"""The BibTeX of what a run has used, each paper once, with what it is cited for."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from importlib.resources import files

from compare.citations.cited import OWN
from compare.citations.used import Used

_ENTRY = re.compile(r"^@\w+\{([^,\s]+),\n.*?^\}$", re.MULTILINE | re.DOTALL)


@cache
def entries() -> dict[str, str]:
    """Read ``references.bib``.

    Returns
    -------
    dict of str to str
        The text of each entry by its key.
    """
    text = (files("compare.citations") / "references.bib").read_text("utf-8")
    return {entry[1]: entry[0] for entry in _ENTRY.finditer(text)}


def reasons(used: Iterable[Used]) -> dict[str, list[str]]:
    """Collect what each paper is cited for.

    Parameters
    ----------
    used : iterable of Used

    Returns
    -------
    dict of str to list of str
        By key of the paper, in the order of first use; this project's own entry is the first.
    """
    found: dict[str, list[str]] = {key: [] for key in OWN}
    for one in used:
        for paper in one.papers:
            words = found.setdefault(paper, [])
            if (name := f"{one.kind} {one.name}") not in words:
                words.append(name)
    return found


def bibtex(used: Iterable[Used]) -> str:
    """Set the bibliography of a run.

    Parameters
    ----------
    used : iterable of Used

    Returns
    -------
    str
        BibTeX; a comment above each entry says what it is cited for. A last comment names what no paper
        is known of.
    """
    used = list(used)
    blocks = [
        f"% {'; '.join(words) or 'this program'}\n{entries()[key]}"
        for key, words in reasons(used).items()
    ]
    unknown = dict.fromkeys(one.name for one in used if not one.papers)
    if unknown:
        blocks.append(f"% no paper is known here of: {', '.join(unknown)}")
    return "\n\n".join(blocks)
