"""The notebooks: each asks, shows, answers, and gives again the text that is stored in it."""

from __future__ import annotations

import base64
import re
from pathlib import Path
from typing import Any

import pytest

nbformat = pytest.importorskip("nbformat")
pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")

from rerun import NOTEBOOKS, ROOT, rerun  # noqa: E402  # once it is known that its libraries are there

NAMES = ["one_motion", "swarm_against_its_bound", "where_the_time_goes", "audit_a_paper", "your_own_swarm",
         "your_own_robot", "a_proof_by_hand"]  # fmt: skip
LONGEST_CELL, LARGEST_PICTURE = 32, 120_000  # lines; bytes
each = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def stored(path: Path) -> Any:
    return nbformat.read(path, as_version=4)


def code(notebook: Any) -> list[Any]:
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def pictures(cell: Any) -> list[bytes]:
    return [
        base64.b64decode(o.data["image/png"]) for o in cell.outputs if "image/png" in o.get("data", {})
    ]


def text(cell: Any) -> list[str]:
    """What a cell gives, a picture as a word."""
    found = []
    for output in cell.outputs:
        data = output.get("data", {"text": output.get("text", "")})
        kinds = sorted(data)
        found += ["picture" if kind == "image/png" else f"{kind}: {data[kind]}" for kind in kinds]
    return found


def test_they_are_numbered_in_the_order_of_teaching_and_linked() -> None:
    assert [path.stem for path in NOTEBOOKS] == [f"{k:02d}_{name}" for k, name in enumerate(NAMES, 1)]
    readme = (ROOT / "README.md").read_text("utf-8")
    tutorials = (ROOT / "docs" / "tutorials" / "index.md").read_text("utf-8")
    for path in (NOTEBOOKS[0], NOTEBOOKS[-1]):
        assert f"(notebooks/{path.name})" in readme
    for path in NOTEBOOKS:
        assert f"notebooks/{path.stem}\n" in tutorials


@each
def test_a_question_comes_first_and_a_computed_answer_last(path: Path) -> None:
    cells = stored(path).cells
    question = cells[0]
    assert question.cell_type == "markdown"
    assert re.search(r"\*\*[^*]+\?\*\*$", question.source), "the first cell ends with a question"
    answer = cells[-1]
    assert answer.cell_type == "code"
    ((said,),) = ([o.data["text/markdown"] for o in answer.outputs],)
    assert said.startswith("**Answer.** ")
    numbers = re.findall(r"\d+\.\d+", said)
    assert numbers, "an answer has numbers"
    typed = [number for number in numbers if number in answer.source]
    assert not typed, "the numbers of an answer are computed"


@each
def test_pictures_come_early_are_stored_and_small(path: Path) -> None:
    cells = code(stored(path))
    told = [cell for cell in cells if not cell.source.startswith("%%writefile")]
    assert any(pictures(cell) for cell in told[:2])
    assert all(pictures(cell) for cell in cells if "plt.show()" in cell.source)
    shown = [picture for cell in cells for picture in pictures(cell)]
    assert len(shown) >= 2
    for picture in shown:
        assert picture.startswith(b"\x89PNG")
        assert len(picture) < LARGEST_PICTURE


@each
def test_cells_are_few_and_short(path: Path) -> None:
    cells = code(stored(path))
    assert len(cells) <= 10
    assert all(len(cell.source.splitlines()) <= LONGEST_CELL for cell in cells)


@pytest.mark.long
@pytest.mark.filterwarnings("default")  # of the notebook machinery, not ours
@each
def test_it_gives_again_what_is_stored(path: Path, tmp_path: Path) -> None:
    before, after = (code(notebook) for notebook in (stored(path), rerun(path, tmp_path)))
    assert len(before) == len(after)
    for old, new in zip(before, after, strict=True):
        assert text(new) == text(old), old.source
