"""Data of a compound file: source, series and its replicas, shift, strain sweeps, ranges, fit."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.units import (
    Bounds,
    Fraction,
    Frequency,
    Modulus,
    MolarEnergy,
    Temperature,
    TemperatureDifference,
    Time,
    si,
    text,
)

if TYPE_CHECKING:
    from conveyor.rubber import AmplitudeFactors, PronySeries, ShiftLaw, StrainSweep

AbsoluteTemperature = Annotated[Temperature, Bounds(gt="0 K", le="1000 K")]
PositiveModulus = Annotated[Modulus, Bounds(gt="0 Pa")]
PositiveTime = Annotated[Time, Bounds(gt="0 s")]
PositiveFrequency = Annotated[Frequency, Bounds(gt="0 Hz")]
Positive = Annotated[Number, Field(gt=0)]
RelativeError = Annotated[Fraction, Bounds(ge="0 %")]

_PASCALS_PER_UNIT = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}


class Source(Model):
    """Where a compound comes from."""

    origin: str
    """Publication, repository or laboratory."""
    licence: str
    """Licence of the data."""
    data: str | None = None
    """File of the measured points, beside the compound's file."""
    targets: str | tuple[str, ...] | None = None
    """What an illustrative compound was built to show."""


class PronyTerm(Model):
    """One term of the relaxation spectrum."""

    modulus: PositiveModulus
    """E_i."""
    time: PositiveTime
    """Relaxation time τ_i at the reference temperature."""


class TableShift(Model):
    """Measured shifts, interpolated and never extrapolated."""

    law: Literal["table"]
    temperature: Annotated[tuple[AbsoluteTemperature, ...], Field(min_length=2)]
    """Temperatures."""
    log10_a_t: Annotated[tuple[Number, ...], Field(min_length=2, alias="log10_aT")]
    """Decadic logarithm of the shift factor at each temperature, 0 at the reference temperature."""
    log10_b_t: Annotated[tuple[Number, ...] | None, Field(alias="log10_bT")] = None
    """Decadic logarithm of the vertical shift of all moduli at each temperature; none without it."""

    @model_validator(mode="after")
    def _one_vertical_shift_each(self) -> Self:
        count = len(self.temperature)
        if self.log10_b_t is not None and len(self.log10_b_t) != count:
            message = f"got {len(self.log10_b_t)} values, {count} are needed, one per temperature"
            raise_problems("TableShift", [Problem(("log10_bT",), message)])
        return self

    def vertical(self, temperature: float) -> float:
        """Return b_T at an absolute temperature [K] inside the table, monotone between its points."""
        from conveyor.rubber.monotone import MonotoneCubic

        if self.log10_b_t is None:
            return 1.0
        at = np.array([si(t) for t in self.temperature])
        order = np.argsort(at)
        return float(10.0 ** MonotoneCubic(at[order], np.array(self.log10_b_t)[order])(temperature))

    def at(self, reference: float) -> ShiftLaw:
        """Return the law for a reference temperature [K]."""
        from conveyor.rubber import ShiftTable

        temperatures = np.array([si(t) for t in self.temperature])
        return ShiftTable(temperatures, np.array(self.log10_a_t), reference)


class WLFShift(Model):
    """Williams-Landel-Ferry law, log10 a_T = -c1 (T - T_ref)/(c2 + T - T_ref)."""

    law: Literal["wlf"]
    c1: Annotated[Number, Field(gt=0)]
    """First coefficient."""
    c2: Annotated[TemperatureDifference, Bounds(gt="0 delta_degC")]
    """Second coefficient."""

    def at(self, reference: float) -> ShiftLaw:
        """Return the law for a reference temperature [K]."""
        from conveyor.rubber import WLF

        return WLF(c1=self.c1, c2=si(self.c2), reference=reference)


class ArrheniusShift(Model):
    """Arrhenius law, log10 a_T = E_a/(R ln 10) (1/T - 1/T_ref)."""

    law: Literal["arrhenius"]
    activation_energy: Annotated[MolarEnergy, Bounds(gt="0 kJ/mol")]
    """Activation energy."""

    def at(self, reference: float) -> ShiftLaw:
        """Return the law for a reference temperature [K]."""
        from conveyor.rubber import Arrhenius

        return Arrhenius(activation_energy=si(self.activation_energy), reference=reference)


Shift = Annotated[TableShift | WLFShift | ArrheniusShift, Field(discriminator="law")]


class Band(Model):
    """Replicas of a fitted series at the same times: what the data behind it allow as well."""

    method: str
    """How the replicas were drawn."""
    equilibrium: Annotated[tuple[PositiveModulus, ...], Field(min_length=1)]
    """E_e of each replica."""
    unit: Literal["Pa", "kPa", "MPa", "GPa"]
    """Unit of `moduli`."""
    moduli: tuple[tuple[Annotated[Number, Field(ge=0)], ...], ...]
    """E_i of each replica, in the order of the terms; 0 is a term that the replica does not have."""
    log10_a_t: Annotated[tuple[tuple[Number, ...], ...] | None, Field(alias="log10_aT")] = None
    """Shift of each replica at the temperatures of `shift`; that of the compound without it."""
    log10_b_t: Annotated[tuple[tuple[Number, ...], ...] | None, Field(alias="log10_bT")] = None
    """Vertical shift of each replica at the temperatures of `shift`; that of the compound without it."""
    shift: tuple[Shift, ...] | None = None
    """Shift law of each replica, where that of the compound is a formula; that of the compound without it."""

    @model_validator(mode="after")
    def _one_list_per_replica(self) -> Self:
        lists: dict[str, Sequence[object] | None] = {
            "moduli": self.moduli, "log10_aT": self.log10_a_t, "log10_bT": self.log10_b_t, "shift": self.shift
        }  # fmt: skip
        raise_problems(
            "Band",
            [
                Problem(
                    (name,),
                    f"got {len(rows)} lists for {len(self.equilibrium)} values of equilibrium, one list per replica is"
                    " needed",
                )
                for name, rows in lists.items()
                if rows is not None and len(rows) != len(self.equilibrium)
            ],
        )
        return self

    def series(self, times: Sequence[float]) -> tuple[PronySeries, ...]:
        """Return the replicas.

        Parameters
        ----------
        times : sequence of float
            Relaxation times of the terms, in their order [s].

        Returns
        -------
        tuple of PronySeries
            One per replica, SI; terms of modulus 0 left out.
        """
        from conveyor.rubber import PronySeries

        tau, scale = np.array(times), _PASCALS_PER_UNIT[self.unit]
        lists = []
        for equilibrium, row in zip(self.equilibrium, self.moduli, strict=True):
            moduli = np.array(row) * scale
            lists.append(PronySeries(si(equilibrium), moduli[moduli > 0.0], tau[moduli > 0.0]))
        return tuple(lists)


class Prony(Model):
    """Relaxation modulus E(t) = E_e + Σ E_i exp(-t/τ_i) at the reference temperature."""

    equilibrium: PositiveModulus
    """E_e, the modulus at rest."""
    terms: Annotated[tuple[PronyTerm, ...], Field(max_length=500)]
    """Terms, in any order, with distinct times."""
    band: Band | None = None
    """Replicas of the fit, for the uncertainty of every result."""

    @model_validator(mode="after")
    def _one_modulus_per_term(self) -> Self:
        count = len(self.terms)
        raise_problems(
            "Prony",
            [
                Problem(("band", "moduli", i), f"got {len(row)} moduli, {count} are needed, one per term")
                for i, row in enumerate(self.band.moduli if self.band else ())
                if len(row) != count
            ],
        )
        return self


class MeasuredRange(Model):
    """Where the data behind a compound lie."""

    frequency: tuple[PositiveFrequency, PositiveFrequency]
    """Lowest and highest frequency at the reference temperature."""
    temperature: tuple[AbsoluteTemperature, AbsoluteTemperature]
    """Lowest and highest temperature."""

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        pairs = {"frequency": self.frequency, "temperature": self.temperature}
        raise_problems(
            "MeasuredRange",
            [
                Problem((name,), f"got {text(low)} to {text(high)}, expected the lower value first")
                for name, (low, high) in pairs.items()
                if not si(low) <= si(high)
            ],
        )
        return self

    @property
    def kelvin(self) -> tuple[float, float]:
        """Lowest and highest temperature [K]."""
        low, high = self.temperature
        return si(low), si(high)


class SweptStrain(Model):
    """Moduli against strain amplitude at one temperature and frequency."""

    temperature: AbsoluteTemperature
    """Temperature of the sweep."""
    frequency: PositiveFrequency
    """Frequency of the sweep."""
    strain: Annotated[tuple[Positive, ...], Field(min_length=4, max_length=1000)]
    """Single strain amplitudes, ascending, in per cent."""
    unit: Literal["Pa", "kPa", "MPa", "GPa"]
    """Unit of `storage` and `loss`."""
    storage: Annotated[tuple[Positive, ...], Field(min_length=4, max_length=1000)]
    """E' at each strain."""
    loss: Annotated[tuple[Positive, ...], Field(min_length=4, max_length=1000)]
    """E'' at each strain."""

    def sweep(self) -> StrainSweep:
        """Return the sweep in SI."""
        return self._sweep

    @cached_property
    def _sweep(self) -> StrainSweep:
        from conveyor.rubber import StrainSweep

        scale = _PASCALS_PER_UNIT[self.unit]
        return StrainSweep(
            si(self.temperature),
            si(self.frequency),
            0.01 * np.array(self.strain),
            scale * np.array(self.storage),
            scale * np.array(self.loss),
        )

    def draw(self, random: np.random.Generator) -> SweptStrain:
        """Draw a sweep that the same measurement could have given, see `conveyor.rubber.StrainSweep.draw`."""
        measured = self.sweep()
        drawn = measured.draw(random)
        if drawn is measured:
            return self
        scale = _PASCALS_PER_UNIT[self.unit]
        return self.replace(storage=tuple((drawn.storage / scale).tolist()), loss=tuple((drawn.loss / scale).tolist()))


class StrainDependence(Model):
    """How filled rubber softens with the amplitude of its strain (Payne effect)."""

    reference_strain: Annotated[Fraction, Bounds(gt="0 %", le="100 %")]
    """Single strain amplitude at which the master curve was measured: there the factors are 1."""
    reference_note: str = ""
    """How the reference strain is known."""
    source: str = ""
    """Where the sweeps come from."""
    sweeps: Annotated[tuple[SweptStrain, ...], Field(min_length=1, max_length=50)]
    """One entry for each temperature and frequency."""

    def factors(self) -> AmplitudeFactors:
        """Return the factors on E' and E'' in SI.

        Raises
        ------
        InputError
            Sweeps that do not ascend or contradict the reference strain.
        """
        from conveyor.rubber import AmplitudeFactors

        return AmplitudeFactors([sweep.sweep() for sweep in self.sweeps], si(self.reference_strain))

    def draw(self, random: np.random.Generator) -> StrainDependence:
        """Draw sweeps that the same measurement could have given, each by its scatter from row to row."""
        drawn = tuple(sweep.draw(random) for sweep in self.sweeps)
        return self if all(map(operator.is_, drawn, self.sweeps)) else self.replace(sweeps=drawn)


class FitStatistics(Model):
    """How well the series meets the data, as relative errors."""

    storage_rms: RelativeError
    """Root mean square of E' over all rows."""
    loss_rms: RelativeError
    """Root mean square of E'' over all rows."""
    storage_worst: RelativeError
    """Largest of E'."""
    loss_worst: RelativeError
    """Largest of E''."""
    method: str
    """How it was fitted."""
    failed: tuple[str, ...] = ()
    """Criteria of the fit that are not met, each with its figure; `conveyor fit` writes them."""
