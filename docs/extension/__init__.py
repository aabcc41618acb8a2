"""What the site takes from the code: commands, keys of files, registries, references; and its formulas.

commands     every command with its options, from the functions that the command line is made of
keys         the keys of a problem file, from its reader's own lists
registries   families, bounds, algorithms, cases and references as tables
mathml       formulas as MathML, made when the site is built
links        links of the pages that are read on a code-hosting site too
words        words in the types of docstrings, which name nothing
"""

from __future__ import annotations

from typing import Any

from sphinx.application import Sphinx

from extension.commands import CommandsDirective
from extension.keys import KeysDirective
from extension.links import on_the_site
from extension.mathml import show_block, show_inline
from extension.registries import RegistryDirective
from extension.words import without_words


def setup(app: Sphinx) -> dict[str, Any]:
    """Enter the directives and the renderer of formulas (called by Sphinx).

    Parameters
    ----------
    app : Sphinx

    Returns
    -------
    dict
    """
    app.add_directive("timebound-commands", CommandsDirective)
    app.add_directive("timebound-keys", KeysDirective)
    app.add_directive("timebound-registry", RegistryDirective)
    app.add_html_math_renderer("mathml", (show_inline, None), (show_block, None))
    app.connect("source-read", on_the_site)
    app.connect("doctree-read", without_words)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
