"""The format of a paper's TOML file: every key, once, with its meaning, unit and example.

The reader refuses what does not stand here (``keys.check_keys``); the reference of the keys
(docs/paper_file.md) and the template (``timebound audit --template``) are made of it (``reference``).
The examples belong to one paper, which is made up and sound.
"""

from __future__ import annotations

from compare.audit.paper.keys import Key, KeyTable
from compare.audit.paper.settings_format import LEFT_OUT, SETTINGS
from formulations import FAMILIES
from formulations.arms import ARMS
from formulations.arms.dh_table import FORMS

_WHERE = "place in the paper, as verdicts name it"

_WAYPOINTS = {
    "where": Key("text", _WHERE, '"Table 1"', shown=True),
    "unit": Key("text", "unit of the angles: rad or deg", '"deg"', needed=True, shown=True),
    "rows": Key(
        "list", "one row of joint angles per waypoint, in the order of the motion",
        '[["0.0", "30.0"], ["20.0", "45.0"], ["55.0", "20.0"], ["70.0", "10.0"]]', "unit", shown=True,
    ),
    "count": Key("whole number", "number of waypoints, where the paper does not print them", "4"),
}  # fmt: skip

_DH = {
    "where": Key("text", _WHERE, '"Table 2"', shown=True),
    "form": Key(
        "text", f"{FORMS[0]}: a row holds a_i and alpha_i; {FORMS[1]} (Craig): a_(i-1) and alpha_(i-1)",
        '"standard"', needed=True, shown=True,
    ),
    "length": Key("text", "unit of d and a: m or mm", '"mm"', needed=True, shown=True),
    "angle": Key("text", "unit of alpha and offset: rad or deg", '"deg"', needed=True, shown=True),
    "d": Key("list", "link offset of each joint", "[0, 0]", "length", needed=True, shown=True),
    "a": Key("list", "link length of each joint", "[300, 250]", "length", needed=True, shown=True),
    "alpha": Key("list", "link twist of each joint", "[0, 0]", "angle", needed=True, shown=True),
    "offset": Key(
        "list", "DH angle of each joint at joint angle 0: -90 where the column theta prints theta2 - 90; "
        "0 if left out", "[0, 0]", "angle", shown=True,
    ),
    "sign": Key("list", "1, or -1 where a joint counts against its DH angle; 1 if left out", "[1, 1]"),
    "joints": Key(
        "list", "revolute for each joint; an arm with a prismatic joint is refused",
        '["revolute", "revolute"]',
    ),
}  # fmt: skip

_LIMITS = {
    "name": Key("text", "name of the table of limits, to which time vectors refer", '"Table 3"',
                needed=True, shown=True),
    "unit": Key("text", "unit of the angles in the limits: rad or deg", '"deg"', needed=True, shown=True),
    "joint": Key("whole number", "the one joint that they hold for, from 1; all joints if left out", "1"),
    "velocity": Key("number or list", "velocity limit of each joint", "[90, 90]", "unit/s", shown=True),
    "acceleration": Key("number or list", "acceleration limit of each joint", '["250", "250"]', "unit/s^2",
                        shown=True),
    "jerk": Key("number or list", "jerk limit of each joint", "[900, 900]", "unit/s^3"),
    "position": Key("list", "lowest and highest angle of each joint", "[[-180, 180], [-120, 120]]", "unit",
                    shown=True),
}  # fmt: skip

_TABLE = {
    "where": Key("text", _WHERE, '"Table 4"', needed=True, shown=True),
    "by": Key("text", "method that made the times", '"PSO"', shown=True),
    "limits": Key("text", "name of the limits that the times were made under; none if left out",
                  '"Table 3"', shown=True),
    "joints": Key("list", 'joint of each time vector, from 1; "all" for one that the joints share',
                  "[1, 2]", needed=True, shown=True),
    "times": Key("list", "one time vector per entry of joints: the duration of each segment",
                 '[["0.90", "1.20", "0.90"], ["1.00", "1.10", "0.80"]]', "s", needed=True, shown=True),
    "totals": Key("list", "total printed beside each time vector", '["3.00", "2.90"]', "s", shown=True),
    "longest": Key("list", "longest time of each segment over the joints, as printed",
                   '["1.00", "1.20", "0.90"]', "s"),
    "longest_where": Key("text", "place of the motion that takes the longest times; it or longest makes "
                         "the audit judge that motion", '"Table 4, last row"', shown=True),
    "total": Key("number", "total of the longest times, as printed", '"3.10"', "s", shown=True),
}  # fmt: skip

_TOTALS = {
    "where": Key("text", _WHERE, '"Table 5"', needed=True, shown=True),
    "by": Key("text", "method that made the totals", '"GA"', shown=True),
    "limits": Key("text", "name of the limits that they were made under; none if left out", '"Table 3"',
                  shown=True),
    "joint": Key("whole number", "joint, from 1; all joints if left out", "1", shown=True),
    "values": Key("list", "total times of runs whose time vectors are not printed", '["3.21", "3.35"]', "s",
                  needed=True, shown=True),
    "mean": Key("number", "their mean, as printed", '"3.28"', "s", shown=True),
}  # fmt: skip

_CLAIM = {
    "where": Key("text", _WHERE, '"abstract"', needed=True, shown=True),
    "says": Key("text", "what the paper claims", '"11.4 % shorter than 3.5 s"', needed=True, shown=True),
    "rule": Key("text", "arithmetic of the claim: sum, difference, mean, or reduction in per cent",
                '"reduction"', needed=True, shown=True),
    "of": Key("list", "numbers that the rule is applied to; the earlier one of two comes first",
              '[3.5, "3.10"]', needed=True, shown=True),
    "equals": Key("number", "result as printed", '"11.4"', needed=True, shown=True),
}  # fmt: skip

_POINT = {
    "where": Key("text", _WHERE, '"Table 6, P1"', needed=True, shown=True),
    "waypoint": Key("whole number", "waypoint whose joint angles lead there, from 1", "1", needed=True,
                    shown=True),
    "length": Key("text", "unit of the position: m or mm", '"mm"', needed=True, shown=True),
    "position": Key("list", "x, y, z of the tool in the frame of the base", '["516.5", "125.0", "0.0"]',
                    "length", needed=True, shown=True),
    "rpy": Key("list", "roll, pitch, yaw of the tool: Rz(yaw) Ry(pitch) Rx(roll)", '["0.0", "0.0", "30.0"]',
               "angle", shown=True),
    "angle": Key("text", "unit of rpy: rad or deg; rad if left out", '"deg"', shown=True),
}  # fmt: skip

_VARIANT = {
    "name": Key("text", "name of the reading", '"corrected"', needed=True),
    "waypoint": Key("whole number", "waypoint, from 1", "2", needed=True),
    "joint": Key("whole number", "joint, from 1", "1", needed=True),
    "value": Key("number", "the angle with the other sign", '"-20.0"', "unit of the waypoints", needed=True),
}  # fmt: skip

FORMAT: dict[str, Key | KeyTable] = {
    "title": Key("text", "paper in a few words", '"Planar arm, 3-5-3, PSO"', shown=True),
    "source": Key("text", "authors, journal, year", '"a made-up example"', shown=True),
    "notes": Key("text", "what a reader of the verdicts has to know", '"Replace every number by your own."',
                 shown=True),
    "case": Key("text", "shipped papers only: case of formulations with the same task", '"planar"'),
    "family": Key("text", f"spline that the times belong to: {', '.join(FAMILIES)}", '"3-5-3"', needed=True,
                  shown=True),
    "limited": Key("list", "derivatives that the paper limits: velocity, acceleration, jerk; velocity if "
                   "left out", '["velocity", "acceleration"]', shown=True),
    "arm": Key("text", f"a shipped arm ({', '.join(ARMS)}) in place of [dh]", '"ur5"'),
    "waypoints": KeyTable("The joint angles that the motion passes.", _WAYPOINTS, needed=True, shown=True),
    "dh": KeyTable("The Denavit-Hartenberg table of the arm; the printed points are judged through it.", _DH,
                shown=True),
    "limits": KeyTable("Stated limits, one table each.", _LIMITS, many=True, shown=True),
    "table": KeyTable("Time vectors of one method.", _TABLE, many=True, shown=True),
    "totals": KeyTable("Total times without a time vector.", _TOTALS, many=True, shown=True),
    "claim": KeyTable("Arithmetic in the text.", _CLAIM, many=True, shown=True),
    "point": KeyTable("A Cartesian point of the tool that belongs to a waypoint.", _POINT, many=True,
                      shown=True),
    "variant": KeyTable("Another reading of one joint angle, audited beside the printed one.", _VARIANT,
                     many=True),
    "settings": SETTINGS,
    "left_out": LEFT_OUT,
}  # fmt: skip
