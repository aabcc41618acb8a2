"""Grading, the runner, the store, the report and the commands."""

from __future__ import annotations

import ast
import csv
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import SOLVED, climbed
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.benchmark import suite
from compare.benchmark.grade import Graded, Run, Trace, durations_of, grade
from compare.benchmark.objective import CODINGS, Objective, search_box
from compare.benchmark.run import workers
from compare.benchmark.statistics import convergence, summaries
from compare.benchmark.store import COLUMNS, TIMES, Store, key_of
from formulations import FAMILIES, FamilyOptimum, InputError, Limits, Problem, check, load
from formulations.proofs.family import family_bound
from metaheuristics import ALGORITHMS

ROOT = Path(__file__).parents[3]
TOLERANCE = 1e-9  # relative: of families without a proof, whose optimum is a local solver's


def graded(problem: Problem, bound: float, coding: str, swarm: str, seed: int, budget: int) -> Graded:
    return grade(Run(problem.name, coding, swarm, seed, budget, 20), problem, bound)


def optimum(case: str) -> FamilyOptimum:
    """Optimum of a shipped case, solved once for all tests."""
    found = climbed(case).optimum
    assert found is not None
    return found


def unbeatable(case: str) -> float:
    """What no verified motion of the case's family can beat: a theorem, where there is a prover."""
    bound = climbed(case).bound
    assert bound is not None
    if bound.status == "proved":
        return bound.least_verified
    # of a B-spline it is the bound of every motion that is proved
    assert load(case).family.startswith("b-spline"), bound.status
    lower = climbed(case).seconds("free_form_lower")
    assert lower is not None
    return max(lower * (1.0 - 10.0 * TOLERANCE), bound.least_verified)


# --- the law the project exists for ---------------------------------------------------------------


@pytest.mark.parametrize("case", SOLVED)
def test_no_verified_swarm_result_lies_below_the_bound(case: str) -> None:
    problem, bound = load(case), unbeatable(case)
    for coding in CODINGS:
        for swarm, entry in ALGORITHMS.items():
            # libraries: one point at a time, most of them; B-splines: far above their bound, and slow
            budget = 200 if entry.libraries or problem.family.startswith("b-spline") else 1000
            row = graded(problem, bound, coding, swarm, 0, budget).row
            if row["seconds"] is not None:
                assert row["seconds"] >= bound, (coding, swarm)
                # judged again here, from the row's own durations
                verdict = check(
                    problem, FAMILIES[problem.family].trajectory(problem, durations_of(row))
                )
                assert verdict.feasible
                assert verdict.seconds == pytest.approx(row["seconds"], rel=1e-12)


@pytest.mark.slow
@given(data=st.data())
@settings(max_examples=15, deadline=None, derandomize=True)
def test_no_swarm_beats_the_bound_of_a_made_up_problem(data: st.DataObject) -> None:
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    dof, waypoints = int(rng.integers(1, 4)), int(rng.integers(3, 6))
    points = rng.normal(size=(waypoints, dof)) * 10.0 ** rng.uniform(-2, 1)
    acceleration, jerk = [(np.inf, np.inf), (2.0, np.inf), (2.0, 5.0)][int(rng.integers(3))]
    problem = Problem.of(points, Limits.of(1.0, acceleration, jerk, dof=dof))
    proof = family_bound(problem, gap=1e-5, time_limit=10.0)
    assert proof.seconds > 0.0
    for coding in CODINGS:
        for swarm in ("pso", "mipso", "whale"):
            row = graded(problem, proof.seconds, coding, swarm, 1, 2000).row
            assert row["seconds"] is None or row["seconds"] >= proof.least_verified


def test_a_wrong_bound_would_be_noticed() -> None:
    """The law above can fail: an optimum 1 % too long is beaten."""
    row = graded(load("sr4c"), optimum("sr4c").seconds * 1.01, "stretched", "pso", 0, 2550).row
    assert row["gap"] < 0.0


# --- codings and grading --------------------------------------------------------------------------


@pytest.mark.parametrize("case", SOLVED)
def test_the_search_box_holds_the_optimum(case: str) -> None:
    problem = load(case)
    lo, hi = search_box(problem)
    best = optimum(case).durations
    assert (lo <= best).all()
    assert (best <= hi).all()


def test_penalty_codings_call_infeasible_exactly_what_the_check_calls_infeasible() -> None:
    problem = load("sr4c")
    family = FAMILIES[problem.family]
    durations = np.random.default_rng(0).uniform(0.5, 4.0, (200, 3))
    fitness = Objective(problem, stretch=False)(durations)
    assert 0 < np.isfinite(fitness).sum() < 200
    for value, row in zip(fitness, durations, strict=True):
        feasible = check(problem, family.trajectory(problem, row)).feasible
        assert feasible == np.isfinite(value)
        assert not feasible or value == pytest.approx(row.sum(), rel=1e-15)


def test_the_stretched_coding_makes_every_shape_feasible_but_for_position() -> None:
    problem = load("ur5")
    durations = np.random.default_rng(1).uniform(0.5, 30.0, (100, 3))
    objective = Objective(problem, stretch=True)
    fitness = objective(durations)
    for value, row in zip(fitness, durations, strict=True):
        verdict = check(problem, FAMILIES["3-5-3"].trajectory(problem, objective.durations(row)))
        if np.isfinite(value):
            assert verdict.feasible
            assert verdict.seconds == pytest.approx(value, rel=1e-12)
        else:
            assert not verdict.position_kept
    assert np.isinf(fitness).any()
    assert np.isfinite(fitness).any()


def test_the_papers_rule_claims_less_than_the_optimum_and_is_found_out() -> None:
    row = graded(load("sr4c"), optimum("sr4c").seconds, "published", "mipso-printed", 0, 2550).row
    assert row["claimed_gap"] < -0.01
    assert row["keeps_limits"] is False
    assert row["stretch"] > 1.05
    assert "acceleration of joint" in row["worst"]
    assert row["gap"] > 0.0


def test_a_search_that_finds_nothing_feasible_stays_a_visible_row() -> None:
    # the first cube arrives at 1 rad still moving, so every 3-5-3 spline overshoots its limit there
    turning = Problem.of([[0.0], [1.0], [-1.0], [0.0]], Limits.of(1.0, position=(-1.0, 1.0), dof=1))
    for coding in CODINGS:
        row = graded(turning, 1.0, coding, "random", 0, 60).row
        assert row["status"] == "no-feasible-point"
        assert row["note"]
        assert row["seconds"] is row["gap"] is None


def test_a_problem_in_which_nothing_moves_is_a_row_too() -> None:
    still = Problem.of(np.ones((4, 2)), Limits.of(1.0, dof=2))
    row = graded(still, 1.0, "published", "pso", 0, 40).row
    assert row["status"] == "nothing-moves"


def test_random_numbers_depend_on_the_run_alone() -> None:
    problem, bound = load("cobot"), optimum("cobot").seconds
    first = graded(problem, bound, "published", "mipso", 3, 300)
    again = graded(problem, bound, "published", "mipso", 3, 300)
    other = graded(problem, bound, "published", "mipso", 4, 300)
    without_times = [{k: v for k, v in g.row.items() if k not in TIMES} for g in (first, again, other)]
    assert without_times[0] == without_times[1]
    assert first.traces == again.traces
    assert without_times[0]["durations"] != without_times[2]["durations"]


# --- statistics -----------------------------------------------------------------------------------


def test_a_summary_counts_every_row_and_leaves_none_out() -> None:
    rows = [
        {"case": "c", "coding": "published", "swarm": "s", "gap": gap, "claimed_gap": gap,
         "keeps_limits": kept, "stretch": 1.2 if kept is False else 1.0, "seconds": gap}
        for gap, kept in ((0.1, True), (0.3, False), (0.2, False), (None, None))
    ]  # fmt: skip
    found = summaries(rows)["c", "published", "s"]
    assert (found.seeds, found.unsolved, found.breaking) == (4, 1, 2)
    assert found.gap == pytest.approx(0.2)
    assert (found.least, found.most, found.stretch) == (0.1, 0.3, 1.2)


def test_convergence_is_infinite_before_the_first_feasible_point_and_ends_at_the_best() -> None:
    traces = [[Trace(-1, [10, 40, 100], [4.0, 3.0, 2.0])]]
    grid, (_, middle, _) = convergence(traces, {-1: 2.0}, 100)
    assert np.isinf(middle[grid < 10]).all()
    assert (middle[(grid >= 10) & (grid < 40)] == 1.0).all()
    assert middle[-1] == 0.0


# --- rows on disk ---------------------------------------------------------------------------------


def stored(folder: Path, count: int) -> Store:
    store = Store(folder)
    store.clear()
    problem = load("sr4c")
    facts = {"problem": "p", "versions": "v", "machine": "m, with a comma"}
    for seed in range(count):
        store.add(graded(problem, 4.7, "shared", "random", seed, 30), facts)
    return store


def test_rows_come_back_as_they_were_written(tmp_path: Path) -> None:
    store = stored(tmp_path, 2)
    rows = store.rows()
    assert [row["seed"] for row in rows] == [0, 1]
    original = graded(load("sr4c"), 4.7, "shared", "random", 1, 30).row
    for name, value in original.items():
        if name not in TIMES:
            assert rows[1][name] == value, name
    assert set(store.traces()) == {key_of(row) for row in rows}


def test_a_row_cut_short_by_a_crash_is_passed_over_and_the_rest_kept(tmp_path: Path) -> None:
    store = stored(tmp_path, 3)
    for path in (store.rows_file, store.traces_file):
        path.write_bytes(path.read_bytes()[:-20])
    assert len(store.rows()) == 2
    store.mend()
    assert len(store.rows()) == 2
    assert store.rows_file.read_text().endswith("\n")


def test_a_table_of_something_else_is_refused_in_one_line(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.rows_file.write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match="not a table of this version"):
        store.rows()
    store.rows_file.write_text(",".join(COLUMNS) + "\n" + ",".join(["x"] * len(COLUMNS)) + "\n")
    with pytest.raises(InputError, match="line 2"):
        store.rows()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_full_disk_is_one_line(tmp_path: Path) -> None:
    store = stored(tmp_path, 1)
    store.rows_file.unlink()
    store.rows_file.symlink_to("/dev/full")
    facts = {"problem": "p", "versions": "v", "machine": "m"}
    with pytest.raises(InputError, match=r"rows\.csv: cannot be written: .*[Nn]o space"):
        store.add(graded(load("sr4c"), 4.7, "shared", "random", 9, 30), facts)


# --- commands -------------------------------------------------------------------------------------


def command(name: str, *options: str, **how: float) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "compare", name, *options],
        capture_output=True, text=True, cwd=ROOT, timeout=how.get("timeout", 300.0), check=False,
    )  # fmt: skip


SMALL = ("--cases", "sr4c,cobot", "--swarms", "pso,whale", "--seeds", "2", "--budget", "200")


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report")
    done = command("all", *SMALL, "--jobs", "2", "--out", str(folder))
    assert done.returncode == 0, done.stderr
    return folder


def comparable(folder: Path) -> list[dict[str, object]]:
    return [{k: v for k, v in row.items() if k not in TIMES} for row in Store(folder).rows()]


def test_workers_are_the_only_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")  # somebody's own choice
    with workers(1) as pool:
        found = list(pool.map(os.getenv, ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")))
    assert found == ["1", "3"]
    assert "OMP_NUM_THREADS" not in os.environ


def test_one_worker_and_two_write_the_same_rows(report: Path, tmp_path: Path) -> None:
    done = command("all", *SMALL, "--jobs", "1", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert len(comparable(tmp_path)) == 2 * 2 * 3 * 2
    assert comparable(tmp_path) == comparable(report)


def test_the_page_stands_alone_and_holds_what_it_promises(report: Path) -> None:
    page = (report / "index.html").read_text()
    sources = re.findall(r'src="([^"]{0,40})', page)
    assert len(sources) == 12  # five figures and an arm for each case
    assert all(source.startswith("data:image/svg+xml;base64,") for source in sources)
    assert "<script" not in page
    assert "<link" not in page
    for word in ("breaks", "Known limitations", "numpy=", "cores", "pso", "whale", "4.7007"):
        assert word in page
    text = (report / "report.md").read_text()
    assert "| pso |" in text
    for words in ("The five papers", "What is known of its task", "What its published numbers say"):
        assert words in page
        assert words in text
    # of each paper one verdict that was checked by hand
    for proof in ("0.471 % below the certified minimum", "3.139 is printed, the sum is 4.1358"):
        assert proof in page
        assert proof in text
    assert "papers/sr4c.html" not in page  # nobody has written it
    assert "<animate" in (report / "figures" / "sr4c-arm.svg").read_text()
    assert set(Store(report).audits()) == {"sr4c", "cobot"}
    for case in ("sr4c", "cobot"):
        for name in ("ladder", "gaps", "convergence", "motion"):
            for ending in ("svg", "png"):
                assert (report / "figures" / f"{case}-{name}.{ending}").stat().st_size > 5000
            assert f"figures/{case}-{name}.png" in text


def test_every_run_is_a_row_with_versions_seed_budget_and_machine(report: Path) -> None:
    with (report / "rows.csv").open() as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == 24
    for row in rows:
        assert row["versions"].startswith("python=")
        assert "cores" in row["machine"]
        assert row["budget"] == "200"
        assert row["seed"] in "01"


def test_the_report_can_be_drawn_again_from_its_rows(report: Path) -> None:
    before = (report / "index.html").read_text()
    done = command("report", str(report))
    assert done.returncode == 0, done.stderr
    assert (report / "index.html").read_text() == before


@pytest.mark.slow
def test_a_killed_run_leaves_readable_rows_and_resume_ends_like_an_unbroken_one(
    report: Path, tmp_path: Path
) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "compare.all", *SMALL, "--jobs", "1", "--out", str(tmp_path)],
        cwd=ROOT, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    deadline = time.monotonic() + 120.0
    while time.monotonic() < deadline and process.poll() is None:
        if (tmp_path / "rows.csv").exists() and len(Store(tmp_path).rows()) >= 5:
            break
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    left = comparable(tmp_path)
    assert len(left) >= 5
    assert all(row in comparable(report) for row in left)
    done = command("all", *SMALL, "--jobs", "1", "--out", str(tmp_path), "--resume")
    assert done.returncode == 0, done.stderr
    assert comparable(tmp_path) == comparable(report)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
def test_an_interrupt_is_one_line_and_leaves_whole_rows(tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "compare.all", "--swarms", "pso", "--seeds", "5000", "--cases", "cobot",
         "--out", str(tmp_path)],
        cwd=ROOT, stderr=subprocess.PIPE, text=True, start_new_session=True,
        # a shell that runs the tests in the background ignores interrupts, and so would the child
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    deadline = time.monotonic() + 120.0
    while time.monotonic() < deadline and len(Store(tmp_path).rows()) < 5:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert errors.strip().splitlines()[-1] == "interrupted; what was finished is on disk"
    assert len(Store(tmp_path).rows()) >= 5


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("all", "--cases", "sr4d"), ("--cases", "sr4d", "sr4c", "bagging")),
        (("all", "--swarms", "psoo"), ("--swarms", "psoo", "pso-linear", "whale")),
        (("all", "--swarms", "nowhere:swarm"), ("--swarms", "nowhere:swarm", "ModuleNotFoundError")),
        (("all", "--swarms", "ipso"), ("--swarms", "ipso", "not reproducible")),
        (("all", "--apart", "0"), ("--apart", "0")),
        (("all", "--codings", "x"), ("--codings", "published", "stretched")),
        (("all", "--cases", ","), ("--cases", "none given", "sr4c")),
        (("all", "--seeds", "0"), ("--seeds", "0")),
        (("all", "--jobs", "-1"), ("--jobs", "-1")),
        (("all", "--budget", "many"), ("--budget", "many")),
        (("all", "--quickly"), ("--quickly",)),
        (("all", "--quick", "--full"), ("--full", "--quick")),
        (("all", "--out", "/dev/null/report"), ("--out", "/dev/null/report")),
        (("solve", "nowhere.toml"), ("nowhere.toml", "no such file", "sr4c")),
        (("solve",), ("FILE",)),
        (("solve", "sr4c", "--json", "/dev/null/x.json"), ("/dev/null/x.json", "cannot be written")),
        (("report", "/nowhere"), ("/nowhere",)),
        (("speed", "--case", "bagging"), ("bagging", "3-5-3")),
    ],
)
def test_bad_input_is_one_clear_line_and_exit_code_2(
    options: tuple[str, ...], words: tuple[str, ...]
) -> None:
    done = command(*options)
    assert done.returncode == 2, done.stderr
    last = done.stderr.strip().splitlines()[-1]
    assert "Traceback" not in done.stderr
    for word in words:
        assert word in last


def test_solve_prints_the_ladder_and_writes_it_as_json(tmp_path: Path) -> None:
    target = tmp_path / "ladder.json"
    done = command("solve", "cobot", "--json", str(target))
    assert done.returncode == 0, done.stderr
    assert "3.3495" in done.stdout
    assert '"family_longest_segment"' in target.read_text()


def test_speed_names_its_rivals_and_their_errors() -> None:
    done = command("speed", "--rounds", "1")
    assert done.returncode == 0, done.stderr
    for word in ("14x14", "one candidate at a time", "independent check", "times slower"):
        assert word in done.stdout


# --- the house ------------------------------------------------------------------------------------


def imported(path: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add((node.module or "").split(".")[0])
    return names


@pytest.mark.parametrize(
    ("package", "forbidden"),
    [
        ("formulations", {"metaheuristics", "compare", "matplotlib"}),
        ("metaheuristics", {"formulations", "compare", "matplotlib", "numba", "casadi"}),
    ],
)
def test_data_flows_one_way(package: str, forbidden: set[str]) -> None:
    files = list((ROOT / package).rglob("*.py"))
    assert files
    for path in files:
        assert not imported(path) & forbidden, path


def test_the_check_shares_no_code_with_the_kernels() -> None:
    assert "families" not in (ROOT / "formulations" / "motion" / "trajectory.py").read_text()


def test_the_readme_shows_exactly_two_set_up_and_run_lines() -> None:
    lines = [line for line in (ROOT / "README.md").read_text().splitlines() if "-m venv" in line]
    assert len(lines) == 2
    assert lines[0].endswith("-m compare.all")
    assert lines[1].endswith("-m pytest")
    assert all("-c constraints.txt" in line for line in lines)


def test_the_full_comparison_uses_the_papers_own_budgets() -> None:
    full = {run.case: run for run in suite.runs(size="full", swarms=["pso"], codings=["shared"])}
    assert full["sr4c"].budget == 50 * 51
    assert full["ur5"].population == 1000
    assert full["cobot"].budget == full["bagging"].budget == 20 * 201


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of the notebook machinery, not ours
@pytest.mark.parametrize("path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda p: p.stem)
def test_the_notebook_runs_from_a_clean_kernel(path: Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(
        notebook, timeout=180, resources={"metadata": {"path": str(ROOT)}}
    ).execute()
    outputs = [o for cell in notebook.cells if cell.cell_type == "code" for o in cell.outputs]
    pictures = [output for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) >= 3
