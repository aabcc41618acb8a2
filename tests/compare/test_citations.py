"""``timebound cite``: nothing that the code calls is without its paper, and a run cites what it used."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from conftest import climbed
from graded_runs import graded

from compare import statistics
from compare.__main__ import main
from compare.benchmark.records.settings import Settings
from compare.benchmark.records.store import Store
from compare.benchmark.suite.catalogue import suite
from compare.citations.bibliography import bibtex, entries, reasons
from compare.citations.cited import CITED, OWN, STOP_AND_GO, CitedKind
from compare.citations.used import Used, used_by, used_swarms
from formulations import CASES, FAMILIES, RUNGS, load
from metaheuristics import ALGORITHMS
from metaheuristics.by_name import LIBRARIES

NAMES = {
    CitedKind.case: set(CASES),
    CitedKind.family: set(FAMILIES),
    CitedKind.rung: {*RUNGS, STOP_AND_GO},
    CitedKind.algorithm: set(ALGORITHMS),
    CitedKind.library: {library.distribution for library in LIBRARIES.values()}
    | {name for entry in ALGORITHMS.values() for name in entry.libraries},
    CitedKind.statistic: {
        path.stem
        for path in Path(statistics.__path__[0]).glob("[a-z]*.py")
        if "\nReferences\n" in path.read_text("utf-8")
    },
}
REQUIRED = {
    "article": {"author", "title", "journal", "year"},
    "book": {"author", "title", "publisher", "year"},
    "inproceedings": {"author", "title", "booktitle", "year"},
    "misc": {"author", "title", "year"},
    "software": {"author", "title", "year"},
    "techreport": {"author", "title", "institution", "year"},
}


def fields(entry: str) -> dict[str, str]:
    """The fields of an entry that has one per line."""
    found = {}
    for line in entry.splitlines()[1:-1]:
        match = re.fullmatch(r"  (\w+) = (\{.*\}|\w+),?", line)
        assert match, line
        found[match[1]] = match[2].removeprefix("{").removesuffix("}")
    return found


def plain(text: str) -> str:
    """An author's name without TeX, as the code writes it."""
    return re.sub(r"\{\\.\{?(\w)\}?\}|[{}]", r"\1", text)


@pytest.mark.parametrize("kind", CitedKind)
def test_everything_that_the_code_calls_has_its_entry(kind: CitedKind) -> None:
    assert set(CITED[kind]) == NAMES[kind]
    for name, papers in CITED[kind].items():
        assert papers, name
        assert set(papers) <= set(entries()), name


def test_no_paper_is_there_that_nothing_cites() -> None:
    cited = {paper for names in CITED.values() for papers in names.values() for paper in papers}
    assert cited == set(entries())


@pytest.mark.parametrize("key", entries())
def test_an_entry_is_whole(key: str) -> None:
    entry = entries()[key]
    kind = re.match(r"@(\w+)\{", entry)
    assert kind
    found = fields(entry)
    assert REQUIRED[kind[1]] <= set(found)
    assert entry.count("{") == entry.count("}")
    assert re.fullmatch(r"\d{4}", found["year"])
    if key not in OWN:
        first = plain(found["author"]).split(" and ")[0].split(",")[0]
        assert key == re.sub(r"\W", "", first).lower() + found["year"]
    if "doi" in found:
        assert re.fullmatch(r"10\.\d{4,5}/\S+", found["doi"])
    if "pages" in found:
        ends = [int(page) for page in found["pages"].split("--")]
        assert ends == sorted(ends)


@pytest.mark.parametrize("name", [n for n in ALGORITHMS if n != "random"])
def test_an_algorithm_cites_whom_its_own_source_names_first(name: str) -> None:
    who = re.match(r"([A-Z][\w-]+)(?: & [A-Z][\w-]+| et al\.)? (\d{4})", ALGORITHMS[name].source)
    assert who, ALGORITHMS[name].source
    assert f"{who[1]}{who[2]}".lower() in CITED[CitedKind.algorithm][name]


@pytest.mark.parametrize("case", CASES)
def test_a_case_cites_the_paper_that_its_file_names(case: str) -> None:
    (paper,) = CITED[CitedKind.case][case]
    found = fields(entries()[paper])
    source = " ".join(load(case).source.split())
    assert found["year"] in source
    assert plain(found["title"]).lower() in source.lower()
    for author in plain(found["author"]).split(" and "):
        assert author.split(",")[0] in source


@pytest.mark.parametrize("name", FAMILIES)
def test_a_family_cites_a_paper_that_its_source_names(name: str) -> None:
    first = CITED[CitedKind.family][name][0]
    author, year = re.fullmatch(r"([a-z]+)(\d+)", first).groups()  # type: ignore[union-attr]
    assert re.search(rf"{author}.* {year}", FAMILIES[name].source, re.IGNORECASE)


@pytest.mark.parametrize("name", CITED[CitedKind.statistic])
def test_statistics_cite_every_paper_that_their_module_names(name: str) -> None:
    text = Path(statistics.__path__[0], f"{name}.py").read_text("utf-8")
    named = re.findall(r"^(\w+) [A-Z]\. .*?\((\d{4})\)", text, re.MULTILINE)
    assert named
    assert {f"{author.lower()}{year}" for author, year in named} <= set(
        CITED[CitedKind.statistic][name]
    )


@pytest.mark.parametrize("page", ["grade.html", "versus.html"])
def test_a_grading_cites_its_statistics(page: str, tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.clear()
    store.add(graded(load("sr4c"), 4.7, "shared", "random", 0, 30))
    store.close()
    (tmp_path / page).write_text("", "utf-8")
    found = set(reasons(used_by(str(tmp_path))))
    assert {*OWN, "wang2025", "holm1979", "vargha2000", "hansen2021"} <= found
    assert "david2003" not in found  # medians are the chapters'


@pytest.mark.slow
@pytest.mark.parametrize("case", ["sr4c", "ur5", "cobot"])
def test_what_a_case_will_use_is_what_its_ladder_has_used(case: str, tmp_path: Path) -> None:
    answer = tmp_path / "answer.json"
    answer.write_text(json.dumps({**climbed(case).to_json(), "diagnosis": None}))
    assert set(used_by(str(answer))) == set(used_by(case))


def test_what_has_no_meaning_for_a_problem_is_not_cited() -> None:
    without_acceleration, without_jerk, all_limits = map(
        reasons, map(used_by, ("cobot", "sr4c", "ur5"))
    )
    assert "berscheid2021" not in without_acceleration  # Ruckig
    assert "huangfu2018" not in without_acceleration  # the relaxation
    assert "berscheid2021" in without_jerk
    assert "wang2026" not in without_jerk  # COPP
    pytest.importorskip("copp_py")
    assert "wang2026" in all_limits


def test_a_failed_rung_and_a_borrowed_number_cite_nothing_of_their_own(tmp_path: Path) -> None:
    rung = {
        "seconds": 1.0,
        "kind": "lower",
        "status": "ok",
        "certified": True,
        "runtime": 0.1,
        "note": "",
    }
    answer = {
        "problem": "mine",
        "durations": {},
        "versions": {},
        "ladder": {
            "displacement": rung,
            "free_form_lower": {**rung, "note": "that of displacement"},
            "toppra_cubic": {**rung, "seconds": None, "status": "failed"},
            "copp_family_path": {**rung, "seconds": None, "status": "not-applicable"},
        },
    }
    path = tmp_path / "answer.json"
    path.write_text(json.dumps(answer))
    assert set(reasons(used_by(str(path)))) == {*OWN}
    answer["ladder"]["toppra_cubic"] = rung  # type: ignore[index]
    path.write_text(json.dumps(answer))
    assert set(reasons(used_by(str(path)))) == {*OWN, "pham2018"}


def test_a_swarm_of_a_library_cites_the_library_and_a_plug_in_is_named() -> None:
    used = used_swarms(["de", "mealpy:OriginalGWO", "mine:swarm"])
    assert set(reasons(used)) == {*OWN, "storn1997", "virtanen2020", "vanthieu2023"}
    text = bibtex(used)
    assert text.endswith("% no paper is known here of: mealpy:OriginalGWO, mine:swarm")
    assert text.count("@article{storn1997,") == 1


def test_a_folder_cites_the_swarms_of_its_rows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = Store(tmp_path)
    store.clear()
    store.write_settings(Settings("quick", ("sr4c",), (0,), "30 evaluations"))
    for swarm in ("whale", "random"):
        store.add(graded(load("sr4c"), 4.7, "shared", swarm, 0, 30))
    store.close()
    assert main(["cite", str(tmp_path)]) == 0
    found = set(re.findall(r"^@\w+\{(\w+),", capsys.readouterr().out, re.MULTILINE))
    assert found == {"timebound", "wang2025", "mirjalili2016"}


def test_a_perturbed_case_cites_the_paper_of_its_case(tmp_path: Path) -> None:
    instance = next(one for one in suite() if one.origin == "perturbed bagging")
    store = Store(tmp_path)
    store.clear()
    store.write_settings(Settings("suite", (instance.name,), (0,), "30 evaluations"))
    store.write_instance(instance.name, instance.to_json())
    store.add(graded(instance.problem, 1.0, "shared", "random", 0, 30))
    store.close()
    assert set(reasons(used_by(str(tmp_path)))) == {*OWN, "li2022"}
    assert Used(CitedKind.case, "bagging", ("li2022",)) in used_by(str(tmp_path))


def test_it_prints_bibtex_alone_and_json_on_request(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cite", "sr4c", "--swarms", "pso"]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert re.sub(r"^(%.*|@\w+\{.*?^\})$", "", said.out, flags=re.MULTILINE | re.DOTALL).strip() == ""
    assert main(["cite", "sr4c", "--swarms", "pso", "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["clerc2002"] == ["algorithm pso"]
