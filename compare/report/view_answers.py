"""The answers of the page of one problem or motion, computed from what was found."""

from __future__ import annotations

from compare.benchmark.records.rows import BoundProof
from compare.benchmark.summaries import bound_of
from compare.report.answers import Answer
from compare.report.judged import distance, mending
from compare.report.viewed import Viewed
from compare.report.words import percent
from formulations.assessment import Assessment

_REACHED = 1e-5  # gap at which a motion cannot be told from the fastest in the digits shown

_S = "\N{NO-BREAK SPACE}s"


def headline(viewed: Viewed) -> str:
    """Return the one sentence that stands above everything.

    Parameters
    ----------
    viewed : Viewed

    Returns
    -------
    str
    """
    name, given = viewed.problem.name, viewed.given
    if given is not None:
        if not given.judgement.feasible:
            return f"{viewed.file} breaks what {name} asks for: {what_is_wrong(given)}"
        kept = f"{viewed.file} keeps everything that {name} asks for"
        if given.gap is None or given.conditions.total is not None:
            return kept
        return f"{kept}, and takes at most {percent(given.gap)} longer than the fastest motion"
    whose = f"{name} under the conditions" if viewed.is_conditional else name
    seconds, bound = viewed.seconds, viewed.bound
    proved = (
        f"no {'such ' if viewed.is_conditional else ''}motion takes less than {bound or 0.0:.4f}{_S}"
    )
    if seconds is None:
        found = f"No motion was {'found' if viewed.was_sought else 'asked'} for {whose}"
        return f"{found}; {proved}" if bound else found
    if viewed.conditions.total is not None:
        return f"The smoothest motion of {whose} takes {seconds:.4f}{_S}"
    if not bound:
        return f"The fastest motion found for {whose} takes {seconds:.4f}{_S}"
    gap = max(seconds / bound - 1.0, 0.0)
    if gap < _REACHED:
        return f"The fastest motion of {whose} takes {seconds:.4f}{_S}, proved to within {percent(gap)}"
    return (
        f"The fastest motion found for {whose} takes {seconds:.4f}{_S}; {proved} (gap {percent(gap)})"
    )


def answers_of(viewed: Viewed) -> list[Answer]:
    """Return the answers below the headline.

    Parameters
    ----------
    viewed : Viewed

    Returns
    -------
    list of Answer
        Of the given motion: its worst fault, what would mend it, how far it is. Of the problem: the fastest
        motion, the bound, the best spline, what limits the motion.
    """
    found = [] if viewed.given is None else _of_motion(viewed.given)
    return found + _of_problem(viewed)


def what_is_wrong(given: Assessment) -> str:
    """Count the faults of a motion in few words.

    Parameters
    ----------
    given : Assessment

    Returns
    -------
    str
        ``keeps everything`` where there are none.
    """
    found = given.judgement
    parts = []
    if found.violations:
        joints = len({peak.joint for peak in found.violations} - {-1})  # -1 is the tool
        most = max(peak.factor for peak in found.violations)
        limits = _count(len(found.violations), "broken limit")
        whose = f" of {_count(joints, 'joint')}" if joints else ""
        parts.append(f"{limits}{whose}, up to {most:.4g} times the limit")
    if found.jumps:
        parts.append(f"{' and '.join(dict.fromkeys(jump.quantity for jump in found.jumps))} jumps")
    if found.not_at_rest:
        parts.append("not at rest" if found.conditions.none else "not as asked for at ends or stops")
    if found.missed:
        parts.append(_count(len(found.missed), "missed waypoint"))
    if found.unkept:
        parts.append(_count(len(found.unkept), "unkept condition"))
    if found.missed_total is not None:
        parts.append("another total time than asked for")
    return "; ".join(parts) or "keeps everything"


def _of_motion(given: Assessment) -> list[Answer]:
    """Its worst fault, what would mend it, and how far it is from the bound."""
    found, made = given.judgement, []
    if found.violations:
        worst = found.violations[0]
        whose = given.problem.joint_name(worst.joint)
        text = f"Worst: {worst.factor:.6g} times the {worst.quantity} limit of {whose}"
        made.append(Answer(text, _sentence(str(worst)), "wrong"))
    for lines, else_, anchor in (
        (mending(given), "A stretch multiplies every duration by one factor.", "motion"),
        (distance(given), "", "ladder"),
    ):
        if lines:
            first, *others = map(_sentence, lines)
            made.append(Answer(first.removesuffix("."), " ".join(others) or else_, anchor))
    return made


def _of_problem(viewed: Viewed) -> list[Answer]:
    """The fastest motion, the bound, the best spline, and what limits the motion."""
    record, seconds, bound = viewed.record, viewed.seconds, viewed.bound
    family, conditional = viewed.problem.family, viewed.is_conditional
    under = " under the conditions" if conditional else ""
    made = []
    if seconds is not None:
        best = "fastest" if viewed.conditions.total is None else "smoothest"
        detail = "It passed the check of limits, waypoints, rest and jumps."
        if bound and viewed.conditions.total is None:
            detail += f" Its gap to the proved bound: {percent(max(seconds / bound - 1.0, 0.0))}."
        text = f"The {best} motion known{under} takes {seconds:.6f}{_S}"
        made.append(Answer(text, detail, "motion"))
    if bound and viewed.given is None:  # else the motion's own answer has said it
        what = "the limits and the conditions" if conditional else "the limits"
        detail = f"This is proved for every motion through the waypoints that keeps {what}."
        text = f"No motion{under} takes less than {bound:.6f}{_S}"
        if viewed.conditions.total is not None:
            text = f"Without a total time, no such motion takes less than {bound:.6f}{_S}"
        made.append(Answer(text, detail, "ladder"))
    spline = record["ladder"]["family"]["seconds"]
    if spline is not None:
        proved = bound_of(record)[1] is BoundProof.certified
        detail = "No durations give a faster one: proved." if proved else "Not proved to be the best."
        if seconds and not conditional and viewed.best != "family":
            detail += f" It takes {percent(spline / seconds - 1.0)} longer than the fastest motion."
        text = f"The best {family} spline takes {spline:.6f}{_S}"
        text += " without the conditions" if conditional else ""
        made.append(Answer(text, detail, "ladder"))
    held = record["held_up_by"]
    if held and not conditional:
        made.append(Answer("What limits the fastest motion most", _sentence(held[0]), "numbers"))
    return made


def _sentence(words: str) -> str:
    """A line of a command as a sentence of a page."""
    return f"{words[:1].upper()}{words[1:]}{'' if words.endswith('.') else '.'}"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
