"""What a hint says, and the change of a paper that it rests on."""

from __future__ import annotations

from dataclasses import dataclass

from compare.audit.paper import Paper

# kind -> the question that it asks; in the order of the report
QUESTIONS: dict[str, str] = {
    "angle unit": "deg and rad mixed?",
    "time unit": "seconds and minutes or milliseconds mixed?",
    "length unit": "m and mm mixed?",
    "sign": "one sign wrong?",
    "swap": "two columns or rows swapped?",
    "other table": "limits of another table in force?",
    "dh": "another reading of the DH table?",
}


@dataclass(frozen=True)
class Change:
    """A paper with one thing changed.

    Attributes
    ----------
    kind : str
        A key of ``QUESTIONS``.
    tried : str
        What was changed, in words.
    paper : Paper
        With the change.
    whole : bool
        Whether the change explains nothing unless every faulty place that it touches becomes sound: for a
        change that loosens or scales many numbers at once.
    """

    kind: str
    tried: str
    paper: Paper
    whole: bool = False


@dataclass(frozen=True)
class Hint:
    """A change that would explain some of a paper's faults.

    Attributes
    ----------
    kind : str
        A key of ``QUESTIONS``.
    tried : str
        What was changed.
    explains : tuple of str
        The places in the paper that become sound; no sound place becomes faulty.
    removes, of : int
        How many faults were found at these places, and how many in all.
    others : tuple of str
        Other changes of this kind that explain the same places, the likeliest first.
    remark : str
        Further numbers of the change; may be empty.
    """

    kind: str
    tried: str
    explains: tuple[str, ...]
    removes: int
    of: int
    others: tuple[str, ...] = ()
    remark: str = ""

    @property
    def text(self) -> str:
        """The hint as one line for people."""
        found = f"{self.of} fault" + ("s" if self.of != 1 else "")
        shown = ", ".join(self.explains[:3])
        more = f" and {len(self.explains) - 3} more" if len(self.explains) > 3 else ""
        told = f"tried: {self.tried}; "
        if not self.removes:
            return f"{told}none of {found} goes, but {self.remark}"
        told += f"this would explain {shown}{more} and remove {self.removes} of {found}"
        if self.others:
            rest = len(self.others) - 1
            told += f"; so would {self.others[0]}{f', and {rest} more of this kind' if rest else ''}"
        return f"{told}; {self.remark}" if self.remark else told
