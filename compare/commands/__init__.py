"""The commands: one thin file each, and the one list of them, ``COMMANDS``.

A command is a function whose parameters are its options; what it computes stands in the libraries. A
new one is one file and one line here. Nothing is imported before its command is asked for, so that
``timebound --help`` answers at once.
"""

from __future__ import annotations

from dataclasses import dataclass

DONE, FAILED, BAD_INPUT, BROKEN, INTERRUPTED = 0, 1, 2, 3, 130  # exit codes


@dataclass(frozen=True)
class Command:
    """One command of ``timebound``.

    name, and the function behind it as ``module:function``; purpose: one line of help; example: a call
    of it; group: under which title it is listed.
    """

    name: str
    target: str
    group: str
    purpose: str
    example: str


MOTIONS, COMPARISON = "Motions and bounds", "Comparison of swarms"
PAPERS, STUDIES = "Published results", "Studies"

_ALL = (
    Command(
        "new", "compare.commands.motions.new:new", MOTIONS,
        "Write a problem file: from a robot's files, from options, or from your answers.",
        "timebound new --from-urdf arm.urdf --limits joint_limits.yaml --waypoints path.csv -o mine.toml",
    ),
    Command(
        "solve", "compare.commands.motions.solve:solve", MOTIONS,
        "Find every bound of one problem, and what limits its fastest motion.",
        "timebound solve sr4c --json sr4c.json",
    ),
    Command(
        "plan", "compare.commands.motions.plan:plan", MOTIONS,
        "Find the fastest motion through the waypoints, also with stops or given times.",
        "timebound plan ur5 --stop 1 --pass 2=12.48 --export ur5.csv --rate 125",
    ),
    Command(
        "check", "compare.commands.motions.check:check_motion", MOTIONS,
        "Judge a motion made elsewhere: limits, waypoints, jumps, gap to the bound.",
        "timebound check sr4c motion.csv --interpolation cubic --json verdict.json",
    ),
    Command(
        "view", "compare.commands.motions.view:view", MOTIONS,
        "Open a page about a problem or a motion: limits, bounds, curves, the arm.",
        "timebound view sr4c motion.csv --out sr4c.html",
    ),
    Command(
        "retime", "compare.commands.motions.retime:retime_motion", MOTIONS,
        "Time a path or a motion anew: TOPP-RA, COPP, and freely within a tolerance.",
        "timebound retime path.csv --limits ur5 --tolerance 0.005 --export faster.csv",
    ),
    Command(
        "split", "compare.commands.motions.split:split", MOTIONS,
        "Show where a swarm's motion loses its time: search, spline, timing, path.",
        "timebound split sr4c --swarm pso --figure split.svg",
    ),
    Command(
        "motion_picture", "compare.commands.motions.motion_picture:motion_picture", MOTIONS,
        "Draw the arm of a case as it moves along the fastest spline (SVG).",
        "timebound motion_picture sr4c --out sr4c.svg",
    ),
    Command(
        "check_certificate", "compare.commands.motions.check_certificate:check_certificate", MOTIONS,
        "Prove a certified bound again, by a checker that shares no code with the prover.",
        "timebound check_certificate sr4c.cert.json --problem sr4c",
    ),
    Command(
        "grade", "compare.commands.benchmark.grade:grade_swarm", COMPARISON,
        "Say whether a swarm is better than another: one verdict, one page.",
        "timebound grade mine.py:swarm --against pso --out grade --json verdict.json",
    ),
    Command(
        "versus", "compare.commands.benchmark.versus:versus", COMPARISON,
        "Compare any two swarms on the held-out instances.",
        "timebound versus mealpy:OriginalGWO whale",
    ),
    Command(
        "all", "compare.commands.all:compare_all", COMPARISON,
        "Grade every swarm on every case, audit the papers, and write the report.",
        "timebound all --cases sr4c,ur5 --swarms pso,mipso --seeds 30 --out report",
    ),
    Command(
        "tune", "compare.commands.tune:tune_swarms", COMPARISON,
        "Tune the constants of swarms on the open instances, with equal effort.",
        "timebound tune --swarms pso,whale --trials 60 --out tuned",
    ),
    Command(
        "report", "compare.commands.report:report", COMPARISON,
        "Draw the report of a comparison again from its stored rows.",
        "timebound report report",
    ),
    Command(
        "merge", "compare.commands.benchmark.merge:merge_folders", COMPARISON,
        "Merge the results of folders into what one comparison would have given.",
        "timebound merge seeds-0-9 seeds-10-19 --out both",
    ),
    Command(
        "export", "compare.commands.benchmark.export:export", COMPARISON,
        "Write rows and traces for polars, IOHanalyzer and COCO.",
        "timebound export report --parquet --ioh",
    ),
    Command(
        "audit", "compare.commands.audit:audit_papers", PAPERS,
        "Judge published results: are limits kept, could they be that fast?",
        "timebound audit sr4c --json audit.json",
    ),
    Command(
        "papers", "compare.commands.papers:papers", PAPERS,
        "Make the tables and figures of the five papers again, beside the printed ones.",
        'timebound papers sr4c --item "Table 9" --out report',
    ),
    Command(
        "cite", "compare.commands.cite:cite", PAPERS,
        "Print BibTeX for exactly the methods and papers that a run has used.",
        "timebound cite sr4c --swarms pso,mipso",
    ),
    Command(
        "table8", "compare.commands.studies.table8:table8", PAPERS,
        "Run Table 8 of Wang 2025 again, beside the bound that no run can beat.",
        "timebound table8 --runs 1000 --out report",
    ),
    Command(
        "ablation", "compare.commands.studies.ablation:ablation", PAPERS,
        "Run Table 3 of Wang 2025 again: MIPSO without one strategy at a time.",
        "timebound ablation --full --out report",
    ),
    Command(
        "readings", "compare.commands.studies.readings:readings", PAPERS,
        "Run each formula as printed and as it can be meant, and show the difference.",
        "timebound readings --seeds 30 --out report",
    ),
    Command(
        "bias", "compare.commands.studies.bias:bias", STUDIES,
        "Measure which swarms are drawn to zero.",
        "timebound bias --swarms pso,whale,sparrow --seeds 30 --out report",
    ),
    Command(
        "proofs", "compare.commands.studies.proofs:proofs", STUDIES,
        "Measure what a certified bound costs, on random problems.",
        "timebound proofs --count 1000 --segments 10 --out report",
    ),
    Command(
        "speed", "compare.commands.studies.speed:speed", STUDIES,
        "Count candidate checks per second, beside the papers' way.",
        "timebound speed --case ur5",
    ),
    Command(
        "free_form_study", "compare.commands.studies.free_form_study:free_form_study", STUDIES,
        "Find the fastest motion on cases, extremes and random problems, and its gap.",
        "timebound free_form_study --count 200 --json answers.json",
    ),
    Command(
        "condition_gaps", "compare.commands.studies.condition_gaps:condition_gaps", STUDIES,
        "Find motions under each kind of condition on random problems, and their gaps.",
        "timebound condition_gaps --count 100 --out report",
    ),
    Command(
        "scale", "compare.commands.studies.scale:scale", STUDIES,
        "Measure time and memory of motion and proof against the number of waypoints.",
        "timebound scale --counts 10,30,100,300 --step 2.5 --out report",
    ),
    Command(
        "tool_gaps", "compare.commands.studies.tool_gaps:tool_gaps", STUDIES,
        "Find motions under a limit of the tool's speed on random problems, and their gaps.",
        "timebound tool_gaps --count 100 --out report",
    ),
    Command(
        "torque_gaps", "compare.commands.studies.torque_gaps:torque_gaps", STUDIES,
        "Find motions of an arm under torque limits on random problems, and their gaps.",
        "timebound torque_gaps ur5_robot.urdf --payload 2 --count 100 --out report",
    ),
    Command(
        "rivals", "compare.commands.studies.rivals:rivals", STUDIES,
        "Run other programs on the same tasks: times, broken limits, distance to the bound.",
        "timebound rivals sr4c --rivals drake_spline,scip --time-limit 30 --page rivals.html",
    ),
)  # fmt: skip

COMMANDS: dict[str, Command] = {command.name: command for command in _ALL}
