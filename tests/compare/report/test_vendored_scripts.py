"""The scripts of others that stand in the pages are the stated ones, unchanged, with their licences."""

from __future__ import annotations

import hashlib
import re
import tomllib
from pathlib import Path

import pytest

from compare.report.frame import CHARTS

FOLDER = Path(__file__).parents[3] / "compare" / "report" / "vendor"
STATED = tomllib.loads((FOLDER / "vendored.toml").read_text("utf-8"))
WORDS = {
    "MIT": "Permission is hereby granted, free of charge",
    "Unlicense": "released into the public domain",
}


@pytest.mark.parametrize("name", STATED)
def test_a_vendored_script_is_the_stated_one_with_its_licence(name: str) -> None:
    stated = STATED[name]
    assert set(stated) == {"file", "version", "licence", "licence_file", "source", "sha256"}
    script = (FOLDER / stated["file"]).read_bytes()
    assert hashlib.sha256(script).hexdigest() == stated["sha256"]
    assert WORDS[stated["licence"]] in (FOLDER / stated["licence_file"]).read_text("utf-8")
    assert stated["source"].startswith("https://www.npmjs.com/package/")


def test_the_folder_holds_what_is_stated_and_nothing_else() -> None:
    stated = {one[key] for one in STATED.values() for key in ("file", "licence_file")}
    assert {path.name for path in FOLDER.iterdir()} == stated | {"vendored.toml"}


def test_every_vendored_script_is_used() -> None:
    assert {f"vendor/{one['file']}" for one in STATED.values()} == {
        p for p in CHARTS if p.startswith("vendor/")
    }


def test_plotly_states_its_version_and_licence() -> None:
    head = (FOLDER / STATED["plotly"]["file"]).read_text("utf-8")[:400]
    found = re.search(r"v(\d+\.\d+\.\d+)", head)
    assert found is not None
    assert found[1] == STATED["plotly"]["version"]
    assert "MIT" in head
