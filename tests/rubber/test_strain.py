"""Strain sweeps, amplitude factors, Kraus' law, and the equivalent-linear series, on two measured rubbers."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from conveyor.contact import solve
from conveyor.contact.fields.interior import interior
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.indentation import RollContact, to_problem
from conveyor.rubber import PronySeries
from conveyor.rubber.equivalent_series import equivalent_linear, soften_series
from conveyor.rubber.kraus import KrausLaw, fit_kraus
from conveyor.rubber.strain import AmplitudeFactors, StrainSweep
from conveyor.shelf import compound

DATA = Path(__file__).parent / "strain_data"
ZERO = 273.15
STRAIN = np.geomspace(1e-4, 0.2, 15)
LAW = KrausLaw(10e6, 4e6, 1.2e6, 0.8e6, 0.01, 0.6, 0.01, 0.6)
LAW_SWEEP = StrainSweep(293.15, 1.0, STRAIN, LAW.storage(STRAIN), LAW.loss(STRAIN))
SERIES = PronySeries(9e6, [1e6, 1e6, 5e6], [1.0, 1e-2, 1e-4])
SPACING, SPEED = 1.2, 5.0


@cache
def sweeps(name):
    rows = np.loadtxt(DATA / f"{name}_strain_sweep.txt", encoding="utf-8")
    if name == "S120":
        rows = np.delete(rows, 1, axis=0)  # the stray point at 0 degC, see the README there
    temperatures = dict.fromkeys(rows[:, 0])
    return [StrainSweep(t + ZERO, 1.0, *(rows[rows[:, 0] == t][:, 2:] * [1e-2, 1e6, 1e6]).T) for t in temperatures]


def flat(temperature, storage=1.0, low=1e-4, loss=1e6, tilt=0.0):
    """A sweep whose E' is 10 MPa at the lowest strain and falls by the factor `storage` to the largest."""
    strain = low * np.array([1.0, 1.4, 1.9, 10.0, 100.0, 1000.0])
    fall = np.array([1.0, 1.0 - 0.5 * tilt, 1.0 - tilt, 0.5 + 0.5 * storage, storage, storage])
    return StrainSweep(temperature, 1.0, strain, 1e7 * fall, np.full(6, loss))


# sweeps


def test_measured_sweep_of_s100():
    ten = sweeps("S100")[1]
    assert ten.temperature == pytest.approx(283.09)
    for strain, storage, tan in ((1e-4, 11.0e6, 0.123), (1e-2, 7.7e6, 0.180), (1e-1, 3.5e6, 0.205)):
        at = int(np.argmin(np.abs(np.log(ten.strain / strain))))
        assert ten.strain[at] == pytest.approx(strain, rel=2e-3)
        assert ten.storage[at] == pytest.approx(storage, abs=0.05e6)
        assert ten.loss[at] / ten.storage[at] == pytest.approx(tan, abs=5e-4)


def test_sweeps_refuse_what_they_cannot_mean():
    up = [1e-3, 1e-2, 1e-1, 0.2]
    with pytest.raises(InputError, match=r"strain\[2\] = 0\.005 follows 0\.01: .* every run as a sweep of its own"):
        StrainSweep(283.0, 1.0, [1e-3, 1e-2, 5e-3, 0.2], up, up)
    with pytest.raises(InputError, match=r"strain reaches 25, allowed to 2: .* divide percentages by 100"):
        StrainSweep(283.0, 1.0, [0.01, 0.1, 1.0, 25.0], up, up)
    with pytest.raises(InputError, match="one length of at least 4 points; got 4, 4, 3"):
        StrainSweep(283.0, 1.0, up, up, up[:3])
    with pytest.raises(InputError, match=r"loss\[1\]: got 0 Pa, allowed: > 0 Pa"):
        StrainSweep(283.0, 1.0, up, up, [1.0, 0.0, 1.0, 1.0])
    with pytest.raises(InputError, match="temperature: got -10 K, allowed: > 0 K"):
        StrainSweep(-10.0, 1.0, up, up, up)
    with pytest.raises(InputError, match="frequency: got 0 Hz, allowed: > 0 Hz"):
        StrainSweep(283.0, 0.0, up, up, up)
    with pytest.raises(ValueError, match="read-only"):
        sweeps("S100")[0].strain[0] = 1.0


# scatter


def noisy(points, scatter, seed):
    strain = np.geomspace(1e-4, 0.1, points)
    apart = scatter * np.random.default_rng(seed).standard_normal((2, points))
    return StrainSweep(293.15, 1.0, strain, *(np.array([LAW.storage(strain), LAW.loss(strain)]) * np.exp(apart)))


@pytest.mark.parametrize("scatter", [0.005, 0.02])
def test_scatter_of_a_sweep_is_that_of_its_rows(scatter):
    found = np.array([noisy(16, scatter, seed).scatter for seed in range(100)])
    # the mean square of 12 residuals: 200 draws know it to 2·√(2/12/200) = 6 %, twice that is allowed
    assert np.mean(found**2, axis=0) == pytest.approx([scatter**2, scatter**2], rel=0.12)


def test_scatter_of_a_sweep_without_any_is_below_what_is_drawn():
    for points in (15, 20, 30):
        assert max(noisy(points, 0.0, 0).scatter) < 1e-3
    assert noisy(7, 0.01, 0).scatter is None
    # sparse rows of a Payne step count as scatter, which is the safe side
    assert 1e-3 < max(noisy(10, 0.0, 0).scatter) < 5e-3


def test_drawn_sweeps_scatter_as_measured_and_keep_their_plateau():
    sweep, random = noisy(16, 0.02, 3), np.random.default_rng(1)
    drawn = [sweep.draw(random) for _ in range(400)]
    for name, scatter in zip(("storage", "loss"), sweep.scatter, strict=True):
        apart = np.log([getattr(one, name) for one in drawn]) - np.log(getattr(sweep, name))
        # 400 draws of 16 rows: their standard deviation is known to 1/√12800 = 0.9 %
        assert apart.std() == pytest.approx(scatter, rel=0.03)
        assert abs(apart.mean()) < 4.0 * scatter / 80.0
    strain = np.array([1e-4, 1.4e-4, 1.9e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1])
    flat_start = StrainSweep(293.15, 1.0, strain, [1e7, 1.01e7, 0.99e7, 8e6, 7e6, 5e6, 4e6, 3e6], [1e6] * 8)
    assert flat_start.plateau("storage").tolist() == [True] * 3 + [False] * 5
    for _ in range(20):
        again = flat_start.draw(random)
        assert again.plateau("storage").any()
        assert np.ptp(np.log(again.storage[:3] / flat_start.storage[:3])) == pytest.approx(0.0, abs=1e-12)
    smooth = noisy(30, 0.0, 0)
    assert smooth.draw(random) is smooth


def test_replicas_of_a_compound_have_the_scatter_of_its_sweeps():
    """Noise of 2 % in every row of the sweeps: √2 of it between a strain and the reference."""
    plain = compound("s100")
    noise = np.random.default_rng(5)
    data = plain.strain_dependence
    rough = plain.replace(
        strain_dependence=data.replace(
            sweeps=[
                one.replace(
                    storage=[y * math.exp(0.02 * noise.standard_normal()) for y in one.storage],
                    loss=[y * math.exp(0.02 * noise.standard_normal()) for y in one.loss],
                )
                for one in data.sweeps
            ]
        )
    )
    spread = {}
    for name, made in (("plain", plain), ("rough", rough)):
        factors = [one.amplitude_factors().storage(0.02, ZERO + 20.0) for one in made.alternatives()]
        spread[name] = float(np.std(np.log(factors)))
    assert spread["plain"] < 0.004
    # two sweeps at weights 0.5 each: 0.02·√2·√0.5 = 0.02, known from 20 replicas to 16 %
    assert spread["rough"] == pytest.approx(0.02, rel=0.5)


# factors


@pytest.mark.parametrize("name", ["S100", "S120"])
def test_factors_are_the_data_at_the_data(name):
    reference = 4.2e-3
    factors = AmplitudeFactors(sweeps(name), reference)
    for sweep in sweeps(name):
        assert factors.storage(reference, sweep.temperature) == pytest.approx(1.0, abs=1e-14)
        assert factors.loss(reference, sweep.temperature) == pytest.approx(1.0, abs=1e-14)
        storage, loss = (f(sweep.strain, sweep.temperature) for f in (factors.storage, factors.loss))
        assert storage / storage[0] == pytest.approx(sweep.storage / sweep.storage[0], rel=1e-12)
        assert loss / loss[0] == pytest.approx(sweep.loss / sweep.loss[0], rel=1e-12)


def test_factors_between_strains_are_monotone_and_near_the_law():
    """Leave every second point out of a smooth law: the interpolation comes back to it."""
    factors = AmplitudeFactors([LAW_SWEEP], float(STRAIN[0]))
    fine = np.geomspace(STRAIN[0], STRAIN[-1], 400)
    found = factors.storage(fine, 293.15)
    assert (np.diff(found) < 0.0).all()
    # cubic through points a factor 1.72 apart, x = strain^0.6 turns by 0.33 a point: 0.33³/24 of the fall
    assert found == pytest.approx(LAW.storage(fine) / LAW.storage(STRAIN[0]), abs=2e-3)
    assert factors.loss(fine, 293.15) == pytest.approx(LAW.loss(fine) / LAW.loss(STRAIN[0]), abs=1e-2)
    assert factors.storage(fine.reshape(20, 20), 293.15).shape == (20, 20)


def test_factors_are_linear_in_temperature_and_held_beyond():
    factors = AmplitudeFactors([flat(300.0, 0.8), flat(280.0, 0.4)], 1e-4)
    assert factors.temperatures.tolist() == [280.0, 300.0]
    assert factors.storage(0.05, 285.0) == pytest.approx(0.75 * 0.4 + 0.25 * 0.8)
    assert factors.storage(0.05, 279.6) == pytest.approx(0.4)
    assert factors.storage(0.05, 300.4) == pytest.approx(0.8)
    for temperature, nearest in ((279.4, 280.0), (250.0, 280.0), (300.6, 300.0), (350.0, 300.0)):
        assert factors.storage(0.05, temperature) == pytest.approx(factors.storage(0.05, nearest))
        assert factors.loss(0.05, temperature) == pytest.approx(factors.loss(0.05, nearest))
        assert factors.nearest(temperature) == nearest
        assert not factors.known_at(temperature)


def test_runs_at_one_temperature_are_averaged_over_what_both_cover():
    twice = AmplitudeFactors([flat(280.0, 0.8), flat(280.3, 0.4)], 1e-4)
    assert twice.temperatures == pytest.approx([280.15])
    assert twice.storage(0.05, 280.15) == pytest.approx(0.6)
    shorter = AmplitudeFactors([flat(280.0, 0.8), flat(280.0, 0.4, low=5e-5)], 1e-4)
    # between its points the second run has fallen by a thousandth at the reference strain
    assert shorter.storage(0.03, 280.0) == pytest.approx(0.6, rel=1e-3)
    # the second run ends at 0.05, half the strain of the first: beyond it its own last factor is held
    assert shorter.largest_strain(280.0) == pytest.approx(0.05)
    assert shorter.storage(0.08, 280.0) == pytest.approx(0.6, rel=1e-3)


def test_beyond_the_largest_strain_its_factor_is_held():
    factors = AmplitudeFactors([flat(280.0, 0.5), LAW_SWEEP], 1e-3)
    for temperature, end in ((280.0, 0.1), (293.15, float(LAW_SWEEP.strain[-1]))):
        assert factors.largest_strain(temperature) == pytest.approx(end)
        for factor in (factors.storage, factors.loss):
            assert factor([end, 3.0 * end], temperature).tolist() == pytest.approx(
                [float(factor(end, temperature))] * 2
            )
    # between two temperatures both sweeps are needed
    assert factors.largest_strain(285.0) == pytest.approx(min(0.1, LAW_SWEEP.strain[-1]))
    with pytest.raises(InputError, match=r"strain\[0\]: got 0, allowed: > 0"):
        factors.storage(0.0, 280.0)


def test_below_the_lowest_strain_only_a_plateau_is_constant():
    assert AmplitudeFactors([flat(280.0, 0.5, tilt=0.039)], 1e-4).storage(1e-6, 280.0) == 1.0
    sloping = AmplitudeFactors([flat(280.0, 0.5, tilt=0.041)], 1e-4)
    assert sloping.loss(1e-6, 280.0) == 1.0  # each modulus by itself
    with pytest.raises(RangeError, match=r"below the lowest measured, 0\.0001, where the data show no plateau"):
        sloping.storage(1e-6, 280.0)
    sparse = AmplitudeFactors([LAW_SWEEP], 1e-3)  # two points up to twice the lowest strain decide nothing
    with pytest.raises(RangeError, match="no plateau"):
        sparse.storage(5e-5, 293.15)


def test_plateau_of_the_measured_sweeps():
    factors = AmplitudeFactors(sweeps("S100"), 1e-4)
    lowest = factors.storage(sweeps("S100")[0].strain[0], ZERO + 0.02)
    assert factors.storage(5e-5, ZERO + 0.02) == pytest.approx(lowest, rel=1e-14)
    # at 50 degC the first point of E'' is 6 % above the next ones
    with pytest.raises(RangeError, match=r"loss modulus at 323\.14 K: .* no plateau"):
        factors.loss(5e-5, ZERO + 49.99)


def test_reference_strain_is_within_the_data():
    with pytest.raises(RangeError, match=r"reference_strain at 280\.00 K \(storage\): a strain of 0\.5 is above"):
        AmplitudeFactors([flat(280.0)], 0.5)
    with pytest.raises(InputError, match="at least one strain sweep"):
        AmplitudeFactors([], 1e-3)
    with pytest.raises(InputError, match="reference_strain: got 0, allowed: > 0"):
        AmplitudeFactors([flat(280.0)], 0.0)


def test_another_reference_strain_is_another_unit():
    one, other = (AmplitudeFactors(sweeps("S100"), reference) for reference in (1e-3, 1e-2))
    strain, temperature = np.geomspace(2e-4, 0.2, 9), sweeps("S100")[2].temperature
    ratio = one.storage(strain, temperature) / other.storage(strain, temperature)
    assert ratio == pytest.approx(np.full(9, float(one.storage(1e-2, temperature))), rel=1e-12)


# Kraus


def test_kraus_law_limits():
    """G. Kraus (1984): E' half way and E'' largest at the critical strain; plateaus far from it."""
    assert LAW.storage(0.01) == pytest.approx(7e6)
    assert LAW.loss(0.01) == pytest.approx(1.2e6)
    assert LAW.storage([1e-12, 1e8]) == pytest.approx([10e6, 4e6], rel=1e-9)
    assert LAW.loss([1e-12, 1e8]) == pytest.approx([0.8e6, 0.8e6], rel=1e-5)
    x = 3.0**0.6
    assert LAW.storage(0.03) == pytest.approx(4e6 + 6e6 / (1.0 + x * x))
    assert LAW.loss(0.03) == pytest.approx(0.8e6 + 2.0 * 0.4e6 * x / (1.0 + x * x))


@pytest.mark.parametrize("shared", [True, False])
def test_kraus_fit_recovers_a_law(shared):
    fit = fit_kraus(LAW_SWEEP, shared=shared)
    assert max(fit.storage_rms, fit.loss_rms) < 1e-8
    for name in ("plateau", "far", "peak_loss", "far_loss", "critical_strain", "exponent", "loss_strain"):
        assert getattr(fit.law, name) == pytest.approx(getattr(LAW, name), rel=1e-5)
    assert fit.smoothed.storage == pytest.approx(LAW_SWEEP.storage, rel=1e-7)


@pytest.mark.parametrize("name", ["S100", "S120"])
def test_kraus_law_of_the_measured_rubbers(name):
    """E' follows the law to 3 %, E'' (steeper at large strains) to 14 %; one critical strain for both does not do."""
    for sweep in sweeps(name):
        own, shared = fit_kraus(sweep), fit_kraus(sweep, shared=True)
        assert own.storage_rms < 0.03
        assert 0.05 < own.loss_rms < 0.14
        assert shared.storage_rms > 0.15
        assert own.law.loss_strain < own.law.critical_strain
    factors = AmplitudeFactors([fit_kraus(sweep).smoothed for sweep in sweeps(name)], 4e-3)
    raw = AmplitudeFactors(sweeps(name), 4e-3)
    assert factors.storage(0.02, 293.15) == pytest.approx(raw.storage(0.02, 293.15), rel=0.05)


# softened


@pytest.mark.parametrize("omega", [1e-2, 3.0, 300.0, 1e6])
def test_softened_is_exact_at_the_working_frequency(omega):
    soft = soften_series(SERIES, storage_factor=0.85, loss_factor=0.9, omega=omega)
    # a linear system of two equations: its condition, below 1e3 here, times rounding
    assert soft.storage(omega) == pytest.approx(0.85 * SERIES.storage(omega), rel=1e-12)
    assert soft.loss(omega) == pytest.approx(0.9 * SERIES.loss(omega), rel=1e-12)
    assert soft.times == pytest.approx(SERIES.times, rel=1e-15)
    # what is slow changes by one factor, what is fast by another, in proportion between
    share = (omega * SERIES.times) ** 2 / (1.0 + (omega * SERIES.times) ** 2)
    change = soft.moduli / SERIES.moduli
    slope, fast = np.polyfit(share, change, 1)
    assert change == pytest.approx(slope * share + fast, rel=1e-9)
    assert 0.0 < fast < 1.5
    assert 0.0 < slope + fast < 1.5
    everywhere = np.geomspace(1e-4, 1e8, 25)
    assert soft.equilibrium > 0.0
    # still one causal function: creep and relaxation are inverse to each other
    assert soft.creep().compliance(everywhere) * soft.modulus(everywhere) == pytest.approx(1.0, rel=1e-12)


def test_softened_by_one_is_the_series():
    same = soften_series(SERIES, storage_factor=1.0, loss_factor=1.0, omega=50.0)
    assert same.equilibrium == pytest.approx(SERIES.equilibrium, rel=1e-12)
    assert same.moduli == pytest.approx(SERIES.moduli, rel=1e-12)
    scaled = soften_series(SERIES, storage_factor=0.7, loss_factor=0.7, omega=50.0)
    assert scaled.equilibrium == pytest.approx(0.7 * SERIES.equilibrium, rel=1e-12)
    elastic = soften_series(PronySeries(2e6, [], []), storage_factor=0.7, loss_factor=0.9, omega=50.0)
    assert elastic.equilibrium == pytest.approx(1.4e6)


def test_softened_refuses_a_fluid():
    with pytest.raises(
        NoSolutionError, match=r"leave -.* of the equilibrium modulus, .* of the slow .* no solid changes so"
    ):
        soften_series(SERIES, storage_factor=0.2, loss_factor=2.0, omega=1e4)
    with pytest.raises(InputError, match="loss_factor: got 0, allowed: > 0"):
        soften_series(SERIES, storage_factor=0.4, loss_factor=0.0, omega=1e4)
    with pytest.raises(InputError, match="omega: got 0 rad/s, allowed: > 0 rad/s"):
        soften_series(SERIES, storage_factor=0.4, loss_factor=1.0, omega=0.0)


# equivalent linear


def stress_controlled(stress, omega=200.0):
    return lambda series: (stress / float(abs(series.modulus(omega))), omega)


@pytest.mark.parametrize("stress", [1e4, 1e5, 4e5])
def test_fixed_point_holds(stress):
    factors = AmplitudeFactors([LAW_SWEEP], 1e-3)
    found = equivalent_linear(SERIES, factors, stress_controlled(stress), temperature=293.15, rtol=1e-8)
    assert found.strain == pytest.approx(stress / float(abs(found.series.modulus(200.0))), rel=1e-12)
    assert found.storage_factor == pytest.approx(float(factors.storage(found.strain, 293.15)), rel=1e-7)
    assert found.loss_factor == pytest.approx(float(factors.loss(found.strain, 293.15)), rel=1e-7)
    assert found.series.storage(200.0) == pytest.approx(found.storage_factor * SERIES.storage(200.0), rel=1e-12)
    assert found.steps <= 8


def test_strain_control_needs_one_step_more_than_the_guess():
    factors = AmplitudeFactors([LAW_SWEEP], 1e-3)
    found = equivalent_linear(SERIES, factors, lambda _: (0.02, 30.0), temperature=293.15)
    assert (found.strain, found.omega, found.steps) == (pytest.approx(0.02), pytest.approx(30.0), 3)
    assert found.storage_factor == pytest.approx(factors.storage(0.02, 293.15), rel=1e-14)


def test_oscillating_strains_settle():
    """Strain ∝ E'^5: the plain iteration ends in a cycle between 0.18 and 2.5 %."""
    factors = AmplitudeFactors([LAW_SWEEP], 1e-3)
    unit = float(SERIES.storage(200.0))
    found = equivalent_linear(
        SERIES,
        factors,
        lambda series: (0.03 * (float(series.storage(200.0)) / unit) ** 5, 200.0),
        temperature=293.15,
        rtol=1e-8,
    )
    assert found.strain == pytest.approx(0.03 * found.storage_factor**5, rel=1e-7)


def test_frequency_settles_too():
    factors = AmplitudeFactors([LAW_SWEEP], 1e-3)

    def strain_of(series):
        stiffness = float(series.storage(100.0))
        return 1e5 / stiffness, 1e-5 * stiffness  # a softer layer is touched longer

    found = equivalent_linear(SERIES, factors, strain_of, temperature=293.15, rtol=1e-9)
    assert found.omega == pytest.approx(strain_of(found.series)[1], rel=1e-8)


def test_strains_that_never_settle_are_said_so():
    factors = AmplitudeFactors([LAW_SWEEP], 1e-3)
    turn = iter(range(1000))
    with pytest.raises(NoSolutionError, match="did not settle in 30 steps"):
        equivalent_linear(SERIES, factors, lambda _: (0.01 * (1.5 + (-1.0) ** next(turn)), 200.0), temperature=293.15)


def test_strains_beyond_the_sweep_hold_its_last_factors():
    factors = AmplitudeFactors([LAW_SWEEP], 1e-3)
    end = float(LAW_SWEEP.strain[-1])
    found = equivalent_linear(SERIES, factors, stress_controlled(4e6), temperature=293.15)
    assert found.strain > end
    assert found.storage_factor == pytest.approx(float(factors.storage(end, 293.15)), rel=1e-12)


# a roll on a measured rubber


def roll(load):
    """Working strain and angular frequency of a 159 mm roll on a 5 mm cover at 5 m/s."""

    def strain_of(series):
        contact = RollContact(radius=0.0795, spacing=SPACING, cover_thickness=5e-3, speed=SPEED, series=series)
        found = solve(to_problem(contact, load))
        inside = interior(found)
        seen.append(found.friction * load)
        return inside.working_strain, inside.wave_number * 2.0 * math.pi / SPACING * SPEED

    seen = []
    return strain_of, seen


def test_roll_on_s100_end_to_end():
    """0.4 %: where the sweeps between 10 and 30 degC show the modulus of the master curve."""
    base = compound("s100").series(ZERO + 20.0)
    factors = AmplitudeFactors(sweeps("S100"), 4e-3)
    strains, changes, frequencies = [], [], []
    for load in (1e3, 2e3, 4e3):
        strain_of, resistance = roll(load)
        found = equivalent_linear(base, factors, strain_of, temperature=ZERO + 20.0)
        assert found.steps <= 6
        strains.append(found.strain)
        changes.append(resistance[-1] / resistance[0] - 1.0)
        frequencies.append(found.omega / (2.0 * math.pi))
        assert found.series.storage(found.omega) == pytest.approx(
            found.storage_factor * base.storage(found.omega), rel=1e-12
        )
    # half a per cent to 3 %, 300 to 500 Hz: a few millimetres of contact at 5 m/s
    assert 5e-3 < strains[0] < strains[1] < strains[2] < 0.03
    assert 600.0 > frequencies[0] > frequencies[1] > frequencies[2] > 200.0
    # softer and, beyond 0.4 %, relatively more lossy: the resistance rises, more with more load
    assert 0.03 < changes[0] < changes[1] < changes[2] < 0.3


def test_factors_of_many_strains_and_temperatures_are_each_alone():
    factors = AmplitudeFactors(sweeps("S100"), 4e-3)
    strain, at = np.array([0.002, 0.01, 0.03]), np.array([ZERO - 40.0, ZERO + 17.0, ZERO + 90.0])
    for of in (factors.storage, factors.loss):
        each = [float(of(e, t)) for e, t in zip(strain.tolist(), at.tolist(), strict=True)]
        assert of(strain, at) == pytest.approx(each, rel=1e-14)


def test_a_step_that_leaves_little_is_not_looked_at_again():
    """Strain of half the power of E', as under a roll: two evaluations, and a thousandth from the fixed point."""
    factors = AmplitudeFactors([LAW_SWEEP], 1e-3)
    unit = float(SERIES.storage(200.0))

    def strain_of(series):
        return 0.0015 * (unit / float(series.storage(200.0))) ** 0.5, 200.0

    soon, late = (equivalent_linear(SERIES, factors, strain_of, temperature=293.15, rtol=rtol) for rtol in (5e-3, 1e-9))
    assert (soon.steps, late.steps > 3) == (2, True)
    assert soon.strain == pytest.approx(late.strain, rel=1e-3)
    assert soon.storage_factor == pytest.approx(late.storage_factor, rel=1e-3)
