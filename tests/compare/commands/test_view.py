"""``timebound view``: the page agrees with ``check``, fetches nothing, and names stay text."""

from __future__ import annotations

import json
import re
import time
import webbrowser
from contextlib import nullcontext
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare.__main__ import main
from compare.commands.motions import view
from compare.commands.motions.view import page_name
from compare.report.charts.motions import ShownMotion, motions_chart
from formulations import FAMILIES, Limits, Problem, Trajectory, check, load, planning, write_motion
from formulations.deadlines import Deadline

QUICK = "free_form,free_form_lower,ruckig_stop_and_go"
NASTY = "<script>alert(1)</script>"


class Page(HTMLParser):
    """The text of a page as a reader sees it, its charts' data, and what its tags would fetch."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.said: list[str] = []
        self.scripts: list[str] = []
        self.fetched: list[str] = []
        self.kinds: list[str] = []
        self.inside = ""
        self.feed(path.read_text("utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.inside = tag
        known = dict(attrs)
        if tag == "script":
            self.scripts.append("")
        if kind := known.get("data-kind"):
            self.kinds.append(kind)
        links = [known.get("src"), known.get("href") if tag in ("link", "a") else None]
        self.fetched += [link for link in links if link and not link.startswith(("#", "data:"))]

    def handle_endtag(self, tag: str) -> None:
        self.inside = ""

    def handle_data(self, data: str) -> None:
        if self.inside == "script":
            self.scripts[-1] += data
        elif self.inside != "style":
            self.said.append(data)

    @property
    def text(self) -> str:
        return re.sub(r"\s+", " ", " ".join(self.said))

    @property
    def charts(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self.scripts[0])["view"]
        return found


@pytest.fixture(scope="module")
def motions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A spline of sr4c at its limits, the same 10 % too fast, and one that misses waypoints."""
    folder = tmp_path_factory.mktemp("motions")
    problem = load("sr4c")
    spline = FAMILIES["3-5-3"].trajectory(problem, [2.0, 1.0, 2.0])
    spline = spline.stretched(check(problem, spline).stretch * (1.0 + 1e-6))
    write_motion(folder / "good.csv", spline)
    write_motion(folder / "fast.csv", spline.stretched(1.0 / 1.1))
    write_motion(folder / "coarse.csv", spline.stretched(2.0), rate=0.7)
    return folder


def viewed(folder: Path, *given: str, code: int = 0) -> Page:
    out = folder / "page.html"
    assert main(["view", *given, "--out", str(out)]) == code
    return Page(out)


def number(pattern: str, text: str) -> float:
    (found,) = set(re.findall(pattern, text))  # in the title too
    return float(found)


def checked(folder: Path, *given: str) -> dict[str, Any]:
    out = folder / "verdict.json"
    main(["check", *given, "--json", str(out)])
    found: dict[str, Any] = json.loads(out.read_text("utf-8"))
    return found


def test_the_page_of_a_problem_says_what_solve_says(tmp_path: Path) -> None:
    answer = tmp_path / "solve.json"
    rungs = [*QUICK.split(","), "family", "family_lower"]
    assert main(["solve", "sr4c", "--rungs", ",".join(rungs), "--json", str(answer)]) == 0
    ladder = json.loads(answer.read_text("utf-8"))["ladder"]
    page = viewed(tmp_path, "sr4c", "--rungs", ",".join(rungs))
    seconds = {key: rung["seconds"] for key, rung in ladder.items()}
    assert (
        f"The fastest motion of sr4c takes {seconds['free_form']:.4f} s, proved to within" in page.text
    )
    assert f"No motion takes less than {seconds['free_form_lower']:.6f} s" in page.text
    assert f"The best 3-5-3 spline takes {seconds['family']:.6f} s" in page.text
    assert "toppra_cubic reference left out" in page.text  # what was not climbed says so
    shown = {line["name"]: line["seconds"] for line in page.charts["ladder"]["lines"]}
    assert shown["optimum of the family"] == pytest.approx(seconds["family"])
    assert [m["kind"] for m in page.charts["motion"]["motions"]] == ["family", "fastest"]
    assert page.kinds == ["ladder", "arm", "motion"]
    velocity = np.rad2deg(load("sr4c").limits.velocity)
    assert [joint["limits"][1][1] for joint in page.charts["motion"]["joints"]] == pytest.approx(
        velocity
    )


def test_a_motion_that_is_too_fast_is_said_to_be_so_as_check_says_it(
    motions: Path, tmp_path: Path
) -> None:
    given = ("sr4c", str(motions / "fast.csv"))
    answer = checked(tmp_path, *given)
    page = viewed(tmp_path, *given, "--rungs", QUICK, code=3)
    worst = answer["violations"][0]
    joints = {one["joint"] for one in answer["violations"]}
    assert f"{len(answer['violations'])} broken limits of {len(joints)} joints" in page.text
    assert (
        f"Worst: {worst['factor']:.6g} times the {worst['quantity']} limit of joint {worst['joint']}"
        in page.text
    )
    for one in answer["violations"]:  # the table, in deg
        value = f"{np.rad2deg(one['value']):.6g}"
        assert f"{one['joint']} {one['time']:.4f} s {value} " in page.text
    long = answer["stretch"] * answer["seconds"]
    assert f"Stretched by {answer['stretch']:.6g}, to {long:.6g} s, it would keep" in page.text
    assert number(r"takes less than ([\d.]+) s \(proved\)", page.text) == pytest.approx(
        answer["bound"], rel=1e-5
    )
    assert f"{100.0 * answer['gap_when_mended']:.3g} % more" in page.text
    kinds = {line["kind"]: line["seconds"] for line in page.charts["ladder"]["lines"]}
    assert kinds["faulty"] == pytest.approx(answer["seconds"])
    assert kinds["given"] == pytest.approx(long)
    assert "fast.csv" in page.charts["ladder"]["alt"]
    assert page.charts["motion"]["motions"][0]["kind"] == "given"
    assert page.charts["motion"]["first"] == worst["joint"] - 1


def test_a_good_motion_keeps_everything_and_its_gap_is_that_of_check(
    motions: Path, tmp_path: Path
) -> None:
    given = ("sr4c", str(motions / "good.csv"))
    answer = checked(tmp_path, *given)
    page = viewed(tmp_path, *given, "--rungs", QUICK)
    assert "good.csv keeps everything that sr4c asks for" in page.text
    gap = number(r"takes at most ([\d.]+) % longer than the fastest", page.text)
    assert gap == pytest.approx(100.0 * answer["gap"], rel=5e-2)  # two digits
    assert f"this one: {100.0 * answer['gap']:.3g} % more" in page.text
    assert "What is wrong" not in page.text


def test_a_page_without_a_search_says_that_none_was_asked_for(tmp_path: Path) -> None:
    page = viewed(tmp_path, "sr4c", "--rungs", "displacement")
    problem = load("sr4c")
    least = (np.abs(np.diff(problem.waypoints, axis=0)) / problem.limits.velocity).max(axis=1).sum()
    assert f"No motion was asked for sr4c; no motion takes less than {least:.4f} s" in page.text
    assert page.kinds == ["ladder"]


def test_missed_waypoints_stand_in_the_table(motions: Path, tmp_path: Path) -> None:
    given = ("sr4c", str(motions / "coarse.csv"))
    answer = checked(tmp_path, *given, "--no-bound")
    page = viewed(tmp_path, *given, "--rungs", QUICK, code=3)
    for miss in answer["missed_waypoints"]:
        assert f"{miss['waypoint']} of 4 {miss['joint']} {miss['time']:.4f} s" in page.text
    assert "No uniform stretch mends it: waypoints are missed" in page.text


def test_names_stay_text_and_nothing_is_fetched(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("nasty.toml").write_text(
        f'name = "../{NASTY}"\ntitle = "{NASTY}"\njoints = ["{NASTY}", "b"]\nunit = "deg"\n'
        "waypoints = [[0, 0], [90, 30], [45, 20]]\n"
        "[limits]\nvelocity = [100, 50]\nacceleration = [400, 200]\njerk = [2000, 2000]\n"
    )
    name = "<script>alert(1).csv"
    problem = load("nasty.toml")
    write_motion(name, FAMILIES[problem.family].trajectory(problem, [0.5, 0.5]))
    assert main(["view", "nasty.toml", name, "--rungs", QUICK]) == 3
    (path,) = Path().glob("*.html")
    assert path.name == "script_alert_1_script.html"
    page = Page(path)
    assert name in page.text
    assert f"1 {NASTY}" in page.text  # a joint, as text
    assert not [script for script in page.scripts[1:] if "alert(1)" in script]
    assert page.charts["motion"]["joints"][0]["name"] == f"joint {NASTY}"
    assert page.fetched == []
    assert "default-src 'none'" in path.read_text("utf-8")
    assert page.kinds == ["ladder", "motion"]  # no arm is known


@pytest.mark.parametrize(
    ("name", "page"),
    [("../../etc/x", "etc_x.html"), ("...", "problem.html"), ("a" * 300, "a" * 80 + ".html")],
)
def test_a_page_is_named_after_its_problem_and_stays_in_the_folder(name: str, page: str) -> None:
    assert page_name(Problem([[0.0], [1.0]], Limits.of(velocity=1.0, dof=1), name=name)) == page


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["sr4d"], "sr4d: no such file, and no case of that name"),
        (["sr4c", "--out", "/nowhere/x.html"], "/nowhere is no folder"),
        (
            ["sr4c", "--rungs", "displacement", "--out", "/proc/x.html"],
            "/proc: cannot be written",
        ),
        (["sr4c", "nowhere.csv"], "nowhere.csv: no such file"),
        (["sr4c", "--stop", "9"], "stops: waypoint 9"),
    ],
)
def test_bad_input_is_one_line(given: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", *given]) == 2
    err = capsys.readouterr().err
    (line,) = [one for one in err.splitlines() if one.startswith("error: ")]
    assert said in line
    assert err == f"{line}\n"  # before any work


def test_the_browser_is_opened_only_if_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda url: opened.append(url))  # says that there is none
    viewed(tmp_path, "sr4c", "--rungs", QUICK)
    viewed(tmp_path, "sr4c", "--rungs", QUICK, "--no-open")
    assert opened == []  # the output is no terminal
    viewed(tmp_path, "sr4c", "--rungs", QUICK, "--open")
    assert opened == [(tmp_path / "page.html").as_uri()]
    assert "no browser was found" in capsys.readouterr().err


def test_conditions_have_a_motion_and_a_bound_of_their_own(tmp_path: Path) -> None:
    page = viewed(tmp_path, "sr4c", "--stop", "1", "--rungs", QUICK)
    answer = tmp_path / "plan.json"
    assert main(["plan", "sr4c", "--stop", "1", "--json", str(answer)]) == 0
    found = json.loads(answer.read_text("utf-8"))
    assert f"The fastest motion known under the conditions takes {found['seconds']:.5f}" in page.text
    assert f"No motion under the conditions takes less than {found['bound']:.5f}" in page.text
    assert "It stands still at waypoint 2." in page.text


@pytest.mark.long
def test_a_time_limit_is_shared_by_motion_bound_and_ladder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A search that uses all of its time leaves the others theirs."""
    search, plan, given = planning.free_form, view.plan, []

    def slow(*arguments: Any, **options: Any) -> Any:
        answer = search(
            *arguments, **options, **({} if "tolerance" in options else {"tolerance": 1e-2})
        )
        time.sleep(max(ends - time.perf_counter(), 0.0))
        return answer

    def planned(problem: Problem, **options: Any) -> Any:
        nonlocal ends
        given.append(options["time_limit"])
        ends = time.perf_counter() + 0.75 * options["time_limit"]  # what plan leaves to the motion
        return plan(problem, **options)

    ends = 0.0
    monkeypatch.setattr(planning, "free_form", slow)
    monkeypatch.setattr(view, "plan", planned)
    asked = ("sr4c", "--stop", "1", "--rungs", "ruckig_stop_and_go,displacement", "--time-limit", "12")
    page = viewed(tmp_path, *asked)
    assert given == [9.0]
    assert "The fastest motion of sr4c under the conditions takes" in page.text  # proved to many digits
    shown = {line["name"] for line in page.charts["ladder"]["lines"]}
    assert "Ruckig, stop and go" in shown


def test_a_ladder_without_time_is_no_error_where_the_motion_was_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    climb = view.climb

    def late(problem: Problem, rungs: Any, deadline: Any, *rest: Any, **options: Any) -> Any:
        return climb(problem, rungs, Deadline(0.0), *rest, **options)

    monkeypatch.setattr(view, "climb", late)
    page = viewed(tmp_path, "sr4c", "--stop", "1", "--rungs", QUICK)  # exit code 0
    assert "No motion was found without the conditions: the time limit was over" in page.text
    err = capsys.readouterr().err
    assert "sr4c: No motion was found without the conditions" in err
    assert "error" not in err
    viewed(tmp_path, "sr4c", "--rungs", QUICK, code=2)
    assert "error: sr4c: No motion was found: the time limit was over" in capsys.readouterr().err


def test_an_interrupt_leaves_the_page_of_what_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(view, "ctrl_c_stops", lambda: nullcontext(lambda: True))
    page = viewed(tmp_path, "sr4c", code=130)
    assert "This was interrupted" in page.text
    assert "No motion was found for sr4c" in page.text


def test_a_motion_of_many_pieces_is_drawn_small_with_its_exact_extremes() -> None:
    problem = Problem([[0.0], [1.0]], Limits.of(velocity=3.0, dof=1), name="long")
    rng = np.random.default_rng(0)
    pieces = rng.uniform(-1.0, 1.0, (20_000, 1, 4))
    motion = Trajectory(rng.uniform(1e-3, 1e-2, 20_000), pieces)
    chart = motions_chart(problem, [ShownMotion("given", "long", motion)])
    (shown,) = chart["motions"]
    assert len(json.dumps(shown["curves"])) < 100_000
    local = np.linspace(0.0, 1.0, 33)[:, None] * motion.durations  # the oracle: dense samples
    for order in range(4):
        times, values = shown["curves"][0][order]
        powers = np.polynomial.polynomial.polyder(pieces[:, 0].T, order) if order else pieces[:, 0].T
        dense = np.polynomial.polynomial.polyval(local, powers, tensor=False)
        assert max(values) >= dense.max() - 1e-8 * abs(dense.max())
        assert max(values) == pytest.approx(dense.max(), rel=1e-4)
        assert min(values) == pytest.approx(dense.min(), rel=1e-4)
        assert np.all(np.diff(times) >= 0.0)


def test_the_page_of_a_thousand_waypoints_stays_small(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    rows = np.cumsum(rng.uniform(-0.2, 0.2, (1000, 6)), axis=0).round(4).tolist()
    limits = "[limits]\nvelocity = 3\nacceleration = 8\njerk = 60\n"
    (tmp_path / "long.toml").write_text(f"waypoints = {rows}\n{limits}")
    page = viewed(tmp_path, str(tmp_path / "long.toml"), "--rungs", "ruckig_stop_and_go")
    assert (tmp_path / "page.html").stat().st_size < 4e6
    assert "and 500 more" in page.text
    assert len(page.charts["motion"]["motions"][0]["curves"]) == 6
