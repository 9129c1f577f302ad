"""Files of one rubber fitted together: constructed, so that the truth is known."""

from __future__ import annotations

import re
import runpy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.fitting import fit_page, fit_tables, fit_verdict, summary
from conveyor.fitting.findings import FINDINGS
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.laboratory import read_dma
from conveyor.rubber import PronySeries, equivalent_sweep
from conveyor.rubber.misfit import scatter_within
from conveyor.spec import load

ROOT = Path(__file__).parent.parent
FOLDER = ROOT / "examples" / "laboratory"
FILES = [FOLDER / name for name in ("isotherms.csv", "relaxation.txt", "ramp.csv")]
AT = "20 degC"
TRUTH = runpy.run_path(str(ROOT / "examples" / "07_laboratory.py"))["TRUTH"]


@pytest.fixture(scope="module")
def together():
    return fit_file(FILES, Request("acme", AT))


@pytest.fixture(scope="module")
def alone():
    return fit_file(FILES[0], Request("acme", AT, replicas=0))


def errors(compound, kelvin=293.15, low=1.0, high=6.0):
    """Largest relative errors of E' and E'' against the truth over a band [decades of Hz]."""
    omega = 2.0 * np.pi * np.logspace(low, high, 40)
    series, truth = compound.series(kelvin), TRUTH.series(kelvin)
    return (
        float(np.max(np.abs(series.storage(omega) / truth.storage(omega) - 1.0))),
        float(np.max(np.abs(series.loss(omega) / truth.loss(omega) - 1.0))),
    )


def test_the_example_files_are_what_the_script_writes():
    texts = runpy.run_path(str(ROOT / "examples" / "07_laboratory.py"))["texts"]()
    number = re.compile(r"[-+]?\d+(?:[.,]\d+)?")
    for name, text in texts.items():
        written = (FOLDER / name).read_text(encoding="utf-8")
        got, told = ([float(x.replace(",", ".")) for x in number.findall(t)] for t in (written, text))
        assert got == pytest.approx(told, rel=2e-3)  # four digits printed, the last may round either way


def test_three_files_meet_the_truth(together, alone):
    """1 % and 2 % of noise: smoothed over some five rows a decade, E' within 2 %, E'' within 5 % over five decades."""
    storage, loss = errors(together.compound)
    assert storage < 0.02
    assert loss < 0.05
    assert together.files == ("isotherms.csv", "relaxation.txt", "ramp.csv")
    assert [int(np.count_nonzero(together.rows.file == k)) for k in range(3)] == [165, 32, 41]
    # relaxation reaches times that 0.5 Hz does not
    assert together.fit.window[0] < 0.01 * alone.fit.window[0]
    assert together.fit.series.equilibrium == pytest.approx(TRUTH.series(293.15).equilibrium, rel=0.03)
    shifts = TRUTH.shift_law().log10_a_T(together.superposition.temperatures)
    assert np.max(np.abs(together.superposition.log10_a_T - shifts)) < 0.05


def test_relaxation_alone_is_fitted_as_the_sweep_that_says_the_same():
    found = fit_file(FILES[1], Request("relaxed", "20 degC", replicas=0))
    assert found.superposition is not None
    assert found.superposition.temperatures.tolist() == pytest.approx([293.15, 317.15])
    storage, loss = errors(found.compound, low=-2.5, high=-1.0)
    assert storage < 0.02  # 1 % noise of E(t)
    assert loss < 0.2  # a small E'' from E(t): about E'/E'' as uncertain


def test_an_equivalent_sweep_of_a_dense_series():
    truth = PronySeries(1e6, np.full(49, 1e5), np.logspace(-8.0, 8.0, 49))
    t = np.logspace(-2.0, 3.0, 51)
    f, storage, loss = equivalent_sweep(t, truth.relaxation(t))
    omega = 2.0 * np.pi * f
    assert (omega.min(), omega.max()) == pytest.approx((1e-2, 10.0))
    assert storage == pytest.approx(truth.storage(omega), rel=0.02)
    # a line n decades beyond an end adds 10^-n of its modulus: three lines a decade, one decade away and more
    assert loss == pytest.approx(truth.loss(omega), rel=0.1)
    with pytest.raises(InputError, match=r"2\.5 are needed"):
        equivalent_sweep(t[:20], truth.relaxation(t[:20]))


def test_a_temperature_sweep_takes_given_shifts(tmp_path: Path, together):
    shifts = tmp_path / "shifts.csv"
    shifts.write_text(summary.shift_table(together), encoding="utf-8")
    found = fit_file([FILES[2], shifts], Request("ramp", AT, replicas=0))
    assert found.rows.frequency.size == 41
    assert max(errors(found.compound, low=1.5, high=5.0)) < 0.1  # 41 rows over eight decades
    with pytest.raises(InputError, match="needs isotherms beside it"):
        fit_file(FILES[2], Request("ramp"))


def test_rows_are_excluded_by_name(alone):
    found = fit_file(FILES[0], Request("x", AT, replicas=0, exclude=("8-18",)))
    assert found.rows.frequency.size == alone.rows.frequency.size - 11
    assert found.superposition.temperatures.size == alone.superposition.temperatures.size - 1
    assert "rows excluded by hand: 8-18" in found.compound.fit.method
    for given, message in (
        ("8-x", "expected rows such as"), ("1-999999999999", "expected rows such as"),
        ("1-999999999", "no row would be left"),
        ("900", "no such rows"), ("1-999", "no row would be left"),
        ("other.csv:8", "rows of which file"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=message):
            fit_file(FILES[0], Request("x", AT, exclude=(given,)))
    with pytest.raises(InputError, match="rows of which file"):
        fit_file(FILES, Request("x", AT, exclude=("8",)))


def test_rows_of_a_file_with_brackets_in_its_name_are_excluded(tmp_path: Path):
    path = tmp_path / "isotherms[1].csv"
    path.write_bytes(FILES[0].read_bytes())
    found = fit_file(path, Request("x", AT, replicas=0, exclude=(f"{path.name}:8-18",)))
    assert "rows excluded by hand: 8-18" in found.compound.fit.method


def test_rows_of_a_file_of_shifts_are_excluded_by_its_name(tmp_path: Path):
    path = tmp_path / "shifts.csv"
    path.write_text("temperature_degC,log10_aT\n0.03,1.5\n20,OVL\n48,-1.4\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"shifts\.csv:3: .*--exclude"):
        fit_file(FILES[0], Request("x", AT, shift=path, replicas=0))
    found = fit_file(FILES[0], Request("x", AT, shift=path, replicas=0, exclude=("shifts.csv:3", "8-18")))
    assert sum("given, " in line for line in found.understood) == 2
    assert "isotherms.csv: rows excluded by hand: 8-18" in found.compound.fit.method


def test_given_shifts_override_those_found(tmp_path: Path, alone):
    path = tmp_path / "one.csv"
    path.write_text("temperature_degC,log10_aT\n0.03,1.5\n48,-1.4\n", encoding="utf-8")
    found = fit_file(FILES[0], Request("x", AT, shift=path, replicas=0))
    changed = np.flatnonzero(found.superposition.log10_a_T != alone.superposition.log10_a_T)
    assert found.superposition.log10_a_T[changed] == pytest.approx([1.5, -1.4])
    assert found.compound.shift.log10_a_t[int(changed[0])] == 1.5
    assert any("shift at 0.03 degC given, +1.5000; the isotherms give +1.4" in line for line in found.understood)
    path.write_text("temperature_degC,log10_aT\n3,1.5\n48,-1.4\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"one\.csv:2: no isotherm at 3\.00 degC"):
        fit_file(FILES[0], Request("x", AT, shift=path))


def test_the_law_that_is_asked_for_is_kept_and_lays_the_rows(alone):
    found = fit_file(FILES[0], Request("x", AT, law="wlf", replicas=0))
    shift = found.compound.shift
    assert shift.law == "wlf"
    truth = TRUTH.shift_law()
    law = found.compound.shift_law()
    assert law.log10_a_T(253.15) == pytest.approx(float(truth.log10_a_T(253.15)), abs=0.05)
    assert found.rows.log10_a_T == pytest.approx(law.log10_a_T(found.rows.temperature), abs=1e-9)
    assert max(errors(found.compound)) < 0.05
    arrhenius = fit_file(FILES[0], Request("x", AT, law="arrhenius", replicas=0))
    # one energy for 84 K above the glass transition: the master curve itself shows that it does not hold
    assert arrhenius.compound.shift.law == "arrhenius"
    assert arrhenius.fit.residual > 3.0 * alone.fit.residual
    with pytest.raises(InputError, match="no vertical shift"):
        fit_file(FILES[0], Request("x", AT, law="wlf", vertical=True))


def test_the_number_of_terms_follows_the_rule_that_is_printed(alone):
    at = next(k for k, line in enumerate(summary.summary_lines(alone)) if "within 2 of the lowest AICc" in line)
    chosen, *others = [line.split() for line in summary.summary_lines(alone)[at + 1 : at + 7]]
    assert len(chosen) == 6  # per decade, penalty, terms, effective parameters, residual, score
    near = [one for one in others if float(one[5]) <= min(float(x[5]) for x in (chosen, *others)) + 2.0]
    assert all((int(chosen[2]), float(chosen[3])) <= (int(one[2]), float(one[3])) for one in near)


@pytest.mark.parametrize("law", ["wlf", "arrhenius"])
def test_the_constants_of_a_law_stand_in_every_output(law):
    fitted = fit_file(FILES[0], Request("x", "25 degC", replicas=0, law=law))
    kept = fitted.compound.shift
    constants = (
        f"c1 {kept.c1:.4g}, c2 {float(str(kept.c2).split()[0]):.4g} K at 25 °C"
        if law == "wlf"
        else f"activation energy {float(str(kept.activation_energy).split()[0]):.4g} kJ/mol at 25 °C"
    )
    criteria = fit_verdict.fit_criteria(fitted)
    assert any(constants in line for line in summary.summary_lines(fitted))
    page = str(fit_page.build_page(fitted, criteria, {}))
    assert page.count(constants) == 2  # of the law kept, and in the table of laws
    contents = fit_tables.fit_contents(fitted, criteria, {})
    facts = {row[0]: row[1] for row in contents["about"].rows}
    assert facts["shift law kept"] == f"{'WLF' if law == 'wlf' else 'Arrhenius'}: {constants}"
    laws = contents["laws"]
    assert constants in [laws.columns[1].get(row) for row in laws.rows]


def test_sweeps_that_begin_above_the_working_strain_have_no_factor_there():
    """Their table stands all the same; one that holds 2.2 % has that of itself."""
    whole = shelf.compound("s100")
    data = whole.strain_dependence
    high = [one.replace(**{name: getattr(one, name)[-8:] for name in ("strain", "storage", "loss")})
            for one in data.sweeps]  # fmt: skip
    above = whole.replace(strain_dependence=data.replace(sweeps=high, reference_strain="5 %"))
    for compound, known in ((whole, True), (above, False)):
        shown = fit_tables.strain_sweep_table(SimpleNamespace(compound=compound, levels=()))
        columns = {column.key: column for column in shown.columns}
        for key, curve in (("storage_factor", "storage"), ("loss_factor", "loss")):
            found = [columns[key].get(row) for row in shown.rows]
            factors = compound.amplitude_factors()
            expected = [float(getattr(factors, curve)(0.022, row.temperature)) for row in shown.rows] if known else None
            assert found == (pytest.approx(expected) if known else [None] * len(high))


def test_a_law_has_its_error_in_the_band(tmp_path: Path):
    """Laws of the replicas hold the truth where it is that law, and scatter by what they miss where it is not."""
    spread = {}
    for name in ("wlf", "arrhenius"):
        compound = fit_file(FILES[0], Request("x", AT, law=name)).compound
        path = tmp_path / f"{name}.yaml"
        path.write_text(shelf.dump(compound), encoding="utf-8")
        read = shelf.read_compound(path)
        laws = [shift.at(read.reference) for shift in read.prony.band.shift]
        assert len(laws) == len(read.replicas(253.15)) == len(read.alternatives()) == 20
        spread[name] = np.array([float(law.log10_a_T(253.15)) for law in laws])
    truth = float(TRUTH.shift_law().log10_a_T(253.15))
    assert spread["wlf"].min() < truth < spread["wlf"].max()
    assert 0.0 < np.std(spread["wlf"]) < 0.05 < np.std(spread["arrhenius"])


def test_errors_weigh_the_moduli(tmp_path: Path):
    """Of E' and E'' that disagree the fit follows the one that is stated to be known better."""
    f = np.logspace(-2.0, 4.0, 40)
    omega = 2.0 * np.pi * f
    series = TRUTH.series(293.15)
    rows = zip(f, series.storage(omega), 1.2 * series.loss(omega), strict=True)
    path = tmp_path / "m.csv"
    path.write_text(
        "frequency_Hz,E'_Pa,E''_Pa\n" + "".join(f"{a:.8g},{b:.8g},{c:.8g}\n" for a, b, c in rows),
        encoding="utf-8",
    )
    left = {}
    for which, (first, second) in {"storage": (0.01, 0.1), "loss": (0.1, 0.01)}.items():
        fit = fit_file(path, Request("x", AT, replicas=0, storage_error=first, loss_error=second)).fit
        left[which] = fit.storage.rms, fit.loss.rms
    assert left["storage"][0] < 0.3 * left["loss"][0]
    assert left["loss"][1] < 0.3 * left["storage"][1]
    with pytest.raises(InputError, match="both"):
        fit_file(path, Request("x", AT, storage_error=0.01))


def test_e_or_g_is_answered(tmp_path: Path):
    path = tmp_path / "m.csv"
    rows = "".join(f"{f:.6g},{1e6 * f**0.1:.8g},{1.5e5 * f**0.1:.8g}\n" for f in np.logspace(-2, 4, 30))
    path.write_text("torsion test\nfrequency_Hz,storage_Pa,loss_Pa\n" + rows, encoding="utf-8")
    with pytest.raises(InputError, match="--moduli"):
        fit_file(path, Request("x", AT, replicas=0))
    tensile, shear = (
        fit_file(path, Request("x", AT, replicas=0, reading={"letter": letter})).fit.series for letter in "EG"
    )
    assert shear.storage(1.0) == pytest.approx(3.0 * float(tensile.storage(1.0)), rel=1e-9)
    path.write_text("frequency_Hz,E'_Pa,E''_Pa\n" + rows, encoding="utf-8")
    with pytest.raises(InputError, match="the name says E, not G"):
        fit_file(path, Request("x", AT, reading={"letter": "G"}))


def test_a_good_rubber_passes_and_the_page_holds_what_is_signed(together):
    criteria = fit_verdict.fit_criteria(together, load(ROOT / "examples" / "specs" / "overland.yaml"))
    assert fit_verdict.is_accepted(criteria), [one.line for one in criteria if one.verdict == "FAIL"]
    assert any(one.name.startswith("window covers") for one in criteria)
    page = str(fit_page.build_page(together, criteria, {"by": "A. Tester <b>", "number": "2026-17"}))
    for words in (
        "A. Tester &lt;b&gt;",
        "2026-17",
        "DMA, tension 15 x 5 x 2 mm",
        "approved by, date",
        "Glossary",
    ):
        assert words in page
    assert page.count("<svg") == 5
    assert all(one.name in page for one in criteria if "'" not in one.name)


def failing(found, conveyor=None) -> set[str]:
    return {one.name for one in fit_verdict.fit_criteria(found, conveyor) if one.verdict == "FAIL"}


def test_each_fault_fails_its_own_criterion(tmp_path: Path):
    head, *rows = [line for line in FILES[0].read_text(encoding="utf-8").splitlines() if not line.startswith("#")]

    def fitted(change) -> set[str]:
        path = tmp_path / "changed.csv"
        path.write_text("\n".join([head, *(",".join(change(*row.split(","))) for row in rows)]), encoding="utf-8")
        return failing(fit_file(path, Request("x", AT, replicas=0, accept=frozenset({"contradiction"}))))

    assert not fitted(lambda t, f, a, b: (t, f, a, b))
    raised = fitted(lambda t, f, a, b: (t, f, a, str(1.25 * float(b))))
    assert {"Kramers-Kronig, E'' from E'", "best positive spectrum of E' and E''"} <= raised
    stiff = fitted(lambda t, f, a, b: (t, f, a if float(t) > 5.0 else str(1.4 * float(a)), b))
    assert "van Gurp-Palmen collapse" in stiff
    noise = np.random.default_rng(1)
    assert "scatter of E' from row to row" in fitted(
        lambda t, f, a, b: (t, f, str(float(a) * (1.0 + 0.06 * noise.standard_normal())), b)
    )


def test_a_window_that_the_rolls_leave_fails():
    narrow = fit_file(FILES[0], Request("x", "46 degC", replicas=0, exclude=("8-150",)))
    line = load(ROOT / "examples" / "specs" / "overland.yaml")
    cold = line.replace(ambient={"temperature": "-30 degC"})
    assert any(name.startswith("window covers") for name in failing(narrow, cold))


def pairs(path: Path, *, apart: float, factor: float = 1.04) -> Path:
    """The isotherms of FILES[0] twice, as of two specimens: one stiffer, the other softer by a factor."""
    read = read_dma(FILES[0])
    lines = ["Temperature [K],Frequency [Hz],E' [Pa],E'' [Pa],Specimen\n"]
    for specimen, sign in enumerate((-1.0, 1.0)):
        for row in zip(read.temperature, read.frequency, read.storage, read.loss, strict=True):
            t, f, e1, e2 = map(float, row)
            lines.append(f"{t + sign * apart},{f},{e1 * factor**sign},{e2 * factor**sign},{specimen}\n")
    path.write_text("".join(lines), encoding="utf-8")
    return path


def test_repeats_are_averaged_where_that_is_asked_for(tmp_path: Path, alone):
    path = pairs(tmp_path / "pairs.csv", apart=0.2)
    with pytest.raises(InputError, match=r"are they repeats of one temperature\? --repeats averages them"):
        fit_file(path, Request("x", AT, replicas=0))
    with pytest.raises(InputError, match=r"a second sweep at .* or have repeats averaged by --repeats"):
        fit_file(pairs(tmp_path / "same.csv", apart=0.0), Request("x", AT, replicas=0))
    found = fit_file(path, Request("x", AT, replicas=0, repeats=True))
    # the geometric mean of both is the file they were made of; printed digits of the sums alone differ
    assert found.superposition.log10_a_T == pytest.approx(alone.superposition.log10_a_T, abs=1e-6)
    assert found.rows.curve[1] == pytest.approx(alone.rows.curve[1], rel=1e-9)
    assert sum("averaged at 11 frequencies; their E' differ by up to 8.2 %" in line for line in found.understood) == 15
    with pytest.raises(InputError, match=r"are none, their E' differs by a factor of 1\.7: .*--exclude"):
        fit_file(pairs(tmp_path / "odd.csv", apart=0.2, factor=1.3), Request("x", AT, repeats=True))


def sparse(path: Path, frequencies, scatter: float, seed: int = 0) -> Path:
    """Isotherms of the truth at few frequencies, with a scatter of each row."""
    rng = np.random.default_rng(seed)
    lines = ["T [degC];f [Hz];E' [MPa];E'' [MPa]"]
    for t in range(-40, 41, 10):
        for f in frequencies:
            series, omega = TRUTH.series(273.15 + t), 2.0 * np.pi * f
            both = (float(m(omega)) * np.exp(scatter * rng.standard_normal()) for m in (series.storage, series.loss))
            lines.append(";".join([f"{t}", f"{f:.6g}", *(f"{m / 1e6:.6g}" for m in both)]))
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_scatter_of_sparse_isotherms_is_not_their_curvature(tmp_path: Path):
    exact = fit_file(sparse(tmp_path / "exact.csv", (0.1, 2.0, 50.0), 0.0), Request("x", AT, replicas=0))
    f, storage, _ = exact.rows.curve
    assert scatter_within(f, storage, exact.rows.temperature) > fit_verdict.NOISE_LIMITS[0]  # by curvature
    # six digits are printed, and the series leaves 0.1 % at the most
    assert max(exact.noise) < 2e-3
    assert not failing(exact)
    left = next(c for c in fit_verdict.fit_criteria(exact) if c.name == "left by the series")
    assert left.required == "at most 1.0 %"


@pytest.mark.parametrize("frequencies", [(0.1, 2.0, 50.0), tuple(np.geomspace(0.1, 50.0, 5))])
@pytest.mark.parametrize("scatter", [0.01, 0.1])
def test_scatter_of_sparse_isotherms_is_found(tmp_path: Path, frequencies, scatter):
    made = [sparse(tmp_path / f"{seed}.csv", frequencies, scatter, seed) for seed in range(4)]
    found = [fit_file(path, Request("x", AT, replicas=0, accept=frozenset(FINDINGS))).noise for path in made]
    # four files of nine residuals and more, of E' and E'' alike: 1/sqrt(2 * 72) = 8 %; three of it
    assert np.sqrt(np.mean(np.square(found))) == pytest.approx(scatter, rel=0.25)


def test_three_rows_tell_no_scatter(tmp_path: Path):
    path = tmp_path / "three.csv"
    path.write_text("f [Hz];E' [MPa];E'' [MPa]\n0.1;6.1;0.61\n0.16;6.2;0.62\n0.26;6.3;0.64\n", encoding="utf-8")
    fitted = fit_file(path, Request("x", AT, replicas=0, accept=frozenset({"few-rows"})))
    assert fitted.noise == (None, None)
    known = {one.name: one.verdict for one in fit_verdict.fit_criteria(fitted)}
    assert known["scatter of E' from row to row"] == "not checked"
    # 0.1 to 0.26 Hz, where rolls need 150 to 2,500 Hz; what the user insisted on stays a finding
    assert {"window covers usual carry rolls", "finding few-rows"} <= failing(fitted)
    criteria = fit_verdict.fit_criteria(fitted)
    kept = fit_verdict.record_failures(fitted, criteria).compound.fit.failed
    assert any("accepted by the user" in line for line in kept)
    assert any("0.1 to 0.26 Hz" in line for line in kept)


def test_a_window_covers_usual_rolls_at_the_temperatures_that_it_says(alone):
    (one,) = (c for c in fit_verdict.fit_criteria(alone) if c.name == "window covers usual carry rolls")
    low, high = (float(part.removesuffix(" °C")) + 273.15 for part in one.calculated.split(" to "))
    slow, fast = fit_verdict.ROLL_BAND
    for kelvin in (low + 0.5, high - 0.5):  # whole degrees are printed
        first, last = alone.compound.frequencies(kelvin)
        assert first < slow < fast < last
    assert one.verdict == "pass"


def test_scatter_that_fails_allows_the_series_no_more(tmp_path: Path):
    path = sparse(tmp_path / "noisy.csv", np.geomspace(0.1, 50.0, 5), 0.2)
    fitted = fit_file(path, Request("x", AT, replicas=0, accept=frozenset(FINDINGS)))
    criteria = {one.name: one for one in fit_verdict.fit_criteria(fitted)}
    assert criteria["scatter of E' from row to row"].verdict == "FAIL"
    most = float(criteria["left by the series"].required.removeprefix("at most ").removesuffix(" %"))
    assert most == pytest.approx(100.0 * (fitted.fit.consistency_floor + fit_verdict.RESIDUAL_MARGIN), abs=0.06)
