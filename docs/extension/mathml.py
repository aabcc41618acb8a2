"""Formulas as MathML, which every browser shows without a script, made by docutils as the site is built."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml
from sphinx.errors import ExtensionError


def show_inline(writer: Any, node: nodes.Element) -> None:
    """Write a formula within a line.

    Parameters
    ----------
    writer : HTMLTranslator
    node : docutils.nodes.math
    """
    writer.body.append(_mathml(node, block=False))
    raise nodes.SkipNode


def show_block(writer: Any, node: nodes.Element) -> None:
    """Write a formula of its own.

    Parameters
    ----------
    writer : HTMLTranslator
    node : docutils.nodes.math_block
    """
    writer.body.append(f'<div class="math">{_mathml(node, block=True)}</div>\n')
    raise nodes.SkipNode


def _mathml(node: nodes.Element, *, block: bool) -> str:
    text = node.astext()
    try:
        shown = latex2mathml.tex2mathml(text, as_block=block)
    except MathError as error:
        raise ExtensionError(f"formula {text!r}: {error}") from error
    for (
        sign
    ) in "|/":  # of a modulus and a quotient; MathML would put the room of a relation around them
        shown = shown.replace(
            f'<mo stretchy="false">{sign}</mo>',
            f'<mo stretchy="false" lspace="0" rspace="0">{sign}</mo>',
        )
    return shown
