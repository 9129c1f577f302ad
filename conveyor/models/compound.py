"""A rubber compound: its relaxation spectrum, temperature shift, provenance and gaps."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationInfo, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from conveyor.arguments.argument_types import check_arguments
from conveyor.arguments.limits import require_number
from conveyor.errors import InputError, MessageQuantity, RangeError
from conveyor.models.base import Model, Name, Number, Problem, raise_problems
from conveyor.models.compound_data import prony_data, shift_data, strain_data, temperature_quantity
from conveyor.models.rolling_tests import RollingTest
from conveyor.models.rubber_data import (
    AbsoluteTemperature,
    FitStatistics,
    MeasuredRange,
    Prony,
    Shift,
    Source,
    StrainDependence,
    TableShift,
)
from conveyor.units import Bounds, Density, Fraction, Quantity, from_si, si, text
from conveyor.units.presentation import format_figure

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from conveyor.rubber import WLF, AmplitudeFactors, Arrhenius, PronySeries, ShiftLaw, ShiftTable


CONVERSION_ROUNDING = 1e-9
"""Relative difference of one temperature given in degC, degF or K: rounding of the conversion only."""


class RubberCompound(Model):
    """A rubber compound as the shelf holds it.

    Examples
    --------
    >>> from conveyor import shelf
    >>> shelf.compound("s100")
    RubberCompound("S100": measured, 30 terms at 39.96 degC, equilibrium modulus 3.425 MPa, shift table)
    """

    name: Name
    """Name on the shelf and in reports."""
    kind: Literal["measured", "illustrative"]
    """Measured (with its source) or illustrative (constructed: not for design)."""
    description: str = ""
    """What it is, in a sentence."""
    source: Source
    poisson_ratio: Annotated[Number, Field(ge=0, le=0.5)]
    """Poisson ratio, taken as constant."""
    density: Annotated[Density, Bounds(gt="0 kg/m^3", le="5000 kg/m^3")] | None = None
    """Density of the rubber."""
    strain: str | None = None
    """Strain amplitude of the measurement, in words."""
    reference_temperature: AbsoluteTemperature
    """Temperature at which the series holds and the shift is 1."""
    prony: Prony
    shift: Shift | None = None
    """Temperature shift of all times; without it only the reference temperature is allowed."""
    range: MeasuredRange | None = None
    strain_dependence: StrainDependence | None = None
    """Softening with strain; without it the rubber is taken as linear."""
    tests: tuple[RollingTest, ...] = ()
    """Rolling-resistance tests: they set its test factor, measured over computed indentation."""
    lot_scatter: Annotated[Fraction, Bounds(ge="0 %", le="50 %")] | None = None
    """Half-width of the 90 % interval of its indentation from lot to lot, by the maker's records; 8 % without it."""
    carrier: Name | None = None
    """Compound whose spectrum stands in for one that was not measured; the tests set its test factor."""
    fit: FitStatistics | None = None
    missing: tuple[str, ...] = ()
    """What is not known about the compound."""

    @model_validator(mode="after")
    def _lawful(self) -> Self:
        """Validate against the rubber laws."""
        checks: dict[str, Callable[[], object]] = {
            "prony": lambda: self.series_at_reference,
            "shift": self.shift_law,
            "prony.band": lambda: [shift and shift.at(self.reference) for shift in self._replica_shifts()],
            "strain_dependence": self.amplitude_factors,
        }
        problems = []
        for name, build in checks.items():
            try:
                build()
            except (InputError, RangeError) as error:
                problems.append(Problem(tuple(name.split(".")), str(error)))
        if self.carrier is not None and not self.tests:
            problems.append(Problem(("tests",), "missing; with a carrier's spectrum the tests are all that is known"))
        raise_problems("RubberCompound", problems)
        return self

    def __repr__(self) -> str:
        prony, shift = self.prony, "no shift" if self.shift is None else f"shift {self.shift.law}"
        return (
            f'RubberCompound("{self.name}": {self.kind}, {len(prony.terms)} terms at '
            f"{format_figure(self.reference, 'temperature', as_input=True)}, equilibrium modulus "
            f"{format_figure(si(prony.equilibrium), 'pressure', as_input=True)}, {shift})"
        )

    def __str__(self) -> str:
        return repr(self)

    @classmethod
    @check_arguments
    def from_series(
        cls,
        series: PronySeries,
        *,
        name: str,
        reference_temperature: float | str | Quantity,
        shift: WLF | Arrhenius | ShiftTable | None = None,
        log10_b_T: Sequence[float] | NDArray[np.float64] | None = None,
        strain: AmplitudeFactors | None = None,
        frequencies: tuple[float, float] | None = None,
        temperatures: tuple[float, float] | None = None,
        poisson_ratio: float = 0.5,
        density: float | None = None,
        kind: Literal["measured", "illustrative"] = "illustrative",
        source: Mapping[str, str] | None = None,
        description: str = "",
    ) -> Self:
        """Make a compound from arrays in SI.

        Parameters
        ----------
        series : PronySeries
            Relaxation spectrum at the reference temperature [Pa, s].
        name : str
            Name of the compound in reports.
        reference_temperature : float, str or Quantity
            Temperature at which the series holds [K], or with its unit ("20 degC").
        shift : WLF, Arrhenius or ShiftTable, optional
            Temperature shift of the times, of the same reference; without it the compound is known at that
            temperature only.
        log10_b_T : array_like, optional
            Vertical shift of all moduli at the temperatures of a table, ascending, shape `(n,)` [-]; none without it.
        strain : AmplitudeFactors, optional
            Softening with strain; linear without it.
        frequencies : tuple of float, optional
            Lowest and highest frequency of the data, at the reference temperature [Hz].
        temperatures : tuple of float, optional
            Lowest and highest temperature of the data [K]; both or neither.
        poisson_ratio : float
            Constant, from 0 to 0.5 [-].
        density : float, optional
            Density of the rubber [kg/m³].
        kind : {"measured", "illustrative"}
            A measured compound states its source.
        source : mapping of str to str, optional
            `origin` and `licence` of the data, as in a compound file.
        description : str
            Description in a sentence.

        Returns
        -------
        RubberCompound
            Also for `conveyor.shelf.dump`; unknown data are listed in `missing`.

        Raises
        ------
        InputError
            Arguments that contradict each other.
        SpecError
            Fields that a compound file would be refused for.

        Examples
        --------
        >>> from conveyor.rubber import WLF, PronySeries
        >>> series = PronySeries(4e6, [3e6, 5e6], [1e-2, 1e-4])
        >>> RubberCompound.from_series(
        ...     series, name="mine", reference_temperature=293.15, shift=WLF(8.86, 101.6, 293.15)
        ... )
        RubberCompound("mine": illustrative, 2 terms at 20 degC, equilibrium modulus 4 MPa, shift wlf)
        """
        at = temperature_quantity(reference_temperature)
        if shift is not None and not math.isclose(shift.reference, si(at), rel_tol=CONVERSION_ROUNDING):
            raise InputError(
                "shift: its reference is {}, that of the series {}; give both at one temperature",
                _temperature_amount(shift.reference),
                _temperature_amount(si(at)),
            )
        if (frequencies is None) != (temperatures is None):
            raise InputError("frequencies and temperatures: the range of the data needs both, or neither is given")
        if kind == "measured" and source is None:
            raise InputError('source: missing; a measured compound states its "origin" and its "licence"')
        unknown = {
            "temperature shift": shift, "range of the data": frequencies, "strain dependence": strain,
            "density": density,
        }  # fmt: skip
        return cls.from_data(
            {
                "name": name,
                "kind": kind,
                "description": description,
                "source": dict(source or {"origin": "arrays given in Python", "licence": "not stated"}),
                "poisson_ratio": poisson_ratio,
                "density": None if density is None else from_si(density, "density"),
                "reference_temperature": at,
                "prony": prony_data(series),
                "shift": shift_data(shift, log10_b_T),
                "range": None
                if frequencies is None or temperatures is None
                else {
                    "frequency": [from_si(limit, "frequency", "Hz") for limit in frequencies],
                    "temperature": list(map(temperature_quantity, temperatures)),
                },
                "strain_dependence": None if strain is None else strain_data(strain),
                "missing": [what for what, known in unknown.items() if known is None],
            }
        )

    @property
    def reference(self) -> float:
        """Reference temperature [K]."""
        return si(self.reference_temperature)

    @property
    def stated_lot_scatter(self) -> float | None:
        """Half-width of the 90 % interval of its indentation from lot to lot [-]; None if not stated."""
        return None if self.lot_scatter is None else si(self.lot_scatter)

    @cached_property
    def series_at_reference(self) -> PronySeries:
        """Terms at the reference temperature [Pa, s]."""
        from conveyor.rubber import PronySeries

        terms = self.prony.terms
        moduli = [si(term.modulus) for term in terms]
        times = np.array([si(term.time) for term in terms])
        return PronySeries(si(self.prony.equilibrium), np.array(moduli), times)

    def shift_law(self) -> ShiftLaw | None:
        """Return the shift law in SI, if the compound has one."""
        return self._law

    @cached_property
    def _law(self) -> ShiftLaw | None:
        return None if self.shift is None else self.shift.at(si(self.reference_temperature))

    def amplitude_factors(self) -> AmplitudeFactors | None:
        """Return the factors of strain on E' and E'', if the compound has the data."""
        return self._factors

    @cached_property
    def _factors(self) -> AmplitudeFactors | None:
        return None if self.strain_dependence is None else self.strain_dependence.factors()

    def swept_series(self, temperature: float) -> PronySeries | None:
        """Return the series at the sweep temperature nearest to a temperature [K]; None within the sweeps.

        Raises
        ------
        RangeError
            The compound is not known there.
        """
        factors = self.amplitude_factors()
        nearest = temperature if factors is None else factors.nearest(temperature)
        return None if nearest == temperature else self.series(nearest)

    def frequencies(self, temperature: float) -> tuple[float, float] | None:
        """Return the measured frequency band [Hz], shifted to a temperature [K]; None if not stated.

        Raises
        ------
        RangeError
            The temperature is outside the shift law.
        """
        if self.range is None:
            return None
        law = self.shift_law()
        factor = 1.0 if law is None else 10.0 ** float(law.log10_a_T(temperature))
        low, high = (si(limit) / factor for limit in self.range.frequency)
        return low, high

    def _refuse_extrapolation(self, temperature: float) -> None:
        if self.range is None:
            return
        low, high = self.range.temperature
        if not self.range.kelvin[0] <= temperature <= self.range.kelvin[1]:
            raise RangeError(
                'compound "{}" is known from {} to {} (its range.temperature), not at {}; calculate inside this range '
                "or extend its data",
                self.name,
                *map(_stated_amount, (low, high)),
                _temperature_amount(temperature),
            )

    def series(self, temperature: float) -> PronySeries:
        """Return the relaxation spectrum at a temperature.

        Parameters
        ----------
        temperature : float
            Absolute temperature [K].

        Returns
        -------
        PronySeries
            The series at `temperature`, SI.

        Raises
        ------
        InputError
            The temperature is no number.
        RangeError
            The temperature is outside the compound's stated range or its shift law, or it has no law.
        """
        require_number(temperature=temperature)
        return self._at(temperature, (self.series_at_reference,), (self.shift,))[0]

    def replicas(self, temperature: float) -> tuple[PronySeries, ...]:
        """Return the replicas of the fit at a temperature, alternatives to `series`.

        Parameters
        ----------
        temperature : float
            Absolute temperature [K].

        Returns
        -------
        tuple of PronySeries
            SI; empty for a compound without a band.

        Raises
        ------
        RangeError
            As `series`.
        """
        return self._at(temperature, self._reference_replicas(), self._replica_shifts())

    def _replica_shifts(self) -> tuple[Shift | None, ...]:
        """Shift of each replica; that of the compound where the band has none."""
        band = self.prony.band
        if band is None:
            return ()
        if band.shift is not None:
            return band.shift
        count = len(band.equilibrium)
        if band.log10_a_t is None:
            return (self.shift,) * count
        if not isinstance(self.shift, TableShift):
            raise InputError("band: log10_aT belongs to a table; the compound's shift is none")
        vertical = band.log10_b_t or (self.shift.log10_b_t,) * count
        return tuple(self.shift.replace(log10_aT=a, log10_bT=b) for a, b in zip(band.log10_a_t, vertical, strict=True))

    def _reference_replicas(self) -> tuple[PronySeries, ...]:
        band, terms = self.prony.band, self.prony.terms
        return () if band is None else band.series([si(term.time) for term in terms])

    def alternatives(self) -> tuple[Self, ...]:
        """Return the compound with each replica of its fit, the replica's shift, and strain sweeps as they scatter."""
        strains = self.strain_dependence
        return tuple(
            self.replace(
                shift=shift,
                prony=prony_data(series),
                strain_dependence=None if strains is None else strains.draw(np.random.default_rng(number)),
            )
            for number, (series, shift) in enumerate(
                zip(self._reference_replicas(), self._replica_shifts(), strict=True)
            )
        )

    def check_temperature(self, temperature: float) -> None:
        """Refuse a temperature at which the compound is not known [K].

        Raises
        ------
        RangeError
            As `series`.
        """
        self._refuse_extrapolation(temperature)
        law = self.shift_law()
        if law is not None:
            law.log10_a_T(temperature)
        elif not math.isclose(temperature, self.reference, rel_tol=CONVERSION_ROUNDING):
            raise RangeError(
                'compound "{}" has no temperature shift: it is known at {} only, not at {}; give it a shift law, or '
                "calculate at its reference temperature",
                self.name,
                _stated_amount(self.reference_temperature),
                _temperature_amount(temperature),
            )

    def _at(
        self, temperature: float, reference: tuple[PronySeries, ...], shifts: tuple[Shift | None, ...]
    ) -> tuple[PronySeries, ...]:
        """Shift series of the reference temperature to another temperature [K], each by its own law."""
        self.check_temperature(temperature)
        if self.shift is None:
            return reference
        pairs = zip(reference, shifts, strict=True)
        return tuple(self._shifted(series, shift, temperature) for series, shift in pairs)

    def _shifted(self, series: PronySeries, shift: Shift | None, temperature: float) -> PronySeries:
        """One series shifted to a temperature [K]."""
        from conveyor.rubber import shift_series

        if shift is None:
            return series
        b_T = shift.vertical(temperature) if isinstance(shift, TableShift) else 1.0
        return shift_series(series, shift.at(self.reference), temperature, b_T=b_T)


def _temperature_amount(temperature: float) -> MessageQuantity:
    """Temperature [K] for a message."""
    return MessageQuantity(
        temperature, "temperature", format_figure(temperature, "temperature", digits=6, as_input=True), digits=6
    )


def _stated_amount(temperature: Quantity) -> MessageQuantity:
    """Temperature for a message, as written in the compound file."""
    return MessageQuantity(si(temperature), "temperature", text(temperature), digits=6)


def _resolve_compound(value: Any, info: ValidationInfo) -> Any:
    """Look up a compound given by name or path with the resolver of the context."""
    if not isinstance(value, str):
        return value
    resolver = (info.context or {}).get("compound")
    if resolver is None:
        message = f'got "{value}": a compound by name needs a shelf; give conveyor.shelf.compound("{value}")'
        raise PydanticCustomError("compound", "{message}", {"message": message})
    try:
        return resolver(value)
    except InputError as error:
        raise PydanticCustomError("compound", "{message}", {"message": str(error)}) from None


class _CompoundMarker:
    """Annotation of a compound that may be given by name or path."""

    wanted = "a compound by its name or path"

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_before_validator_function(_resolve_compound, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        return {"anyOf": [{"type": "string"}, handler(schema)]}


CompoundReference = Annotated[RubberCompound, _CompoundMarker()]
"""A compound, or its shelf name or path where the validation context has a resolver."""
