"""IPOPT through CasADi, stopped between two iterations at a deadline or by Ctrl-C.

Python's own handler of Ctrl-C raises in whatever runs next. Within IPOPT that is CasADi's callback, and
CasADi makes a normal return of it. So the signal is kept while IPOPT runs, stops it after the iteration
at hand, and is delivered as soon as IPOPT has returned.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Any

import casadi

from formulations.deadlines.deadline import NEVER, Deadline

_STATE = threading.local()  # .over: whether the solve of this thread has to stop


class _AfterEachIteration(casadi.Callback):
    """CasADi's iteration callback: anything but 0 stops IPOPT, which returns the point at hand."""

    def __init__(self, nlp: dict[str, Any]) -> None:
        super().__init__()
        sizes = {"x": nlp["x"], "g": nlp["g"], "p": nlp.get("p", casadi.SX(0, 1))}
        self._n = {"f": 1, **{name: symbols.numel() for name, symbols in sizes.items()}}
        self.construct("after_each_iteration", {})

    def get_n_in(self) -> int:
        return int(casadi.nlpsol_n_out())

    def get_n_out(self) -> int:
        return 1

    def get_sparsity_in(self, i: int) -> Any:
        return casadi.Sparsity.dense(self._n[casadi.nlpsol_out(i).removeprefix("lam_")], 1)

    def eval(self, point: Any) -> list[float]:
        return [float(_STATE.over())]


class StoppableIpopt:
    """A program that IPOPT solves until a deadline.

    CasADi derives Jacobian and Hessian in seconds where the program is large, and cannot be stopped
    within. So they are derived in parts, when they are needed first, and the time is looked at in between.
    """

    def __init__(
        self,
        name: str,
        nlp: dict[str, Any],
        options: dict[str, Any],
        blocks: Sequence[Any] | None = None,
    ) -> None:
        """Name the program; nothing is derived yet.

        Parameters
        ----------
        name : str
        nlp : dict
            Symbols x, g, f and p, as ``casadi.nlpsol`` takes them. Where they are MX, which stand for calls of
            functions, CasADi derives those functions itself, at once.
        options : dict
            Those of ``casadi.nlpsol``.
        blocks : sequence of casadi.SX, optional
            Parts of g, in their order. Rows of one kind share a structure, so that the Jacobian of each
            block takes fewer sweeps than that of the whole.
        """
        self.blocks = [nlp["g"]] if blocks is None else blocks
        self.name, self.nlp, self.options = name, nlp, options
        self._callback = _AfterEachIteration(nlp)  # CasADi keeps no reference to it
        self._prices = casadi.SX.sym("lam_f"), casadi.SX.sym("lam_g", nlp["g"].numel())
        self._derived: dict[str, Any] = {}
        self._solver: Any = None

    def solve(
        self, deadline: Deadline = NEVER, **arguments: Any
    ) -> tuple[dict[str, Any], dict[str, Any]] | None:
        """Solve the program.

        Parameters
        ----------
        deadline : Deadline
            IPOPT stops after the iteration in which it is over; its status is then
            "User_Requested_Stop".
        **arguments
            Those of the solver: x0, p, lbx, ubx, lbg, ubg, lam_x0, lam_g0.

        Returns
        -------
        answer : dict
            x, f, g and multipliers.
        stats : dict
            CasADi's statistics, with "return_status" and "success".
            None in place of both where the time is over before IPOPT can begin.

        Raises
        ------
        RuntimeError
            If CasADi refuses the program or the numbers.
        """
        if self._solver is None:
            self._derive(deadline)
        if deadline.over or self._solver is None:
            return None
        with _interrupts_kept() as interrupted:
            _STATE.over = lambda: interrupted() or deadline.over
            answer = self._solver(**arguments)
            return answer, self._solver.stats()

    def _derive(self, deadline: Deadline) -> None:
        """Derive what IPOPT needs, part by part; unfinished where the time is over."""
        x, p, f, g = (self.nlp[name] for name in "xpfg")
        shared = {"no_nlp_grad": True, "calc_lam_p": False, "iteration_callback": self._callback}
        if isinstance(x, casadi.MX):
            options = {
                **self.options,
                **shared,
                "expand": True,
            }  # evaluated in scalars: seven times faster
            self._solver = casadi.nlpsol(self.name, "ipopt", self.nlp, options)
            return
        price, prices = self._prices
        parts: dict[str, Callable[[], Any]] = {"slope": lambda: casadi.gradient(f, x)}
        for index, block in enumerate(self.blocks):
            parts[f"slopes {index}"] = partial(casadi.jacobian, block, x)
        if self.options.get("ipopt.hessian_approximation") != "limited-memory":
            parts["bend"] = lambda: casadi.hessian(price * f, x)[0]
            parts["bends"] = lambda: casadi.hessian(casadi.dot(prices, g), x)[0]
        for name, derive in parts.items():
            if deadline.over:
                return
            if name not in self._derived:
                self._derived[name] = derive()
        found, derived = self._derived, {}
        slopes = casadi.vertcat(*(found[f"slopes {index}"] for index in range(len(self.blocks))))
        derived["grad_f"] = casadi.Function("nlp_grad_f", [x, p], [f, found["slope"]])
        derived["jac_g"] = casadi.Function("nlp_jac_g", [x, p], [g, slopes])
        if "bends" in found:
            bends = casadi.triu(found["bend"] + found["bends"])
            derived["hess_lag"] = casadi.Function("nlp_hess_l", [x, p, price, prices], [bends])
        # multipliers of the parameters would need a further gradient, which takes most of the time
        options = {**self.options, **derived, **shared}
        self._solver = casadi.nlpsol(self.name, "ipopt", self.nlp, options)


@contextmanager
def _interrupts_kept() -> Iterator[Callable[[], bool]]:
    """Keep Ctrl-C back for a while; gives a function that says whether there was one."""
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield lambda: False
        return
    kept: list[tuple[Any, ...]] = []
    signal.signal(signal.SIGINT, lambda *received: kept.append(received))
    try:
        yield lambda: bool(kept)
    finally:
        signal.signal(signal.SIGINT, handler)
        for received in kept:
            handler(*received)
