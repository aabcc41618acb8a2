"""Printed tables and settings that the audit does not need, one TOML per paper: NAME.where and values."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any


def tables(key: str) -> dict[str, dict[str, Any]]:
    """The tables of a paper by name; each says in ``where`` which table, row or section it is."""
    text = (files("compare.papers.printed") / f"{key}.toml").read_text("utf-8")
    return tomllib.loads(text)
