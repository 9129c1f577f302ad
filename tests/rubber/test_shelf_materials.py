"""The shelf: data as published, files that the script reproduces, compounds that are what they say."""

from __future__ import annotations

import hashlib
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ruamel.yaml import YAML

from conveyor import shelf
from conveyor.indentation import RollContact, indentation_resistances
from conveyor.laboratory import read_dma
from conveyor.line.rolling_test_theory import compound_test_factor
from conveyor.rubber import WLF, PronySeries, ShiftLaw, ShiftTable, shift_series

ROOT = Path(__file__).parents[2]
SHELF = ROOT / "materials"
NAMES = ["s100", "s120", "standard-cover", "low-rolling-resistance-cover", "cold-resistant-cover"]
TARGETS = {
    "standard-cover": (10e6, 0.20),
    "low-rolling-resistance-cover": (8e6, 0.12),
    "cold-resistant-cover": (8e6, 0.15),
}
KEYS = {
    "name", "kind", "description", "source", "poisson_ratio", "strain", "reference_temperature",
    "prony", "shift", "range", "strain_dependence", "tests", "fit", "missing",
}  # fmt: skip
TEN_HERTZ = 2 * np.pi * 10.0


def raw(text: str) -> dict[str, Any]:
    loaded: dict[str, Any] = YAML(typ="safe").load(text)
    return loaded


def compound(name: str) -> dict[str, Any]:
    return raw((SHELF / f"{name}.yaml").read_text(encoding="utf-8"))


def si(text: str) -> float:
    """The few units the shelf uses; no more, so that a stray one fails here."""
    number, unit = text.split(" ")
    if unit == "degC":
        return float(number) + 273.15
    return float(number) * {"MPa": 1e6, "s": 1.0, "Hz": 1.0, "K": 1.0, "kg/m^3": 1.0}[unit]


def series_of(c: dict[str, Any]) -> PronySeries:
    terms = c["prony"]["terms"]
    moduli, times = [si(t["modulus"]) for t in terms], [si(t["time"]) for t in terms]
    return PronySeries(si(c["prony"]["equilibrium"]), moduli, times)


def law_of(c: dict[str, Any]) -> ShiftLaw:
    shift, reference = c["shift"], si(c["reference_temperature"])
    if shift["law"] == "wlf":
        return WLF(shift["c1"], si(shift["c2"]), reference)
    return ShiftTable([si(t) for t in shift["temperature"]], shift["log10_aT"], reference)


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    return runpy.run_path(str(ROOT / "examples" / "02_refit_materials.py"))


@pytest.mark.parametrize(
    "file", [f"{name}.{kind}.csv" for name in ("s100", "s120") for kind in ("dma", "shift", "strain")]
)
def test_rows_are_the_published_ones(file: str) -> None:
    lines = (SHELF / file).read_text(encoding="utf-8").splitlines()
    stated = next(x.split(": ")[1] for x in lines if x.startswith("# sha256_of_published_rows"))
    rows = [x for x in lines if not x.startswith("#")][1:]
    published = "".join(x.replace(",", "\t") + "\n" for x in rows)
    assert hashlib.sha256(published.encode()).hexdigest() == stated


def test_spot_values_of_the_published_data() -> None:
    s100, s120 = (read_dma(SHELF / f"{n}.dma.csv") for n in ("s100", "s120"))
    assert (s100.frequency.size, s120.frequency.size) == (84, 84)
    first = s100.frequency[0], s100.storage[0], s100.loss[0]
    last = s120.frequency[-1], s120.storage[-1], s120.loss[-1]
    assert first == pytest.approx((1.439e-3, 4.644e6, 3.137e5), rel=1e-12)
    assert last == pytest.approx((3.789e9, 4.4159862316946548e8, 3.8447175405600593e8), rel=1e-12)


def numbers(node: Any) -> list[tuple[str, Any]]:
    """Every leaf with its path; 'number unit' strings as numbers."""
    if isinstance(node, dict):
        return [(f"{k}.{p}", v) for k, child in node.items() for p, v in numbers(child)]
    if isinstance(node, list):
        return [(f"{i}.{p}", v) for i, child in enumerate(node) for p, v in numbers(child)]
    if isinstance(node, str) and node.count(" ") == 1:
        number, unit = node.split(" ")
        try:
            return [(unit, float(number))]
        except ValueError:
            return [("", node)]
    return [("", node)]


@pytest.mark.parametrize("name", NAMES)
def test_script_reproduces_the_committed_file(name: str, script: dict[str, Any]) -> None:
    fresh = numbers(raw(script["shelf_texts"]()[f"{name}.yaml"]))
    kept = numbers(compound(name))
    assert [p for p, _ in fresh] == [p for p, _ in kept]
    for (path, a), (_, b) in zip(fresh, kept, strict=True):
        if isinstance(a, float):
            # twelve digits written, condition of the fit below 10, other linear algebra libraries allowed
            # the replicas are written with six digits: a last one may round the other way
            assert a == pytest.approx(b, rel=2e-5 if ".band." in path else 1e-9, abs=0), path
        else:
            assert a == b, path


def test_script_writes_all_files(tmp_path: Path, script: dict[str, Any]) -> None:
    script["main"](tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(f"{n}.yaml" for n in NAMES)
    assert sorted(p.stem for p in SHELF.glob("*.yaml")) == sorted(NAMES)


def test_reading_back_gives_the_fit_itself(script: dict[str, Any]) -> None:
    for name in ("S100", "S120"):
        fit, read = script["refit"](name).fit, series_of(compound(name.lower()))
        np.testing.assert_allclose(read.moduli, fit.series.moduli, rtol=1e-9)
        np.testing.assert_allclose(read.times, fit.series.times, rtol=1e-9)
        assert read.equilibrium == pytest.approx(fit.series.equilibrium, rel=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_every_compound_is_complete_and_usable(name: str) -> None:
    c = compound(name)
    assert c.keys() - {"density"} == KEYS
    assert ("carrier" in c) is False
    assert bool(c["tests"]) == (name in TARGETS)
    assert c["name"].lower() == name
    assert c["kind"] == ("illustrative" if name in TARGETS else "measured")
    assert ("NOT a measured compound" in c["description"]) == (name in TARGETS)
    assert c["missing"]
    series, law = series_of(c), law_of(c)
    # times beyond the window by more than a decade would not be determined by it
    low, high = (si(f) for f in c["range"]["frequency"])
    if c["kind"] == "measured":
        assert series.times[0] >= 0.0999 / (2 * np.pi * high)
        assert series.times[-1] <= 10.01 / (2 * np.pi * low)
    for temperature in (si(t) for t in c["range"]["temperature"]):
        assert np.isfinite(shift_series(series, law, temperature).times).all()
    assert float(law.log10_a_T(si(c["reference_temperature"]))) == 0.0
    omega = np.logspace(-20, 20, 400)
    assert np.abs(series.creep().compliance(omega) * series.modulus(omega) - 1).max() < 1e-12


@pytest.mark.parametrize("name", ["s100", "s120"])
def test_stated_misfit_is_the_misfit_of_the_written_numbers(name: str) -> None:
    c = compound(name)
    curve = read_dma(SHELF / c["source"]["data"])
    series, omega = series_of(c), 2 * np.pi * curve.frequency
    # measured from 1 to 100 Hz: each row at the temperature that brings it to 10 Hz
    kelvin, decades = np.array([si(t) for t in c["shift"]["temperature"]]), np.array(c["shift"]["log10_aT"])
    measured = np.interp(1.0 - np.log10(curve.frequency), -decades, kelvin)
    b = measured / si(c["reference_temperature"])
    storage, loss = series.storage(omega) * b / curve.storage - 1, series.loss(omega) * b / curve.loss - 1
    # the ends of the window say 10 Hz to 0.02 decades: 0.1 K of 300 K, 3e-4 of a modulus
    assert c["fit"]["storage_rms"] == pytest.approx(np.sqrt(np.mean(storage**2)), abs=1e-3)
    assert c["fit"]["loss_rms"] == pytest.approx(np.sqrt(np.mean(loss**2)), abs=2e-3)
    assert c["fit"]["storage_worst"] == pytest.approx(np.abs(storage).max(), abs=2e-3)
    assert c["fit"]["loss_worst"] == pytest.approx(np.abs(loss).max(), abs=5e-3)


@pytest.mark.parametrize("name", TARGETS)
def test_illustrative_covers_meet_their_targets(name: str) -> None:
    c = compound(name)
    series = shift_series(series_of(c), law_of(c), 293.15)
    storage, tan_delta = TARGETS[name]
    # 1 % is promised; three linear equations meet them to the twelve digits written
    assert series.storage(TEN_HERTZ) == pytest.approx(storage, rel=1e-9)
    assert series.tan_delta(TEN_HERTZ) == pytest.approx(tan_delta, rel=1e-9)
    assert series.glassy == pytest.approx(1.5e9, rel=1e-9)


@pytest.mark.parametrize("name", TARGETS)
def test_illustrative_covers_are_smooth_and_look_like_rubber(name: str) -> None:
    c = compound(name)
    series, law = series_of(c), law_of(c)
    low, high = (si(f) for f in c["range"]["frequency"])
    omega = 2 * np.pi * np.geomspace(low, high, 1401)
    tan_delta = series.tan_delta(omega)
    # one glass transition, one shallow network shoulder: at most three turning points, no wiggles
    turns = np.count_nonzero(np.diff(np.sign(np.diff(tan_delta))))
    assert turns <= 3
    assert 0.4 < tan_delta.max() < 1.5
    assert tan_delta.min() > 0.005
    # heating from 0 to 80 degC at 10 Hz softens
    warm = [float(shift_series(series, law, t + 273.15).storage(TEN_HERTZ)) for t in range(0, 81, 5)]
    assert np.all(np.diff(warm) < 0)


def test_covers_differ_as_their_names_say() -> None:
    at: dict[tuple[str, int], PronySeries] = {}
    for name in TARGETS:
        c = compound(name)
        for celsius in (-40, -20, 0, 20, 40):
            at[name, celsius] = shift_series(series_of(c), law_of(c), celsius + 273.15)
    standard, easy, cold = TARGETS
    for celsius in (0, 20, 40):
        assert at[easy, celsius].tan_delta(TEN_HERTZ) < 0.70 * at[standard, celsius].tan_delta(TEN_HERTZ)
    # softer in the cold, and with less loss; what is sold down to -40 degC is no glass there (a tenth of E_inf)
    assert 2 * at[cold, -40].storage(TEN_HERTZ) < at[standard, -40].storage(TEN_HERTZ) < 150e6
    assert at[cold, -20].tan_delta(TEN_HERTZ) < 0.8 * at[standard, -20].tan_delta(TEN_HERTZ)


def friction(name: str, *celsius: float) -> np.ndarray:
    """Indentation of a cover on the roll of its tests at temperatures over that at 20 degC, the strain of the curve."""
    rubber = shelf.compound(name)
    contacts = [
        RollContact(radius=0.1095, spacing=1.0, cover_thickness=7e-3, speed=5.0, series=rubber.series(t + 273.15))
        for t in (20.0, *celsius)
    ]
    solved = np.array([float(one) for one in indentation_resistances(contacts, [3e3] * len(contacts), 1e-4)])
    return np.asarray(solved[1:] / solved[0])


def test_the_cold_costs_power_as_plants_report() -> None:
    """A belt maker's table has f = 0.022, and 0.030 in extreme cold: 1.36 times the whole friction.

    (Bridgestone, friction coefficient of idlers; drag of rolls and flexure do not fall in the cold.) Indentation is
    half to 60 % of it, so 1.2 to 2 times are asked of a standard cover from -20 to -30 degC.
    """
    ratio = friction("standard-cover", 0.0, -20.0, -30.0)
    assert ratio[0] > 1.0
    assert np.all((ratio[1:] > 1.2) & (ratio[1:] < 2.0))


def test_each_cover_does_what_it_is_sold_for() -> None:
    level = {"standard-cover": 1.25, "low-rolling-resistance-cover": 1.0, "cold-resistant-cover": 1.12}
    warm = {name: level[name] * friction(name, 20.0, 40.0) for name in level}
    cold = {name: float(level[name] * friction(name, -25.0)[0]) for name in level}
    standard, easy, resistant = level
    assert np.all(warm[easy] < 0.85 * warm[standard])
    assert cold[resistant] < 0.9 * min(cold[standard], cold[easy])


@pytest.mark.parametrize("name", TARGETS)
def test_sweeps_and_law_of_the_tests_agree(name: str) -> None:
    """The law has the exponent 1.28, the theory at the strain of the tests the same to 0.03.

    The law's range of loads is not printed: over a half and over twice of 1 to 8 N/mm the theory's exponent differs by
    0.02, and the law is printed to 0.005.
    """
    rubber = shelf.compound(name)
    level = compound_test_factor(rubber, softened=True)
    assert level is not None
    assert abs(level.slope) < 0.03


@pytest.mark.parametrize("name", TARGETS)
def test_replicas_differ_in_the_cold_and_meet_the_targets(name: str) -> None:
    rubber, (storage, tan_delta) = shelf.compound(name), TARGETS[name]
    warm, cold = rubber.replicas(293.15), rubber.replicas(243.15)
    for one in warm:
        # six digits are written, the condition of the equations is below 10
        assert one.storage(TEN_HERTZ) == pytest.approx(storage, rel=1e-5)
        assert one.tan_delta(TEN_HERTZ) == pytest.approx(tan_delta, rel=1e-4)
    stiff = [float(one.storage(TEN_HERTZ)) for one in cold]
    middle = float(rubber.series(243.15).storage(TEN_HERTZ))
    assert min(stiff) < 0.95 * middle
    assert max(stiff) > 1.05 * middle


def test_glass_temperatures_five_kelvin_off_are_in_the_band(script: dict[str, Any]) -> None:
    """All glass temperatures 5 K up and down: the cold friction stays between the replicas'."""
    (cover,) = (one for one in script["ILLUSTRATIVE"] if one.name == "standard-cover")
    rubber = shelf.compound("standard-cover")

    def at(series: Any) -> RollContact:
        return RollContact(radius=0.1095, spacing=1.0, cover_thickness=7e-3, speed=5.0, series=series)

    def carried(pairs: list[tuple[Any, Any]]) -> Any:
        """Friction at -30 degC over that at 20 degC."""
        contacts = [at(one) for pair in pairs for one in pair]
        solved = indentation_resistances(contacts, [3e3] * len(contacts), 1e-3)
        cold, warm = np.array([float(one) for one in solved]).reshape(-1, 2).T
        return cold / warm

    moved = []
    for kelvin in (-5.0, 5.0):
        glass = {name: t + kelvin for name, t in script["GLASS"].items()}
        series, law = script["construct"](cover, script["Shape"](glass, cover.blend))
        moved.append((shift_series(series, law, 243.15), series))
    replicas = list(zip(rubber.replicas(243.15), rubber.replicas(293.15), strict=True))
    band, off = carried(replicas), carried(moved)
    assert band.min() < off.min()
    assert off.max() < band.max()
