"""An engine for tests: calls run one after the other in a thread of this process."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor


class OneThread(ThreadPoolExecutor):
    """An engine whose worker cannot die."""

    lost: tuple[type[Exception], ...] = ()

    def __init__(self) -> None:
        super().__init__(1)

    def restart(self) -> None:
        """Do nothing."""
