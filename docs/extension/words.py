"""Words in the types of docstrings: ``shape (n, dof)`` does not name anything of the API."""

from __future__ import annotations

from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx


def without_words(app: Sphinx, doctree: nodes.document) -> None:
    """Make plain text of references to plain words (an event of Sphinx).

    Parameters
    ----------
    app : Sphinx
    doctree : docutils.nodes.document
        A page that was read; it is changed in place.
    """
    for reference in list(doctree.findall(pending_xref)):
        target = reference.get("reftarget", "")
        if reference.get("refdomain") == "py" and target.isidentifier() and target.islower():
            reference.replace_self(reference.children)
