"""The strain of a master curve: read from its files, converted from shear, held against what a person says."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.fitting.amplitude import UNLIKE_STRAINS, WORKING_STRAIN
from conveyor.fitting.fit_verdict import fit_criteria
from conveyor.fitting.fitted_compound import FittedCompound, Request, fit_file
from conveyor.units import si

FREQUENCY = np.geomspace(1.0, 50.0, 7)


def rubber(temperature: float, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """E' and E'' [MPa] of a power law with an exponential shift, invented: tan(pi/2 0.1) between them."""
    storage = 6.0 * (frequency * 10.0 ** (-0.05 * (temperature - 20.0))) ** 0.1
    return storage, storage * math.tan(0.05 * math.pi)


def isotherms(folder: Path, strains: dict[int, float], *, letter: str = "E", column: str = "Strain [%]") -> Path:
    """A file of isotherms at temperatures [degC], each at a strain [%]; no column where its name is empty."""
    factor = 3.0 if letter == "G" else 1.0
    lines = [f"T [degC];f [Hz];{letter}' [MPa];{letter}'' [MPa]" + (f";{column}" if column else "")]
    for t, strain in strains.items():
        for f, a, b in zip(FREQUENCY, *rubber(t, FREQUENCY), strict=True):
            cells = [f"{t};{f:.6g};{a / factor:.8g};{b / factor:.8g}", *([f"{strain:g}"] if column else [])]
            lines.append(";".join(cells))
    path = folder / "isotherms.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def sweep(folder: Path, largest: float) -> Path:
    """A strain sweep up to a strain [%], E' falling by a tenth a decade."""
    rows = [f"20;10;{s:.6g};{6.0 * s**-0.05:.6g};{0.9 * s**-0.02:.6g}" for s in np.geomspace(0.01, largest, 9)]
    path = folder / "sweep.csv"
    path.write_text("\n".join(["T [degC];f [Hz];strain [%];E' [MPa];E'' [MPa]", *rows]), encoding="utf-8")
    return path


ALIKE = dict.fromkeys((0, 10, 20, 30), 0.1)


def fit(path: Path, strain: Path | None = None, given: str | None = None, **reading: object) -> FittedCompound:
    return fit_file(path, Request("pad", "20 degC", strain=strain, reference_strain=given, replicas=0, reading=reading))


def reference(fitted: FittedCompound) -> float:
    known = fitted.compound.strain_dependence
    assert known is not None
    return si(known.reference_strain)


def test_the_column_is_the_reference(tmp_path: Path) -> None:
    path, swept = isotherms(tmp_path, ALIKE), sweep(tmp_path, 10.0)
    fitted = fit(path, swept)
    assert reference(fitted) == pytest.approx(1e-3, rel=1e-5)  # written with six digits
    assert fitted.compound.strain == "0.1 %"
    assert reference(fit(path, swept, "0.105 %")) == pytest.approx(1.05e-3, rel=1e-5)
    with pytest.raises(InputError, match=r"column of the strain says 0\.1 %, --reference-strain 1 %: leave out"):
        fit(path, swept, "1 %")
    with pytest.raises(InputError, match=r"at which strain was the master curve measured\?"):
        fit(isotherms(tmp_path, ALIKE, column=""), swept)


@pytest.mark.parametrize("column", ["Strain [%]", "Shear strain [%]"])
def test_a_shear_strain_is_converted(tmp_path: Path, column: str) -> None:
    path, swept = isotherms(tmp_path, ALIKE, letter="G", column=column), sweep(tmp_path, 10.0)
    # equal energy, E eps^2 = G gamma^2 with E = 3 G
    assert reference(fit(path, swept)) == pytest.approx(1e-3 / math.sqrt(3.0), rel=1e-5)
    assert reference(fit(path, swept, "0.1 % shear")) == pytest.approx(1e-3 / math.sqrt(3.0), rel=1e-5)
    with pytest.raises(InputError, match=r"says 0\.05774 %, converted from the shear strain of the file"):
        fit(path, swept, "0.1 %")


def test_of_a_shear_test_without_the_column_it_is_asked(tmp_path: Path) -> None:
    path, swept = isotherms(tmp_path, ALIKE, letter="G", column=""), sweep(tmp_path, 10.0)
    with pytest.raises(InputError, match=r'Write "0\.1 % shear" or "0\.1 % tensile"'):
        fit(path, swept, "0.1 %")
    assert reference(fit(path, swept, "0.1 % tensile")) == pytest.approx(1e-3, rel=1e-5)
    assert reference(fit(path, swept, "0.1 % shear")) == pytest.approx(1e-3 / math.sqrt(3.0), rel=1e-5)


def test_a_remark_states_it_too(tmp_path: Path) -> None:
    path = isotherms(tmp_path, ALIKE, column="")
    path.write_text("# Strain: 0,1 %\n" + path.read_text(encoding="utf-8"), encoding="utf-8")
    swept = sweep(tmp_path, 10.0)
    assert reference(fit(path, swept)) == pytest.approx(1e-3, rel=1e-5)
    with pytest.raises(InputError, match=r'isotherms\.csv:1: "Strain" says 0\.1 %, --reference-strain 0\.3 %'):
        fit(path, swept, "0.3 %")


def criterion(fitted: FittedCompound, name: str) -> str:
    return next(one.verdict for one in fit_criteria(fitted) if one.name.startswith(name))


def test_isotherms_at_different_strains_fail(tmp_path: Path) -> None:
    mixed = {0: 0.1, 10: 0.1, 20: 0.1 * 1.01 * UNLIKE_STRAINS, 30: 0.1}
    path, swept = isotherms(tmp_path, mixed), sweep(tmp_path, 10.0)
    assert criterion(fit(path), "strain of the isotherms") == "FAIL"
    with pytest.raises(InputError, match=r"measured at 0\.1 % to 0\.126\d* %.*--reference-strain"):
        fit(path, swept)
    assert reference(fit(path, swept, "0.11 %")) == pytest.approx(1.1e-3, rel=1e-5)
    assert criterion(fit(isotherms(tmp_path, ALIKE)), "strain of the isotherms") == "pass"
    assert criterion(fit(isotherms(tmp_path, ALIKE, column="")), "strain of the isotherms") == "not checked"


@pytest.mark.parametrize(
    ("largest", "short"), [(0.5, True), (90.0 * WORKING_STRAIN, True), (110.0 * WORKING_STRAIN, False)]
)
def test_sweeps_that_end_below_the_working_strain_are_told(tmp_path: Path, largest: float, short: bool) -> None:
    fitted = fit(isotherms(tmp_path, ALIKE), sweep(tmp_path, largest))
    said = [line for line in fitted.compound.missing if "where the sweeps end" in line]
    assert bool(said) == short
    assert all(f"above {largest:.4g} %" in line and "calculation: {strain: off}" in line for line in said)


def test_scatter_is_that_within_isotherms(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    frequency, lines = np.geomspace(0.1, 100.0, 40), ["T [degC];f [Hz];E' [MPa];E'' [MPa]"]
    for k, t in enumerate(range(-30, 70, 10)):
        storage, loss = rubber(t, frequency)
        # every second isotherm has two fifths more loss: no shift makes that good
        loss *= 1.4 ** (k % 2)
        storage, loss = (m * np.exp(0.01 * rng.standard_normal(40)) for m in (storage, loss))
        lines += [f"{t};{f:.6g};{a:.6g};{b:.6g}" for f, a, b in zip(frequency, storage, loss, strict=True)]
    path = tmp_path / "anew.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    fitted = fit(path)
    assert fitted.noise[0] is not None
    # 380 residuals of 1 %: their rms is known to 1 / sqrt(2 * 380), four of it allowed and correlated by half
    assert fitted.noise[0] == pytest.approx(0.01, rel=0.2)
    assert fitted.noise[1] == pytest.approx(0.01, rel=0.2)
    assert fitted.disagreement is not None
    assert fitted.noise[1] is not None
    apart = math.hypot(fitted.noise[1], fitted.disagreement[1])
    assert apart == pytest.approx(fitted.fit.loss_noise, rel=1e-12)
    assert fitted.disagreement[1] > 2.0 * fitted.noise[1]
    assert criterion(fitted, "disagreement of E'' between isotherms") == "FAIL"
    assert criterion(fitted, "scatter of E'' from row to row") == "pass"
