"""One local solve of the family's nonlinear program: whatever the start, it ends in a status."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import problems
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

from formulations import FAMILIES, Limits, Problem
from formulations.optima.family.exchange import StartStatus
from formulations.optima.family.optimum import local_optimum
from formulations.optima.family.program import PosedProgram

STILL = Problem.of(
    [[0.0], [1e-3], [1e-3], [1.0], [1.5]], Limits.of(1.0, 2.0, 5.0, dof=1), family="4-3-4"
)


@pytest.mark.parametrize("shortest", [1e-30, 1e-200, 1e-300])
def test_a_segment_far_below_the_least_duration_is_a_legal_start(shortest: float) -> None:
    """A proof asks for such starts: nothing moves on the second segment, so it may be very short."""
    found = local_optimum(STILL, np.array([1.0, shortest, 1.0, 1.0]))
    assert np.isfinite(found.seconds)


@pytest.mark.parametrize("radius", [1e-9, 1e-3, 1.0, 30.0])
@pytest.mark.parametrize("y", [-40.0, -50.0, -60.0])
def test_a_trust_region_below_the_least_duration_keeps_its_bounds_in_order(
    y: float, radius: float
) -> None:
    centre = np.array([1.0, np.exp(y), 1.0, 1.0])
    program = PosedProgram(STILL, FAMILIES["4-3-4"], centre, set())
    solved, outcome = program.solve(centre, radius, True)
    assert outcome
    assert (np.abs(np.log(solved / centre)) <= radius * (1.0 + 1e-6) + 1e-6).all()


def test_a_start_that_leaves_the_range_of_floats_is_a_status() -> None:
    found = local_optimum(STILL, np.full(4, 1e-300))
    assert found.status == StartStatus.NOT_FINITE
    assert found.reason
    assert found.seconds == np.inf


@pytest.mark.parametrize(
    "failure", [RuntimeError("refused:\nbecause"), np.linalg.LinAlgError("no roots")]
)
def test_an_exception_of_the_solver_is_a_status(
    failure: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(self: PosedProgram, spline: object, follow: bool) -> object:
        raise failure

    monkeypatch.setattr(PosedProgram, "_extremes", fails)
    found = local_optimum(STILL, np.ones(4))
    assert (found.status, found.reason) == (StartStatus.NOT_FINITE, str(failure).splitlines()[-1])
    assert np.isfinite(found.seconds)  # the start itself, stretched


@pytest.mark.slow
@pytest.mark.parametrize("family", list(FAMILIES))
@given(
    problem=problems(reach=(-5.0, 1.0), position=True),
    exponents=st.lists(st.floats(-300.0, 300.0), min_size=3, max_size=3),
)
# eight problems per family: the exchange is the same code for all of them, and from a start of 1e300 s it may
# take 40 solves of 300 iterations
@settings(max_examples=8, phases=(Phase.explicit, Phase.generate))
def test_every_start_ends_in_a_status(family: str, problem: Problem, exponents: list[float]) -> None:
    """The law: from any positive start the solver returns durations that keep the limits, or says why."""
    assume(problem.moving_joints)
    chosen = FAMILIES[family]
    problem = Problem.of(problem.waypoints, problem.limits, family=family)
    found = local_optimum(problem, 10.0 ** np.array(exponents))
    assert isinstance(found.status, StartStatus)
    if np.isfinite(found.seconds):
        assert chosen.stretch(problem, found.durations[None])[0] == pytest.approx(1.0, rel=1e-6)
        assert chosen.position_excess(problem, found.durations[None])[0] <= problem.position_slack
    else:
        assert found.status != StartStatus.OK


@given(
    problem=problems(segments=st.integers(2, 5), family="4-3-4", reach=(-5.0, 1.0)),
    exponents=st.lists(st.floats(-300.0, 300.0), min_size=5, max_size=5),
)
@settings(max_examples=20, phases=(Phase.explicit, Phase.generate))
def test_every_start_of_a_longer_spline_ends_in_a_status(
    problem: Problem, exponents: list[float]
) -> None:
    assume(problem.moving_joints)
    found = local_optimum(problem, 10.0 ** np.array(exponents[: problem.n_segments]))
    if np.isfinite(found.seconds):
        stretch = FAMILIES["4-3-4"].stretch(problem, found.durations[None])[0]
        assert stretch == pytest.approx(1.0, rel=1e-6)
    else:
        assert found.status != StartStatus.OK


@given(
    y=st.lists(st.floats(-500.0, 500.0), min_size=4, max_size=4),
    radius=st.floats(-12.0, 1.5).map(lambda x: 10.0**x),
    follow=st.booleans(),
)
@settings(max_examples=30, phases=(Phase.explicit, Phase.generate))
def test_every_box_gives_a_point_inside_or_a_reason(
    y: list[float], radius: float, follow: bool
) -> None:
    """The law behind it: however narrow or far away the trust region, its bounds never cross."""
    centre = np.exp(np.array(y))
    solved, outcome = PosedProgram(STILL, FAMILIES["4-3-4"], centre, set()).solve(
        centre, radius, follow
    )
    assert outcome
    if np.isfinite(solved).all() and (solved > 0.0).all():
        assert (np.abs(np.log(solved) - y) <= radius * (1.0 + 1e-6) + 1e-6).all()
    else:
        assert outcome != "Solve_Succeeded"
