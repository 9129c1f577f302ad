"""A compound of arrays is the compound of a file with the same figures, and `analyse` takes it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import conveyor
from conveyor import shelf
from conveyor.models import RubberCompound
from conveyor.rubber import WLF, Arrhenius, PronySeries, ShiftTable
from conveyor.units import quantity, si

SERIES = PronySeries(4e6, [3e6, 5e6], [1e-2, 1e-4])
ROUNDING = 1e-14  # of units and per cents, a few times 2^-53
SPEC = Path(__file__).parents[2] / "examples" / "specs" / "shuttle.yaml"


def of_arrays(compound: RubberCompound) -> RubberCompound:
    """The same by its arrays in SI alone."""
    shift, known = compound.shift, compound.range
    return RubberCompound.from_series(
        compound.series_at_reference,
        name=compound.name,
        reference_temperature=compound.reference,
        shift=compound.shift_law(),
        log10_b_T=getattr(shift, "log10_b_t", None),
        strain=compound.amplitude_factors(),
        frequencies=None if known is None else (si(known.frequency[0]), si(known.frequency[1])),
        temperatures=None if known is None else known.kelvin,
        poisson_ratio=compound.poisson_ratio,
        density=None if compound.density is None else si(compound.density),
        kind=compound.kind,
        source={"origin": compound.source.origin, "licence": compound.source.licence},
    )


@pytest.mark.parametrize("name", shelf.names())
def test_a_compound_of_the_shelf_is_that_of_its_arrays(name: str) -> None:
    given = shelf.compound(name)
    made = of_arrays(given)
    low, high = given.range.kelvin
    for at in np.linspace(low, high, 5).tolist():
        one, other = given.series(at), made.series(at)
        assert one.moduli == pytest.approx(other.moduli, rel=ROUNDING)
        assert one.times == pytest.approx(other.times, rel=1e-12)  # of temperatures in the shift's exponent
        assert one.equilibrium == pytest.approx(other.equilibrium, rel=ROUNDING)
        assert given.frequencies(at) == pytest.approx(made.frequencies(at), rel=1e-12)
    factors, twin = given.amplitude_factors(), made.amplitude_factors()
    assert (factors is None) == (twin is None)
    if factors is not None:
        strain, at = np.logspace(-3.0, -1.5, 7), factors.temperatures.mean()
        assert factors.storage(strain, at) == pytest.approx(twin.storage(strain, at), rel=1e-12)
        assert factors.loss(strain, at) == pytest.approx(twin.loss(strain, at), rel=1e-12)


def test_analyse_and_compare_take_it_and_a_file_holds_it(tmp_path: Path) -> None:
    line = conveyor.load(SPEC)
    given = line.carry_compound.replace(tests=())  # no test sets its level
    made = of_arrays(given).replace(name="of arrays")
    line, twin = (
        line.replace(
            belt=line.belt.replace(bottom_cover=line.belt.bottom_cover.replace(compound=one)),
            drive=line.drive.replace(design_friction="100 %"),  # as compare has it
        )
        for one in (given, made)
    )
    # the same contacts, but for rounding: far within rtol
    powers = [conveyor.analyse(one).balance.power.motor for one in (line, twin)]
    assert powers[1] == pytest.approx(powers[0], rel=1e-9)
    table = conveyor.compare(line, [given, made])
    assert table["motor power [kW]"].tolist() == pytest.approx([powers[0] / 1e3] * 2, rel=line.calculation.rtol)
    path = tmp_path / "arrays.yaml"
    path.write_text(shelf.dump(made), encoding="utf-8")
    assert shelf.compound(path) == made


@pytest.mark.parametrize(
    ("shift", "law"),
    [
        (WLF(8.86, 101.6, 293.15), "wlf"),
        (Arrhenius(120e3, 293.15), "arrhenius"),
        (ShiftTable([303.15, 283.15, 293.15], [-1.0, 1.2, 0.0], 293.15), "table"),
    ],
    ids=["wlf", "arrhenius", "table"],
)
@pytest.mark.parametrize("reference", [293.15, "20 degC", quantity("293.15 K")], ids=["number", "text", "quantity"])
def test_times_move_by_the_law_that_was_given(shift: Any, law: str, reference: Any) -> None:
    made = RubberCompound.from_series(SERIES, name="mine", reference_temperature=reference, shift=shift)
    assert made.shift is not None
    assert made.shift.law == law
    a_T = 10.0 ** float(shift.log10_a_T(288.15))
    assert made.series(288.15).times == pytest.approx(a_T * SERIES.times, rel=1e-12)
    assert made.series(288.15).moduli == pytest.approx(SERIES.moduli, rel=ROUNDING)
    assert made.missing == ("range of the data", "strain dependence", "density")


def test_a_table_may_shift_the_moduli_too() -> None:
    table = ShiftTable([283.15, 293.15, 303.15], [1.2, 0.0, -1.0], 293.15)
    made = RubberCompound.from_series(
        SERIES, name="mine", reference_temperature=293.15, shift=table, log10_b_T=np.array([-0.1, 0.0, 0.05])
    )
    assert made.series(283.15).moduli == pytest.approx(10.0**-0.1 * SERIES.moduli, rel=1e-12)
    assert made.series(303.15).equilibrium == pytest.approx(10.0**0.05 * SERIES.equilibrium, rel=1e-12)


def test_without_a_shift_it_is_known_at_its_reference_only() -> None:
    made = RubberCompound.from_series(SERIES, name="mine", reference_temperature=293.15)
    assert made.series(293.15).times == pytest.approx(SERIES.times, rel=ROUNDING)
    with pytest.raises(conveyor.RangeError, match=r"no temperature shift: it is known at 293\.15 K only"):
        made.series(283.15)
    assert made.source.licence == "not stated"
    assert "temperature shift" in made.missing


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"shift": WLF(8.86, 101.6, 298.15)},
            r"^shift: its reference is 25 degC, that of the series 20 degC",
        ),
        ({"frequencies": (1.0, 100.0)}, r"^frequencies and temperatures: the range of the data needs both"),
        (
            {"temperatures": (273.15, 313.15)},
            r"^frequencies and temperatures: the range of the data needs both",
        ),
        (
            {"kind": "measured"},
            r'^source: missing; a measured compound states its "origin" and its "licence"',
        ),
        ({"log10_b_T": [0.0, 0.1]}, r"^log10_b_T: belongs to the temperatures of a ShiftTable"),
        ({"kind": "guessed"}, r'^kind: got "guessed", allowed: \'measured\' or \'illustrative\''),
        ({"poisson_ratio": 0.6}, r"^poisson_ratio: got 0\.6, allowed: <= 0\.5"),
        ({"density": 9000.0}, r"^density: got 9000 kg/m\^3, allowed: > 0 kg/m\^3 and <= 5000 kg/m\^3"),
        ({"source": {"origin": "me"}}, r"^source\.licence: missing; expected text"),
        ({"reference_temperature": "20 mm"}, r'got "20 mm" \(a length\), expected a temperature'),
        ({"reference_temperature": -3.0}, r"^reference_temperature: got -3 K, below absolute zero"),
        ({"series": 4e6}, r"^from_series: series: expected PronySeries, got 4000000\.0 \(float\)"),
    ],
)
def test_what_contradicts_itself_is_refused(changes: dict[str, Any], message: str) -> None:
    given = {"series": SERIES, "name": "mine", "reference_temperature": 293.15}
    RubberCompound.from_series(**given)
    with pytest.raises(conveyor.InputError, match=message):
        RubberCompound.from_series(**(given | changes))
