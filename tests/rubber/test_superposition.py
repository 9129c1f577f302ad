"""Superposition against synthetic truth, its own stated uncertainty, and published shift factors."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.rubber.master_curve import Isotherm, Superposition
from conveyor.rubber.overlap import LogIsotherm, measure_overlap
from conveyor.rubber.prony import PronySeries
from conveyor.rubber.shift import WLF, ShiftTable
from conveyor.rubber.time_temperature import superpose

DATA = Path(__file__).parent / "data"
CELSIUS = 273.15
REFERENCE = 293.15
LAW = WLF(8.86, 101.6, REFERENCE)
TIMES = np.logspace(-14, 8, 67)
RUBBER = PronySeries(4e6, 60e6 * np.exp(-0.5 * ((np.log10(TIMES) + 9) / 2.0) ** 2) + 2e5, TIMES)
TEMPERATURES = REFERENCE + 7.0 * np.arange(-6, 9)


def sweeps(  # noqa: PLR0917
    seed: int,
    noise: float,
    temperatures: np.ndarray = TEMPERATURES,
    rows: int = 10,
    b: np.ndarray | None = None,
    uneven: bool = False,
) -> list[Isotherm]:
    rng = np.random.default_rng(seed)
    found = []
    for i, t in enumerate(temperatures):
        f = np.sort(10.0 ** rng.uniform(-1, 2, rows)) if uneven else np.logspace(-1, 2, rows)
        omega = 2 * np.pi * f * 10.0 ** LAW.log10_a_T(t)
        scatter = np.exp(noise * rng.standard_normal((2, rows))) * (1.0 if b is None else b[i])
        found.append(Isotherm(float(t), f, RUBBER.storage(omega) * scatter[0], RUBBER.loss(omega) * scatter[1]))
    return found


def table(name: str, skip: int = 2) -> np.ndarray:
    return np.loadtxt(DATA / name, delimiter=",", skiprows=skip, encoding="utf-8-sig")


def raw_isotherms() -> list[Isotherm]:
    rows = table("pyvisco_freq_user_raw.csv")
    found = []
    for k in np.unique(rows[:, 4]):
        f, e1, e2, t, _ = rows[rows[:, 4] == k].T
        found.append(Isotherm(float(t.mean()) + CELSIUS, f, e1 * 1e6, e2 * 1e6))
    return found


def unshifted_master() -> tuple[list[Isotherm], np.ndarray]:
    """Isotherms inside the published master curve, coldest first, and its published log10 a_T."""
    master = table("pyvisco_freq_user_master.csv")
    shifts = table("pyvisco_freq_user_master_shift_factors.csv")[::-1]
    sweep = np.log10([0.1, 0.215443, 0.464159, 1, 2.15443, 4.64159, 10, 21.5443, 46.4159, 100])
    origin = np.abs(shifts[:, 1, None] + sweep - np.log10(master[:, 0])[:, None, None]) < 1e-4
    single = origin.sum(axis=(1, 2)) == 1  # two rows belong to two temperatures at once, two are the cut ends
    found = []
    for i, (t, _) in enumerate(shifts):
        mine = np.flatnonzero(single & origin[:, i].any(axis=1))
        f = 10.0 ** sweep[np.argmax(origin[mine, i], axis=1)]
        found.append(Isotherm(t + CELSIUS, f, master[mine, 1] * 1e6, master[mine, 2] * 1e6))
    assert sum(one.frequency.size for one in found) == 202
    return found, shifts[:, 1]


def chi2_per_shift(result: Superposition, truth: np.ndarray) -> float:
    away = result.temperatures != result.reference
    error = (result.log10_a_T - truth)[away]
    return float(error @ np.linalg.solve(result.covariance[np.ix_(away, away)], error)) / error.size


def test_truth_without_noise_to_interpolation_error() -> None:
    result = superpose(sweeps(0, 0.0), REFERENCE)
    # knots 0.2 decades apart miss ln E'' by up to 2e-4, its slope is 0.3 to 1 per decade, 14 steps add up
    np.testing.assert_allclose(result.log10_a_T, LAW.log10_a_T(TEMPERATURES), atol=1e-3)
    omega = 2 * np.pi * result.frequency
    # 1e-3 decades times the steepest slope of ln E, 2.3 per decade
    np.testing.assert_allclose(result.storage, RUBBER.storage(omega), rtol=2.5e-3)
    np.testing.assert_allclose(result.loss, RUBBER.loss(omega), rtol=2.5e-3)


@pytest.mark.parametrize(
    ("rows", "noise", "step", "uneven"),
    [
        (10, 0.01, 1, False),
        (20, 0.03, 1, False),
        (6, 0.01, 1, False),
        (10, 0.01, 2, False),
        (12, 0.01, 1, True),
    ],
)
def test_uncertainties_are_honest(rows: int, noise: float, step: int, *, uneven: bool) -> None:
    temperatures = TEMPERATURES[2 * (step - 1) :: step]  # two steps of 7 K below -8 degC are > 3 decades
    truth = np.asarray(LAW.log10_a_T(temperatures))
    found = [
        chi2_per_shift(superpose(sweeps(s, noise, temperatures, rows, None, uneven), REFERENCE), truth)
        for s in range(12)
    ]
    # chi^2 of 12 x 14 (7) degrees of freedom scatters by sqrt(2/168) = 11 % (15 %); three of these, and the
    # noise itself is known to sqrt(1/(2 N)) only: 0.6 to 1.5. Errors stated 25 % too small would give 1.6
    assert 0.6 < np.mean(found) < 1.5, found


def test_uncertainty_grows_along_the_chain() -> None:
    error = superpose(sweeps(1, 0.01), REFERENCE).log10_a_T_error
    at = int(np.flatnonzero(TEMPERATURES == REFERENCE)[0])
    assert error[at] == 0.0
    assert np.all(np.delete(error, at) > 0.0)
    for side in (error[at + 1 :], error[at - 1 :: -1]):  # on the average: a steep curve may place one better
        half = side.size // 2
        assert side[half:].mean() > side[:half].mean()


def test_vertical_shift_recovered() -> None:
    b = TEMPERATURES / REFERENCE
    found = [superpose(sweeps(s, 0.005, b=b), REFERENCE, vertical=True) for s in range(6)]
    away = TEMPERATURES != REFERENCE
    z = np.array([(r.log10_b_T - np.log10(b))[away] / r.log10_b_T_error[away] for r in found])
    # neighbours share their errors: of 6 x 14 numbers about 6 x 3 are independent, rms 1 +- 0.17
    assert 0.5 < np.sqrt(np.mean(z**2)) < 1.5
    truth = np.asarray(LAW.log10_a_T(TEMPERATURES))
    assert 0.5 < np.mean([chi2_per_shift(r, truth) for r in found]) < 1.6
    assert np.all(superpose(sweeps(0, 0.005), REFERENCE).log10_b_T == 0.0)


def test_reference_between_isotherms_and_consistency_of_the_zero() -> None:
    cold = superpose(sweeps(2, 0.01), REFERENCE)
    between = superpose(sweeps(2, 0.01), REFERENCE + 3.0)
    moved = cold.log10_a_T - between.log10_a_T
    np.testing.assert_allclose(moved, moved[0], atol=1e-12)  # one curve, another zero
    again = ShiftTable(between.temperatures, between.log10_a_T, reference=REFERENCE + 3.0)
    assert abs(again.log10_a_T(REFERENCE + 3.0)) < 1e-12
    # PCHIP over 7 K of a WLF law: 0.01 decades; the shifts themselves: 0.01
    assert abs(moved[0] - LAW.log10_a_T(REFERENCE + 3.0)) < 0.03
    assert np.all(between.log10_a_T_error > 0.0)


def test_order_and_units_of_the_input_do_not_matter() -> None:
    plain = superpose(sweeps(3, 0.01), REFERENCE)
    mixed = [
        Isotherm(i.temperature, i.frequency[::-1], 1e-3 * i.storage[::-1], 1e-3 * i.loss[::-1])
        for i in sweeps(3, 0.01)[::-1]
    ]
    other = superpose(mixed, REFERENCE)
    np.testing.assert_allclose(other.log10_a_T, plain.log10_a_T, atol=1e-6)  # steps end at 1e-2 of an error
    np.testing.assert_allclose(other.storage, 1e-3 * plain.storage, rtol=1e-9)
    assert np.all(np.diff(plain.frequency) >= 0.0)
    assert plain.isotherm.size == sum(i.frequency.size for i in mixed)


def test_one_outlier_moves_nothing() -> None:
    clean = sweeps(4, 0.01)
    bad = [Isotherm(i.temperature, i.frequency, i.storage.copy(), i.loss.copy()) for i in clean]
    spoiled = bad[7].loss.copy()
    spoiled[4] *= 2.0
    bad[7] = Isotherm(bad[7].temperature, bad[7].frequency, bad[7].storage, spoiled)
    with_it, without = superpose(bad, REFERENCE), superpose(clean, REFERENCE)
    error = np.maximum(without.log10_a_T_error, 0.002)
    assert np.all(np.abs(with_it.log10_a_T - without.log10_a_T) < 2.0 * error)


def spoiled(one: Isotherm, row: int, storage: float, loss: float) -> Isotherm:
    e1, e2 = one.storage.copy(), one.loss.copy()
    e1[row] *= storage
    e2[row] *= loss
    return Isotherm(one.temperature, one.frequency, e1, e2)


def test_a_resonance_is_found_and_moves_nothing() -> None:
    clean = sweeps(9, 0.01)
    result = superpose([spoiled(one, -1, 1.3, 2.5) for one in clean], REFERENCE)
    (found,) = result.resonances
    assert found.frequency == pytest.approx(100.0, rel=1e-9)
    # a row more or less beside its curve: at the ends one is the curve
    assert found.isotherms >= TEMPERATURES.size - 3
    assert (found.storage, found.loss) == (pytest.approx(0.3, abs=0.02), pytest.approx(1.5, abs=0.05))
    without = superpose(
        [Isotherm(i.temperature, i.frequency[:-1], i.storage[:-1], i.loss[:-1]) for i in clean], REFERENCE
    )
    np.testing.assert_array_equal(result.log10_a_T, without.log10_a_T)
    assert superpose(clean, REFERENCE).resonances == ()


def test_one_isotherm_off_is_no_resonance() -> None:
    clean = sweeps(9, 0.01)
    assert superpose([spoiled(clean[0], -1, 1.3, 2.5), *clean[1:]], REFERENCE).resonances == ()


def test_a_vertical_shift_that_is_missing_is_said_and_in_the_errors() -> None:
    truth = np.asarray(LAW.log10_a_T(TEMPERATURES))
    away = TEMPERATURES != REFERENCE
    for seed in range(3):
        result = superpose(sweeps(seed, 0.01, b=TEMPERATURES / REFERENCE), REFERENCE)
        assert result.with_vertical is not None
        np.testing.assert_array_equal(result.log10_b_T, 0.0)
        # what is missing is one error of one standard deviation
        z = np.abs(result.log10_a_T - truth)[away] / result.log10_a_T_error[away]
        assert np.sqrt(np.mean(z**2)) < 1.5
        b = np.log10(TEMPERATURES / REFERENCE)[away] / result.log10_b_T_error[away]
        assert np.sqrt(np.mean(b**2)) < 1.5
        assert superpose(sweeps(seed, 0.01), REFERENCE).with_vertical is None


def test_curves_almost_without_slope_keep_an_order() -> None:
    """E'' constant, E' rising by 3 % a decade: noise of 2 % alone would let every other isotherm change places."""
    flat = PronySeries(6e6, np.full(67, 6e4), TIMES)
    rng = np.random.default_rng(0)
    found = []
    for t in TEMPERATURES[4:]:
        f = np.logspace(-1, 2, 10)
        omega = 2 * np.pi * f * 10.0 ** LAW.log10_a_T(t)
        scatter = np.exp(0.02 * rng.standard_normal((2, 10)))
        found.append(Isotherm(t, f, flat.storage(omega) * scatter[0], flat.loss(omega) * scatter[1]))
    result = superpose(found, REFERENCE)
    assert np.all(np.diff(result.log10_a_T) < 0.0)
    z = (result.log10_a_T - LAW.log10_a_T(TEMPERATURES[4:])) / np.maximum(result.log10_a_T_error, 1e-9)
    assert np.all(np.abs(z) < 4.0)


def test_residuals_are_the_noise() -> None:
    result = superpose(sweeps(5, 0.02), REFERENCE)
    # 150 rows less some 40 parameters: 7 % standard error of the scatter, three of them
    assert result.storage_scatter == pytest.approx(0.02, rel=0.22)
    assert result.loss_scatter == pytest.approx(0.02, rel=0.22)
    # row against a line between two rows: sqrt(1 + 1/2 to 1) of the noise
    assert 0.02 < result.storage_residual < 0.032
    assert len(result.overlaps) == TEMPERATURES.size - 1
    assert not any(one.held for one in result.overlaps)
    assert abs(result.correlation) < 0.25


def test_by_storage_alone() -> None:
    ruined = [
        Isotherm(i.temperature, i.frequency, i.storage, i.loss * np.exp(np.sin(3 * k)))
        for k, i in enumerate(sweeps(6, 0.002))
    ]
    result = superpose(ruined, REFERENCE, by="storage")
    assert result.loss_scatter is None
    assert chi2_per_shift(result, np.asarray(LAW.log10_a_T(TEMPERATURES))) < 2.5  # 14 dof: 1 +- 0.38, four of it


def test_published_master_curve_unshifted_and_superposed_again() -> None:
    isotherms, published = unshifted_master()
    # the published factors put -50 degC 3.69 decades from -42 degC; the sweeps are 3 decades wide
    with pytest.raises(InputError, match=r"-50\.00 degC and -42\.00 degC do not overlap.*0\.32 decades"):
        superpose(isotherms, 268.15)
    result = superpose(isotherms[1:], 268.15)
    difference = result.log10_a_T - published[1:]
    warm = slice(0, -3)  # -42 to 77 degC: on the plateau beyond, ln E' moves by 0.05 to 0.1 per decade
    assert result.overlaps[0].held  # 0.24 decades of overlap as published, below the least allowed
    assert np.sqrt(np.mean(difference[warm] ** 2)) < 0.12
    assert np.abs(difference[warm]).max() < 0.25
    # the published factors are multiples of 0.06 decades: 0.03 each, however they were found
    pull = difference[warm] / np.hypot(result.log10_a_T_error[warm], 0.03)
    assert np.sqrt(np.mean(pull**2)) < 2.5
    master = table("pyvisco_freq_user_master.csv")
    inside = (result.frequency > master[0, 0]) & (result.frequency < master[-1, 0])
    x = np.log(result.frequency[inside])
    for mine, column, tolerance in ((result.storage, 1, 0.02), (result.loss, 2, 0.04)):
        error = np.log(mine[inside]) - np.interp(x, np.log(master[:, 0]), np.log(master[:, column] * 1e6))
        assert np.sqrt(np.mean(error**2)) < tolerance
    # and it is the better one: neighbours agree better than with the published factors
    there = [
        rms_storage(c, h, a - b)
        for (c, h), (a, b) in zip(pairwise(isotherms[1:]), pairwise(published[1:]), strict=True)
    ]
    assert result.storage_residual < 0.8 * np.sqrt(np.mean(np.square(there)))


def rms_storage(cold: Isotherm, hot: Isotherm, step: float) -> float:
    sheets = [LogIsotherm(i.temperature, np.log10(i.frequency), np.log([i.storage, i.loss])) for i in (cold, hot)]
    return measure_overlap(sheets[0], sheets[1], float(step), 0.0, held=False).storage


def test_published_raw_isotherms_are_another_polymer_than_the_published_master_curve() -> None:
    isotherms = raw_isotherms()
    shifts = table("pyvisco_freq_user_master_shift_factors.csv")[::-1]
    master = table("pyvisco_freq_user_master.csv")
    sheet = isotherms[6]  # -5 degC, the reference: no shift at all
    expected = np.interp(0.0, np.log10(master[:, 0]), master[:, 1])
    at_one_hertz = np.interp(0.0, np.log10(sheet.frequency), sheet.storage / 1e6)
    assert at_one_hertz / expected > 20.0
    steps = -np.diff(shifts[:, 1])
    there = [rms_storage(c, h, a) for (c, h), a in zip(pairwise(isotherms[2:]), steps[2:], strict=True)]
    result = superpose(isotherms, 268.15, by="storage")
    assert result.storage_residual < 0.012
    assert np.sqrt(np.mean(np.square(there))) > 5.0 * result.storage_residual
    assert np.all(np.diff(result.log10_a_T) < 0.0)
    # its E'' does not superpose (a minimum in each isotherm of the glass), and the result says so
    assert result.loss_residual > 0.2
    assert superpose(isotherms, 268.15).correlation > 0.5


def test_refusals() -> None:
    good = sweeps(0, 0.01)
    with pytest.raises(InputError, match=">= 2 isotherms; got 1"):
        superpose(good[:1], REFERENCE)
    with pytest.raises(InputError, match=r"two isotherms at 20\.00 degC"):
        superpose([*good, good[6]], REFERENCE)
    with pytest.raises(RangeError, match=r"reference 100\.00 degC is outside.*-22\.00 degC to 76\.00 degC"):
        superpose(good, 373.15)
    with pytest.raises(InputError, match='"both", "storage" or "loss"'):
        superpose(good, REFERENCE, by="tan delta")  # type: ignore[arg-type]
    f, e = [1.0, 2.0, 3.0], [1e6, 2e6, 3e6]
    with pytest.raises(InputError, match=r"frequency\[1\]: got -2 Hz, allowed: > 0 Hz"):
        Isotherm(293.15, [1.0, -2.0, 3.0], e, e)
    with pytest.raises(InputError, match=r"needs >= 3 rows.*frequency 2, storage 2, loss 2"):
        Isotherm(293.15, f[:2], e[:2], e[:2])
    with pytest.raises(InputError, match=r"20\.00 degC holds 2 Hz twice"):
        Isotherm(293.15, [1.0, 2.0, 2.0], e, e)
    with pytest.raises(InputError, match=r"temperature: got 0 K"):
        Isotherm(0.0, f, e, e)


def test_missing_decades_are_named() -> None:
    f = np.logspace(0, 2, 9)
    power = 0.2

    def sheet(t: float, a: float) -> Isotherm:
        return Isotherm(t, f, 1e6 * (f * a) ** power, 1e5 * (f * a) ** power)

    # sweeps two decades wide, three apart: one decade of a power law is missing
    with pytest.raises(InputError, match=r"10\.00 degC and 20\.00 degC do not overlap.*about 1 decades"):
        superpose([sheet(283.15, 1e3), sheet(293.15, 1.0)], REFERENCE)


def test_power_laws_do_not_tell_vertical_from_horizontal() -> None:
    f = np.logspace(0, 2, 9)

    def sheet(t: float, a: float) -> Isotherm:
        return Isotherm(t, f, 1e6 * (f * a) ** 0.2, 1e5 * (f * a) ** 0.2)

    with pytest.raises(NoSolutionError, match="straight line in log-log"):
        superpose([sheet(283.15, 10.0), sheet(293.15, 1.0)], REFERENCE, vertical=True)
