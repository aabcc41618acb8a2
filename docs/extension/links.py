"""Links between pages that are read on a code-hosting site too, where they name files outside the site."""

from __future__ import annotations

from sphinx.application import Sphinx

_ON_THE_SITE = {"(../CONTRIBUTING.md": "(about/contributing.md", "(../README.md": "(index.md"}


def on_the_site(app: Sphinx, page: str, source: list[str]) -> None:
    """Let a page name the site's own copy of a file (an event of Sphinx).

    Parameters
    ----------
    app : Sphinx
    page : str
        The page that is read.
    source : list of str
        Its text, which is changed in place.
    """
    if "/" not in page:
        for there, here in _ON_THE_SITE.items():
            source[0] = source[0].replace(there, here)
