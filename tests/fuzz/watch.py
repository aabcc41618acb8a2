"""One call of a reader under watch: how it may end, how long it may take, what it must not touch.

A reader ends with an answer or with one line of a named error. It writes nothing, starts nothing, opens no
connection, and reads only what lies beside its input, unless the input names other files.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from compare.check_certificate.answers import BadInput, Refused
from formulations import InputError

SLOWEST = 5.0  # s of processor time for one input, ten times what the slowest takes
WAITING = 20.0  # times as much by the clock, for a reader that waits and computes nothing
MEMORY = 2_000_000_000  # bytes of address space beyond what the process has
LONGEST = 1000  # characters of an error

_FORBIDDEN = (
    "os.",
    "shutil.",
    "subprocess.",
    "socket.",
    "tempfile.",
    "pickle.",
    "sqlite3.",
    "ftplib.",
    "urllib.",
)
_HARMLESS = (
    "os.listdir",
    "os.scandir",
    "os.walk",
    "os.fwalk",
    "os.getxattr",
    "os.listxattr",
    "os.putenv",
    "sqlite3.connect/handle",
)
_ALARMS = (signal.SIGALRM, signal.SIGPROF)
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_CODE = tuple(
    str(Path(root))
    for root in {sys.prefix, sys.base_prefix, *sys.path, Path(__file__).parents[2]}
    if root
)


class Fault(Exception):  # noqa: N818  # what was found, not what failed
    """A reader ended, or did, what it must not."""


class Slow(BaseException):
    """The time of one input is over; no ``except Exception`` of a reader stops it."""


class _Watch:
    """What the process must not do while it is on. An audit hook cannot be taken off again."""

    def __init__(self) -> None:
        self.on = False
        self.folder = ""
        self.names_files = False
        self.faults: list[str] = []
        sys.addaudithook(self.see)

    def see(self, event: str, args: tuple[Any, ...]) -> None:
        if not self.on:
            return
        if event == "open":
            self._opened(*args)
        elif event == "sqlite3.connect" and str(args[0]).startswith(self.folder):
            pass  # the store opens the file that it is given, and SQLite its log beside it
        elif event.startswith(_FORBIDDEN) and event not in _HARMLESS:
            self._fault(f"{event}{args!r:.200}")

    def _opened(self, path: Any, mode: str | None, flags: int) -> None:
        if flags & _WRITING or (mode and set(mode) & set("wax+")):
            self._fault(f"opens {path!r:.200} to write")
        elif not (self.names_files or isinstance(path, int)):
            place = os.path.abspath(os.fsdecode(path))
            if not place.startswith((self.folder, *_CODE)):
                self._fault(f"reads {place!r:.200}")

    def _fault(self, what: str) -> None:
        self.faults.append(what)
        raise Fault(what)


_WATCH = _Watch()


def _over(signum: int, frame: Any) -> None:
    raise Slow("the time is over")


@contextmanager
def guarded() -> Iterator[None]:
    """Bound the memory of the process, and take the alarm, for as long as inputs are tried."""
    with open("/proc/self/statm", encoding="ascii") as pages:
        used = int(pages.read().split()[0]) * resource.getpagesize()
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    before = [signal.signal(number, _over) for number in _ALARMS]
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        for number, handler in zip(_ALARMS, before, strict=True):
            signal.signal(number, handler)


def accepted(
    read: Callable[[Path], None],
    path: Path,
    *,
    names_files: bool = False,
    places: tuple[str, ...] = (),
    seconds: float = SLOWEST,
) -> tuple[bool, float, str]:
    """Whether a reader accepts a file, the processor time it took [s], and the line with which it refused.

    Raises Fault for every other end.
    """
    watch = _WATCH
    watch.folder, watch.names_files = str(path.parent), names_files
    watch.faults.clear()
    line, refused = "", False
    start = time.thread_time()
    try:
        signal.setitimer(signal.ITIMER_PROF, seconds)
        signal.setitimer(signal.ITIMER_REAL, WAITING * seconds)
        watch.on = True
        try:
            read(path)
        finally:
            watch.on = False
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            signal.setitimer(signal.ITIMER_REAL, 0.0)
    except (InputError, BadInput, Refused) as error:
        line, refused = str(error), True
    except (Exception, Slow) as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        raise Fault(f"{type(error).__name__}: {error!s:.300}") from error
    spent = time.thread_time() - start
    if watch.faults:  # a reader caught it
        raise Fault(watch.faults.pop())
    if refused:
        if not line or len(line) > LONGEST or not line.isprintable():
            raise Fault(f"not one short line: {line!r:.300}")
        if path.stem not in line and not line.startswith((str(path.parent), *places)):
            raise Fault(f"names neither file nor key: {line!r:.300}")
    return not refused, spent, line
