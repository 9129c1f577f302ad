"""Every refusal: its message names what is wrong, its value and what is allowed; statuses say what to change."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve, solve_loads, solve_many
from conveyor.errors import InputError, NoSolutionError

CREEP = CreepSpectrum(0.1, [0.9], [1.0])


def problem(**changes):
    given = {"support": "free", "radius": 0.4, "thickness": 1.0, "pressure": 0.05, "creep": CREEP}
    return ContactProblem(**(given | changes))


WRAPPED = problem(support="half-space", pressure=1e3)
# an edge layer of width ζ j∞ = 1e-15 of the half width: no order resolves it to 1e-12
SHARP = problem(support="half-space", creep=CreepSpectrum(1e-6, [1.0 - 1e-6], [1e-9]))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"support": "bonded"}, r"support: got 'bonded', allowed: free, confined, half-space or a Layer"),
        ({"radius": 0.0}, r"radius: got 0\.0, allowed: >= 1e-12 and <= 0\.5 \(R/λ: rolls do not overlap"),
        ({"radius": 0.51}, r"radius: got 0\.51, allowed: "),
        ({"radius": math.nan}, r"radius: got nan, allowed: "),
        ({"thickness": 0.0}, r"thickness: got 0\.0, allowed: >= 1e-12 and <= 1e\+30 or inf"),
        ({"thickness": -1.0}, r"thickness: got -1\.0, allowed"),
        ({"thickness": math.nan}, r"thickness: got nan, allowed"),
        ({"pressure": 0.0}, r"pressure: got 0\.0, allowed: >= 1e-30 and <= 1e\+30"),
        ({"pressure": math.inf}, r"pressure: got inf, allowed"),
        ({"pressure": math.nan}, r"pressure: got nan, allowed"),
        ({"poisson": 0.51}, r"poisson: got 0\.51, allowed: >= 0 and <= 0\.5"),
        ({"poisson": -0.1}, r"poisson: got -0\.1, allowed"),
        ({"creep": None}, r"creep: got None, allowed: a CreepSpectrum"),
        ({"poisson": math.nan}, r"poisson: got nan, allowed"),
    ],
)
def test_problem(changes, message):
    with pytest.raises(InputError, match=message):
        problem(**changes)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.0, [1.0], [1.0]), r"instantaneous: got 0\.0, allowed: >= 1e-30 and <= 1 \(j∞"),
        ((1.5, [], []), r"instantaneous: got 1\.5, allowed"),
        ((math.nan, [], []), r"instantaneous: got nan, allowed"),
        ((0.1, [0.9], [1.0, 2.0]), r"weights \(1,\) and times \(2,\): give two lists of equal length"),
        ((0.1, [[0.9]], [[1.0]]), r"weights \(1, 1\) and times \(1, 1\): give two lists of equal length"),
        (
            (0.1, [1.0, -0.1], [1.0, 2.0]),
            r"weights: got \[1\.0, -0\.1\], allowed: > 0 each",
        ),
        ((0.1, [0.9, 0.0], [1.0, 2.0]), r"weights: got \[0\.9, 0\.0\], allowed: > 0 each"),
        ((0.1, [math.inf], [1.0]), r"weights: got \[inf\], allowed: > 0 each"),
        (
            (0.1, [1e308, 1e308], [1.0, 2.0]),
            r"weights: got \[1e\+308, 1e\+308\], allowed: > 0 each, .* = 1",
        ),
        ((0.1, [0.9], [-1.0]), r"times: got \[-1\.0\], allowed: 0, or >= 1e-100"),
        ((0.1, [0.9], [math.inf]), r"times: got \[inf\], allowed: 0, or"),
        (
            (0.1, [0.8], [1.0]),
            r"instantaneous \+ sum\(weights\) = 0\.9: must be 1 \(compliances are in units",
        ),
    ],
)
def test_creep(arguments, message):
    with pytest.raises(InputError, match=message):
        CreepSpectrum(*arguments)


def test_decimals_that_users_type_need_not_add_to_the_last_digit():
    assert CreepSpectrum(0.1, [0.3, 0.3, 0.3], [1.0, 2.0, 3.0]).weights.sum() == pytest.approx(0.9)


def test_creep_is_a_frozen_copy():
    weights = np.array([0.9])
    creep = CreepSpectrum(0.1, weights, [1.0])
    weights[0] = 0.0
    assert creep.weights[0] == 0.9
    with pytest.raises(ValueError, match="read-only"):
        creep.times[0] = 2.0


@pytest.mark.parametrize("rtol", [0.0, 1e-13, 0.1, -1.0, math.nan])
def test_tolerance(rtol):
    with pytest.raises(InputError, match=r"rtol: got .*, allowed: >= 1e-12 and <= 0\.01"):
        solve(problem(), rtol=rtol)


FIGURES = (
    "friction half_width eccentricity penetration dissipation energy_error error_estimate patches peak_pressure"
).split()


class TestWrapped:
    def test_raises_with_advice(self):
        with pytest.raises(NoSolutionError, match=r"beyond its half circle.*lower the load, or enlarge the radius"):
            solve(WRAPPED)

    def test_is_returned_for_batches(self):
        found = solve(WRAPPED, throw=False)
        assert found.status is Status.WRAP_LIMIT
        assert found.problem is WRAPPED
        assert found.message.startswith(Status.WRAP_LIMIT.message)
        assert found.stats.grid > 0

    @pytest.mark.parametrize("figure", FIGURES)
    def test_has_no_figures(self, figure):
        found = solve(WRAPPED, throw=False)
        with pytest.raises(NoSolutionError, match="half circle"):
            getattr(found, figure)

    @pytest.mark.parametrize("field", ["pressure", "profile"])
    def test_has_no_fields(self, field):
        found = solve(WRAPPED, throw=False)
        with pytest.raises(NoSolutionError, match="half circle"):
            getattr(found, field)([0.0])


class TestNotConverged:
    def test_raises_with_advice(self):
        with pytest.raises(NoSolutionError, match=r"did not reach the tolerance: see error_estimate; ask for"):
            solve(SHARP, rtol=1e-12)

    def test_has_figures_with_their_error(self):
        found = solve(SHARP, rtol=1e-12, throw=False)
        assert found.status is Status.NOT_CONVERGED
        assert 1e-12 < found.error_estimate < 1e-5
        # short memory: μ/ζ of ζ = 1e-10, to the order of ζ/α (α = 1.06)
        shorter = solve(problem(support="half-space", creep=CreepSpectrum(1e-6, [1.0 - 1e-6], [1e-10])))
        assert found.friction == pytest.approx(1e1 * shorter.friction, rel=1e-6)


def test_limit_of_the_load_is_said():
    found = solve(WRAPPED, throw=False)
    limit = float(found.message.rsplit(" ", 1)[1])
    # 256 nodes on the roll: the load just below is carried, ten times it reaches the end
    near = solve(problem(support="half-space", pressure=0.9 * limit))
    assert near.status is Status.OK
    assert near.outer_edge > 0.95
    assert solve(problem(support="half-space", pressure=10.0 * limit), throw=False).status is Status.WRAP_LIMIT


def test_every_status_but_ok_says_what_to_change():
    for status in Status:
        assert status.message
        assert (status is Status.OK) != any(word in status.message for word in ("lower", "smaller", "ask for"))


def test_a_batch_goes_on_after_a_refusal():
    found = solve_many([problem(), WRAPPED, SHARP, problem(pressure=0.01)], rtol=1e-12)
    assert [s.status.name for s in found] == ["OK", "WRAP_LIMIT", "NOT_CONVERGED", "OK"]


def test_a_batch_raises_on_request():
    with pytest.raises(NoSolutionError, match="half circle"):
        solve_many([problem(), WRAPPED], throw=True)


def test_a_layer_too_thin_for_memory_is_a_status_not_an_exception():
    thin = ContactProblem("confined", 0.1, 1e-3, CreepSpectrum(0.1, [0.9], [1.0]), 1e-7)
    assert solve(thin, throw=False).status is Status.TOO_THIN
    with pytest.raises(NoSolutionError, match="thicker layer"):
        solve(thin)


@pytest.mark.parametrize("value", ["x", None, True])
def test_radius_must_be_a_number(value):
    with pytest.raises(InputError, match=r"radius: got .*, allowed: a number"):
        ContactProblem("confined", value, 1e-3, CreepSpectrum(1.0))


def test_deeper_than_the_radius_is_a_status_of_its_own():
    # free, R/λ 0.1: the contact exists and converges, Δ/R 1.41 is far outside small strain
    deep = ContactProblem("free", 0.1, 0.13, CreepSpectrum(0.1, [0.9], [1.0]), 1.0)
    found = solve(deep)
    assert found.status is Status.TOO_DEEP
    assert found.penetration > 1.0
    assert found.friction == pytest.approx(0.86352368, rel=1e-6)
    assert "1.41 R" in found.message
    assert solve(ContactProblem("free", 0.1, 0.01, CreepSpectrum(0.1, [0.9], [1.0]), 1.0)).status is Status.OK


def test_a_load_far_beyond_the_limit_is_refused_on_a_coarse_grid():
    # 15 s on grids of up to 4096 nodes on the roll before; the limit was not always named
    thin = ContactProblem("free", 0.00112, 0.239, CreepSpectrum(8.5e-6, [1.0 - 8.5e-6], [16.92]), 0.00166, 0.49)
    found = solve(thin, throw=False)
    assert found.status is Status.WRAP_LIMIT
    assert float(found.message.rsplit(" ", 1)[1]) == pytest.approx(7e-6, rel=0.2)
    assert found.stats.grid == 64 * 512


@pytest.mark.parametrize("given", [np.zeros_like, lambda m: np.nan * m, lambda m: -1.0 / m, lambda m: m[:2]])
def test_a_layer_that_is_none_is_refused(given):
    with pytest.raises(InputError, match=r"5 wave numbers must be as many finite complex numbers with a positive"):
        problem(support=SimpleNamespace(reach=1.0, symbol=lambda m, _: given(m)))


@pytest.mark.parametrize("field", ["pressure", "profile"])
@pytest.mark.parametrize("x", ["a", [0.0, math.nan], math.inf, None])
def test_places_are_numbers(field, x):
    with pytest.raises(InputError, match=r"x.*: places x/R are "):
        getattr(solve(problem()), field)(x)


@pytest.mark.parametrize("shares", [(2.0,), (0.5, 0.1), (math.nan,), (0.0, 0.5)])
def test_shares_of_the_loss_ascend_between_0_and_1(shares):
    with pytest.raises(InputError, match=r"shares: got .*, allowed: ascending numbers > 0 and < 1"):
        solve(problem()).excitation(shares)


def test_loads_are_numbers():
    with pytest.raises(InputError, match="pressures: give numbers"):
        solve_loads(problem(), ["heavy"])
